"""Sensors, drives and air drag against closed forms and independent calculations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from wheels import PAPER_WHEEL

from ocs_design.common.arrays import stacked
from ocs_design.simulation.imperfections import (
    AIR_DENSITY,
    AIR_VISCOSITY,
    AirDrag,
    ImperfectDrives,
    Imperfections,
    Sensing,
    air_drag,
    cylinder_drag,
    disc_drag,
)
from ocs_design.simulation.motor_limits import MotorLimits

NO_AIR = AirDrag(np.array([0.0, 1.0]), np.zeros(2))
ONES = np.ones(2)
UNLIMITED = stacked([MotorLimits(np.inf, 0.0, np.inf)] * 2)
PERFECT = Imperfections(
    attitude_bias=np.zeros(2),
    gyro_bias=np.zeros(3),
    attitude_noise=0.0,
    gyro_noise=0.0,
    stream=np.random.SeedSequence(1),
    torque_gain=ONES,
    limits=UNLIMITED,
    coulomb=0.0 * ONES,
    viscous=0.0 * ONES,
    air=NO_AIR,
    air_factor=0.0,
    delay=0,
)
STEP, HOLD, INERTIA = 1e-3, 5, 7e-5


def drives(*samples, instants=2000):
    return ImperfectDrives(
        samples,
        response=np.full(len(samples), 1.0 / INERTIA),
        instants=instants,
        hold=HOLD,
        step=STEP,
    )


def spun(imperfections, commands, start=0.0):
    """Speed of a free wheel at each control instant, by explicit integration [rad/s]."""
    speed, speeds = np.full((1, 2), start), []
    drive = drives(imperfections, instants=len(commands))
    for k, command in enumerate(commands):
        speeds.append(speed[0, 0])
        _, acting = drive.applied_torque(k, np.full((1, 2), command), speed)
        speed = speed + acting.sum(axis=1) * STEP / INERTIA
    return np.array(speeds)


def test_a_wheel_runs_down_and_stays_at_rest():
    """`I W' = -c - d W` ends at `T ln(1 + d W0 / c)`, T = I / d."""
    coulomb, viscous, start = 5e-3, 2e-5, 400.0
    with_friction = replace(PERFECT, coulomb=coulomb * ONES, viscous=viscous * ONES)
    speed = spun(with_friction, np.zeros(1200), start)
    constant = INERTIA / viscous
    ends = constant * np.log(1.0 + viscous * start / coulomb)
    time = HOLD * STEP * np.arange(len(speed))
    exact = (start + coulomb / viscous) * np.exp(-time / constant) - coulomb / viscous
    np.testing.assert_allclose(speed, np.where(time < ends, exact, 0.0), atol=0.5)
    np.testing.assert_allclose(speed[time > ends + 2 * HOLD * STEP], 0.0, atol=1e-12)


def test_a_motor_must_overcome_friction_first():
    with_friction = replace(PERFECT, coulomb=5e-3 * ONES)
    assert not spun(with_friction, np.full(50, 4.9e-3)).any()
    assert spun(with_friction, np.full(50, 5.1e-3))[-1] > 0.0


def test_air_drag_is_interpolated_in_its_table():
    air = AirDrag(np.array([0.0, 100.0, 300.0]), np.array([0.0, 1e-3, 5e-3]))
    with_air = replace(PERFECT, air=air, air_factor=2.0)
    _, acting = drives(with_air).applied_torque(0, np.zeros((1, 2)), np.array([[200.0, -100.0]]))
    np.testing.assert_allclose(acting[0, 0], [-6e-3, 2e-3], rtol=1e-12)


@pytest.mark.parametrize("speed", [[900.0, -700.0], [-900.0, 700.0]])
def test_the_power_limit_holds_for_motors_that_deviate(speed):
    """R (tau / k_t)^2 + tau W of both motors; tau and k_t are 1.09 times their nominal values."""
    copper, limit, response = 0.1 / 0.02**2 / 1.09**2, 100.0, HOLD * STEP / INERTIA
    limits = replace(UNLIMITED, copper=copper * ONES, power_max=np.array([limit]))
    with_supply = replace(PERFECT, torque_gain=1.09 * ONES, limits=limits)
    speed, command = np.array([speed]), np.array([[0.06, -0.06]])
    mean, acting = drives(with_supply).applied_torque(0, command, speed)

    def power(torque):
        ends = speed, speed + torque * response
        return np.array([(copper * torque**2 + torque * end).sum() for end in ends])

    assert np.abs(power(1.09 * command)).max() > 1.02 * limit
    assert np.abs(power(mean)).max() == pytest.approx(limit)
    np.testing.assert_allclose(acting, np.repeat(mean[:, None], HOLD, axis=1))


@pytest.mark.parametrize("delay", [0, 1, 3, 5, 7, 12])
def test_a_command_takes_effect_after_its_delay(delay):
    """Step by step, compared with the shifted series of all commands."""
    rng = np.random.default_rng(2)
    commands = rng.normal(size=(40, 2))
    drive = drives(PERFECT, replace(PERFECT, delay=delay), instants=40)
    rows = [
        drive.applied_torque(k, np.stack([command, command]), np.zeros((2, 2)))[1]
        for k, command in enumerate(commands)
    ]
    acting = np.concatenate(rows, axis=1)
    held = np.repeat(commands, HOLD, axis=0)
    np.testing.assert_array_equal(acting[0], held)
    shifted = np.concatenate([np.zeros((delay, 2)), held])[: len(held)]
    np.testing.assert_array_equal(acting[1], shifted)


def test_an_imperfect_motor_has_its_own_gain_and_limits():
    limits = replace(
        UNLIMITED,
        torque_limit=np.array([0.5, 0.2]),
        no_load_speed=np.array([100.0, np.inf]),
        line_slope=np.array([50.0, 0.0]),
    )
    imperfect = replace(PERFECT, torque_gain=np.array([1.1, 0.9]), limits=limits)
    mean, _ = drives(imperfect).applied_torque(0, np.array([[0.3, 0.3]]), np.zeros((1, 2)))
    np.testing.assert_allclose(mean, [[0.33, 0.2]], rtol=1e-12)
    # On the voltage line at 98 rad/s: the torque for the speed at the end of the step.
    mean, _ = drives(imperfect).applied_torque(0, np.array([[0.3, 0.0]]), np.array([[98.0, 0.0]]))
    assert mean[0, 0] == pytest.approx(2.0 / (50.0 + HOLD * STEP / INERTIA), rel=1e-12)


def test_a_bias_of_attitude_tilts_the_measured_vertical():
    bias = np.array([2e-4, -3e-4])
    biased = replace(PERFECT, attitude_bias=bias, gyro_bias=np.array([0.1, 0.2, 0.3]))
    attitude = Rotation.from_euler("ZYX", [40.0, 20.0, -10.0], degrees=True)
    vertical = attitude.inv().apply([[0.0, 0.0, 1.0]])
    measured, rate = Sensing([biased], [3], 5e-3).measured(1, vertical, np.zeros((1, 3)))
    tilted = attitude * Rotation.from_rotvec([*bias, 0.0])
    np.testing.assert_allclose(measured, tilted.inv().apply([[0.0, 0.0, 1.0]]), atol=1e-6)
    np.testing.assert_array_equal(rate, [[0.1, 0.2, 0.3]])


def test_noise_is_white_with_its_standard_deviation():
    noisy = replace(PERFECT, attitude_noise=0.01, gyro_noise=0.5)
    errors = noisy.noise(20_000)
    np.testing.assert_allclose(errors.std(axis=0), [0.01, 0.01, 0.5, 0.5, 0.5], rtol=0.03)
    neighbours = np.array([np.corrcoef(e[1:], e[:-1])[0, 1] for e in errors.T])
    assert np.abs(neighbours).max() < 0.04
    np.testing.assert_array_equal(noisy.noise(10), errors[:10])


MU = AIR_DENSITY * AIR_VISCOSITY
SPEEDS = np.geomspace(1e-3, 1e4, 2001)


def test_a_disc_close_to_its_walls_drags_as_torsional_couette_flow():
    """Twice the integral of `mu W r / s * r * 2 pi r dr`."""
    radius, gap, speed = 0.05, 5e-4, np.array([0.01, 0.1])
    exact = np.pi * MU * speed * radius**4 / gap
    np.testing.assert_allclose(disc_drag(speed, radius, gap), exact, rtol=1e-12)


def test_a_cylinder_that_turns_slowly_drags_as_couette_flow():
    inner, gap, height, speed = 0.04, 0.002, 0.01, np.array([0.01, 0.1])
    outer = inner + gap
    exact = 4.0 * np.pi * MU * speed * height * (inner * outer) ** 2 / (outer**2 - inner**2)
    np.testing.assert_allclose(cylinder_drag(speed, inner, height, gap), exact, rtol=1e-12)


def short_cylinder_drag(speed, radius, gap):
    return cylinder_drag(speed, radius, 0.01, gap)


@pytest.mark.parametrize("drag", [disc_drag, short_cylinder_drag])
def test_drag_is_continuous_and_grows_faster_than_speed(drag):
    torque = drag(SPEEDS, 0.04, 0.002)
    slope = np.diff(np.log(torque)) / np.diff(np.log(SPEEDS))
    assert np.all((slope > 1.0 - 1e-9) & (slope < 2.0))


def test_a_housing_has_less_drag_than_open_air():
    """von Karman's turbulent free disc: `0.146 Re^-1/5` for both faces."""
    speed = np.array([2000.0, 4000.0])
    radius = 0.08
    reynolds = speed * radius**2 / AIR_VISCOSITY
    free = 0.146 / reynolds**0.2 * 0.5 * AIR_DENSITY * speed**2 * radius**5
    assert np.all(disc_drag(speed, radius, 0.004) < free)


