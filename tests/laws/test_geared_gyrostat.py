"""Trunk and driven wheels behind a gear: the law's equations against MuJoCo's own."""

import mujoco
import numpy as np
import pytest
from wheels import EC45, driven_device, geared

from ocs_design.requirement.maneuver import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world import WorldBuilder

INERTIA = (0.030, 0.0535, 0.068, 0.001, 0.003, -0.002)
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
    """Of trunk and wheels by MuJoCo."""
    data = mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    data.qvel[3:6], data.qvel[6:8] = rate, wheel_speed
    # Not by the motors: they are limited.
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


def test_the_wheel_responds_as_told(world):
    pushes = [np.array([1.0, 1.0]), np.array([1.0, -1.0])]
    found = [np.abs(accelerations(world, np.zeros(3), np.zeros(2), tau)[1]).max() for tau in pushes]
    assert max(found) == pytest.approx(world.body.wheel_response, rel=1e-9)


def test_momentum_is_kept_behind_a_gear(world):
    """The armature is no body: it holds energy, and the gear's own turning takes no momentum."""
    data = mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    data.qvel[3:6], data.qvel[6:8] = (0.5, -2.0, 0.3), (300.0, -500.0)
    mujoco.mj_forward(world.model, data)
    at = slice(world.addresses.momentum, world.addresses.momentum + 3)
    before = data.sensordata[at].copy()
    mujoco.mj_step(world.model, data, 300)
    assert np.linalg.norm(data.sensordata[at] - before) < 1e-8 * np.linalg.norm(before)
