"""What is said of a trunk that is narrower than the feet are far apart, or not beneath them."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from robots import SOLO12
from wheels import driven_device

from ocs_design.export.assembly_notes import trunk_notes
from ocs_design.export.device_parts import printed_foot
from ocs_design.robot.meshes import trunk_extent, trunk_top
from ocs_design.robot.reader import read_robot

DEVICE = driven_device()
FOOT = printed_foot(DEVICE)


@pytest.fixture(scope="module")
def robot():
    return read_robot(SOLO12)


def moved(robot, out, up=0.0):
    """With its left wheel so far out, its foot so far above the trunk's top [m]."""
    top = trunk_top(robot.tree, robot.trunk)
    left, right = DEVICE.modules
    place = np.array([0.0, out, top + FOOT.wheel_height + up])
    mirrored = place * [1.0, -1.0, 1.0]
    return replace(
        DEVICE, modules=(replace(left, position=place), replace(right, position=mirrored))
    )


def half_width(robot):
    return trunk_extent(robot.tree, robot.trunk, np.array([0.0, 1.0, 0.0]))


def test_feet_on_the_trunk_need_no_word(robot):
    assert trunk_notes(robot, moved(robot, half_width(robot) - FOOT.base_radius - 1e-6)) == ()


def test_a_base_beyond_the_trunk_is_measured(robot):
    (said,) = trunk_notes(robot, moved(robot, half_width(robot) - FOOT.base_radius + 0.002))
    assert said == "the feet stand 2 mm over the trunk's sides; their screws are on it"


def test_a_screw_beyond_the_trunk_needs_a_plate(robot):
    """The screws stand at 45 degrees, their clearance holes have 3.4 mm."""
    out = half_width(robot) - FOOT.slot_radius / sqrt(2.0) - 0.0017 + 0.003
    (said,) = trunk_notes(robot, moved(robot, out))
    width = 2e3 * (out + FOOT.base_radius)
    assert "the outer screw of each is 3 mm off it" in said
    assert f"a plate of {width:.4g}"[:14] in said


@pytest.mark.parametrize(("up", "words"), [(0.02, "20 mm above"), (-0.015, "15 mm below")])
def test_feet_that_are_not_on_top_need_a_bracket(robot, up, words):
    (said,) = trunk_notes(robot, moved(robot, 0.03, up))
    assert words in said
    assert "bracket" in said


def test_wheels_without_feet_stand_on_nothing(robot):
    bare = replace(DEVICE, carrier=replace(DEVICE.carrier, mass=0.0))
    assert trunk_notes(robot, bare) == ()
