"""Limits of a motor against brute force over torque."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from wheels import EC45, motor

from ocs_design.simulation.motor_limits import MotorLimits

SLOPE = 650.4 / 1.4566
SLOW = replace(EC45, speed_max=300.0)


@given(st.floats(-900.0, 900.0))
def test_the_range_is_where_voltage_and_current_suffice(speed):
    lowest, highest = MotorLimits.of(EC45).torque_range(np.array([speed]))
    torque = np.linspace(-1.0, 1.0, 20_001)
    possible = torque[np.abs(speed + SLOPE * torque) <= 650.4]
    if possible.size:
        assert possible[0] == pytest.approx(lowest[0], abs=2e-4)
        assert possible[-1] == pytest.approx(highest[0], abs=2e-4)
    else:
        assert lowest[0] == highest[0] == -np.sign(speed)


def test_beyond_its_top_speed_a_wheel_is_only_braked():
    lowest, highest = MotorLimits.of(SLOW).torque_range(np.array([-301.0, -299.0, 299.0, 301.0]))
    np.testing.assert_array_equal(lowest, [0.0, *lowest[1:]])
    assert highest[3] == 0.0
    assert np.all(lowest[1:] < -0.7)
    assert np.all(highest[:3] > 0.7)


def test_without_a_line_there_is_full_torque_to_the_end():
    limits = MotorLimits.of(motor(700.0, None, 2.0))
    lowest, highest = limits.torque_range(np.array([0.0, 699.0, -699.0]))
    np.testing.assert_array_equal(lowest, -2.0)
    np.testing.assert_array_equal(highest, 2.0)


def test_the_reserve_is_of_voltage_current_and_speed():
    usable = MotorLimits.of(SLOW).reserved()
    assert usable.no_load_speed == pytest.approx(0.95 * 650.4)
    assert usable.torque_limit == pytest.approx(0.95)
    assert (usable.line_slope, usable.speed_max) == (pytest.approx(SLOPE), 285.0)


def test_utilisation_counts_each_limit():
    speed, torque = np.array([250.0, -280.0]), np.array([0.2, -0.5])
    limits = MotorLimits.of(SLOW)
    assert limits.utilisation(speed, 0.0 * torque) == pytest.approx(280.0 / 300.0)
    assert limits.utilisation(0.1 * speed, torque) == pytest.approx(0.5)
    fast = MotorLimits.of(EC45)
    assert fast.utilisation(speed, torque) == pytest.approx((280.0 + SLOPE * 0.5) / 650.4)


def test_friction_is_left_its_part_of_the_voltage():
    """0.5 A of friction through 0.1 ohm are 50 mV of 24 V, at the 0.02 V s/rad of k_t 2.5 rad/s."""
    rubbing = replace(
        motor(1200.0, 4.8, 0.4), torque_constant=0.02, resistance=0.1, no_load_current=0.5
    )
    limits = MotorLimits.of(rubbing)
    assert limits.no_load_speed == pytest.approx(1200.0 - 2.5)
    assert limits.line_slope == pytest.approx(1200.0 / 4.8)
    assert rubbing.line_left == pytest.approx(1.0 - 0.05 / 24.0)


@pytest.mark.parametrize(
    ("drive", "finite"), [(EC45, True), (motor(700.0), False), (motor(700.0, 2.0), True)]
)
def test_finite_is_what_has_a_torque_limit_at_all_speeds(drive, finite):
    assert MotorLimits.of(drive).is_finite is finite
