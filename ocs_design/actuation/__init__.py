"""Actuation: a motor at a voltage with a gear, and what it can do in a given time."""
