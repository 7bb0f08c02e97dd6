"""Limits of motor and supply against brute force over torque."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from wheels import EC45, motor

from ocs_design.actuation.supply import Supply
from ocs_design.simulation.motor_limits import MotorLimits

SLOPE = 650.4 / 1.4566
SLOW = replace(EC45, speed_max=300.0)


@given(st.floats(-900.0, 900.0))
def test_the_torque_range_is_where_voltage_and_current_suffice(speed):
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


def test_without_a_voltage_line_there_is_full_torque_at_any_speed():
    limits = MotorLimits.of(motor(700.0, None, 2.0))
    lowest, highest = limits.torque_range(np.array([0.0, 699.0, -699.0]))
    np.testing.assert_array_equal(lowest, -2.0)
    np.testing.assert_array_equal(highest, 2.0)


def test_the_reserve_applies_to_voltage_current_and_speed():
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


def test_friction_takes_its_part_of_the_voltage():
    """0.5 A of friction in 0.1 ohm take 50 mV of 24 V: 2.5 rad/s at k_t of 0.02 V s/rad."""
    with_friction = replace(
        motor(1200.0, 4.8, 0.4), torque_constant=0.02, resistance=0.1, no_load_current=0.5
    )
    limits = MotorLimits.of(with_friction)
    assert limits.no_load_speed == pytest.approx(1200.0 - 2.5)
    assert limits.line_slope == pytest.approx(1200.0 / 4.8)
    assert with_friction.friction_factor == pytest.approx(1.0 - 0.05 / 24.0)


@pytest.mark.parametrize(
    ("drive", "finite"), [(EC45, True), (motor(700.0), False), (motor(700.0, 2.0), True)]
)
def test_is_finite_where_the_torque_is_limited_at_all_speeds(drive, finite):
    assert MotorLimits.of(drive).is_finite is finite


SHAPE = (3, 2)
POWERS = st.floats(1.0, 1e4)
TORQUES = arrays(float, SHAPE, elements=st.floats(-2.0, 2.0, allow_subnormal=False))
SPEEDS = arrays(float, SHAPE, elements=st.floats(-2000.0, 2000.0, allow_subnormal=False))
DRIVES = st.tuples(st.floats(1.0, 500.0), st.floats(0.5, 1.0))
WITH_WINDING = replace(EC45, torque_constant=0.02, resistance=0.1)
GAINS = st.floats(1e-3, 200.0)


def column(value):
    return np.full((SHAPE[0], 1), value)


def with_supply(copper, efficiency, power=np.inf):
    unlimited = MotorLimits(np.inf, 0.0, np.inf)
    return replace(unlimited, copper=copper, efficiency=efficiency, power_max=power)


def limited(torque, speed, gain, drive, power):
    return with_supply(*map(column, (*drive, power))).within_supply(torque, speed, column(gain))


@given(TORQUES, SPEEDS, GAINS, DRIVES, POWERS)
def test_the_bus_power_is_limited_throughout_the_control_step(torque, speed, gain, drive, power):
    torques = limited(torque, speed, gain, drive, power)
    for fraction in np.linspace(0.0, 1.0, 21):
        bus_power = with_supply(*drive).bus_power(speed + fraction * gain * torques, torques)
        assert np.abs(bus_power).max() <= power * (1.0 + 1e-9)


def test_a_tiny_torque_is_not_cut():
    """The ratio of the supply's power to its power overflows."""
    torque, ones = np.full((1, 2), 1e-307), np.ones((1, 1))
    limits = replace(MotorLimits(np.inf, 0.0, np.inf), power_max=1e4 * ones)
    assert np.array_equal(limits.within_supply(torque, np.ones((1, 2)), ones), torque)


@given(TORQUES, SPEEDS, GAINS, DRIVES, POWERS)
def test_torques_keep_their_direction_and_are_cut_no_more_than_needed(
    torque, speed, gain, drive, power
):
    torques = limited(torque, speed, gain, drive, power)
    square = (torque**2).sum(axis=1)
    factor = np.divide(
        (torques * torque).sum(axis=1), square, out=np.ones(SHAPE[0]), where=square > 0.0
    )
    assert np.all((factor >= 0.0) & (factor <= 1.0 + 1e-12))
    np.testing.assert_allclose(torques, factor[:, None] * torque, rtol=1e-12)

    # Slightly larger torques would exceed the power at one end of the step.
    more = np.minimum(factor * (1.0 + 1e-6), 1.0)[:, None] * torque
    largest = np.max(
        [
            np.abs(with_supply(*drive).bus_power(speed + part * gain * more, more))
            for part in (0.0, 1.0)
        ],
        axis=0,
    )
    assert np.all((factor > 1.0 - 1e-9) | (largest > power * (1.0 - 1e-5)))


def test_bus_power_of_a_brushless_motor():
    """R = 0.1 ohm, k_t = 0.02 N m/A: 0.2 N m is 10 A, 10 W of heat, at 600 rad/s 120 W of work."""
    limits = MotorLimits.of(WITH_WINDING, Supply(24.0, power_max=100.0), 2)
    speed, torque = np.array([[600.0, 0.0]]), np.array([[0.2, 0.0]])
    assert limits.bus_power(speed, torque) == pytest.approx([130.0])
    assert limits.bus_power(speed, -torque) == pytest.approx([-110.0])
    assert limits.utilisation(speed, torque) >= 1.3


def test_friction_takes_its_part_of_the_supply():
    """0.5 A of friction at 24 V and 2 V of 20 A in 0.1 ohm: 26 W for two motors."""
    with_friction = replace(WITH_WINDING, no_load_current=0.5, torque_limit=0.4)
    limits = MotorLimits.of(with_friction, Supply(24.0, power_max=100.0), 2)
    assert limits.power_max == pytest.approx(100.0 - 2.0 * 0.5 * (24.0 + 2.0 + 0.05))


def test_a_supply_limited_by_its_current():
    limits = MotorLimits.of(WITH_WINDING, Supply(24.0, current_max=2.0, power_max=100.0), 2)
    assert limits.power_max == 48.0
    for unlimited in (MotorLimits.of(WITH_WINDING), MotorLimits.of(EC45, Supply(24.0))):
        assert unlimited.power_max == np.inf
