"""Export of a design to files for manufacturing, robots and simulators."""
