"""The cage: what carries a motor by its back, as outrunners of aircraft are screwed on.

A cup around the motor on the back of the foot's plate. Its floor holds the motor's back, four posts
with ears between floor and plate take the screws that come through the housing's floor and the
plate. Between the posts there is room for air and wires; printed on its floor nothing overhangs.
"""

from dataclasses import dataclass
from math import pi, sin

from ocs_design.drive.mounting import BoltCircle, Mounting
from ocs_design.sizing.housing import (
    CLEARANCE,
    DENSITY,
    EAR_COUNT,
    EAR_RADIUS,
    LID_SCREW,
    WALL,
    ear_axis,
    ear_holes,
    eared,
)
from ocs_design.sizing.mass_moments import MassMoments, cylinder
from ocs_design.sizing.mount import MountHoles, for_what_turns, screwed_by_face

FRONT_GAP = 1.0e-3
"""Between the turning front of the motor and the foot's plate [m]."""

FLOOR = 3.0e-3
"""Thickness [m]: the motor's screws press on it, as the trunk's do on the foot's base."""

HALF_POST = pi / 6.0
"""Of each post's angle around the axis [rad]: a third of the wall is open."""

_LEAST_EDGE = 0.1
"""Of a post's wall beside its ear [rad]."""


@dataclass(frozen=True)
class Cage:
    """Around one motor.

    Attributes:
        motor_radius, motor_length: [m].
        holes: in its floor, for the motor's screws and for what stands out of its back.
    """

    motor_radius: float
    motor_length: float
    holes: MountHoles

    @property
    def bore(self) -> float:
        """Radius of its room, in which the motor's bell turns [m]."""
        return self.motor_radius + CLEARANCE

    @property
    def across(self) -> float:
        """Radius of its wall, outside [m]."""
        return self.bore + WALL

    @property
    def depth(self) -> float:
        """Of its room [m]."""
        return FRONT_GAP + self.motor_length

    @property
    def length(self) -> float:
        """From the foot's plate to the back of its floor [m]."""
        return self.depth + FLOOR

    @property
    def reach(self) -> float:
        """Radius that its ears stay within [m]."""
        return ear_axis(self.across) + EAR_RADIUS

    @property
    def screws(self) -> BoltCircle:
        """Through floor and plate into its ears, of which the first is straight up."""
        return BoltCircle(2.0 * ear_axis(self.across), EAR_COUNT, LID_SCREW.name)

    def moments(self) -> MassMoments[float]:
        """About the middle of its front; it stands behind it."""
        tapped = ear_holes(self.across, LID_SCREW.tapping_drill / 2.0, self.depth)
        room = cylinder(self.bore, self.depth, DENSITY) + tapped + self._windows()
        whole = eared(self.across, self.length).shifted(-self.length / 2.0, 0.0)
        floor = self.holes.cut_out(FLOOR).shifted(-self.length + FLOOR / 2.0, 0.0)
        return whole + room.times(-1.0).shifted(-self.depth / 2.0, 0.0) + floor

    def _windows(self) -> MassMoments[float]:
        """Between the posts: of a ring the share that they have of a turn."""
        ring = cylinder(self.across, self.depth, DENSITY)
        ring += cylinder(self.bore, self.depth, DENSITY).times(-1.0)
        return ring.times(1.0 - EAR_COUNT * HALF_POST / pi)


def cage_of(mounting: Mounting, diameter: float | None, length: float | None) -> Cage | None:
    """For a motor with threads at its back; None where its size is not known or does not do.

    Args:
        mounting: of the motor. diameter, length: of its body [m].
    """
    stator = mounting.stator
    if stator is None or diameter is None or length is None:
        return None
    cage = Cage(diameter / 2.0, length, screwed_by_face(mounting, stator))
    room_for_ears = sin(HALF_POST - _LEAST_EDGE) * cage.across > EAR_RADIUS
    inside = for_what_turns(mounting) + WALL <= cage.bore
    return cage if room_for_ears and inside and stator.reach + WALL <= cage.bore else None
