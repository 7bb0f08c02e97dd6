"""Torque-speed line of a drive, inertia behind gears, tilt inertia, and motor conventions."""

import math
from dataclasses import fields, replace

import driven_wheels
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.actuation.drive import (
    Drive,
    DriveLine,
    armature,
    drive_line,
    missing_figures,
    rotor_share,
    speed_limit,
)
from ocs_design.actuation.motor import (
    DIRECT,
    Motor,
    ResistanceConvention,
    TorqueConstantConvention,
    line_to_line_resistance,
    six_step_current,
    six_step_torque_constant,
)
from ocs_design.actuation.tilt_inertia import DRIFT_MAX, TiltInertia
from ocs_design.common.errors import OcsError

RPM = math.pi / 30.0
EC45 = replace(
    driven_wheels.EC45,
    length=None,
    no_load_speed=6110 * RPM,
    speed_max=1e4 * RPM,
    peak_current=39.5,
)


def gear(ratio, **changes):
    return replace(DIRECT, name="g", ratio=ratio, efficiency=0.9, **changes)


def test_worked_example_of_the_theory():
    """EC 45 flat 70 W at 24 V: w_0 650.4, tau_s 1.4566 (docs/theory.md)."""
    line = drive_line(EC45, DIRECT, 24.0)
    assert line.no_load_speed == pytest.approx(650.4, abs=0.05)
    assert line.stall_torque == pytest.approx(1.4566, abs=5e-5)
    assert line.torque_limit == 1.0
    assert line.speed_max == EC45.speed_max


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_a_lossless_gear_conserves_power(ratio):
    direct = drive_line(EC45, DIRECT, 24.0)
    geared = drive_line(EC45, replace(gear(ratio), efficiency=1.0), 24.0)
    assert geared.stall_torque * geared.no_load_speed == pytest.approx(
        direct.stall_torque * direct.no_load_speed, rel=1e-14
    )
    assert geared.no_load_speed * ratio == pytest.approx(direct.no_load_speed, rel=1e-14)
    assert geared.torque_limit == pytest.approx(ratio * direct.torque_limit, rel=1e-14)


def test_every_limit_of_a_gear_is_applied():
    free = gear(2.0)
    assert drive_line(EC45, free, 24.0).torque_limit == pytest.approx(2.0 * 0.9)
    assert drive_line(EC45, replace(free, torque_max=1.1), 24.0).torque_limit == 1.1
    assert drive_line(EC45, free, 24.0).speed_max == EC45.speed_max / 2.0
    assert drive_line(EC45, replace(free, motor_speed_max=600.0), 24.0).speed_max == 300.0
    assert drive_line(EC45, replace(free, wheel_speed_max=200.0), 24.0).speed_max == 200.0


def test_a_motor_without_a_rated_speed_is_limited_by_its_rated_voltage():
    unrated = replace(EC45, speed_max=None)
    assert speed_limit(unrated) == EC45.no_load_speed
    assert speed_limit(replace(unrated, no_load_speed=None)) == pytest.approx(24.0 / 0.0369)
    at_48 = drive_line(unrated, DIRECT, 48.0)
    assert at_48.speed_max == EC45.no_load_speed < at_48.no_load_speed


def test_the_reserve_reduces_every_limit():
    line = DriveLine(np.array([1.0, 2.0]), 650.0, 0.5, 700.0)
    reserved = line.reserved(0.9)
    np.testing.assert_allclose(reserved.stall_torque, [0.9, 1.8])
    assert (reserved.no_load_speed, reserved.torque_limit) == (585.0, 0.45)
    assert reserved.speed_max == 630.0
    assert line.reserved().no_load_speed == 0.95 * 650.0


@pytest.mark.parametrize(
    ("field", "name"),
    [
        ("mass", "mass"),
        ("torque_constant", "torque constant"),
        ("resistance", "resistance"),
        ("peak_torque", "peak torque or current"),
    ],
)
def test_missing_figures_are_named(field, name):
    motor = replace(EC45, **{field: None})
    assert missing_figures(motor, DIRECT) == (name,)
    if field != "mass":
        with pytest.raises(OcsError, match=name):
            drive_line(motor, DIRECT, 24.0)


def test_a_speed_limit_needs_some_figure():
    motor = replace(EC45, speed_max=None, no_load_speed=None, rated_voltage=None)
    assert missing_figures(motor, DIRECT) == ("highest speed or rated voltage",)
    assert missing_figures(EC45, DIRECT) == ()


