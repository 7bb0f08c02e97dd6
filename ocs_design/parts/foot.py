"""The foot: a turntable with a plate, which sets the incidence angle by hand.

Its own frame is the one that it is printed in: origin in the middle of its underside, z up, the
wheel's axis along y. Two screws into the trunk hold it through arc slots; a line on the trunk that
points forward stands at the mark of the angle.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.parts.housing import Housing
from ocs_design.parts.outline import Outline, arc_slot, rectangle
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, hollow_cylinder
from ocs_design.robot.rotations import rotation_about
from ocs_design.robot.tree import Placement
from ocs_design.sizing.foot import (
    BASE_THICKNESS,
    LONG_MARK_EVERY,
    LONG_MARK_LENGTH,
    MARK_DEPTH,
    MARK_EVERY,
    MARK_LENGTH,
    MARK_WIDTH,
    TRUNK_SCREW,
    base_radius,
    plate_back,
    plate_half_width,
    slot_radius,
    wheel_height,
)
from ocs_design.sizing.housing import DENSITY, WALL

HALF_SWING = pi / 4.0
"""Of each slot to both sides of the wheel's axis [rad]: incidence 0..90 degrees.

So the trunk's screws stand at 45 degrees to the lateral direction.
"""

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Foot:
    """What carries a housing on the trunk.

    Attributes:
        housing: that it carries, with the holes that its plate shares.
    """

    housing: Housing

    @property
    def wheel_height(self) -> float:
        """Of the wheel's centre above the underside [m]."""
        return wheel_height(self.housing.rim_radius)

    @property
    def half_width(self) -> float:
        """Of the plate [m]."""
        return plate_half_width(self.housing.rim_radius, self.housing.mount.reach)

    @property
    def back(self) -> float:
        """Of the plate, from the wheel's middle [m]."""
        return plate_back(self.housing.half_height)

    @property
    def slot_radius(self) -> float:
        """Where heads clear the plate at the ends of the slots [m]."""
        return slot_radius(self.housing.rim_height)

    @property
    def base_radius(self) -> float:
        """Around the marks outside the slots, the heads in them and the plate [m]."""
        size = self.housing.rim_radius, self.housing.rim_height
        return base_radius(*size, self.housing.mount.reach)

    @property
    def placement(self) -> Placement:
        """Of its frame in the wheel's: x forward in both, y along the spin axis, z up is -y."""
        rotation = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        return Placement(rotation, np.array([0.0, self.wheel_height, 0.0]))


def foot_part(foot: Foot) -> Part:
    """In its own frame."""
    base = hollow_cylinder(0.0, foot.base_radius, 0.0, BASE_THICKNESS)
    low, high = -foot.back, -foot.housing.half_height
    plate = Prism(_plate(foot), low, high, _standing(foot, BASE_THICKNESS))
    holes = foot.housing.mount.holes(low, high, _standing(foot, foot.wheel_height))
    cut = (*_slots(foot), *_marks(foot), *holes)
    return Part("foot", DENSITY, (base, plate), cut)


def _standing(foot: Foot, height: float) -> Placement:
    """A frame with the wheel's axes at a height above the underside [m]."""
    return Placement(foot.placement.rotation.T, height * UP)


def _plate(foot: Foot) -> Outline:
    """From the base upwards to half a circle around the wheel's axis; y points down to 0 there."""
    width, axis = foot.half_width, BASE_THICKNESS - foot.wheel_height
    # Zero, and not a difference that is rounded, so that plate and base touch.
    points = [(width, axis), (width, 0.0), (-width, 0.0), (-width, axis)]
    return Outline(np.array(points), np.array([0.0, 0.0, 0.0, 1.0]))


def _slots(foot: Foot) -> Iterator[Prism]:
    for middle in (pi / 2.0, -pi / 2.0):
        outline = arc_slot(
            foot.slot_radius,
            TRUNK_SCREW.clearance_hole,
            middle - HALF_SWING,
            middle + HALF_SWING,
        )
        yield Prism(outline, 0.0, BASE_THICKNESS)


def _marks(foot: Foot) -> Iterator[Prism]:
    """Grooves all along the base's edge."""
    for degrees in range(0, 360, MARK_EVERY):
        length = MARK_LENGTH if degrees % LONG_MARK_EVERY else LONG_MARK_LENGTH
        end = foot.base_radius - WALL
        groove = rectangle(end - length, end, -MARK_WIDTH / 2.0, MARK_WIDTH / 2.0)
        turned = Placement(rotation_about(UP, np.radians(degrees)), np.zeros(3))
        yield Prism(groove, BASE_THICKNESS - MARK_DEPTH, BASE_THICKNESS, turned)
