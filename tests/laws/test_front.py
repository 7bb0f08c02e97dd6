"""More time and more room never make a device heavier, nor does a smaller angle."""

from itertools import pairwise

import numpy as np
import pytest
from commands import SOLO12

from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import SWEEPS
from ocs_design.workflows.pareto import draw_front, lightest_device, read_task

SETTLED = 1e-9
"""Relative, to which the selection finds the lightest of one drive."""
ON_A_PLATE = 1e-3
"""The same with room: less of it may make a plate lighter by more than the modules get heavier.

The selection knows a plate's mass, and not that a smaller module has a lighter one: at 0.8 of
Solo12's `r_max` the device is lighter by 1.8e-4. It claims to be within a thousandth.
"""


@pytest.fixture(scope="module")
def solo12():
    return read_task(Specification(robot=RobotSection(file=SOLO12)))


def masses(task, against, ratios):
    """Of the lightest device at each value; inf where there is none."""
    sweep = SWEEPS[against]
    front = draw_front(task, sweep, [ratio * sweep.own(task) for ratio in ratios], lightest_device)
    return [point.device.mass if point.device else np.inf for point in front.points]


@pytest.mark.parametrize(
    ("against", "least"),
    [("time", 0.6), ("radius", 0.75), ("height", 0.21)],
)
@pytest.mark.exhaustive
def test_more_is_never_heavier(solo12, against, least):
    found = masses(solo12, against, (least, 1.0, 1.3))
    near = SETTLED if against == "time" else ON_A_PLATE
    assert all(less >= more * (1.0 - near) for less, more in pairwise(found))
    assert found[0] > found[-1]


@pytest.mark.exhaustive
def test_a_larger_angle_is_never_lighter(solo12):
    found = masses(solo12, "angle", (0.5, 1.0, 1.6))
    assert all(small <= large * (1.0 + SETTLED) for small, large in pairwise(found))
    assert found[-1] > 1.01 * found[0]


def test_a_turn_that_no_motor_can_make_has_no_device(solo12):
    (mass,) = masses(solo12, "time", (0.05,))
    assert mass == np.inf