@pytest.mark.parametrize(
    ("ratio", "reverses", "needed"),
    [(1.0, False, False), (0.5, False, False), (2.0, False, True), (0.5, True, True)],
)
def test_the_rotor_may_be_unknown_only_where_ignoring_it_is_conservative(ratio, reverses, needed):
    """It must not slow down a wheel with a given rim: I_m (1 / h)^2 falls with J_r."""
    stage = gear(ratio, reverses=reverses)
    missing = missing_figures(replace(EC45, rotor_inertia=None), stage)
    assert missing == (("rotor inertia",) if needed else ())
    rim, rotor = 7e-5, 1.8e-5
    h = rim + rotor_share(rotor, stage)
    driven = h + armature(rotor, stage)
    # Limited by torque, the time grows with I_m / h; at a given speed, the sweep grows with h.
    assert (driven / h > 1.0 or h < rim) == needed


def test_spin_and_driven_inertia_are_those_of_rim_rotor_and_gear():
    for stage in (gear(4.0, reverses=True, inertia=1e-6), gear(0.4, inertia=2e-6)):
        sense = -1.0 if stage.reverses else 1.0
        rim, rotor, N = 7e-5, 1.8e-5, stage.ratio
        h = rim + rotor_share(rotor, stage)
        # Momentum of rim and rotor at unit wheel speed; twice the energy of all three.
        assert h == pytest.approx(rim + rotor * (sense * N), rel=1e-14)
        driven = rim + rotor * N**2 + stage.inertia
        assert h + armature(rotor, stage) == pytest.approx(driven, rel=1e-14)
    assert armature(1.8e-5, DIRECT) == 0.0


def test_a_drive_copies_the_figures_of_its_motor_that_the_gear_does_not_change():
    """A field of `Drive` with the name of a field of `Motor` is filled automatically."""
    figures = {
        item.name: f"some {item.name}" if item.type is str else 0.25 * number
        for number, item in enumerate(fields(Motor), 1)
        if item.name not in {"mounting"}
    }
    motor = Motor(**figures, mounting=None)
    gear = replace(DIRECT, name="2:1", ratio=2.0, efficiency=0.9)
    drive = Drive.of(motor, gear, 24.0)
    changed = {
        "no_load_speed": 24.0 / (2.0 * motor.torque_constant),
        "speed_max": motor.speed_max / 2.0,
        "rotor_inertia": 2.0 * motor.rotor_inertia,
        "continuous_torque": 1.8 * motor.continuous_torque,
        "saturation_torque": 1.8 * motor.saturation_torque,
    }
    shared = {item.name for item in fields(Motor)} & {item.name for item in fields(Drive)}
    assert {"name", "source", "resistance", "no_load_current", "length"} <= shared
    for name in shared:
        if name in changed:
            assert getattr(drive, name) == pytest.approx(changed[name], rel=1e-15), name
        else:
            assert getattr(drive, name) == getattr(motor, name), name
    assert (drive.gear, drive.gear_ratio, drive.bus_voltage) == ("2:1", 2.0, 24.0)


INERTIA = np.array([[1.49, -0.22, -0.33], [-0.22, 2.74, -0.16], [-0.33, -0.16, 2.75]])
"""Inertia similar to that of a quadruped with an arm to one side [kg m^2]."""

PITCH_ONLY = np.array([0.0, 1.0])


def rates_without_momentum(inertia, controlled):
    """Rates for a unit rate about the last controlled axis, without momentum about the others."""
    free = [axis for axis in range(3) if axis not in controlled]
    rates = np.zeros(3)
    rates[list(controlled)] = [float(axis == max(controlled)) for axis in controlled]
    rates[free] = np.linalg.solve(inertia[np.ix_(free, free)], -inertia[free] @ rates)
    return rates


def test_a_pure_pitch_rate_has_the_roll_momentum_of_the_product():
    rates = rates_without_momentum(INERTIA, (0, 1))
    roll, pitch = TiltInertia.of(INERTIA).momentum(np.array([0.0, 1.0]))
    assert roll == pytest.approx((INERTIA @ rates)[0], rel=1e-14)
    # I_yy is not reduced by the free heading.
    assert 0.0 <= pitch - (INERTIA @ rates)[1] == pytest.approx(0.16**2 / 2.75, rel=1e-12)


