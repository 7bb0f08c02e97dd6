"""Maneuvers in 3-D: laws of motion, limits, and integrators that know nothing of collocation."""

import mujoco
import numpy as np
import pytest
from gyrostats import BACK_FLIP, DIAGONAL, EC_45_FLAT, FALL, FULL, PUSH, asked, body, drop
from scipy.integrate import solve_ivp

from ocs_design.drive.line import DriveLine
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.drive.wheel_pair import WheelPairTask, pair_slew_time
from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.maneuver import Disturbance, Flip
from ocs_design.sizing.optimal_control.solution import Objective
from ocs_design.sizing.optimal_control.solving import solve_maneuver

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


@pytest.fixture(scope="module", params=[(n, o) for n in CASES for o in Objective], ids=str)
def solved(request):
    name, objective = request.param
    gyrostat, maneuver = CASES[name]
    return (
        gyrostat,
        asked(maneuver),
        solve_maneuver(gyrostat, EC_45_FLAT, asked(maneuver), objective),
    )


def _momentum(gyrostat, path):
    return path.rate @ gyrostat.inertia + gyrostat.spin_inertia * path.wheel_speed @ gyrostat.axes.T


def test_it_ends_at_rest_where_it_should(solved):
    _, boundary, solution = solved
    assert solution.solved
    assert solution.sound
    path = solution.trajectory
    assert path.time[-1] == pytest.approx(solution.duration)
    assert solution.duration <= boundary.duration * (1.0 + 1e-9)
    np.testing.assert_allclose(path.vertical[-1], boundary.final_vertical, rtol=0, atol=1e-5)
    np.testing.assert_allclose(path.rate[-1, :2], 0.0, rtol=0, atol=1e-6)
    if abs(boundary.angle) > 0.0:
        assert path.turned[-1] == pytest.approx(boundary.angle, rel=0.01)


def test_limits_hold_at_every_sample(solved):
    _, _, solution = solved
    path, line = solution.trajectory, EC_45_FLAT
    assert np.abs(path.wheel_torque).max() <= line.torque_limit * (1.0 + 1e-6)
    slope = line.no_load_speed / line.stall_torque
    reached = np.abs(path.wheel_speed + slope * path.wheel_torque).max()
    assert reached <= line.no_load_speed * (1.0 + 1e-6)
    assert solution.fine.violation < 1e-6


def test_momentum_is_kept_in_the_world(solved):
    """Its length, and its part along the vertical."""
    gyrostat, _, solution = solved
    path = solution.trajectory
    momentum = _momentum(gyrostat, path)
    largest = np.abs(gyrostat.spin_inertia * path.wheel_speed).max()
    length = np.linalg.norm(momentum, axis=1)
    upward = np.einsum("ij,ij->i", momentum, path.vertical)
    np.testing.assert_allclose(length, length[0], rtol=0, atol=1e-6 * largest)
    np.testing.assert_allclose(upward, upward[0], rtol=0, atol=1e-6 * largest)


def test_the_motors_pay_for_the_kinetic_energy(solved):
    gyrostat, _, solution = solved
    path = solution.trajectory
    state = np.hstack([path.rate, path.wheel_speed])
    energy = 0.5 * np.einsum("ni,ij,nj->n", state, gyrostat.mass_matrix, state)
    power = np.einsum("ni,ni->n", path.wheel_torque, path.wheel_speed)
    # Simpson's rule on pairs of steps, five in each interval of the plan. Where two intervals meet
    # torques may jump, and the sample is the mean of both sides: what that adds on one side it
    # takes on the other.
    pairs = np.diff(path.time)[::2] / 3.0 * (power[:-2:2] + 4.0 * power[1:-1:2] + power[2::2])
    error = energy[2::2] - energy[0] - np.cumsum(pairs)
    inside = np.arange(len(pairs)) % 5 != 4
    assert np.abs(error[inside]).max() < 2e-5 * energy.max()
    assert abs(error[-1]) < 2e-5 * energy.max()


