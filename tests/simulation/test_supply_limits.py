"""The supply's limit in the wheel law, for any wheels, torques and supplies."""

import csv
import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from robots import SOLO12
from wheels import EC45

from ocs_design.actuation.supply import Supply
from ocs_design.simulation.motor_limits import MotorLimits, bus_power, within_supply

SHAPE = (3, 2)
POWERS = st.floats(1.0, 1e4)
TORQUES = arrays(float, SHAPE, elements=st.floats(-2.0, 2.0, allow_subnormal=False))
SPEEDS = arrays(float, SHAPE, elements=st.floats(-2000.0, 2000.0, allow_subnormal=False))
DRIVES = st.tuples(st.floats(1.0, 500.0), st.floats(0.5, 1.0))
WOUND = replace(EC45, torque_constant=0.02, resistance=0.1)
GAINS = st.floats(1e-3, 200.0)


def column(value):
    return np.full((SHAPE[0], 1), value)


def limited(torque, speed, gain, drive, power):
    copper, efficiency = map(column, drive)
    return within_supply(
        torque,
        speed,
        gain=column(gain),
        copper=copper,
        efficiency=efficiency,
        power_max=column(power),
    )


@given(TORQUES, SPEEDS, GAINS, DRIVES, POWERS)
def test_no_instant_of_the_control_step_draws_or_feeds_back_more(torque, speed, gain, drive, power):
    held = limited(torque, speed, gain, drive, power)
    for part in np.linspace(0.0, 1.0, 21):
        now = bus_power(held, speed + part * gain * held, copper=drive[0], efficiency=drive[1])
        assert np.abs(now).max() <= power * (1.0 + 1e-9)


@given(TORQUES, SPEEDS, GAINS, DRIVES, POWERS)
def test_torques_keep_their_direction_and_are_cut_no_more_than_needed(
    torque, speed, gain, drive, power
):
    held = limited(torque, speed, gain, drive, power)
    size = (torque**2).sum(axis=1)
    factor = np.divide((held * torque).sum(axis=1), size, out=np.ones(SHAPE[0]), where=size > 0.0)
    assert np.all((factor >= 0.0) & (factor <= 1.0 + 1e-12))
    np.testing.assert_allclose(held, factor[:, None] * torque, rtol=1e-12)

    # A little more would be too much at one end of the step.
    more = np.minimum(factor * (1.0 + 1e-6), 1.0)[:, None] * torque
    largest = np.max(
        [
            np.abs(
                bus_power(more, speed + part * gain * more, copper=drive[0], efficiency=drive[1])
            )
            for part in (0.0, 1.0)
        ],
        axis=0,
    )
    assert np.all((factor > 1.0 - 1e-9) | (largest > power * (1.0 - 1e-5)))


def test_a_brushless_motor_by_hand():
    """R = 0.1 ohm, k_t = 0.02 N m/A: 0.2 N m is 10 A, 10 W of heat, at 600 rad/s 120 W of work."""
    limits = MotorLimits.of(WOUND, Supply(24.0, power_max=100.0), 2)
    speed, torque = np.array([[600.0, 0.0]]), np.array([[0.2, 0.0]])
    assert limits.bus_power(speed, torque) == pytest.approx([130.0])
    assert limits.bus_power(speed, -torque) == pytest.approx([-110.0])
    assert limits.utilisation(speed, torque) >= 1.3


def test_friction_is_left_its_part_of_the_supply():
    """0.5 A of friction at 24 V and, of 0.1 ohm at 20 A of winding current, 2 V: 26 W of two."""
    rubbing = replace(WOUND, no_load_current=0.5, torque_limit=0.4)
    limits = MotorLimits.of(rubbing, Supply(24.0, power_max=100.0), 2)
    assert limits.power_max == pytest.approx(100.0 - 2.0 * 0.5 * (24.0 + 2.0 + 0.05))


def test_a_supply_by_its_current():
    limits = MotorLimits.of(WOUND, Supply(24.0, current_max=2.0, power_max=100.0), 2)
    assert limits.power_max == 48.0
    assert MotorLimits.of(WOUND).power_max == MotorLimits.of(EC45, Supply(24.0)).power_max == np.inf


@pytest.mark.slow
@pytest.mark.parametrize("power", [1000.0, 300.0])
def test_no_recorded_flight_passes_what_supply_and_motor_give(tmp_path, power):
    """Solo12 with push-offs, touchdowns and wheels that are braked down, from the files alone."""
    out, spec = tmp_path / "out", tmp_path / "s.toml"
    spec.write_text(f'validation.desaturate = true\nsupply.power_max = "{power} W"\n')
    command = [sys.executable, "-m", "ocs_design", "size", SOLO12, "--spec", spec, "-o", out, "-q"]
    subprocess.run(list(map(str, command)), check=False, capture_output=True)
    motor = json.loads((out / "design.json").read_text())["ocs"]["motor"]
    flown = sorted((out / "validation").glob("*_with_ocs.csv"))
    assert len(flown) == 3
    for file in flown:
        with file.open(newline="") as text:
            rows = list(csv.DictReader(text))

        def largest(name, rows=rows):
            return max(abs(float(row[name])) for row in rows)

        assert largest("bus_power_w") <= power
        assert largest("bus_current_a") <= power / 24.0
        for side in ("left", "right"):
            torque = largest(f"wheel_torque_{side}_nm")
            assert torque <= motor["torque_limit"] * (1.0 + 1e-6)  # six digits are written
            assert largest(f"wheel_speed_{side}_rad_s") <= motor["no_load_speed"] * 1.005
