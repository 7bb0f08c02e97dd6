"""The holes that motor, housing and foot share."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.mounting import BoltCircle, Face, Mounting
from ocs_design.sizing.foot import PLATE_THICKNESS
from ocs_design.sizing.housing import CLEARANCE, DENSITY, WALL
from ocs_design.sizing.mass_moments import MassMoments, cylinder, nothing
from ocs_design.sizing.rim_problem import RimLimits


@dataclass(frozen=True)
class MountHoles:
    """Through holes around the wheel's axis, in the housing's floor and in the foot's plate.

    Attributes:
        pilot_radius: of the hole in the middle, for shaft and centring collar [m]; 0: none.
        screws: of the motor, the first of them straight up; None: not on this side, or not known.
    """

    pilot_radius: float = 0.0
    screws: BoltCircle | None = None

    @property
    def reach(self) -> float:
        """Radius that the holes stay within [m]."""
        return self.pilot_radius if self.screws is None else self.screws.reach

    def cut_out(self) -> MassMoments[float]:
        """What they take, about the middle of the floor's outside."""
        total = nothing()
        for up, forward, radius in self._holes():
            hole = cylinder(radius, WALL + PLATE_THICKNESS, DENSITY)
            moved = hole.shifted((WALL - PLATE_THICKNESS) / 2.0, up)
            total += replace(moved, xx=moved.xx + moved.mass * forward**2)
        return total.times(-1.0)

    def _holes(self) -> Iterator[tuple[float, float, float]]:
        """How far up and forward each is, and its radius [m]."""
        if self.pilot_radius > 0.0:
            yield 0.0, 0.0, self.pilot_radius
        if self.screws is not None:
            for angle in 2.0 * pi * np.arange(self.screws.bolts) / self.screws.bolts:
                up, forward = self.screws.radius * np.cos(angle), self.screws.radius * np.sin(angle)
                yield float(up), float(forward), self.screws.hole_radius


def mount_holes(mounting: Mounting | None) -> MountHoles:
    """Of a motor that is screwed on by the face that its shaft comes out of; else none.

    A motor whose threads are at its back needs a bracket, or stands in the wheel. The hole in the
    middle takes any centring collar that fits between the screws.
    """
    if mounting is None or mounting.stator is None or mounting.stator_face is not Face.OUTPUT:
        return MountHoles()
    stator, shaft = mounting.stator, (mounting.shaft_diameter or 0.0) / 2.0
    pilot = max(stator.inside - WALL, (stator.inside + shaft) / 2.0)
    return MountHoles(pilot, stator)


def limits_with_mount(limits: RimLimits, mount_reach: float | FloatArray) -> RimLimits:
    """Limits of rims whose housing's floor has a wall around its mount [m]."""
    return replace(
        limits, outer_radius_min=np.maximum(np.asarray(mount_reach) + (WALL - CLEARANCE), 0.0)
    )
