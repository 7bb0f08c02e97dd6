"""What drives a wheel: motor, gear, and what both can do in a given time."""
