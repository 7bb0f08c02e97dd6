"""Thinnest walls against what parts are made of."""

import pytest
from made_parts import FOOT, HOUSING, HUB, TWO_PIECES
from part_gaps import thinnest_wall

from ocs_design.parts.foot import MARK_DEPTH, foot_part
from ocs_design.parts.housing import housing_parts
from ocs_design.parts.printed import BASE_THICKNESS, PANEL, WALL
from ocs_design.parts.wheel import wheel_parts

POLYGONS = 0.01
"""Share of a wall that polygons of 128 sections cost."""


def test_thinnest_of_the_wheel_is_its_web():
    hub = wheel_parts(TWO_PIECES)[1]
    assert thinnest_wall(hub) == pytest.approx(HUB.web_thickness, rel=1e-6)


@pytest.mark.parametrize(
    "part", [*housing_parts(HOUSING), foot_part(FOOT)], ids=["drum", "lid", "foot"]
)
def test_printed_parts_have_the_stated_wall(part):
    least = WALL if part.name == "foot" else PANEL
    assert thinnest_wall(part) >= (1.0 - POLYGONS) * least


def test_marks_leave_most_of_the_base():
    assert BASE_THICKNESS - MARK_DEPTH > WALL
