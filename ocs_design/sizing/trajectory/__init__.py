"""Maneuvers in 3-D: one trajectory program for planned flights and for co-design."""
