"""The smallest spin inertia: closed form, the theory's figures, and another transcription."""

import casadi as ca
import numpy as np
import pytest
from driven_wheels import EC45_LINE
from gyrostats import (
    BACK_FLIP,
    DIAGONAL,
    FALL,
    PUSH,
    attitude_error,
    body,
    boundary_of,
    drop,
    end_rate,
    smallest_wheels,
)

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia
from ocs_design.device.layout import Layout, LayoutName, module_axes
from ocs_design.requirement.boundary import UPRIGHT, Boundary
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import HeadingLoop


def _closed_form(roll, pitch, incidence, duration=FALL):
    inertia = DIAGONAL.diagonal()[:2]
    task = WheelTask(
        inertia * np.radians([roll, pitch]),
        np.zeros(2),
        duration,
        TiltInertia.uncoupled(inertia),
        module_axes(incidence)[:2],
    )
    return smallest_spin_inertia(task, EC45_LINE).item()


@pytest.mark.parametrize(
    ("degrees", "maneuver", "excess"),
    [
        (0.0, drop(30.0), 2e-4),
        pytest.param(30.0, drop(30.0), 2e-4, marks=pytest.mark.exhaustive),
        pytest.param(40.0, drop(30.0), 2e-4, marks=pytest.mark.slow),
        pytest.param(0.0, BACK_FLIP, 3e-4, marks=pytest.mark.slow),
    ],
)
def test_about_pitch_it_is_the_closed_form(degrees, maneuver, excess):
    """No plan can be below it; the mesh adds at most 0.03 %."""
    incidence, turn = np.radians(degrees), boundary_of(maneuver)
    smallest = smallest_wheels(body(incidence, 1.2e-4, DIAGONAL), turn)
    best = _closed_form(0.0, np.degrees(abs(turn.angle)), incidence, turn.duration)
    assert smallest.solution.solved
    assert 1.0 - 1e-7 < smallest.gyrostat.spin_inertia / best < 1.0 + excess


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pitch", "roll", "degrees", "free", "specified"),
    [
        pytest.param(30.0, 0.0, 40.0, False, 9.11e-5, marks=pytest.mark.slow),
        pytest.param(30.0, 0.0, 30.0, False, 7.80e-5, marks=pytest.mark.exhaustive),
        (30.0, 10.0, 28.5, True, 1.091e-4),
        pytest.param(20.0, 20.0, 39.1, True, 1.042e-4, marks=pytest.mark.exhaustive),
    ],
)
def test_it_is_below_the_figures_for_piecewise_constant_torques(
    pitch, roll, degrees, free, specified
):
    """The theory's figures are for 40 constant torques and the body's inertia with braked wheels.

    The program below reproduces them; torques that follow the voltage line need 1 to 2 % less, at
    the same incidence.
    """
    incidence = np.radians(degrees)
    constant = _with_constant_torques(
        np.radians([roll, pitch]), None if free else module_axes(incidence)
    )
    assert constant == pytest.approx(specified, rel=1e-3)
    guess = body(incidence, 1.2e-4, DIAGONAL)
    smallest = smallest_wheels(guess, boundary_of(drop(pitch, roll)), free_incidence=free)
    assert smallest.solution.solved
    assert 0.98 < smallest.gyrostat.spin_inertia / specified < 0.99
    assert np.degrees(smallest.incidence) == pytest.approx(degrees, abs=0.1)
    assert smallest.violation < 1e-6


