"""Error probabilities of the sequential test, summed exactly over all outcomes; the reserve."""

import re
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from campaigns import NAMES, short_campaign, synthetic_outcomes
from commands import SOLO12
from scipy import stats
from wheels import layout_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.device.records.flights import Conclusion
from ocs_design.monte_carlo.certificate import (
    ERROR,
    LARGEST_RAISE,
    SequentialTest,
    certificate,
    lesson,
)
from ocs_design.monte_carlo.outcomes import METRICS, share
from ocs_design.requirement.turns import TurnTo

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
import certified
from certified import operating

endings = cache(certified.endings)

RELIABILITIES = (0.5, 0.8, 0.9, 0.95, 0.99, 0.999)


@pytest.mark.parametrize("specified", RELIABILITIES)
def test_wrong_verdicts_are_within_the_error_probability(specified):
    test = SequentialTest(specified)
    ends = endings(test)
    for reliability in (0.3, specified, 0.5 * (1.0 + specified)):
        assert sum(operating(ends, reliability)[0].values()) == pytest.approx(1.0, abs=1e-9)
    for better in (specified, 0.5 * (1 + specified)):
        assert operating(ends, better)[0][Conclusion.SHORT] <= ERROR
    for worse in (test.worse, 0.9 * test.worse):
        assert operating(ends, worse)[0][Conclusion.CERTIFIED] <= ERROR


@pytest.mark.parametrize("specified", RELIABILITIES)
def test_a_good_device_is_certified_and_a_bad_one_is_not(specified):
    test = SequentialTest(specified)
    ends = endings(test)
    verdicts, flights = operating(ends, 1 - 0.1 * (1 - specified))
    assert verdicts[Conclusion.CERTIFIED] >= 0.999
    first = test.verdict_on(np.ones(test.most_flights, dtype=bool))[1]
    assert flights <= 1.15 * first
    assert operating(ends, 0.5 * test.worse)[0][Conclusion.SHORT] >= 0.9


def test_99_percent_take_152_flights_and_are_rarely_undecided():
    """ln 20 / ln(0.99 / 0.970588) = 151.3."""
    test = SequentialTest(0.99)
    assert test.worse == pytest.approx(0.970588, abs=1e-6)
    assert test.most_flights == 1000
    assert test.verdict_on(np.ones(151, dtype=bool)) == (None, 151)
    assert test.verdict_on(np.ones(400, dtype=bool)) == (Conclusion.CERTIFIED, 152)
    assert test.verdict_on(np.zeros(400, dtype=bool)) == (Conclusion.SHORT, 3)
    halfway = operating(endings(test), 0.5 * (test.required + test.worse))[0]
    assert halfway[Conclusion.UNDECIDED] < 0.1
    for reliability, flights in ((0.95, 32), (0.8, 9)):
        verdict = SequentialTest(reliability).verdict_on(np.ones(64, dtype=bool))
        assert verdict == (Conclusion.CERTIFIED, flights)


@pytest.mark.parametrize("specified", [0.8, 0.95, 0.99])
def test_coverage_of_the_interval_is_nearly_that_of_a_fixed_number(specified):
    """Sequential stopping reduces the coverage, see docs/monte_carlo.md."""
    ends = endings(SequentialTest(specified))
    intervals = [share(passed, flights) for passed, flights, *_ in ends]
    for truth in 1 - np.geomspace(1e-3 * (1 - specified), 0.98, 40):
        covering = [
            end
            for end, interval in zip(ends, intervals, strict=True)
            if interval.low <= truth <= interval.high
        ]
        assert sum(operating(covering, truth)[0].values()) >= 0.89


def test_it_ends_undecided_after_the_maximum():
    test = SequentialTest(0.9)
    passed = np.arange(2 * test.most_flights) % 6 != 5
    assert test.verdict_on(passed) == (Conclusion.UNDECIDED, test.most_flights)


@pytest.fixture(scope="module")
def campaign(solo12):
    return short_campaign(solo12, drop_only=True)


def test_flights_after_the_verdict_are_not_counted(campaign):
    outcomes = synthetic_outcomes(range(64))
    outcomes.codes[:] = 0
    outcomes.codes[[3, 4, 5, 6, 40]] = 3
    outcome = certificate(SequentialTest(0.9), campaign, outcomes)
    assert (outcome.verdict, outcome.samples, outcome.whole) == ("falls short", 7, 3)
    assert outcome.passed == {"drop": 3}
    exact = stats.binomtest(3, 7).proportion_ci(0.95, method="exact")
    assert outcome.interval["drop"] == pytest.approx((exact.low, exact.high))
    assert outcome.whole_interval == outcome.interval["drop"]


