"""Causes of bad outcomes, advice for modules turned by hand, and confidence intervals."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from campaigns import NAMES, synthetic_outcomes
from scipy import stats

from ocs_design.device.layout import module_axes
from ocs_design.monte_carlo.outcomes import METRICS, share
from ocs_design.monte_carlo.summary import advice, attitude_error, causes, severity_ranking
from ocs_design.requirement.turns import Drop, Flip, TurnTo

DROP = Drop(name="drop", height=1.0, pitch=0.5)
IN_LINE = Flip(name="flip", jump_height=1.0, angle=-3.0, duration=1.0, incidence=0.0)


def test_only_the_actual_cause_is_found():
    outcomes = synthetic_outcomes(range(400))
    actual = causes(outcomes, severity_ranking(outcomes, DROP, 0))
    assert [(cause.quantity, cause.either_way) for cause in actual] == [(NAMES[0], True)]
    distance = np.abs(outcomes.values[:, 0] - np.median(outcomes.values[:, 0]))
    expected = stats.spearmanr(distance, attitude_error(outcomes, DROP, 0)).statistic
    assert abs(actual[0].correlation - expected) < 1e-12


def test_one_sided_causes_have_their_sign():
    outcomes = synthetic_outcomes(range(200))
    outcomes.metrics[:] = 0.0
    outcomes.codes[:] = 0
    outcomes.metrics[:, 0, 1] = 5.0 - outcomes.values[:, 3]
    (cause,) = causes(outcomes, severity_ranking(outcomes, DROP, 0))
    assert (cause.quantity, cause.either_way) == (NAMES[3], False)
    assert cause.correlation == -1.0


def test_failures_and_unjudged_flights_are_ordered_last():
    outcomes = synthetic_outcomes(range(50))
    outcomes.codes[:] = 0
    outcomes.codes[7] = 4
    assert severity_ranking(outcomes, DROP, 0)[-1] == 7
    outcomes.codes[9], outcomes.metrics[9] = 1, np.nan
    assert severity_ranking(outcomes, DROP, 0)[-2:].tolist() == [7, 9]


def test_the_error_of_a_turn_is_the_angle_of_the_vertical():
    """A turn that only has to end at rest has no known error."""
    outcomes = synthetic_outcomes(range(3))
    maneuver = TurnTo(name="lean", pitch=0.5, duration=1.0, gravity=1.62, jump_height=1.0)
    tilts = outcomes.metric("touchdown_pitch"), outcomes.metric("touchdown_roll")
    tilts[0][:, 0], tilts[1][:, 0] = (0.5, 0.6, 0.0), 0.0
    outcomes.metric("heading_drift")[:, 0] = 0.0
    error = attitude_error(outcomes, maneuver, 0)
    np.testing.assert_allclose(error, [0.0, 0.1, 0.5], rtol=0, atol=1e-9)
    assert np.isnan(attitude_error(outcomes, replace(maneuver, end="at rest"), 0)).all()


def test_the_error_of_a_flip_is_its_missing_angle():
    outcomes = synthetic_outcomes(range(3))
    np.testing.assert_array_equal(attitude_error(outcomes, IN_LINE, 0), [3.0, 3.0, 3.0])


def test_constant_quantities_are_no_cause():
    outcomes = synthetic_outcomes(range(100))
    outcomes.values[:] = 1.0
    assert causes(outcomes, severity_ranking(outcomes, DROP, 0)) == ()


def with_tilted_landings(axis, samples=60):
    """Outcomes in which some samples fail because they land tilted about one axis."""
    outcomes = synthetic_outcomes(range(samples), fail_from=1.5)
    error = outcomes.metric("touchdown_pitch").copy()
    outcomes.metrics[:] = 0.0
    outcomes.metrics[:, :, METRICS.index(f"touchdown_{axis}")] = error
    return outcomes, int((outcomes.codes == 3).sum())


@pytest.mark.parametrize(("axis", "incidence"), [("roll", 0.0), ("pitch", pi / 2.0)])
def test_advice_for_tilted_landings_about_an_axis_without_authority(axis, incidence):
    component = np.abs(module_axes(incidence)[["roll", "pitch"].index(axis)]).max()
    assert component < 1e-12
    outcomes, failures = with_tilted_landings(axis)
    assert failures > 3
    maneuver = replace(IN_LINE, incidence=incidence)
    text = advice(outcomes, maneuver, 0)
    assert text.startswith(f"{failures} land off level in {axis},")
    assert "`incidence`" in text
    # There is no advice for robots that fall after a level landing.
    outcomes.codes[outcomes.codes > 0] = 4
    assert advice(outcomes, maneuver, 0) == ""


@pytest.mark.parametrize(("axis", "incidence"), [("pitch", 0.0), ("roll", None), ("roll", 0.1)])
def test_no_advice_for_an_axis_with_authority(axis, incidence):
    outcomes, _ = with_tilted_landings(axis)
    assert advice(outcomes, replace(IN_LINE, incidence=incidence), 0) == ""


@pytest.mark.parametrize("flown", [1, 2, 10, 64, 10_000])
def test_the_interval_is_that_of_scipy(flown):
    for passed in {0, 1, flown // 2, flown - 1, flown}:
        exact = stats.binomtest(passed, flown).proportion_ci(0.95, method="exact")
        interval = share(passed, flown)
        assert (interval.low, interval.high) == pytest.approx((exact.low, exact.high), abs=1e-12)
        assert interval.estimate == passed / flown
        assert interval.width == interval.high - interval.low


def test_the_interval_has_at_least_its_confidence():
    """Summed over all outcomes of 20 trials."""
    intervals = [share(passed, 20) for passed in range(21)]
    for truth in np.linspace(0.01, 0.99, 49):
        covers = [interval.low <= truth <= interval.high for interval in intervals]
        assert stats.binom.pmf(range(21), 20, truth)[covers].sum() >= 0.95
