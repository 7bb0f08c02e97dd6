"""What feedback leaves of a push, compared with flights of the law on a rigid trunk."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocs_design.common import quaternions
from ocs_design.requirement.boundary import Push
from ocs_design.requirement.froude import PAPER_GAINS
from ocs_design.simulation.wheel_law import tilt_error
from ocs_design.sizing.settling import tilt_left_of

PUSH = Push(np.array([0.5, -0.8, 1.2]), 0.1, 0.05)
INERTIA = np.array([0.04, 0.06, 0.07])


def settled(push, rate=(0.0, 0.0), time_left=0.3):
    """Roll and pitch at the end, by the closed form [rad]."""
    impulse = push.torque * push.duration
    return tilt_left_of(
        push,
        PAPER_GAINS,
        np.array([time_left]),
        acceleration=(push.torque / INERTIA)[None, :2],
        rate=np.array([rate]),
        yaw_rate=np.array([impulse[2] / INERTIA[2]]),
    )[0]


def flown(push, rate=(0.0, 0.0), time_left=0.3):
    """The same by integrating the attitude of a trunk that accelerates as the law commands."""
    upright = np.array([[0.0, 0.0, 1.0]])

    def change(time, state):
        attitude, turning = state[:4], state[4:]
        error = tilt_error(quaternions.vertical(attitude[None]), upright)[0]
        commanded = PAPER_GAINS.stiffness * error - PAPER_GAINS.damping * turning[:2]
        pushed = push.torque / INERTIA * (push.onset <= time < push.onset + push.duration)
        rotation = quaternions.product(attitude, np.array([0.0, *turning]))
        accelerating = pushed + np.array([*commanded, 0.0])
        return np.concatenate([0.5 * rotation, accelerating])

    state = np.array([1.0, 0.0, 0.0, 0.0, *rate, 0.0])
    ends = np.cumsum([0.0, push.onset, push.duration, time_left])
    for start, end in pairwise(ends):
        # The torque is discontinuous at these instants.
        state = solve_ivp(
            lambda t, y, last=end: change(min(t, last - 1e-9), y),
            (start, end),
            state,
            rtol=1e-9,
            atol=1e-9,
        ).y[:, -1]
    return np.array(quaternions.tilt(state[:4]))


@pytest.mark.parametrize("yaw", [0.0, 1.2, -6.0])
def test_feedback_leaves_as_much_of_a_push_as_in_an_integrated_flight(yaw):
    push = Push(np.array([1.0, -1.6, yaw]), PUSH.onset, PUSH.duration)
    expected = flown(push, rate=(0.3, 0.2))
    assert np.abs(expected).max() > np.radians(1.0)
    np.testing.assert_allclose(settled(push, rate=(0.3, 0.2)), expected, atol=np.radians(0.15))


def test_without_yaw_a_critically_damped_push_decays_as_in_closed_form():
    """x = w t exp(-s t) after an impulse of rate w, for K_p = s^2 and K_d = 2 s."""
    push = Push(np.array([1e5, 0.0, 0.0]), 0.1, 1e-6)
    gains = type(PAPER_GAINS)(stiffness=64.0, damping=16.0)
    tilt = tilt_left_of(
        push, gains, np.array([0.3]), acceleration=np.array([[2e6, 0.0]]),
        rate=np.zeros((1, 2)), yaw_rate=np.zeros(1),
    )  # fmt: skip
    np.testing.assert_allclose(tilt, [[2.0 * 0.3 * np.exp(-8.0 * 0.3), 0.0]], atol=1e-6)


def test_a_tilt_turns_with_the_heading():
    """Without feedback a tilt stands still in space, so a yawing trunk sees it turn."""
    push = Push(np.zeros(3), 0.0, 1e-9)
    without = type(PAPER_GAINS)(stiffness=1e-9, damping=1e3)
    # The rate dies out at once and leaves a roll of rate / damping.
    tilt = tilt_left_of(
        push, without, np.array([2.0]), acceleration=np.zeros((1, 2)),
        rate=np.array([[10.0, 0.0]]), yaw_rate=np.array([np.pi / 4.0]),
    )  # fmt: skip
    np.testing.assert_allclose(tilt, [[0.0, -0.01]], atol=1e-4)
