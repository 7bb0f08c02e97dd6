"""What a requirement asks at the design's own incidence, against the closed forms."""

import numpy as np
import pytest

from ocs_design.requirement.maneuver import Disturbance, Drop, Flip
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.bound.device_problem import design_momenta

STANDING = 0.3
INERTIA = np.array([[0.03, 0.001, 0.002], [0.001, 0.055, 0.0], [0.002, 0.0, 0.07]])
DROP = Drop(name="drop", height=STANDING + 9.81 * 0.4**2 / 2.0, pitch=np.radians(30.0))
PUSH = Disturbance(
    name="push", takeoff_velocity=(0.0, 2.4), torque=(-0.8, 0.2, 0.0), onset=0.1, duration=0.05
)
TURNED = Flip(
    name="flip", gravity=1.62, incidence=0.0, jump_height=1.0, angle=-2.0 * np.pi, duration=2.0
)


def asked(*maneuvers, rate_change=None):
    return design_momenta(Requirement(maneuvers, rate_change, 1.0, None, STANDING), INERTIA)


def test_the_largest_of_each_axis():
    """2 I theta / T of a fall of 0.4 s on pitch, the impulse of the push on roll."""
    expected = [0.8 * 0.05, 2.0 * 0.055 * np.radians(30.0) / 0.4]
    np.testing.assert_allclose(asked(DROP, PUSH), expected, rtol=1e-12)


def test_a_rate_change_is_asked_of_both_axes():
    np.testing.assert_allclose(asked(rate_change=2.0), [0.06, 0.11], rtol=1e-12)
    np.testing.assert_allclose(asked(PUSH, rate_change=2.0), [0.06, 0.11], rtol=1e-12)


def test_modules_turned_by_hand_do_not_count():
    np.testing.assert_array_equal(asked(PUSH, TURNED), asked(PUSH))
    np.testing.assert_array_equal(asked(TURNED), [0.0, 0.0])


def test_a_sign_says_nothing():
    assert asked(PUSH)[0] == pytest.approx(0.04, rel=1e-12)