def test_a_high_order_integrator_follows_the_plan():
    """Least effort has no jumps: DOP853 with the torque between its samples ends level at rest."""
    gyrostat, maneuver = CASES["pitch and roll"]
    path = solve_maneuver(gyrostat, EC_45_FLAT, asked(maneuver)).trajectory
    matrix = gyrostat.mass_matrix

    def slope(time, state):
        vertical, rate = state[:3], state[3:6]
        torque = [np.interp(time, path.time, column) for column in path.wheel_torque.T]
        turning = np.cross(matrix[:3] @ state[3:], rate)
        change = np.linalg.solve(matrix, np.concatenate([turning, torque]))
        return np.concatenate([np.cross(vertical, rate), change])

    start = np.concatenate([path.vertical[0], path.rate[0], path.wheel_speed[0]])
    answer = solve_ivp(slope, (0.0, path.time[-1]), start, "DOP853", rtol=1e-9, atol=1e-9)
    end = answer.y[:, -1]
    np.testing.assert_allclose(end[:3], [0.0, 0.0, 1.0], rtol=0, atol=1e-5)
    np.testing.assert_allclose(end[3:6], 0.0, rtol=0, atol=1e-4)


@pytest.mark.parametrize("name", ["pitch and roll", "back-flip at an angle", "push"])
def test_mujoco_ends_where_the_plan_ends(name):
    gyrostat, maneuver = CASES[name]
    # Between its samples a trajectory is linear: on more intervals that is nearer to the plan.
    path = solve_maneuver(gyrostat, EC_45_FLAT, asked(maneuver), intervals=60).trajectory
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
    """Two wheels at the centre of mass, and what they leave of the inertia in the trunk."""
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


@pytest.mark.parametrize("incidence", [0.0, FORTY])
def test_the_shortest_time_about_pitch_is_the_closed_form(incidence):
    """Without products of inertia it is a turn about one axis; a mesh can only be a little slow."""
    spin = 1.2e-4
    task = WheelPairTask(
        swept=DIAGONAL.diagonal()[:2] * np.radians([0.0, 30.0]),
        momentum=np.zeros(2),
        duration=FALL,
        inertia=TiltInertia.uncoupled(DIAGONAL.diagonal()[:2]),
        incidence=incidence,
    )
    best = pair_slew_time(task, spin, EC_45_FLAT).item()
    found = solve_maneuver(
        body(incidence, spin, DIAGONAL), EC_45_FLAT, asked(drop(30.0)), Objective.TIME, 40
    )
    assert 1.0 - 1e-7 < found.duration / best < 1.0 + 5e-4


def test_least_effort_without_limits_is_a_parabola_of_angle():
    """A double integrator rest to rest: torque linear in time, effort 12 (J theta / T^1.5)^2."""
    gyrostat = body(0.0, 1e-4, DIAGONAL)
    free = DriveLine(np.inf, 1e5, np.inf, np.inf)
    found = solve_maneuver(gyrostat, free, asked(drop(30.0)))
    reduced = DIAGONAL[1, 1] - 2.0 * gyrostat.spin_inertia
    each = reduced * np.radians(30.0) / 2.0
    assert found.value == pytest.approx(2.0 * 12.0 * each**2 / FALL**3, rel=1e-6)
    torque = found.trajectory.wheel_torque[:, 0]
    np.testing.assert_allclose(torque, np.linspace(torque[0], -torque[0], len(torque)), atol=1e-6)


def test_a_mechanical_speed_limit_is_kept():
    slow = DriveLine(1.4566, 650.4, 1.0, 480.0)
    found = solve_maneuver(body(FORTY), slow, asked(drop(30.0)))
    assert found.sound
    assert 479.0 < np.abs(found.trajectory.wheel_speed).max() < 480.01


def test_what_is_out_of_reach_is_said_to_be():
    weak = DriveLine(1.4566, 650.4, 0.3, np.inf)
    found = solve_maneuver(body(FORTY), weak, asked(drop(30.0)))
    assert not found.solved
    assert not found.sound
    assert "Infeasible" in found.failure


def test_an_axis_out_of_reach_is_left_alone():
    """At alpha = 0 roll stays as it is, and the end of pitch is met."""
    found = solve_maneuver(body(0.0, inertia=FULL), EC_45_FLAT, asked(drop(20.0, 15.0)))
    assert found.sound
    assert found.trajectory.vertical[-1, 0] == pytest.approx(0.0, abs=1e-6)
    assert np.degrees(found.fine.end_tilt) > 10.0


def test_level_from_the_start_asks_for_nothing():
    found = solve_maneuver(body(FORTY), EC_45_FLAT, asked(drop(0.0)))
    assert found.sound
    assert found.value < 1e-12


def test_a_push_that_outlasts_the_flight_is_refused():
    late = Disturbance(
        name="late", takeoff_velocity=(0.0, 1.0), torque=(0.0, 1.0, 0.0), onset=0.2, duration=0.1
    )
    with pytest.raises(SpecificationError, match="late"):
        asked(late)
