"""Validation: robot, device and floor in MuJoCo under the paper's law, its maneuvers, verdicts."""