def test_an_uncontrolled_axis_follows_and_reduces_the_inertia():
    """Wheels about pitch only: without momentum about roll, roll follows pitch."""
    tilt = TiltInertia.of(INERTIA)
    inertia = np.array([[tilt.diagonal[0], tilt.product], [tilt.product, tilt.diagonal[1]]])
    roll_rate = -inertia[0, 1] / inertia[0, 0]
    momentum = tilt.within_reach(PITCH_ONLY, 0.0).momentum(np.array([0.0, 1.0]))
    assert momentum == pytest.approx(inertia @ [roll_rate, 1.0], abs=1e-15)
    assert tilt.drift[0] == pytest.approx(abs(roll_rate), rel=1e-14)


def test_an_axis_may_be_uncontrolled_only_if_it_ends_level():
    tilt = TiltInertia.of(INERTIA)
    limit = DRIFT_MAX / tilt.drift[0]
    assert tilt.within_reach(PITCH_ONLY, 0.999 * limit).product == 0.0
    assert tilt.within_reach(PITCH_ONLY, 1.001 * limit).product == tilt.product
    assert tilt.within_reach(np.array([0.1, 0.99]), 0.0) is tilt


@given(st.integers(0, 10_000))
def test_tilt_inertia_of_a_random_body(seed):
    """Positive definite, and the same in a frame turned by 180 degrees."""
    rng = np.random.default_rng(seed)
    x, y, z = rng.uniform(0.01, 1.0, 3)
    rotation = Rotation.random(random_state=rng).as_matrix()
    body = rotation @ np.diag([y + z, x + z, x + y]) @ rotation.T
    assert 0.0 <= TiltInertia.of(body).share < 1.0
    behind = np.diag([-1.0, -1.0, 1.0])
    assert TiltInertia.of(behind @ body @ behind).product == pytest.approx(
        float(TiltInertia.of(body).product), abs=1e-15
    )


PHASES = 2.0 * np.pi * np.arange(3) / 3.0
ANGLES = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)


def test_published_figures_per_kv():
    """9.549 / Kv between lines, 8.27 / Kv per ampere of phase amplitude (docs/theory.md)."""
    kv = 300.0
    six_step = 1.0 / (kv * math.pi / 30.0)
    assert six_step * kv == pytest.approx(9.549, abs=5e-4)
    for convention, figure in [
        (TorqueConstantConvention.SIX_STEP, 9.549),
        (TorqueConstantConvention.FOC, 8.270),
        (TorqueConstantConvention.FOC_RMS, 11.695),
    ]:
        specified = figure / kv
        assert six_step_torque_constant(specified, convention) == pytest.approx(six_step, rel=1e-4)


def test_power_torque_and_heat_are_those_of_three_sine_phases():
    """Against sums over the phases, independent of conventions, at 100 rad/s."""
    emf, amplitude, phase_resistance, speed = 7.0, 3.0, 0.2, 100.0
    voltages = emf * np.sin(ANGLES[:, None] + PHASES)
    currents = amplitude * np.sin(ANGLES[:, None] + PHASES)
    power = (voltages * currents).sum(axis=1).mean()
    heat = (phase_resistance * currents**2).sum(axis=1).mean()
    largest_line_voltage = np.ptp(voltages[:, :2] @ [[1.0], [-1.0]]) / 2.0
    torque = power / speed

    foc = TorqueConstantConvention.FOC
    k_t = six_step_torque_constant(torque / amplitude, foc)
    current = six_step_current(amplitude, foc)
    resistance = line_to_line_resistance(phase_resistance, ResistanceConvention.PHASE)
    assert k_t * current == pytest.approx(torque, rel=1e-12)
    assert resistance * current**2 == pytest.approx(heat, rel=1e-12)
    assert k_t * speed == pytest.approx(largest_line_voltage, rel=1e-4)


@pytest.mark.parametrize("convention", TorqueConstantConvention)
def test_the_torque_does_not_depend_on_the_convention(convention):
    torque = six_step_torque_constant(0.03, convention) * six_step_current(12.0, convention)
    assert torque == pytest.approx(0.36, rel=1e-14)


def test_rms_and_amplitude_differ_by_the_square_root_of_two():
    foc = six_step_current(math.sqrt(2.0), TorqueConstantConvention.FOC)
    assert six_step_current(1.0, TorqueConstantConvention.FOC_RMS) == pytest.approx(foc, rel=1e-14)


def test_line_to_line_resistance_is_not_converted():
    assert line_to_line_resistance(0.4, ResistanceConvention.LINE_LINE) == 0.4
