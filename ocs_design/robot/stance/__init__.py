"""Trunk, legs and the posture that a robot is measured in."""
