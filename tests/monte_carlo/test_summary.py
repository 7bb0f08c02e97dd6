"""What bad outcomes go with, which are put down to modules turned by hand, and intervals."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from campaigns import NAMES, synthetic_outcomes
from scipy import stats

from ocs_design.device.layout import module_axes
from ocs_design.monte_carlo.outcomes import METRICS, share
from ocs_design.monte_carlo.summary import advice, attitude_error, causes, order
from ocs_design.requirement.turns import Drop, Flip, TurnTo

DROP = Drop(name="drop", height=1.0, pitch=0.5)
IN_LINE = Flip(name="flip", jump_height=1.0, angle=-3.0, duration=1.0, incidence=0.0)


def test_what_decides_is_found_and_nothing_else():
    outcomes = synthetic_outcomes(range(400))
    found = causes(outcomes, order(outcomes, DROP, 0))
    assert [(cause.quantity, cause.either_way) for cause in found] == [(NAMES[0], True)]
    distance = np.abs(outcomes.values[:, 0] - np.median(outcomes.values[:, 0]))
    expected = stats.spearmanr(distance, attitude_error(outcomes, DROP, 0)).statistic
    assert abs(found[0].correlation - expected) < 1e-12


def test_one_sided_causes_have_their_sign():
    outcomes = synthetic_outcomes(range(200))
    outcomes.metrics[:] = 0.0
    outcomes.codes[:] = 0
    outcomes.metrics[:, 0, 1] = 5.0 - outcomes.values[:, 3]
    (cause,) = causes(outcomes, order(outcomes, DROP, 0))
    assert (cause.quantity, cause.either_way) == (NAMES[3], False)
    assert cause.correlation == -1.0


def test_failures_are_worse_than_any_pass_and_what_was_not_judged_is_the_worst():
    outcomes = synthetic_outcomes(range(50))
    outcomes.codes[:] = 0
    outcomes.codes[7] = 4
    assert order(outcomes, DROP, 0)[-1] == 7
    outcomes.codes[9], outcomes.metrics[9] = 1, np.nan
    assert order(outcomes, DROP, 0)[-2:].tolist() == [7, 9]


def test_a_turn_is_off_by_the_angle_to_the_vertical_that_is_asked_for():
    """And one that shall only stop turning is off by nothing that is known."""
    outcomes = synthetic_outcomes(range(3))
    asked = TurnTo(name="lean", pitch=0.5, duration=1.0, gravity=1.62, jump_height=1.0)
    tilts = outcomes.metric("touchdown_pitch"), outcomes.metric("touchdown_roll")
    tilts[0][:, 0], tilts[1][:, 0] = (0.5, 0.6, 0.0), 0.0
    outcomes.metric("heading_drift")[:, 0] = 0.0
    found = attitude_error(outcomes, asked, 0)
    np.testing.assert_allclose(found, [0.0, 0.1, 0.5], rtol=0, atol=1e-9)
    assert np.isnan(attitude_error(outcomes, replace(asked, end="at rest"), 0)).all()


def test_a_flip_is_off_by_what_it_lacks():
    outcomes = synthetic_outcomes(range(3))
    np.testing.assert_array_equal(attitude_error(outcomes, IN_LINE, 0), [3.0, 3.0, 3.0])


def test_what_never_varies_is_no_cause():
    outcomes = synthetic_outcomes(range(100))
    outcomes.values[:] = 1.0
    assert causes(outcomes, order(outcomes, DROP, 0)) == ()


def landing_off(axis, samples=60):
    """Some of the samples land off level about one axis, and fail for it alone."""
    outcomes = synthetic_outcomes(range(samples), fail_from=1.5)
    error = outcomes.metric("touchdown_pitch").copy()
    outcomes.metrics[:] = 0.0
    outcomes.metrics[:, :, METRICS.index(f"touchdown_{axis}")] = error
    return outcomes, int((outcomes.codes == 3).sum())


@pytest.mark.parametrize(("axis", "incidence"), [("roll", 0.0), ("pitch", pi / 2.0)])
def test_landings_off_about_the_axis_that_modules_have_no_part_in_are_counted(axis, incidence):
    part = np.abs(module_axes(incidence)[["roll", "pitch"].index(axis)]).max()
    assert part < 1e-12
    outcomes, failures = landing_off(axis)
    assert failures > 3
    turned = replace(IN_LINE, incidence=incidence)
    told = advice(outcomes, turned, 0)
    assert told.startswith(f"{failures} land off level in {axis},")
    assert "`incidence`" in told
    # Nothing is said of robots that fall after a level landing.
    outcomes.codes[outcomes.codes > 0] = 4
    assert advice(outcomes, turned, 0) == ""


@pytest.mark.parametrize(("axis", "incidence"), [("pitch", 0.0), ("roll", None), ("roll", 0.1)])
def test_nothing_is_said_of_an_axis_that_they_turn(axis, incidence):
    outcomes, _ = landing_off(axis)
    assert advice(outcomes, replace(IN_LINE, incidence=incidence), 0) == ""


@pytest.mark.parametrize("flown", [1, 2, 10, 64, 10_000])
def test_it_is_that_of_scipy(flown):
    for passed in {0, 1, flown // 2, flown - 1, flown}:
        exact = stats.binomtest(passed, flown).proportion_ci(0.95, method="exact")
        found = share(passed, flown)
        assert (found.low, found.high) == pytest.approx((exact.low, exact.high), abs=1e-12)
        assert found.estimate == passed / flown
        assert found.width == found.high - found.low


def test_it_holds_the_truth_at_least_as_often_as_it_says():
    """Summed over all outcomes of 20 trials."""
    intervals = [share(passed, 20) for passed in range(21)]
    for truth in np.linspace(0.01, 0.99, 49):
        holds = [found.low <= truth <= found.high for found in intervals]
        assert stats.binom.pmf(range(21), 20, truth)[holds].sum() >= 0.95
