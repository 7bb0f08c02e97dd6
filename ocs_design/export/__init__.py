"""Files for printers, robots and simulators."""
