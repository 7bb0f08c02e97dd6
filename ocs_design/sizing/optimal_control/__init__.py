"""Maneuvers as optimal control problems in 3-D: direct collocation with CasADi and IPOPT."""
