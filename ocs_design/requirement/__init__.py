"""Requirements on the device: maneuvers, the paper's bound, the specification file."""
