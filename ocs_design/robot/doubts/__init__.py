"""What a robot file states that can be, but hardly is meant: advisory, named by link and test."""