@pytest.mark.parametrize("spread", [0.04, 0.05])
def test_the_reserve_is_raised_by_the_excess_of_the_tilt(campaign, spread):
    """99 % are within 2.576 standard deviations; 5 deg are allowed."""
    outcomes = synthetic_outcomes(range(400))
    column = NAMES.index("com_error.y")
    tilt = spread * (0.9 * outcomes.values[:, column] + np.sqrt(0.19) * outcomes.values[:, 3])
    outcomes.metrics[:, 0, METRICS.index("touchdown_pitch")] = 0.0
    outcomes.metrics[:, 0, METRICS.index("touchdown_roll")] = tilt
    result = lesson(SequentialTest(0.99), campaign, outcomes)
    assert result.factor == pytest.approx(
        min(2.576 * spread / np.radians(5.0), LARGEST_RAISE), rel=0.1
    )
    assert "off level in roll" in result.observation
    assert re.search(
        r"; 99% stay within \d+\.\d deg \(5 deg is allowed\), and \d+% of the", result.observation
    )
    assert result.observation.endswith(
        f": the reserve is raised by a factor of {result.factor:.2f}"
    )
    assert "com error y" in result.observation


@pytest.mark.parametrize(
    ("metric", "cause", "words"),
    [
        ("touchdown_pitch", "attitude_bias.pitch", "a better attitude sensor"),
        ("turned_angle", "com_error.y", "every touchdown is level"),
        ("touchdown_roll", "com_error.z", "however large, turns the robot in roll"),
    ],
)
def test_no_reserve_is_raised_where_it_does_not_help(solo12, metric, cause, words):
    """One wheel turns a robot in pitch alone."""
    device = layout_device(Layout(LayoutName.SINGLE))
    campaign = short_campaign(solo12, device=device, drop_only=True)
    outcomes = synthetic_outcomes(range(64))
    metric_values = 0.1 * outcomes.values[:, NAMES.index(cause)]
    outcomes.metrics[:] = 0.0
    outcomes.metrics[:, 0, METRICS.index(metric)] = metric_values
    result = lesson(SequentialTest(0.99), campaign, outcomes)
    assert result.factor == 1.0
    assert words in result.observation


@pytest.mark.parametrize(
    ("attitude", "free"), [({"pitch": np.pi}, 0.0), ({"roll": np.pi / 2}, 1.0)]
)
def test_ends_upside_down_or_on_the_side_are_judged_by_the_vertical(campaign, attitude, free):
    """Upside down pitch jumps by a turn, and on the side it is arbitrary."""
    (flight,) = campaign.flights
    turn = TurnTo(name="turn", duration=1.0, jump_height=0.5, **attitude)
    campaign = replace(campaign, flights=(replace(flight, maneuver=turn),))
    outcomes = synthetic_outcomes(range(64))
    error = 0.02 * outcomes.values[:, 0]
    roll, pitch = attitude.get("roll", 0.0) + error, attitude.get("pitch", 0.0) + error
    pitch = np.where(np.arange(64) % 2, pitch, -pitch) if not free else free * outcomes.values[:, 1]
    for name, angle in (("roll", roll), ("pitch", pitch)):
        outcomes.metrics[:, 0, METRICS.index(f"touchdown_{name}")] = angle
    result = lesson(SequentialTest(0.99), campaign, outcomes)
    assert result.observation.startswith("every touchdown is level"), result.observation


@pytest.mark.parametrize("change", ["one lands", "nothing varies"])
def test_equal_landings_do_not_change_the_reserve(campaign, change):
    outcomes = synthetic_outcomes(range(8))
    tilt = outcomes.metrics[:, 0, METRICS.index("touchdown_pitch")]
    tilt[:] = 0.3
    if change == "one lands":
        tilt[1:] = np.nan
    else:
        outcomes.values[:] = 1.0
    result = lesson(SequentialTest(0.9), campaign, outcomes)
    assert result.factor == 1.0
    assert "land off level in pitch, all alike" in result.observation


@pytest.mark.exhaustive  # Minutes of flights.
def test_the_certificate_in_the_docs_is_reproduced():
    """Single flights may differ on another machine: the intervals overlap, the verdict stays."""
    documented = certified.kept()["solo12"]
    certified_now = certified.flown(Path(SOLO12))
    assert certified_now["verdict"] == documented["verdict"]
    for scenario, (low, high) in certified_now["interval"].items():
        assert low <= documented["interval"][scenario][1]
        assert documented["interval"][scenario][0] <= high
    assert certified_now["mass"] == pytest.approx(documented["mass"], rel=1e-3)
