"""The device as frozen values, and the records of `design.json`."""
