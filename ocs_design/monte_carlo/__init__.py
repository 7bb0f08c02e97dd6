"""Reliability of a design under tolerances and disturbances, by Monte Carlo simulation."""
