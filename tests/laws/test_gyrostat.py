"""Free flight of trunk and wheels, also behind gears, against the gyrostat's equations."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from wheels import EC45, PAPER_WHEEL, driven_device, geared, motor, paper_device

from ocs_design.requirement.froude import Gains
from ocs_design.requirement.turns import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation.motor_limits import USED_SHARE, MotorLimits
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.wheel_law import Allocation, WheelLaw
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import WorldBuilder

INERTIA = (0.030, 0.0535, 0.068, 0.001, 0.003, -0.002)


def floating(inertia=INERTIA, wheels=Wheels.ACTIVE, device=None, duration=1.0) -> World:
    """A body by hand without gravity, far from the floor, with its controller off."""
    builder = WorldBuilder(robot_by_hand(2.5, inertia), device or paper_device())
    world = builder.flight(Drop(name="drop", height=100.0, pitch=0.0), wheels)
    world.model.opt.gravity[:] = 0.0
    return replace(world, law=WheelLaw.off(2), duration=duration)


def spinning(world: World, rate, wheel_speed) -> World:
    qvel = world.qvel.copy()
    qvel[3:6], qvel[6:8] = rate, wheel_speed
    return replace(world, qvel=qvel)


def gyrostat_motion(world: World, rate, wheel_speed, torque, times):
    """Rate and wheel speeds from `J w' = -A tau - w x H`, `W' = tau / I_w - A^T w'`."""
    body = world.body
    J, A = body.actuated_inertia, body.axes

    def slope(_, state):
        w, W = state[:3], state[3:]
        momentum = body.inertia @ w + body.spin_inertia * A @ W
        w_dot = np.linalg.solve(J, -A @ torque - np.cross(w, momentum))
        return np.concatenate([w_dot, torque / body.spin_inertia - A.T @ w_dot])

    start = np.concatenate([rate, wheel_speed])
    solution = solve_ivp(
        slope, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-12
    )
    return solution.y[:3].T, solution.y[3:].T


@pytest.mark.parametrize(
    ("rate", "wheel_speed"),
    [
        ((1.0, -2.0, 0.5), (500.0, -300.0)),
        ((3.0, 6.0, -4.0), (1690.0, 1500.0)),
        ((0.1, 0, 0), (0, 0)),
    ],
)
def test_fast_wheels_follow_the_gyrostat_and_conserve_momentum(rate, wheel_speed):
    world = spinning(floating(), rate, wheel_speed)
    recording = simulate([world], hold=5)
    w, W = gyrostat_motion(world, rate, wheel_speed, np.zeros(2), recording.time)
    np.testing.assert_allclose(recording.rate[:, 0], w, rtol=0, atol=1e-6)
    np.testing.assert_allclose(recording.wheel_speed[:, 0], W, rtol=0, atol=1e-5)
    momentum = recording.momentum[:, 0]
    change = np.linalg.norm(momentum - momentum[0], axis=1).max()
    assert change < 1e-9 * np.linalg.norm(momentum[0])


def test_a_symmetric_top_precesses_as_eulers_equations_say():
    """w_x = w_0 cos(l t), w_y = w_0 sin(l t), l = (I_zz - I_xx) / I_xx w_z."""
    world = spinning(
        floating(inertia=(0.05, 0.05, 0.08), wheels=Wheels.ABSENT), (1.0, 0.0, 7.0), (0.0, 0.0)
    )
    recording = simulate([world])
    phase = (0.08 - 0.05) / 0.05 * 7.0 * recording.time
    expected = np.column_stack([np.cos(phase), np.sin(phase), np.full_like(phase, 7.0)])
    np.testing.assert_allclose(recording.rate[:, 0], expected, rtol=0, atol=1e-7)


@pytest.mark.parametrize("incidence", [0.0, np.radians(40.0)])
def test_full_torque_and_its_reverse_turn_the_trunk_as_the_closed_form_says(incidence):
    """t = 2 sqrt(I_b theta / tau), peak wheel speed 2 theta / (xi t) with xi = I_w / (I_w + I_b).

    See docs/theory.md. Two wheels at alpha = 0 act as one of twice the inertia and torque.
    """
    world = floating(inertia=INERTIA[:3], device=paper_device(incidence))
    model, data = world.model, mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    half, torque = 200, 0.2
    time = 2 * half * model.opt.timestep
    cosine = np.cos(incidence)
    inertia = world.body.actuated_inertia[1, 1]
    theta = 2.0 * cosine * torque * (time / 2.0) ** 2 / inertia
    # At an incidence each wheel turns with the trunk by cos(alpha), and stores by cos(alpha).
    xi = 2.0 * cosine * PAPER_WHEEL.spin_inertia
    xi /= 2.0 * cosine**2 * PAPER_WHEEL.spin_inertia + inertia
    motors = list(world.addresses.motors)
    data.ctrl[motors] = -torque
    mujoco.mj_step(model, data, half)
    peak = data.qvel[6]
    data.ctrl[motors] = torque
    mujoco.mj_step(model, data, half)
    assert 2.0 * np.arctan2(data.qpos[5], data.qpos[3]) == pytest.approx(theta, rel=1e-7)
    assert np.abs(data.qvel[3:8]).max() < 1e-8
    assert -peak == pytest.approx(2.0 * theta / (xi * time), rel=1e-7)


def test_a_saturated_motor_follows_its_voltage_line():
    """W = f w_0 (1 - exp(-t / T)), T = I_red w_0 / tau_s (docs/theory.md, What a motor can do).

    f is the share of the voltage that the controller uses.
    """
    drive = motor(no_load_speed=650.4, stall_torque=1.4566)
    world = floating(device=paper_device(incidence=0.0, drive=drive), duration=0.1)
    far = replace(world.turn, start=0.0, end=3.0, at_once=True)
    law = WheelLaw.of(world.body, Gains(1e5, 0.0), MotorLimits.of(drive), Allocation.PSEUDO_INVERSE)
    recording = simulate([replace(world, law=law, turn=far)], hold=1)
    speed = -recording.wheel_speed[:, 0, 0]
    constant = 650.4 / 1.4566 / world.body.wheel_response
    continuous = USED_SHARE * 650.4 * (1.0 - np.exp(-recording.time / constant))
    discrete = USED_SHARE * 650.4 * (1.0 - (1.0 + 1e-3 / constant) ** -np.arange(len(speed)))
    np.testing.assert_allclose(speed, discrete, rtol=1e-5)
    np.testing.assert_allclose(speed, continuous, rtol=0, atol=0.01 * 650.4)


def test_an_external_torque_changes_momentum_by_its_impulse():
    world = floating()
    push = replace(
        world.pushes[0], torque=np.array([0.2, 0.8, -0.1]), onset=0.1003, duration=0.0501
    )
    recording = simulate([replace(world, pushes=(push,))])
    gained = recording.momentum[-1, 0] - recording.momentum[0, 0]
    np.testing.assert_allclose(gained, recording.impulse[-1, 0], rtol=1e-9)
    assert np.linalg.norm(gained) == pytest.approx(np.linalg.norm(push.torque) * 0.0501, rel=1e-3)


DRIVES = {
    "direct": EC45,
    "reducing": geared(3.0),
    "reversing": geared(1.5, reverses=True),
    "speeding up": geared(0.5, inertia=0.0),
}


@pytest.fixture(params=DRIVES, scope="module")
def world(request):
    device = driven_device(drive=DRIVES[request.param])
    builder = WorldBuilder(robot_by_hand(2.5, INERTIA), device)
    world = builder.flight(Drop(name="drop", height=100.0, pitch=0.0), Wheels.ACTIVE)
    world.model.opt.gravity[:] = 0.0
    return world


def accelerations(world, rate, wheel_speed, torque):
    """Accelerations of trunk and wheels by MuJoCo."""
    data = mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    data.qvel[3:6], data.qvel[6:8] = rate, wheel_speed
    # Not by the motors, which have limits.
    data.qfrc_applied[6:8] = torque
    mujoco.mj_forward(world.model, data)
    return data.qacc[3:6].copy(), data.qacc[6:8].copy()


@pytest.mark.parametrize("seed", range(5))
def test_both_equations_hold_whatever_the_gear(world, seed):
    rng = np.random.default_rng(seed)
    w, W, tau = rng.uniform(-5, 5, 3), rng.uniform(-900, 900, 2), rng.uniform(-2, 2, 2)
    w_dot, W_dot = accelerations(world, w, W, tau)
    body, A, h = world.body, world.body.axes, world.body.spin_inertia
    gyroscopic = np.cross(w, body.inertia @ w + h * A @ W)
    np.testing.assert_allclose(
        body.actuated_inertia @ w_dot, -body.reaction * A @ tau - gyroscopic, rtol=0, atol=1e-9
    )
    driven = h * A.T @ w_dot + (h + body.armature) * W_dot
    np.testing.assert_allclose(driven, tau, rtol=0, atol=1e-9)


def test_the_wheel_response_is_the_largest_acceleration_per_torque(world):
    torques = [np.array([1.0, 1.0]), np.array([1.0, -1.0])]
    largest = max(
        np.abs(accelerations(world, np.zeros(3), np.zeros(2), tau)[1]).max() for tau in torques
    )
    assert largest == pytest.approx(world.body.wheel_response, rel=1e-9)


def test_momentum_is_conserved_behind_a_gear(world):
    """The armature is no body: it stores energy, and the gear's rotation has no momentum."""
    data = mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    data.qvel[3:6], data.qvel[6:8] = (0.5, -2.0, 0.3), (300.0, -500.0)
    mujoco.mj_forward(world.model, data)
    at = slice(world.addresses.momentum, world.addresses.momentum + 3)
    before = data.sensordata[at].copy()
    mujoco.mj_step(world.model, data, 300)
    assert np.linalg.norm(data.sensordata[at] - before) < 1e-8 * np.linalg.norm(before)
