"""The MJCF reader."""