def test_drag_of_a_turbulent_gap_is_that_of_a_motor_designer():
    """Touhami's thesis (Toulouse 2020, eq. II-70 and II-73), with the figures of FAST-OAD_CS23-HE.

    A rotor of 0.1814 m with a gap of 2.8 mm at Re = 27082: `C = 0.001487` in `C pi rho W^2 R^4 h`.
    """
    radius, gap, height = 0.0907, 0.0028, 0.01
    speed = np.array([27082.0 * AIR_VISCOSITY / (radius * gap)])
    quoted = 0.001487 * np.pi * AIR_DENSITY * speed**2 * radius**4 * height
    np.testing.assert_allclose(cylinder_drag(speed, radius, height, gap), quoted, rtol=5e-4)


def test_drag_of_turbulent_faces_is_that_of_a_review():
    """Harmand et al. (2013): `C = 0.051 (s/R)^0.1 Re^-1/5` for each face, separate layers."""
    radius, gap, speed = 0.2, 0.02, np.array([1500.0])
    reynolds = speed * radius**2 / AIR_VISCOSITY
    face = 0.051 * (gap / radius) ** 0.1 / reynolds**0.2 * 0.5 * AIR_DENSITY * speed**2 * radius**5
    np.testing.assert_allclose(disc_drag(speed, radius, gap), 2.0 * face, rtol=1e-12)


def test_the_table_agrees_with_the_formula():
    curve = air_drag(PAPER_WHEEL, 0.002)
    between = np.random.default_rng(0).uniform(1.0, 3000.0, 200)
    exact = disc_drag(between, 0.03, 0.002) + cylinder_drag(between, 0.03, 0.01, 0.002)
    np.testing.assert_allclose(curve.at(between), exact, rtol=1e-3)
    assert curve.at(np.zeros(1)) == 0.0
