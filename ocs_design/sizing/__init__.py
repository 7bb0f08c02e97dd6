"""Sizing: the incidence of the wheel axes, the rim, and the device on the robot that carries it."""
