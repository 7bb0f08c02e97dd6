"""Which failures are put down to modules that were turned by hand."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from made_outcomes import made_outcomes

from ocs_design.device.layout import module_axes
from ocs_design.monte_carlo.outcomes import METRICS
from ocs_design.monte_carlo.summary import advice
from ocs_design.requirement.maneuver import Flip

FLIP = Flip(name="flip", jump_height=1.0, angle=-3.0, duration=1.0, incidence=0.0)


def landing_off(axis, samples=60):
    """Some of the samples land off level about one axis, and fail for it alone."""
    outcomes = made_outcomes(range(samples), fail_from=1.5)
    error = outcomes.metric("touchdown_pitch").copy()
    outcomes.metrics[:] = 0.0
    outcomes.metrics[:, :, METRICS.index(f"touchdown_{axis}")] = error
    return outcomes, int((outcomes.codes == 3).sum())


def test_roll_that_modules_in_line_do_not_turn_is_counted():
    outcomes, failures = landing_off("roll")
    assert failures > 3
    told = advice(outcomes, FLIP, 0)
    assert told.startswith(f"{failures} land off level in roll")
    assert "`incidence`" in told


@pytest.mark.parametrize(("axis", "incidence"), [("roll", 0.0), ("pitch", pi / 2.0)])
def test_the_axis_is_the_one_that_their_axes_have_no_part_in(axis, incidence):
    part = np.abs(module_axes(incidence)[["roll", "pitch"].index(axis)]).max()
    assert part < 1e-12
    outcomes, _ = landing_off(axis)
    assert f"in {axis}," in advice(outcomes, replace(FLIP, incidence=incidence), 0)


@pytest.mark.parametrize(("axis", "incidence"), [("pitch", 0.0), ("roll", None), ("roll", 0.1)])
def test_nothing_is_said_of_an_axis_that_they_turn(axis, incidence):
    outcomes, _ = landing_off(axis)
    assert advice(outcomes, replace(FLIP, incidence=incidence), 0) == ""


def test_nothing_is_said_of_robots_that_fall_after_a_level_landing():
    outcomes, _ = landing_off("roll")
    outcomes.codes[outcomes.codes > 0] = 4
    assert advice(outcomes, FLIP, 0) == ""
