"""The cage as it is printed, around its motor."""

import pytest
from made_parts import CAGE
from part_gaps import overlap_volume, thinnest_wall, turning_clearance

from ocs_design.parts.cage import FLOOR, FRONT_GAP, cage_part
from ocs_design.parts.part import Part
from ocs_design.parts.printed import CLEARANCE, WALL
from ocs_design.parts.solids import hollow_cylinder

MOTOR = Part(
    "motor", 1.0, (hollow_cylinder(0.0, CAGE.motor_radius, FLOOR, FLOOR + CAGE.motor_length),)
)
TURNING = Part(
    "bell", 1.0, (hollow_cylinder(0.0, CAGE.motor_radius, FLOOR + 2.0 * CLEARANCE, 0.039),)
)


def test_no_wall_is_thinner_than_stated():
    """Polygons make round walls thinner by a few micrometres."""
    assert thinnest_wall(cage_part(CAGE)) == pytest.approx(WALL, abs=2e-5)


def test_the_motor_stands_on_its_floor_and_turns_freely():
    cage = cage_part(CAGE)
    assert overlap_volume(cage, MOTOR) == pytest.approx(0.0, abs=1e-15)
    assert turning_clearance([TURNING], [cage], 0.01) == pytest.approx(CLEARANCE, abs=5e-6)
    assert CAGE.length - FLOOR - CAGE.motor_length == pytest.approx(FRONT_GAP)
