"""The bell of an outrunner with a ring bonded around it, instead of a wheel with a web.

This needs no web, hub or shaft joint and makes a flat module, as in Mini Wheelbot with brass around
an MN4006 (github.com/wheelbot/Mini-Wheelbot, hardware/how-to-assemble-motors.md). The motor stands
on the floor of the housing, inside the ring; its back is screwed to floor and plate.
"""

from typing import NamedTuple

from ocs_design.actuation.motor import AnyMotor, Face
from ocs_design.parts.printed import CLEARANCE, PETG, WALL
from ocs_design.parts.solids import Part, revolved

GLUE_GAP = 0.1e-3
"""Gap between bell and ring [m], filled with epoxy and kept even by a printed fixture."""

BELL_SHARE = 0.45
"""Length of a bell's straight middle part over the motor's length: 11 of the 25 mm of an MN5006. An
estimate: no row of the catalogue has that figure."""

FIXTURE_FLOOR = 3.0e-3
"""Least thickness of the fixture's floor [m]: the bell's front is pressed on it while glue sets."""

FIXTURE_FIT = 0.1e-3
"""Radial play of bell and ring in their fixture [m]: scrape it until both slide in."""

GLUE_ROOM = 1.0e-3
"""Width and depth of the groove under the glue gap, for glue that is squeezed out [m]."""


class Bell(NamedTuple):
    """Limits that a bell sets for a ring around it.

    Attributes:
        bore: radius of the ring's bore [m].
        straight: largest height of the ring, whose middle is in the middle of its housing [m].
        room: height of a rim whose housing has room for motor and shaft [m].
        front: from the ring's middle to the motor's front [m].
        shaft: radius of the shaft there, or 0 [m].
        shaft_length: by which the shaft protrudes from the front; 0 if unknown [m].
    """

    bore: float
    straight: float
    room: float
    front: float
    shaft: float
    shaft_length: float = 0.0

    @property
    def fixture_floor(self) -> float:
        """Thickness of the fixture's floor, through which the shaft must not protrude [m]."""
        return max(FIXTURE_FLOOR, self.shaft_length + FIXTURE_FIT)


def bell_of(motor: AnyMotor) -> Bell | None:
    """Bell of a motor with threads at its back; None: there is none, or its size is not known.

    The motor stands on the housing's floor, with its shaft clear of the lid. So the middle of the
    housing is beyond the bell's by half of shaft and clearance, and the ring must be that much
    lower on both sides.
    """
    mounting, diameter, length = motor.mounting, motor.diameter, motor.length
    if mounting is None or mounting.stator is None or mounting.stator_face is not Face.BACK:
        return None
    if diameter is None or length is None:
        return None
    before = (mounting.shaft_length or 0.0) + CLEARANCE
    straight = BELL_SHARE * length - before
    if straight <= 0.0:
        return None
    bore, room = diameter / 2.0 + GLUE_GAP, length + before - 2.0 * CLEARANCE
    shaft = (mounting.shaft_diameter or 0.0) / 2.0, mounting.shaft_length or 0.0
    return Bell(bore, straight, room, (length - before) / 2.0, *shaft)


def fixture_part(bell: Bell, outer_radius: float, height: float) -> Part[float]:
    """Fixture that holds ring and bell coaxial while the glue sets, in its printing frame.

    The bell stands on its front in a bore, the ring around it on a step inside a wall.

    Args:
        bell: of the motor. outer_radius, height: of the ring [m].
    """
    around = bell.bore - GLUE_GAP + FIXTURE_FIT
    floor = bell.fixture_floor
    step = floor + bell.front - height / 2.0
    inside, top = outer_radius + FIXTURE_FIT, step + height / 2.0
    hole = bell.shaft + FIXTURE_FIT if bell.shaft > 0.0 else 0.0
    groove, bottom, outside = around + GLUE_ROOM, step - GLUE_ROOM, inside + WALL
    wall = (hole, 0.0), (outside, 0.0), (outside, top), (inside, top), (inside, step)
    seat = (groove, step), (groove, bottom), (around, bottom), (around, floor), (hole, floor)
    return Part("ring_fixture", PETG.density, (revolved((*wall, *seat)),))
