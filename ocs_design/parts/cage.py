"""The cage as it is printed: on its floor, its posts upright.

Its own frame stands in the middle of the underside of its floor, the wheel's axis along z and up
along -y, as in the wheel's frame.
"""

from math import pi

from ocs_design.parts.ears import ear_holes, eared, posts
from ocs_design.parts.mount import made_mount
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism
from ocs_design.sizing.cage import FLOOR, HALF_POST, Cage
from ocs_design.sizing.housing import DENSITY, LID_SCREW

FIRST_EAR = -pi / 2.0
"""Angle from the x axis [rad]: straight up, as the first of a ring's holes."""


def cage_part(cage: Cage) -> Part:
    """In its own frame."""
    across, top = cage.across, cage.length
    floor = Prism(eared(across, LID_SCREW, FIRST_EAR), 0.0, FLOOR)
    upright = posts(cage.bore, across, LID_SCREW, HALF_POST, FIRST_EAR)
    tapped = ear_holes(across, LID_SCREW, LID_SCREW.tapping_drill, FIRST_EAR)
    return Part(
        "cage",
        DENSITY,
        (floor, *(Prism(post, FLOOR, top) for post in upright)),
        (
            *made_mount(cage.holes).holes(0.0, FLOOR),
            *(Prism(hole, FLOOR, top) for hole in tapped),
        ),
    )
