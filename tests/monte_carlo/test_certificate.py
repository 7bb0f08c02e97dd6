"""The sequential test's promises, summed exactly over all flights it may see."""

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
    LARGEST,
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

ASKED = (0.5, 0.8, 0.9, 0.95, 0.99, 0.999)


@pytest.mark.parametrize("asked", ASKED)
def test_neither_wrong_verdict_is_likelier_than_it_says(asked):
    test = SequentialTest(asked)
    ends = endings(test)
    for reliability in (0.3, asked, 0.5 * (1.0 + asked)):
        assert sum(operating(ends, reliability)[0].values()) == pytest.approx(1.0, abs=1e-9)
    for better in (asked, 0.5 * (1 + asked)):
        assert operating(ends, better)[0][Conclusion.SHORT] <= ERROR
    for worse in (test.worse, 0.9 * test.worse):
        assert operating(ends, worse)[0][Conclusion.CERTIFIED] <= ERROR


@pytest.mark.parametrize("asked", ASKED)
def test_a_good_device_is_certified_and_a_bad_one_is_not(asked):
    test = SequentialTest(asked)
    ends = endings(test)
    findings, flown = operating(ends, 1 - 0.1 * (1 - asked))
    assert findings[Conclusion.CERTIFIED] >= 0.999
    first = test.found(np.ones(test.most, dtype=bool))[1]
    assert flown <= 1.15 * first
    assert operating(ends, 0.5 * test.worse)[0][Conclusion.SHORT] >= 0.9


def test_99_of_100_take_152_flights_and_settle_most_questions():
    """ln 20 / ln(0.99 / 0.970588) = 151.3."""
    test = SequentialTest(0.99)
    assert test.worse == pytest.approx(0.970588, abs=1e-6)
    assert test.most == 1000
    assert test.found(np.ones(151, dtype=bool)) == (None, 151)
    assert test.found(np.ones(400, dtype=bool)) == (Conclusion.CERTIFIED, 152)
    assert test.found(np.zeros(400, dtype=bool)) == (Conclusion.SHORT, 3)
    halfway = operating(endings(test), 0.5 * (test.asked + test.worse))[0]
    assert halfway[Conclusion.UNDECIDED] < 0.1
    for asked, flights in ((0.95, 32), (0.8, 9)):
        found = SequentialTest(asked).found(np.ones(64, dtype=bool))
        assert found == (Conclusion.CERTIFIED, flights)


@pytest.mark.parametrize("asked", [0.8, 0.95, 0.99])
def test_the_interval_holds_the_truth_nearly_as_often_as_of_a_fixed_number(asked):
    """Stopping by the result costs some: docs/monte_carlo.md says how much."""
    ends = endings(SequentialTest(asked))
    intervals = [share(passed, flown) for passed, flown, *_ in ends]
    for truth in 1 - np.geomspace(1e-3 * (1 - asked), 0.98, 40):
        held = [
            end
            for end, found in zip(ends, intervals, strict=True)
            if found.low <= truth <= found.high
        ]
        assert sum(operating(held, truth)[0].values()) >= 0.89


def test_it_gives_up_in_the_end():
    test = SequentialTest(0.9)
    passed = np.arange(2 * test.most) % 6 != 5
    assert test.found(passed) == (Conclusion.UNDECIDED, test.most)


@pytest.fixture(scope="module")
def campaign(solo12):
    return short_campaign(solo12, drop_only=True)


def test_flights_after_the_verdict_are_not_counted(campaign):
    outcomes = synthetic_outcomes(range(64))
    outcomes.codes[:] = 0
    outcomes.codes[[3, 4, 5, 6, 40]] = 3
    found = certificate(SequentialTest(0.9), campaign, outcomes)
    assert (found.verdict, found.samples, found.whole) == ("falls short", 7, 3)
    assert found.passed == {"drop": 3}
    exact = stats.binomtest(3, 7).proportion_ci(0.95, method="exact")
    assert found.interval["drop"] == pytest.approx((exact.low, exact.high))
    assert found.whole_interval == found.interval["drop"]


