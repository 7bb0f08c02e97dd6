"""The faces of a trunk on which two modules may stand, and the places on each of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.bounds import trunk_extent
from ocs_design.robot.robot import Robot
from ocs_design.sizing.placement import CLEARANCE, Place

FORWARD, LEFT, UP = np.eye(3)

ON_TOP = "on top of"

STEP = 0.5
"""Between places that are tried, over the radius of the largest module's sphere."""

STAND_OFF = 2.0
"""Farthest from a face, in the same unit."""

Spot = tuple[float, float, float]
"""Where on a face: along, across and off it [m]."""


@dataclass(frozen=True, eq=False)
class Face:
    """A side of the box around the trunk.

    Attributes:
        name: for people, as in "on top of the trunk".
        normal, along, across: unit vectors in B: outwards, and two in the face, shape (3,).
        outward: how the left module stands off as it grows; see `Place`.
        upright: whether it stands on its foot; see `Place`.
        nearest: point of the face that is nearest to the centre of mass, in B [m], shape (3,).
        shifts, offsets: ranges along and across, from `nearest`, that stay on the face [m].
    """

    name: str
    normal: FloatArray
    along: FloatArray
    across: FloatArray
    outward: FloatArray
    nearest: FloatArray
    shifts: tuple[float, float]
    offsets: tuple[float, float]
    upright: bool = False

    def place(self, spot: Spot) -> Place:
        """Of modules at a spot, to the micrometre."""
        shift, offset, stand_off = spot
        origin = self.nearest + shift * self.along + offset * self.across + stand_off * self.normal
        # A rounding error of the centre of mass must not reach the files.
        x, y, z = (round(float(value), 6) + 0.0 for value in origin)
        out_x, out_y, out_z = (float(value) for value in self.outward)
        return Place((x, y, z), (out_x, out_y, out_z), self.upright)

    def spots(self, reach: float) -> Iterator[Spot]:
        """To try for modules that fill a sphere of radius `reach` [m]."""
        step = STEP * reach
        for shift in _steps(self.shifts, step):
            for offset in _steps(self.offsets, step):
                for stand_off in _steps((0.0, STAND_OFF * reach), step):
                    yield shift, offset, stand_off


def faces(robot: Robot) -> tuple[Face, ...]:
    """Top, back and flanks of the trunk.

    Nothing is put beneath it, where a robot lands that falls short, or in front, where legs fold
    up and cameras look.
    """
    return (
        _sagittal_face(robot, ON_TOP, UP, FORWARD),
        _sagittal_face(robot, "behind", -FORWARD, UP),
        _flank(robot),
    )


def _sagittal_face(robot: Robot, name: str, normal: FloatArray, along: FloatArray) -> Face:
    """Both modules on one face, side by side, as far apart as the trunk is wide or less."""
    shift, shifts = _range(robot, along)
    upright = name == ON_TOP
    return Face(
        name,
        normal,
        along,
        LEFT,
        CLEARANCE * (LEFT if upright else normal + LEFT),
        _plane(robot, normal) * normal + shift * along,
        shifts,
        (0.0, max(_plane(robot, LEFT), _plane(robot, -LEFT))),
        upright,
    )


def _flank(robot: Robot) -> Face:
    """Each module on its own side."""
    forward, shifts = _range(robot, FORWARD)
    up, offsets = _range(robot, UP)
    half_width = max(_plane(robot, LEFT), _plane(robot, -LEFT))
    nearest = half_width * LEFT + forward * FORWARD + up * UP
    return Face("beside", LEFT, FORWARD, UP, CLEARANCE * LEFT, nearest, shifts, offsets)


def _plane(robot: Robot, normal: FloatArray) -> float:
    return trunk_extent(robot.tree, robot.trunk, normal)


def _range(robot: Robot, direction: FloatArray) -> tuple[float, tuple[float, float]]:
    """Coordinate on the trunk nearest to the centre of mass, and how far the trunk goes from it."""
    low, high = -_plane(robot, -direction), _plane(robot, direction)
    start = float(np.clip(direction @ robot.com, low, high))
    return start, (low - start, high - start)


def _steps(limits: tuple[float, float], step: float) -> list[float]:
    """Multiples of `step` between two limits that have 0 between them."""
    low, high = limits
    return [count * step for count in range(int(np.ceil(low / step)), int(high // step) + 1)]
