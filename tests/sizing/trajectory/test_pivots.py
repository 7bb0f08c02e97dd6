"""Plans and gains about a pivot against scalar equations of a pendulum."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocs_design.actuation.drive import PLANNED, DriveLine
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia
from ocs_design.requirement.pivoted import Balance, StandUp
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import reference
from ocs_design.sizing.trajectory.tracking import linearised

# Wheelbot v2.5 about roll (docs/machines.md): 0.01957 kg m^2 and 1.430 N m about its lower wheel.
WEIGHT, INERTIA, ARM = 1.430, 0.01957, 0.1
BODY = MassProperties(WEIGHT / 9.81 / ARM, np.zeros(3), np.eye(3) * (INERTIA - WEIGHT / 9.81 * ARM))
LINE = DriveLine(1.6, 282.7, 1.2, np.inf, np.inf)
PLACE = {"pivot": (0.0, 0.0, -ARM), "edge": (1.0, 0.0, 0.0)}
ABOUT_COM = TiltInertia.of(BODY.inertia)
UP = StandUp(name="up", **PLACE, roll=np.radians(36.0), duration=0.4).on(BODY)


def gyrostat(maneuver, spin_inertia):
    figures = (maneuver.inertia, np.eye(3)[:, :1], spin_inertia)
    return Gyrostat(*figures, gravity_moment=maneuver.gravity_moment, edge=maneuver.axis)


def pendulum(tilt, rate, spin_inertia, trajectory, until):
    """Solve `(I - h) w' = m g l sin(theta) - tau`, `h (w' + W') = tau` with the planned torque."""

    def slope(time, state):
        theta, speed, _ = state
        torque = np.interp(time, trajectory.time, trajectory.wheel_torque[:, 0])
        acceleration = (WEIGHT * np.sin(theta) - torque) / (INERTIA - spin_inertia)
        return [speed, acceleration, torque / spin_inertia - acceleration]

    return solve_ivp(slope, (0.0, until), [tilt, rate, 0.0], rtol=1e-9, atol=1e-11, max_step=1e-3)


def test_a_plan_stands_the_scalar_pendulum_up():
    planned = reference(gyrostat(UP, 1e-3), LINE, UP)
    assert not planned.note
    steps = planned.trajectory.time[planned.trajectory.time <= UP.duration * (1.0 + 1e-12)]
    ends = pendulum(UP.roll, 0.0, 1e-3, planned.trajectory, steps[-1]).y[:, -1]
    np.testing.assert_allclose(ends[:2], 0.0, atol=5e-3)
    speed = planned.trajectory.wheel_speed[len(steps) - 1, 0]
    assert ends[2] == pytest.approx(speed, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("time", "rpm"), [(0.3, 0.0), (0.3, -2000.0)])
def test_the_closed_form_is_near_the_smallest_wheel(time, rpm):
    """The selection's estimate is within 10 % of what planned stand-ups from 36 deg need."""
    up = replace(UP, duration=time, wheel_speed=rpm * np.pi / 30.0)
    low, high = 3e-4, 3e-3
    while high > 1.05 * low:
        middle = np.sqrt(low * high)
        planned = reference(gyrostat(up, middle), LINE, up).trajectory
        low, high = (middle, high) if planned is None else (low, middle)
    slew, inertia = up.slew(ABOUT_COM), up.turned(ABOUT_COM)
    task = WheelTask(
        slew.swept,
        slew.momentum,
        slew.duration,
        inertia,
        np.eye(2)[:, :1],
        initial_speed=slew.initial_speed,
        one_way=slew.one_way,
    )
    closed_form = smallest_spin_inertia(task, LINE.reserved(PLANNED))
    assert high / closed_form == pytest.approx(1.0, abs=0.1)


@pytest.mark.slow
def test_a_plan_that_fails_says_from_which_tilt_it_would_succeed():
    refused = reference(gyrostat(UP, 3e-4), LINE, UP)
    assert refused.trajectory is None
    assert 0.2 < refused.tilt_fraction < 1.0
    milder = replace(UP, roll=refused.tilt_fraction * UP.roll)
    assert reference(gyrostat(milder, 3e-4), LINE, milder).trajectory is not None


@pytest.mark.slow
def test_a_wheel_that_starts_spinning_backwards_may_be_smaller():
    """Wheelbot spins up to 2,000 rpm backwards before it stands up from 36 deg."""
    smaller = gyrostat(UP, 6e-4)
    assert reference(smaller, LINE, UP).trajectory is None
    spun = replace(UP, wheel_speed=-2000.0 * np.pi / 30.0)
    assert reference(smaller, LINE, spun).trajectory is not None


def test_poles_of_the_inverted_pendulum():
    """Free wheels do not turn with the body about their axis: `l^2 = m g l / (I - h)`."""
    h = 1e-3
    upright = np.array([[0.0, 0.0, 1.0]])
    system = linearised(gyrostat(UP, h), np.zeros((1, 3)), np.zeros((1, 1)), upright)[0]
    poles = np.sort(np.linalg.eigvals(system[:, :7]).real)
    pole = np.sqrt(WEIGHT / (INERTIA - h))
    np.testing.assert_allclose(poles[[0, -1]], [-pole, pole], rtol=1e-9)
    np.testing.assert_allclose(poles[1:-1], 0.0, atol=1e-9)


def test_the_regulator_keeps_the_body_upright_and_stops_the_wheel():
    h, maneuver = 1e-3, Balance(name="b", **PLACE, roll=0.1, duration=1.0).on(BODY)
    body = gyrostat(maneuver, h)
    gains = reference(body, LINE, maneuver).trajectory.gains[0]
    system = linearised(body, np.zeros((1, 3)), np.zeros((1, 1)), np.array([[0.0, 0.0, 1.0]]))[0]
    states = [0, 3, 6]
    closed_loop = (system[:, :7] - system[:, 7:8] @ gains)[np.ix_(states, states)]
    assert np.linalg.eigvals(closed_loop).real.max() < -0.5
