"""Where the two modules stand on the trunk."""

from collections.abc import Callable

import numpy as np

from ocs_design.arrays import FloatArray, frozen
from ocs_design.robot.bounds import trunk_top
from ocs_design.robot.robot import Robot

CLEARANCE = 1.1
"""Room kept around a wheel, over the radius of the sphere that it sweeps at any incidence."""

Place = Callable[[float, float], FloatArray]
"""Centres of both wheels in B, left first, shape (2, 3), for R and h; all [m]."""


def place_on_top(robot: Robot) -> Place:
    """On top of the trunk over the centre of mass, symmetric to the sagittal plane.

    Each wheel may be turned to any incidence without touching the trunk or the other wheel. Other
    parts of the robot are not looked at: give a position where something stands on the trunk.
    """
    # To the micrometre, so that no rounding error of the centre of mass reaches the files.
    forward = round(float(robot.com[0]), 6) + 0.0
    top = round(trunk_top(robot.tree, robot.trunk), 6)

    def place(outer_radius: float, height: float) -> FloatArray:
        reach = CLEARANCE * float(np.hypot(outer_radius, height / 2.0))
        return frozen([[forward, reach, top + reach], [forward, -reach, top + reach]])

    return place


def place_at(position: tuple[float, ...]) -> Place:
    """The left wheel at `position` in B [m], the right one mirrored in y."""
    x, y, z = position

    def place(outer_radius: float, height: float) -> FloatArray:
        del outer_radius, height
        return frozen([[x, y, z], [x, -y, z]])

    return place
