"""The records of `design.json`: SI, radians, the base frame B, full double precision."""
