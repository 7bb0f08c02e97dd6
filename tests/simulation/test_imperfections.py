"""Sensors, drives and air drag against what they should be by other means."""

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
BOTH = np.ones(2)
UNLIMITED = stacked([MotorLimits(np.inf, 0.0, np.inf)] * 2)
PERFECT = Imperfections(
    attitude_bias=np.zeros(2),
    gyro_bias=np.zeros(3),
    attitude_noise=0.0,
    gyro_noise=0.0,
    stream=np.random.SeedSequence(1),
    torque_gain=BOTH,
    limits=UNLIMITED,
    coulomb=0.0 * BOTH,
    viscous=0.0 * BOTH,
    air=NO_AIR,
    air_factor=0.0,
    delay=0,
)
STEP, HOLD, INERTIA = 1e-3, 5, 7e-5


def drives(*own, instants=2000):
    return ImperfectDrives(
        own, response=np.full(len(own), 1.0 / INERTIA), instants=instants, hold=HOLD, step=STEP
    )


def spun(own, commands, start=0.0):
    """Speed of a free wheel at each control instant, integrated by hand."""
    speed, found = np.full((1, 2), start), []
    machine = drives(own, instants=len(commands))
    for k, command in enumerate(commands):
        found.append(speed[0, 0])
        _, acting = machine.driven(k, np.full((1, 2), command), speed)
        speed = speed + acting.sum(axis=1) * STEP / INERTIA
    return np.array(found)


def test_a_wheel_runs_down_and_stays_at_rest():
    """`I W' = -c - d W` ends at `T ln(1 + d W0 / c)`, T = I / d."""
    coulomb, viscous, start = 5e-3, 2e-5, 400.0
    own = replace(PERFECT, coulomb=coulomb * BOTH, viscous=viscous * BOTH)
    speed = spun(own, np.zeros(1200), start)
    constant = INERTIA / viscous
    ends = constant * np.log(1.0 + viscous * start / coulomb)
    time = HOLD * STEP * np.arange(len(speed))
    exact = (start + coulomb / viscous) * np.exp(-time / constant) - coulomb / viscous
    np.testing.assert_allclose(speed, np.where(time < ends, exact, 0.0), atol=0.5)
    np.testing.assert_allclose(speed[time > ends + 2 * HOLD * STEP], 0.0, atol=1e-12)


def test_a_motor_must_overcome_friction_first():
    own = replace(PERFECT, coulomb=5e-3 * BOTH)
    assert not spun(own, np.full(50, 4.9e-3)).any()
    assert spun(own, np.full(50, 5.1e-3))[-1] > 0.0


def test_air_holds_a_wheel_back_as_its_table_says():
    air = AirDrag(np.array([0.0, 100.0, 300.0]), np.array([0.0, 1e-3, 5e-3]))
    own = replace(PERFECT, air=air, air_factor=2.0)
    _, acting = drives(own).driven(0, np.zeros((1, 2)), np.array([[200.0, -100.0]]))
    np.testing.assert_allclose(acting[0, 0], [-6e-3, 2e-3], rtol=1e-12)


@pytest.mark.parametrize("speed", [[900.0, -700.0], [-900.0, 700.0]])
def test_a_supply_gives_and_takes_what_it_can_whatever_the_motors_are(speed):
    """R (tau / k_t)^2 + tau W of both, where tau is 1.09 of the command and so is k_t."""
    copper, limit, held = 0.1 / 0.02**2 / 1.09**2, 100.0, HOLD * STEP / INERTIA
    limits = replace(UNLIMITED, copper=copper * BOTH, power_max=np.array([limit]))
    own = replace(PERFECT, torque_gain=1.09 * BOTH, limits=limits)
    speed, command = np.array([speed]), np.array([[0.06, -0.06]])
    mean, acting = drives(own).driven(0, command, speed)

    def power(torque):
        ends = speed, speed + torque * held
        return np.array([(copper * torque**2 + torque * end).sum() for end in ends])

    assert np.abs(power(1.09 * command)).max() > 1.02 * limit
    assert np.abs(power(mean)).max() == pytest.approx(limit)
    np.testing.assert_allclose(acting, np.repeat(mean[:, None], HOLD, axis=1))


@pytest.mark.parametrize("delay", [0, 1, 3, 5, 7, 12])
def test_a_command_takes_effect_after_its_delay(delay):
    """Step by step against one long row of commands that is shifted."""
    rng = np.random.default_rng(2)
    commands = rng.normal(size=(40, 2))
    machine = drives(PERFECT, replace(PERFECT, delay=delay), instants=40)
    rows = [
        machine.driven(k, np.stack([command, command]), np.zeros((2, 2)))[1]
        for k, command in enumerate(commands)
    ]
    acting = np.concatenate(rows, axis=1)
    held = np.repeat(commands, HOLD, axis=0)
    np.testing.assert_array_equal(acting[0], held)
    shifted = np.concatenate([np.zeros((delay, 2)), held])[: len(held)]
    np.testing.assert_array_equal(acting[1], shifted)


def test_a_real_motor_gives_its_own_torque_within_its_own_limits():
    limits = replace(
        UNLIMITED,
        torque_limit=np.array([0.5, 0.2]),
        no_load_speed=np.array([100.0, np.inf]),
        line_slope=np.array([50.0, 0.0]),
    )
    own = replace(PERFECT, torque_gain=np.array([1.1, 0.9]), limits=limits)
    mean, _ = drives(own).driven(0, np.array([[0.3, 0.3]]), np.zeros((1, 2)))
    np.testing.assert_allclose(mean, [[0.33, 0.2]], rtol=1e-12)
    # On its line at 98 rad/s: what is left of the voltage, at the speed that the step ends with.
    mean, _ = drives(own).driven(0, np.array([[0.3, 0.0]]), np.array([[98.0, 0.0]]))
    assert mean[0, 0] == pytest.approx(2.0 / (50.0 + HOLD * STEP / INERTIA), rel=1e-12)