def _with_constant_torques(tilt, axes, steps=40):
    """Least spin inertia by multiple shooting, one Runge-Kutta step per constant torque.

    States are the vertical, w and W. Without axes, for a pair at the best incidence.
    """
    wheels, free = (2, True) if axes is None else (axes.shape[1], False)
    v, w, W, tau = (
        ca.SX.sym(name, n) for name, n in (("v", 3), ("w", 3), ("W", wheels), ("tau", wheels))
    )
    h, alpha, dt = ca.SX.sym("h"), ca.SX.sym("alpha"), FALL / steps
    s, c, inertia = ca.sin(alpha), ca.cos(alpha), ca.SX(DIAGONAL)
    A = ca.vertcat(ca.horzcat(s, -s), ca.horzcat(c, c), ca.SX.zeros(1, 2)) if free else ca.SX(axes)
    momentum = inertia @ w + h * A @ W
    actuated = inertia - h * A @ A.T
    w_dot = ca.solve(actuated, -A @ tau - ca.cross(w, momentum))
    slope = ca.vertcat(ca.cross(v, w), w_dot, tau / h - A.T @ w_dot)
    f = ca.Function("f", [ca.vertcat(v, w, W), tau, h, alpha], [slope])
    program = ca.Opti()
    size, angle = program.variable(), program.variable()
    states, torques = program.variable(6 + wheels, steps + 1), program.variable(wheels, steps)
    k = EC45_LINE.no_load_speed / EC45_LINE.stall_torque
    scale = np.array([1.0, 1, 1, 3, 3, 3, *[500] * wheels])
    for i in range(steps):
        x, u, z = states[:, i] * scale, torques[:, i], size * 1e-4
        k1 = f(x, u, z, angle)
        k2 = f(x + dt / 2 * k1, u, z, angle)
        k3 = f(x + dt / 2 * k2, u, z, angle)
        k4 = f(x + dt * k3, u, z, angle)
        following = x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        program.subject_to(states[:, i + 1] == following / scale)
        for speed in (states[6:, i] * 500, states[6:, i + 1] * 500):
            program.subject_to(program.bounded(-1, (speed + k * u) / EC45_LINE.no_load_speed, 1))
    roll, pitch = tilt
    start = [-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)]
    program.subject_to(states[:, 0] == np.append(start, np.zeros(3 + wheels)))
    # Only pitch for wheels that act about no other axis.
    rates, tilts = ([3, 4], [0, 1]) if free or np.any(axes[0]) else ([4], [0])
    program.subject_to(states[tilts, -1] == 0)
    program.subject_to(states[rates, -1] == 0)
    program.subject_to(program.bounded(-1, ca.vec(torques), 1))
    program.subject_to(program.bounded(0.2, angle, 1.2) if free else angle == 0.6)
    program.set_initial(size, 1.1)
    program.set_initial(angle, 0.6)
    share = np.linspace(0.0, 1.0, steps + 1)
    program.set_initial(states[:3, :], np.outer(start, 1 - share) + np.outer([0, 0, 1], share))
    guess = np.full(2, 0.3) if free else 0.3 * np.sign(axes.T @ [*tilt, 0.0])
    program.set_initial(torques, np.outer(guess, np.sign(0.5 - share[:-1])))
    program.minimize(size)
    program.solver("ipopt", {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"})
    return float(program.solve().value(size)) * 1e-4


@pytest.mark.slow
def test_a_push_requires_more_than_its_momentum():
    smallest = smallest_wheels(body(np.radians(35.0), 1.2e-4, DIAGONAL), boundary_of(PUSH))
    assert smallest.solution.solved
    roll, pitch, _ = np.array(PUSH.torque) * PUSH.duration
    shares = np.sin(np.radians(35.0)), np.cos(np.radians(35.0))
    momentum_bound = (roll / shares[0] + pitch / shares[1]) / 2.0 / EC45_LINE.no_load_speed
    assert smallest.gyrostat.spin_inertia > momentum_bound
    assert end_rate(smallest.gyrostat, smallest.trajectory) < 1e-6


SINGLE, TRIAD, ORTHOGONAL, PYRAMID = (
    Layout(LayoutName(name)).axes(np.radians(35.0))
    for name in ("single", "triad", "orthogonal", "pyramid")
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("axes", "pitch", "roll", "specified"),
    [
        (SINGLE, 30.0, 0.0, 1.773e-4),
        pytest.param(module_axes(0.0), 30.0, 0.0, 6.55e-5, marks=pytest.mark.exhaustive),
        pytest.param(TRIAD, 30.0, 0.0, 6.55e-5, marks=pytest.mark.exhaustive),
        (TRIAD, 20.0, 20.0, 5.66e-5),
        pytest.param(ORTHOGONAL, 30.0, 0.0, 1.773e-4, marks=pytest.mark.exhaustive),
        pytest.param(ORTHOGONAL, 20.0, 20.0, 7.84e-5, marks=pytest.mark.exhaustive),
        pytest.param(PYRAMID, 30.0, 0.0, 5.52e-5, marks=pytest.mark.exhaustive),
        pytest.param(PYRAMID, 20.0, 20.0, 5.58e-5, marks=pytest.mark.slow),
    ],
)
def test_one_program_sizes_any_layout_of_wheels(axes, pitch, roll, specified):
    """The theory's figures for one, three and four wheels."""
    assert _with_constant_torques(np.radians([roll, pitch]), axes) == pytest.approx(
        specified, rel=1e-3
    )
    boundary = boundary_of(drop(pitch, roll))
    smallest = smallest_wheels(Gyrostat(DIAGONAL, axes, 1.2e-4), boundary)
    assert 0.97 < smallest.gyrostat.spin_inertia / specified < 0.995
    assert not smallest.failure
    assert attitude_error(boundary, smallest.trajectory) < 1e-6


@pytest.mark.slow
def test_a_single_wheel_flips_the_robot():
    """Within 1 % of the theory's figure for piecewise constant torques."""
    smallest = smallest_wheels(Gyrostat(DIAGONAL, SINGLE, 2e-4), boundary_of(BACK_FLIP))
    assert not smallest.failure
    assert 0.99 < smallest.gyrostat.spin_inertia / 2.95e-4 < 1.0


QUARTER = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
"""The attitude turned about the vertical by 90 degrees."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("axes", "specified"),
    [pytest.param(ORTHOGONAL, 8.6e-5, marks=pytest.mark.exhaustive), (PYRAMID, 3.7e-5)],
)
def test_wheels_about_the_vertical_turn_the_heading(axes, specified):
    up = np.array([0.0, 0.0, 1.0])
    yaw = Boundary("yaw", UPRIGHT, QUARTER, up, np.pi / 2.0, 2.0, end="attitude")
    smallest = smallest_wheels(Gyrostat(DIAGONAL, axes, 1.2e-4), yaw)
    assert not smallest.failure
    assert attitude_error(yaw, smallest.trajectory) < 1e-6
    assert 0.975 < smallest.gyrostat.spin_inertia / specified < 0.995


@pytest.mark.slow
@pytest.mark.parametrize(
    ("duration", "specified"),
    [
        pytest.param(1.5, 1.47e-4, marks=pytest.mark.exhaustive),
        (2.0, 1.05e-4),
        pytest.param(3.0, 6.8e-5, marks=pytest.mark.exhaustive),
    ],
)
def test_two_wheels_turn_the_heading_by_a_loop_of_the_tilt(duration, specified):
    """Without momentum the trunk never rotates about its own vertical, but ends with a new yaw."""
    guess = Gyrostat(DIAGONAL, module_axes(np.radians(39.0)), 2e-4)
    up = np.array([0.0, 0.0, 1.0])
    yaw = Boundary("yaw", UPRIGHT, QUARTER, up, 0.0, duration, end="attitude")
    loop = HeadingLoop(UPRIGHT, np.zeros(3), np.pi / 2.0, 0.0, duration)
    smallest = smallest_wheels(guess, yaw, start=loop.motion(guess, 16))
    assert not smallest.failure
    assert attitude_error(yaw, smallest.trajectory) < 1e-5
    assert smallest.gyrostat.spin_inertia == pytest.approx(specified, rel=0.02)
    assert np.abs(smallest.trajectory.rate[:, 2]).max() < 1e-6
