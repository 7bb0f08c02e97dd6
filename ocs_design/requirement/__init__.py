"""What the device must do: maneuvers, the paper's bound, the specification file."""