def test_a_biased_trunk_sees_the_vertical_as_one_that_is_tilted_by_the_bias():
    bias = np.array([2e-4, -3e-4])
    own = replace(PERFECT, attitude_bias=bias, gyro_bias=np.array([0.1, 0.2, 0.3]))
    attitude = Rotation.from_euler("ZYX", [40.0, 20.0, -10.0], degrees=True)
    vertical = attitude.inv().apply([[0.0, 0.0, 1.0]])
    seen, rate = Sensing([own], [3], 5e-3).measured(1, vertical, np.zeros((1, 3)))
    believed = attitude * Rotation.from_rotvec([*bias, 0.0])
    np.testing.assert_allclose(seen, believed.inv().apply([[0.0, 0.0, 1.0]]), atol=1e-6)
    np.testing.assert_array_equal(rate, [[0.1, 0.2, 0.3]])


def test_noise_has_its_deviation_and_no_memory():
    own = replace(PERFECT, attitude_noise=0.01, gyro_noise=0.5)
    errors = own.noise(20_000)
    np.testing.assert_allclose(errors.std(axis=0), [0.01, 0.01, 0.5, 0.5, 0.5], rtol=0.03)
    neighbours = np.array([np.corrcoef(e[1:], e[:-1])[0, 1] for e in errors.T])
    assert np.abs(neighbours).max() < 0.04
    np.testing.assert_array_equal(own.noise(10), errors[:10])


MU = AIR_DENSITY * AIR_VISCOSITY
SPEEDS = np.geomspace(1e-3, 1e4, 2001)


def test_a_disc_close_to_its_walls_drags_as_torsional_couette_flow():
    """Twice the integral of `mu W r / s * r * 2 pi r dr`."""
    radius, gap, slow = 0.05, 5e-4, np.array([0.01, 0.1])
    exact = np.pi * MU * slow * radius**4 / gap
    np.testing.assert_allclose(disc_drag(slow, radius, gap), exact, rtol=1e-12)


def test_a_cylinder_that_turns_slowly_drags_as_couette_flow():
    inner, gap, height, slow = 0.04, 0.002, 0.01, np.array([0.01, 0.1])
    outer = inner + gap
    exact = 4.0 * np.pi * MU * slow * height * (inner * outer) ** 2 / (outer**2 - inner**2)
    np.testing.assert_allclose(cylinder_drag(slow, inner, height, gap), exact, rtol=1e-12)


def short_cylinder_drag(speed, radius, gap):
    return cylinder_drag(speed, radius, 0.01, gap)


@pytest.mark.parametrize("drag", [disc_drag, short_cylinder_drag])
def test_drag_grows_without_jumps_and_faster_than_speed(drag):
    torque = drag(SPEEDS, 0.04, 0.002)
    slope = np.diff(np.log(torque)) / np.diff(np.log(SPEEDS))
    assert np.all((slope > 1.0 - 1e-9) & (slope < 2.0))


def test_a_housing_is_better_than_open_air():
    """von Karman's turbulent free disc, `0.146 Re^-1/5` for both faces: no core turns with it."""
    fast = np.array([2000.0, 4000.0])
    radius = 0.08
    reynolds = fast * radius**2 / AIR_VISCOSITY
    free = 0.146 / reynolds**0.2 * 0.5 * AIR_DENSITY * fast**2 * radius**5
    assert np.all(disc_drag(fast, radius, 0.004) < free)


def test_a_turbulent_gap_drags_as_a_motor_designer_has_it():
    """Touhami's thesis (Toulouse 2020, equations II-70 and II-73) as FAST-OAD_CS23-HE checks it.

    The rotor of 0.1814 m turns 2.8 mm away from its stator at Re = 27082: `C = 0.001487`, of
    `C pi rho W^2 R^4 h`.
    """
    radius, gap, height = 0.0907, 0.0028, 0.01
    speed = np.array([27082.0 * AIR_VISCOSITY / (radius * gap)])
    quoted = 0.001487 * np.pi * AIR_DENSITY * speed**2 * radius**4 * height
    np.testing.assert_allclose(cylinder_drag(speed, radius, height, gap), quoted, rtol=5e-4)


def test_turbulent_faces_drag_as_a_review_has_it():
    """Harmand et al. (2013): `C = 0.051 (s/R)^0.1 Re^-1/5` of each face, boundary layers apart."""
    radius, gap, fast = 0.2, 0.02, np.array([1500.0])
    reynolds = fast * radius**2 / AIR_VISCOSITY
    each = 0.051 * (gap / radius) ** 0.1 / reynolds**0.2 * 0.5 * AIR_DENSITY * fast**2 * radius**5
    np.testing.assert_allclose(disc_drag(fast, radius, gap), 2.0 * each, rtol=1e-12)


def test_the_table_is_the_formula():
    curve = air_drag(PAPER_WHEEL, 0.002)
    between = np.random.default_rng(0).uniform(1.0, 3000.0, 200)
    exact = disc_drag(between, 0.03, 0.002) + cylinder_drag(between, 0.03, 0.01, 0.002)
    np.testing.assert_allclose(curve.at(between), exact, rtol=1e-3)
    assert curve.at(np.zeros(1)) == 0.0
