"""Roll and pitch of a body whose yaw, or an axis that no wheel reaches, is left to itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.actuation.tilt_inertia import STRAY_MAX, TiltInertia

INERTIA = np.array([[1.49, -0.22, -0.33], [-0.22, 2.74, -0.16], [-0.33, -0.16, 2.75]])
"""About that of a quadruped with an arm to one side [kg m^2]."""

PITCH_ONLY = np.array([0.0, 1.0])


def rates_without_momentum(inertia, held):
    """All three rates of a unit rate about the held axis, with no momentum about the others."""
    free = [axis for axis in range(3) if axis not in held]
    rates = np.zeros(3)
    rates[list(held)] = [float(axis == max(held)) for axis in held]
    rates[free] = np.linalg.solve(inertia[np.ix_(free, free)], -inertia[free] @ rates)
    return rates


def test_a_pure_pitch_takes_the_roll_momentum_of_the_product():
    rates = rates_without_momentum(INERTIA, (0, 1))
    roll, pitch = TiltInertia.of(INERTIA).momentum(np.array([0.0, 1.0]))
    assert roll == pytest.approx((INERTIA @ rates)[0], rel=1e-14)
    # What the heading takes of I_yy is left in.
    assert 0.0 <= pitch - (INERTIA @ rates)[1] == pytest.approx(0.16**2 / 2.75, rel=1e-12)


def test_an_axis_out_of_reach_follows_and_gives_way():
    """Wheels on the pitch axis alone: no momentum about roll, so that roll follows pitch."""
    whole = TiltInertia.of(INERTIA)
    inertia = np.array([[whole.diagonal[0], whole.product], [whole.product, whole.diagonal[1]]])
    follows = -inertia[0, 1] / inertia[0, 0]
    left = whole.within_reach(PITCH_ONLY, 0.0)
    assert left.momentum(np.array([0.0, 1.0])) == pytest.approx(inertia @ [follows, 1.0], abs=1e-15)
    assert whole.drift[0] == pytest.approx(abs(follows), rel=1e-14)


def test_a_turn_that_would_end_off_level_asks_for_what_the_wheels_do_not_reach():
    whole = TiltInertia.of(INERTIA)
    enough = STRAY_MAX / whole.drift[0]
    assert whole.within_reach(PITCH_ONLY, 0.999 * enough).product == 0.0
    assert whole.within_reach(PITCH_ONLY, 1.001 * enough).product == whole.product
    assert whole.within_reach(np.array([0.1, 0.99]), 0.0) is whole


@given(st.integers(0, 10_000))
def test_it_is_that_of_a_body(seed):
    """Positive, whatever the body is; and the same seen from behind."""
    rng = np.random.default_rng(seed)
    x, y, z = rng.uniform(0.01, 1.0, 3)
    turn = Rotation.random(random_state=rng).as_matrix()
    body = turn @ np.diag([y + z, x + z, x + y]) @ turn.T
    assert 0.0 <= TiltInertia.of(body).share < 1.0
    behind = np.diag([-1.0, -1.0, 1.0])
    assert TiltInertia.of(behind @ body @ behind).product == pytest.approx(
        float(TiltInertia.of(body).product), abs=1e-15
    )
