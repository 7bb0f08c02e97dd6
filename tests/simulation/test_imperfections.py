"""Sensors and drives against what they should be by other means."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ocs_design.simulation.imperfections import AirDrag, Drives, Imperfections, Sensing

NO_AIR = AirDrag(np.array([0.0, 1.0]), np.zeros(2))
BOTH = np.ones(2)
PERFECT = Imperfections(
    attitude_bias=np.zeros(2),
    gyro_bias=np.zeros(3),
    attitude_noise=0.0,
    gyro_noise=0.0,
    stream=np.random.SeedSequence(1),
    torque_gain=BOTH,
    no_load_speed=np.inf * BOTH,
    line_slope=0.0 * BOTH,
    torque_limit=np.inf * BOTH,
    copper=0.0 * BOTH,
    efficiency=1.0,
    power_max=np.inf,
    coulomb=0.0 * BOTH,
    viscous=0.0 * BOTH,
    air=NO_AIR,
    air_factor=0.0,
    delay=0,
)
STEP, HOLD, INERTIA = 1e-3, 5, 7e-5


def drives(*own, instants=2000):
    return Drives(
        own,
        response=np.full(len(own), 1.0 / INERTIA),
        instants=instants,
        hold=HOLD,
        step=STEP,
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
    own = replace(PERFECT, torque_gain=1.09 * BOTH, copper=copper * BOTH, power_max=limit)
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
    own = replace(
        PERFECT,
        torque_gain=np.array([1.1, 0.9]),
        torque_limit=np.array([0.5, 0.2]),
        no_load_speed=np.array([100.0, np.inf]),
        line_slope=np.array([50.0, 0.0]),
    )
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
