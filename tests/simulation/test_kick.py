"""Simulated kicks give exactly their impulse and angular momentum."""

from copy import copy
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from wheels import paper_device

from ocs_design.requirement.pushes import Disturbance
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate

KICK = Disturbance(
    name="kick",
    takeoff_velocity=(0.0, 2.4),
    torque=(-0.5, 0.8, 0.0),
    onset=0.101,
    duration=0.052,
    velocity_change=(-0.1, 0.3, 0.2),
)


def check_kick(world, momentum, velocity):
    """Check the changes of angular momentum and velocity by the kick, without gravity."""
    recording = simulate([world], hold=5)
    before, after = np.searchsorted(recording.time, [0.09, 0.17])
    gained = recording.momentum[after, 0] - recording.momentum[before, 0]
    assert gained == pytest.approx(momentum, abs=2e-3)
    (v1, v2) = np.gradient(recording.com[:, 0], recording.time, axis=0)[[before, after]]
    fallen = [0.0, 0.0, 9.81 * (recording.time[after] - recording.time[before])]
    assert v2 - v1 + fallen == pytest.approx(velocity, abs=0.02)


def test_a_kick_changes_velocity_and_momentum_by_its_impulses(builder):
    world = builder.flight(KICK, Wheels.ABSENT)
    check_kick(world, np.multiply(KICK.torque, KICK.duration), KICK.velocity_change)


@pytest.mark.parametrize("wheels", [Wheels.ABSENT, Wheels.BRAKED])
def test_a_force_at_a_point_gives_the_momentum_of_mujoco(builder, wheels):
    """About the centre of mass of robot and device, which is 22 mm from the robot's own."""
    kick = replace(KICK, impulse=(-0.2, 0.6, 0.3), point=(0.1, 0.05, 0.0))
    world = builder.flight(kick, wheels)
    model = copy(world.model)
    data = mujoco.MjData(model)
    model.opt.timestep, model.opt.gravity[:], data.qpos[:] = 1e-6, 0.0, world.qpos
    mujoco.mj_forward(model, data)
    trunk = world.addresses.trunk
    point, force = data.xpos[trunk] + kick.point, np.array(kick.impulse) / model.opt.timestep
    mujoco.mj_applyFT(model, data, force, np.zeros(3), point, trunk, data.qfrc_applied)
    mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    check_kick(world, data.subtree_angmom[0], data.subtree_linvel[0])


@pytest.mark.slow
def test_a_kick_is_no_momentum_error(solo12):
    with_device, without = run_scenarios(Flights(solo12, paper_device(), [KICK]))
    for run in (with_device, without):
        assert run.metrics.momentum_error < 1e-6
        assert "not judged" not in run.reason
    assert with_device.metrics.touchdown_pitch < without.metrics.touchdown_pitch
