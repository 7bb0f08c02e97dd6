"""The cage: what carries a motor by its back, as outrunners of aircraft are screwed on.

A cup around the motor on the back of the foot's plate. Its floor holds the motor's back, four posts
with ears between floor and plate take the screws that come through the housing's floor and the
plate. Between the posts there is room for air and wires; printed on its floor nothing overhangs.

Its own frame stands in the middle of the underside of its floor, the wheel's axis along z and up
along -y, as in the wheel's frame.
"""

from dataclasses import dataclass
from math import pi

from ocs_design.actuation.motor import BoltCircle
from ocs_design.parts.moments import MassMoments
from ocs_design.parts.part import Part
from ocs_design.parts.printed import (
    CLEARANCE,
    DENSITY,
    LID_SCREW,
    UPRIGHT,
    WALL,
    MountHoles,
    ear_axis,
    ear_holes,
    ear_radius,
    eared,
)
from ocs_design.parts.shapes import EAR_COUNT, Post
from ocs_design.parts.solids import Prism

FRONT_GAP = 1.0e-3
"""Between the turning front of the motor and the foot's plate [m]."""

FLOOR = 3.0e-3
"""Thickness [m]: the motor's screws press on it, as the trunk's do on the foot's base."""

HALF_POST = pi / 6.0
"""Half of each post's angle around the axis [rad]: a third of the wall is open."""

FIRST_EAR = -pi / 2.0
"""Angle from the x axis [rad]: straight up, as the first of a ring's holes."""


@dataclass(frozen=True)
class Cage:
    """The cage around one motor.

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
    def length(self) -> float:
        """Length from the foot's plate to the back of its floor [m]."""
        return FRONT_GAP + self.motor_length + FLOOR

    @property
    def reach(self) -> float:
        """Radius that its ears stay within [m]."""
        return ear_axis(self.across, LID_SCREW) + ear_radius(LID_SCREW)

    @property
    def screws(self) -> BoltCircle:
        """Screws through floor and plate into its ears, of which the first is straight up."""
        return BoltCircle(2.0 * ear_axis(self.across, LID_SCREW), EAR_COUNT, LID_SCREW.name)

    def moments(self) -> MassMoments[float]:
        """Moments about the middle of its front, in the axes of the module; it stands behind."""
        return cage_part(self).moments().turned(UPRIGHT).shifted(-self.length, 0.0)


def cage_part(cage: Cage) -> Part[float]:
    """The cage in its own frame."""
    top, band = cage.length, eared(cage.across, LID_SCREW, FIRST_EAR)
    post = Post(band, cage.bore, HALF_POST)
    posts = Prism(post, FLOOR, top, count=EAR_COUNT, first=FIRST_EAR)
    tapped = ear_holes(band, LID_SCREW.tapping_drill, FLOOR, top)
    return Part(
        "cage",
        DENSITY,
        (Prism(band, 0.0, FLOOR), posts),
        (*cage.holes.prisms(0.0, FLOOR), tapped),
    )
