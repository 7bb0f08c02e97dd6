"""What bad outcomes go with, against SciPy's rank correlation."""

import numpy as np
from made_outcomes import NAMES, made_outcomes
from scipy import stats

from ocs_design.monte_carlo.summary import attitude_error, causes, order
from ocs_design.requirement.maneuver import Drop, Flip

DROP = Drop(name="drop", height=1.0, pitch=0.5)
FLIP = Flip(name="flip", jump_height=1.0, angle=-3.0, duration=1.0)


def test_what_decides_is_found_and_nothing_else():
    outcomes = made_outcomes(range(400))
    found = causes(outcomes, order(outcomes, DROP, 0))
    assert [(cause.quantity, cause.either_way) for cause in found] == [(NAMES[0], True)]
    distance = np.abs(outcomes.values[:, 0] - np.median(outcomes.values[:, 0]))
    expected = stats.spearmanr(distance, attitude_error(outcomes, DROP, 0)).statistic
    assert abs(found[0].correlation - expected) < 1e-12


def test_one_sided_causes_have_their_sign():
    outcomes = made_outcomes(range(200))
    outcomes.metrics[:] = 0.0
    outcomes.codes[:] = 0
    outcomes.metrics[:, 0, 1] = 5.0 - outcomes.values[:, 3]
    (cause,) = causes(outcomes, order(outcomes, DROP, 0))
    assert (cause.quantity, cause.either_way) == (NAMES[3], False)
    assert cause.correlation == -1.0


def test_failures_are_worse_than_any_pass():
    outcomes = made_outcomes(range(50))
    outcomes.codes[:] = 0
    outcomes.codes[7] = 4
    assert order(outcomes, DROP, 0)[-1] == 7


def test_what_was_not_judged_is_the_worst():
    outcomes = made_outcomes(range(50))
    outcomes.codes[9], outcomes.metrics[9] = 1, np.nan
    assert order(outcomes, DROP, 0)[-1] == 9


def test_a_flip_is_off_by_what_it_lacks():
    outcomes = made_outcomes(range(3))
    np.testing.assert_array_equal(attitude_error(outcomes, FLIP, 0), [3.0, 3.0, 3.0])


def test_what_never_varies_is_no_cause():
    outcomes = made_outcomes(range(100))
    outcomes.values[:] = 1.0
    assert causes(outcomes, order(outcomes, DROP, 0)) == ()