@pytest.mark.parametrize("spread", [0.04, 0.05])
def test_the_reserve_is_raised_by_what_the_tilt_lacks(campaign, spread):
    """99 of 100 are within 2.576 deviations; 5 deg are allowed."""
    outcomes = synthetic_outcomes(range(400))
    drawn = NAMES.index("com_error.y")
    tilt = spread * (0.9 * outcomes.values[:, drawn] + np.sqrt(0.19) * outcomes.values[:, 3])
    outcomes.metrics[:, 0, METRICS.index("touchdown_pitch")] = 0.0
    outcomes.metrics[:, 0, METRICS.index("touchdown_roll")] = tilt
    learnt = lesson(SequentialTest(0.99), campaign, outcomes)
    assert learnt.factor == pytest.approx(min(2.576 * spread / np.radians(5.0), LARGEST), rel=0.1)
    assert "off level in roll" in learnt.observation
    assert re.search(
        r"; 99% stay within \d+\.\d deg \(5 deg is allowed\), and \d+% of the", learnt.observation
    )
    assert learnt.observation.endswith(
        f": the reserve is raised by a factor of {learnt.factor:.2f}"
    )
    assert "com error y" in learnt.observation


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
    drawn = 0.1 * outcomes.values[:, NAMES.index(cause)]
    outcomes.metrics[:] = 0.0
    outcomes.metrics[:, 0, METRICS.index(metric)] = drawn
    learnt = lesson(SequentialTest(0.99), campaign, outcomes)
    assert learnt.factor == 1.0
    assert words in learnt.observation


@pytest.mark.parametrize(("asked", "free"), [({"pitch": np.pi}, 0.0), ({"roll": np.pi / 2}, 1.0)])
def test_what_ends_upside_down_or_on_its_side_teaches_by_where_the_vertical_is(
    campaign, asked, free
):
    """Pitch jumps by a turn upside down, and is any angle on the side."""
    (flight,) = campaign.flights
    turn = TurnTo(name="turn", duration=1.0, jump_height=0.5, **asked)
    campaign = replace(campaign, flights=(replace(flight, maneuver=turn),))
    outcomes = synthetic_outcomes(range(64))
    off = 0.02 * outcomes.values[:, 0]
    roll, pitch = asked.get("roll", 0.0) + off, asked.get("pitch", 0.0) + off
    pitch = np.where(np.arange(64) % 2, pitch, -pitch) if not free else free * outcomes.values[:, 1]
    for name, angle in (("roll", roll), ("pitch", pitch)):
        outcomes.metrics[:, 0, METRICS.index(f"touchdown_{name}")] = angle
    learnt = lesson(SequentialTest(0.99), campaign, outcomes)
    assert learnt.observation.startswith("every touchdown is level"), learnt.observation


@pytest.mark.parametrize("change", ["one lands", "nothing varies"])
def test_landings_that_are_all_alike_teach_nothing_of_the_reserve(campaign, change):
    outcomes = synthetic_outcomes(range(8))
    tilt = outcomes.metrics[:, 0, METRICS.index("touchdown_pitch")]
    tilt[:] = 0.3
    if change == "one lands":
        tilt[1:] = np.nan
    else:
        outcomes.values[:] = 1.0
    learnt = lesson(SequentialTest(0.9), campaign, outcomes)
    assert learnt.factor == 1.0
    assert "land off level in pitch, all alike" in learnt.observation


@pytest.mark.exhaustive  # Minutes of flights.
def test_what_the_docs_quote_is_what_flies():
    """Single flights may end otherwise on another machine: intervals overlap, the verdict stays."""
    quoted = certified.kept()["solo12"]
    flown = certified.flown(Path(SOLO12))
    assert flown["verdict"] == quoted["verdict"]
    for scenario, (low, high) in flown["interval"].items():
        assert low <= quoted["interval"][scenario][1]
        assert quoted["interval"][scenario][0] <= high
    assert flown["mass"] == pytest.approx(quoted["mass"], rel=1e-3)
