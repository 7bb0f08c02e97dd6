"""Flights with and without the device, side by side, as MP4 or GIF."""
