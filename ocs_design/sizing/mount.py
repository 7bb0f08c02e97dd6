"""The holes that motor, housing and foot share."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.mounting import BoltCircle, Mounting
from ocs_design.sizing.housing import CLEARANCE, DENSITY, WALL
from ocs_design.sizing.mass_moments import MassMoments, cylinder, nothing, point
from ocs_design.sizing.rim_problem import RimLimits
from ocs_design.sizing.web import HUB_WALL

SHAFT_ROOM = 1.0e-3
"""Around a shaft that turns in a hole of a print [m]: prints are out by 0.2 mm."""

ROTOR_ROOM = HUB_WALL + SHAFT_ROOM
"""Around the holes of what is screwed to a rotor [m]: its wall, and the same to turn in."""


@dataclass(frozen=True)
class MountHoles:
    """Through holes around the wheel's axis.

    Attributes:
        pilot_radius: of the hole in the middle, for shaft and centring collar [m]; 0: none.
        screws: around it, the first of them straight up; None: no others.
    """

    pilot_radius: float = 0.0
    screws: BoltCircle | None = None

    @property
    def reach(self) -> float:
        """Radius that the holes stay within [m]."""
        return self.pilot_radius if self.screws is None else self.screws.reach

    def cut_out(self, thickness: float) -> MassMoments[float]:
        """What they take of a plate [m], about its middle."""
        total = nothing()
        if self.pilot_radius > 0.0:
            total += cylinder(self.pilot_radius, thickness, DENSITY)
        if self.screws is not None:
            hole = cylinder(self.screws.hole_radius, thickness, DENSITY)
            total += around(self.screws, hole)
        return total.times(-1.0)


def around(circle: BoltCircle, each: MassMoments[float]) -> MassMoments[float]:
    """Equal bodies at the places of a circle's screws, the first straight up."""
    total = nothing()
    for up, forward in places(circle):
        moved = each.shifted(0.0, up)
        total += replace(moved, xx=moved.xx + moved.mass * forward**2)
    return total


def points(circle: BoltCircle, mass: float) -> MassMoments[float]:
    """Of that mass in all [kg], at the places of a circle's screws."""
    return around(circle, point(mass / circle.bolts))


def places(circle: BoltCircle) -> Iterator[tuple[float, float]]:
    """How far up and forward each screw is [m]."""
    for index in range(circle.bolts):
        angle = 2.0 * pi * index / circle.bolts
        yield circle.radius * cos(angle), circle.radius * sin(angle)


def screwed_by_face(mounting: Mounting, stator: BoltCircle) -> MountHoles:
    """Of a motor whose threads are in the face that its shaft comes out of.

    The hole in the middle takes any centring collar that fits between the screws.
    """
    shaft = (mounting.shaft_diameter or 0.0) / 2.0
    return MountHoles(max(stator.inside - WALL, (stator.inside + shaft) / 2.0), stator)


def for_what_turns(mounting: Mounting) -> float:
    """Radius of a hole for the shaft, or for what stands between rotor and hub [m]; 0: none."""
    if mounting.rotor is not None:
        return mounting.rotor.reach + ROTOR_ROOM
    if mounting.shaft_diameter is not None:
        return mounting.shaft_diameter / 2.0 + SHAFT_ROOM
    return 0.0


def limits_with_mount(limits: RimLimits, mount_reach: float | FloatArray) -> RimLimits:
    """Limits of rims whose housing's floor has a wall around its mount [m]."""
    return replace(
        limits, outer_radius_min=np.maximum(np.asarray(mount_reach) + (WALL - CLEARANCE), 0.0)
    )
