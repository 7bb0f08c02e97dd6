"""Maneuvers in 3-D: laws of motion, limits, and independent integrators."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from driven_wheels import EC45_LINE
from gyrostats import (
    BACK_FLIP,
    DIAGONAL,
    FALL,
    FULL,
    PUSH,
    attitude_error,
    body,
    boundary_of,
    drop,
    smallest_wheels,
)
from scipy.integrate import solve_ivp
from subsets import fast_subset

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.errors import SpecificationError
from ocs_design.common.quaternions import scaled_vertical
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.boundary import Boundary
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Flip
from ocs_design.sizing.trajectory.collocation import SQUARE
from ocs_design.sizing.trajectory.equations import after_push
from ocs_design.sizing.trajectory.flight import limit_violation
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import least_power_turn
from ocs_design.sizing.trajectory.program import solve
from ocs_design.sizing.trajectory.transcription import Phase

FORTY = np.radians(40.0)
CASES = {
    "pitch": (body(FORTY), drop(30.0)),
    "pitch and roll": (body(FORTY, armature=4e-5), drop(20.0, 15.0)),
    "push": (body(FORTY), PUSH),
    "back-flip": (body(0.0), BACK_FLIP),
    "back-flip at an angle": (body(np.radians(35.0), 2.2e-4), BACK_FLIP),
    "half a flip": (
        body(0.0, inertia=DIAGONAL),
        Flip(name="half", gravity=1.62, jump_height=1.0, angle=1.7, duration=0.8),
    ),
}


# Each case is fast with one of both kinds of wheels.
KINDS = [(name, ("given", "least")[(i + k) % 2]) for k in (0, 1) for i, name in enumerate(CASES)]


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(kind, marks=[pytest.mark.slow] * (i >= len(CASES)), id=" ".join(kind))
        for i, kind in enumerate(KINDS)
    ],
)
def solved(request):
    """Smooth torques with the given wheels, switching ones with the smallest."""
    name, wheels = request.param
    gyrostat, maneuver = CASES[name]
    if wheels == "least":
        # On equal intervals the means at steps of the torque cancel.
        planned = smallest_wheels(gyrostat, boundary_of(maneuver), passes=(24,))
        return planned.gyrostat, boundary_of(maneuver), planned
    return gyrostat, boundary_of(maneuver), _planned(gyrostat, maneuver)


def _planned(gyrostat, maneuver, line=EC45_LINE, **options):
    return least_power_turn(boundary_of(maneuver), gyrostat, line, **options)


def _momentum(gyrostat, path):
    return path.rate @ gyrostat.inertia + gyrostat.spin_inertia * path.wheel_speed @ gyrostat.axes.T


def test_it_ends_at_rest_at_the_final_attitude(solved):
    _, boundary, solution = solved
    assert solution.solution.solved
    assert not solution.failure
    path = solution.trajectory
    assert path.time[-1] == pytest.approx(boundary.duration)
    np.testing.assert_allclose(path.vertical[-1], boundary.final_vertical, rtol=0, atol=1e-5)
    np.testing.assert_allclose(path.rate[-1, :2], 0.0, rtol=0, atol=1e-6)
    if abs(boundary.angle) > 0.0:
        turned = np.trapezoid(path.rate @ boundary.axis, path.time)
        assert turned == pytest.approx(boundary.angle, rel=0.01)


def test_limits_hold_at_every_sample(solved):
    _, _, solution = solved
    path, line = solution.trajectory, EC45_LINE
    assert np.abs(path.wheel_torque).max() <= line.torque_limit * (1.0 + 1e-6)
    slope = line.no_load_speed / line.stall_torque
    largest = np.abs(path.wheel_speed + slope * path.wheel_torque).max()
    assert largest <= line.no_load_speed * (1.0 + 1e-6)
    assert solution.violation < 1e-6


def test_momentum_is_conserved_in_the_world(solved):
    """Its magnitude and its vertical component."""
    gyrostat, _, solution = solved
    path = solution.trajectory
    momentum = _momentum(gyrostat, path)
    largest = np.abs(gyrostat.spin_inertia * path.wheel_speed).max()
    length = np.linalg.norm(momentum, axis=1)
    vertical = np.einsum("ij,ij->i", momentum, path.vertical)
    np.testing.assert_allclose(length, length[0], rtol=0, atol=1e-6 * largest)
    np.testing.assert_allclose(vertical, vertical[0], rtol=0, atol=1e-6 * largest)


def test_the_motors_work_becomes_kinetic_energy(solved):
    gyrostat, _, solution = solved
    path = solution.trajectory
    state = np.hstack([path.rate, path.wheel_speed])
    energy = 0.5 * np.einsum("ni,ij,nj->n", state, gyrostat.mass_matrix, state)
    power = np.einsum("ni,ni->n", path.wheel_torque, path.wheel_speed)
    # Simpson's rule on pairs of steps, five in each interval of the plan. Between intervals torques
    # may jump, and the sample is the mean of both sides: the errors of both sides cancel.
    pairs = np.diff(path.time)[::2] / 3.0 * (power[:-2:2] + 4.0 * power[1:-1:2] + power[2::2])
    error = energy[2::2] - energy[0] - np.cumsum(pairs)
    inside = np.arange(len(pairs)) % 5 != 4
    assert np.abs(error[inside]).max() < 2e-5 * energy.max()
    assert abs(error[-1]) < 2e-5 * energy.max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pitch and roll", "back-flip at an angle", "push"])
def test_mujoco_ends_where_the_plan_ends(name):
    gyrostat, maneuver = CASES[name]
    # Trajectories are linear between samples: more intervals are closer to the plan.
    path = _planned(gyrostat, maneuver, intervals=60).trajectory
    model = _gyrostat_in_mujoco(gyrostat)
    data = mujoco.MjData(model)
    axis = np.cross(path.vertical[0], [0.0, 0.0, 1.0])
    sine = np.linalg.norm(axis)
    angle = np.arctan2(sine, path.vertical[0, 2])
    if sine > 0.0:
        mujoco.mju_axisAngle2Quat(data.qpos[3:7], axis / sine, angle)
    data.qvel[3:6], data.qvel[6:] = path.rate[0], path.wheel_speed[0]
    steps = round(path.time[-1] / 2e-4)
    model.opt.timestep = path.time[-1] / steps
    middles = (np.arange(steps) + 0.5) * model.opt.timestep
    torques = [np.interp(middles, path.time, column) for column in path.wheel_torque.T]
    for torque in np.column_stack(torques):
        data.qfrc_applied[6:] = torque
        mujoco.mj_step(model, data)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, data.qpos[3:7])
    np.testing.assert_allclose(rotation.reshape(3, 3)[2], path.vertical[-1], rtol=0, atol=2e-5)
    np.testing.assert_allclose(data.qvel[3:6], path.rate[-1], rtol=0, atol=2e-4)
    np.testing.assert_allclose(data.qvel[6:], path.wheel_speed[-1], rtol=0, atol=0.02)


def _gyrostat_in_mujoco(gyrostat):
    """Two wheels at the centre of mass, and the remaining inertia in the trunk."""
    spin = gyrostat.spin_inertia
    trunk, wheels = gyrostat.inertia.copy(), ""
    for axis in gyrostat.axes.T:
        trunk -= 0.5 * spin * (np.eye(3) + np.outer(axis, axis))
        wheels += (
            f'<body zaxis="{axis[0]} {axis[1]} {axis[2]}"><joint axis="0 0 1" damping="0" '
            f'armature="{gyrostat.armature}"/>'
            f'<inertial pos="0 0 0" mass="1e-3" diaginertia="{spin / 2} {spin / 2} {spin}"/></body>'
        )
    entries = trunk[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    full = " ".join(repr(float(entry)) for entry in entries)
    return mujoco.MjModel.from_xml_string(
        '<mujoco><option gravity="0 0 0" integrator="RK4" jacobian="dense"/><worldbody><body>'
        f'<freejoint/><inertial pos="0 0 0" mass="2.5" fullinertia="{full}"/>{wheels}'
        "</body></worldbody></mujoco>"
    )


def test_least_effort_without_limits_is_a_parabola_of_angle():
    """A double integrator rest to rest: torque linear in time, effort 12 (J theta / T^1.5)^2."""
    gyrostat = body(0.0, 1e-4, DIAGONAL)
    free = DriveLine(np.inf, 1e5, np.inf, np.inf)
    planned = _planned(gyrostat, drop(30.0), free)
    reduced = DIAGONAL[1, 1] - 2.0 * gyrostat.spin_inertia
    share = reduced * np.radians(30.0) / 2.0
    assert _effort(planned) == pytest.approx(2.0 * 12.0 * share**2 / FALL**3, rel=1e-6)
    torque = planned.trajectory.wheel_torque[:, 0]
    np.testing.assert_allclose(torque, np.linspace(torque[0], -torque[0], len(torque)), atol=1e-6)


def _effort(planned):
    """Integral of all squared torques [N^2 m^2 s]."""
    motion = planned.solution.motions[0]
    coefficients = motion.torques.reshape(len(motion.torques), len(motion.lengths), -1)
    return np.einsum("ika,ab,ikb,k->", coefficients, SQUARE, coefficients, motion.lengths)


def test_a_mechanical_speed_limit_is_kept():
    slow = DriveLine(1.4566, 650.4, 1.0, 480.0)
    planned = _planned(body(FORTY), drop(30.0), slow)
    assert not planned.failure
    assert 479.0 < np.abs(planned.trajectory.wheel_speed).max() < 480.01


@pytest.mark.parametrize("weak", [{"torque_limit": 0.3}, {"power_max": 10.0}])
def test_weak_drives_have_no_solution(weak):
    planned = _planned(body(FORTY), drop(30.0), replace(EC45_LINE, **weak))
    assert not planned.solution.solved
    assert planned.failure.startswith("no solution within the limits in ")


def test_an_uncontrolled_axis_is_left_free():
    """At alpha = 0 roll is not changed, and pitch ends as required."""
    planned = _planned(body(0.0, inertia=FULL), drop(20.0, 15.0))
    assert not planned.failure
    assert planned.trajectory.vertical[-1, 0] == pytest.approx(0.0, abs=1e-6)
    assert np.degrees(attitude_error(boundary_of(drop(20.0, 15.0)), planned.trajectory)) > 10.0


def test_a_level_start_needs_no_torque():
    planned = _planned(body(FORTY), drop(0.0))
    assert not planned.failure
    assert _effort(planned) < 1e-12


def test_a_push_that_outlasts_the_flight_is_refused():
    late = Disturbance(
        name="late", takeoff_velocity=(0.0, 1.0), torque=(0.0, 1.0, 0.0), onset=0.2, duration=0.1
    )
    with pytest.raises(SpecificationError, match="late"):
        boundary_of(late)


def test_the_state_after_a_push_follows_eulers_equation():
    inertia = CASES["push"][0].inertia
    torque = np.array(PUSH.torque)

    def slope(_, state):
        """Derivative of the vertical in B and of the rate."""
        vertical, rate = state[:3], state[3:]
        change = np.linalg.solve(inertia, torque - np.cross(rate, inertia @ rate))
        return np.concatenate([np.cross(vertical, rate), change])

    start = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    end = solve_ivp(slope, (0.0, PUSH.duration), start, "DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    attitude, rate = (np.asarray(each).ravel() for each in after_push(boundary_of(PUSH))(inertia))
    np.testing.assert_allclose(scaled_vertical(attitude), end[:3], rtol=0, atol=1e-8)
    np.testing.assert_allclose(rate, end[3:], rtol=1e-8)


def test_a_tumbling_body_with_spinning_wheels_comes_to_rest():
    """Three orthogonal wheels absorb any momentum, including that of the heading."""
    gyrostat = Gyrostat(FULL, np.eye(3), 2e-4)
    start = Boundary(
        name="caught",
        attitude=np.array([0.8, 0.0, 0.6, 0.0]),
        final_attitude=np.array([0.8, 0.0, 0.0, 0.6]),
        axis=np.array([0.0, 1.0, 0.0]),
        angle=-1.3,
        duration=1.0,
        end="attitude",
        rate=np.array([0.3, -0.4, 0.2]),
        wheel_speed=np.array([50.0, -80.0, 20.0]),
    )
    planned = least_power_turn(start, gyrostat, EC45_LINE)
    assert not planned.failure
    path = planned.trajectory
    assert attitude_error(start, path) < 1e-5
    np.testing.assert_allclose(path.rate[0], start.rate, rtol=1e-12)
    np.testing.assert_allclose(path.wheel_speed[0], start.wheel_speed, rtol=1e-12)
    np.testing.assert_allclose(path.rate[-1], 0.0, rtol=0, atol=1e-5)
    length = np.linalg.norm(_momentum(gyrostat, path), axis=1)
    np.testing.assert_allclose(length, length[0], rtol=1e-7)


def _power(path, line=EC45_LINE):
    """Power of both motors at every sample, with R i^2 = w_0 / tau_s tau^2 [W]."""
    torque, slope = path.wheel_torque, line.no_load_speed / line.stall_torque
    return (torque * (slope * torque + path.wheel_speed)).sum(axis=1)


@pytest.mark.parametrize("name", fast_subset(3, ["pitch and roll", "pitch", "half a flip"]))
def test_a_power_limit_reduces_the_peak_power(name):
    gyrostat, maneuver = CASES[name]
    before = np.abs(_power(_planned(gyrostat, maneuver).trajectory)).max()
    planned = _planned(gyrostat, maneuver, replace(EC45_LINE, power_max=before))
    assert planned.failure == ""
    assert np.abs(_power(planned.trajectory)).max() < 0.95 * before


def test_power_is_a_limit_at_every_sample():
    gyrostat, maneuver = CASES["pitch"]
    before = np.abs(_power(_planned(gyrostat, maneuver).trajectory)).max()
    tight = replace(EC45_LINE, power_max=0.45 * before)
    path = _planned(gyrostat, maneuver, tight).trajectory
    assert np.abs(_power(path)).max() <= 0.9 * before * (1.0 + 1e-5)
    assert limit_violation(path.wheel_speed, path.wheel_torque, tight) < 1e-5
    assert limit_violation(path.wheel_speed, path.wheel_torque, replace(tight, power_max=1.0)) > 1.0


def test_a_cached_program_keeps_no_state_of_other_turns():
    """A program of the same dimensions is solved for another turn in between."""
    line = replace(EC45_LINE, power_max=300.0)
    gyrostat, maneuver = CASES["pitch"]
    first = _planned(gyrostat, maneuver, line).solution
    other = _planned(gyrostat, drop(24.0), line).solution
    again = _planned(gyrostat, maneuver, line).solution
    assert first.solved and other.solved and other.cost < 0.9 * first.cost
    assert again.cost == first.cost
    np.testing.assert_array_equal(again.motions[0].states, first.motions[0].states)


@pytest.mark.parametrize("name", ["pair", "triad", "orthogonal", "pyramid"])
def test_an_uneven_guess_ends_with_the_same_wheel_momentum(name):
    gyrostat = Gyrostat(FULL, np.asarray(Layout(LayoutName(name)).axes(0.6)), 1e-4, 2e-5)
    even = Phase(boundary_of(drop(30.0)), gyrostat).outline.motion(gyrostat, 12)
    uneven = even.uneven(gyrostat)
    change = uneven.states[4:] - even.states[4:]
    assert np.abs(change).max() > 0.01 * np.abs(even.states[4:]).max()
    np.testing.assert_allclose(gyrostat.axes @ change[:, [0, -1]], 0.0, rtol=0, atol=1e-9)
    # The torques accelerate the driven inertia to these speeds.
    difference = uneven.torques - even.torques
    steps = difference.reshape(len(change), -1, 3).mean(axis=2) * even.lengths
    np.testing.assert_allclose(steps.sum(axis=1), 1.2e-4 * change[:, -1], rtol=0, atol=1e-12)


def test_four_wheels_without_a_plan_use_that_of_an_equivalent_pair(monkeypatch):
    """A double pair was once enlarged for a turn that two lighter wheels could make."""

    def failing_solve(turns, *arguments):
        planned = solve(turns, *arguments)
        return replace(planned, solved=turns[0].gyrostat.axes.shape[1] < 4)

    monkeypatch.setattr("ocs_design.sizing.trajectory.plans.solve", failing_solve)
    pair = body(np.radians(30.0), spin_inertia=1.4e-4, armature=1e-6)
    four = replace(pair, axes=np.tile(pair.axes, 2), spin_inertia=0.7e-4, armature=0.5e-6)
    weak = replace(
        EC45_LINE,
        stall_torque=EC45_LINE.stall_torque / 2.0,
        torque_limit=EC45_LINE.torque_limit / 2.0,
    )
    turn = boundary_of(drop(20.0, 10.0))
    planned, expected = least_power_turn(turn, four, weak), least_power_turn(turn, pair, EC45_LINE)
    assert not planned.failure
    path = planned.trajectory
    assert attitude_error(turn, path) == pytest.approx(attitude_error(turn, expected.trajectory))
    np.testing.assert_array_equal(path.wheel_speed, np.tile(expected.trajectory.wheel_speed, 2))
    np.testing.assert_allclose(_momentum(four, path), 0.0, atol=1e-6)
    # h A^T w_dot + (h + a) W_dot = tau, over each step.
    momentum = four.spin_inertia * path.rate @ four.axes
    momentum += (four.spin_inertia + four.armature) * path.wheel_speed
    impulse = path.step_torque.mean(axis=1) * np.diff(path.time)[:, None]
    np.testing.assert_allclose(np.diff(momentum, axis=0), impulse, atol=1e-6)
