"""The device's continuous figures together with its maneuvers in 3-D, as one program."""
