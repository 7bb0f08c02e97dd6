"""Turns to any attitude in MuJoCo, also by two wheels, which cannot turn the heading directly."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from wheels import driven_device

from ocs_design.requirement.turns import Catch, TurnTo
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.verdict import landing_attitude
from ocs_design.simulation.world import total_mass_properties
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.trajectory.plans import plan

pytestmark = pytest.mark.slow

MOON = 1.62
YAW = TurnTo(name="yaw", yaw=np.pi / 2.0, duration=2.9, gravity=MOON, jump_height=1.9)
YAW_AND_PITCH = TurnTo(
    name="both", yaw=-np.pi / 4.0, pitch=0.3, duration=2.5, gravity=MOON, jump_height=1.4
)
LEVEL = Catch(name="catch", rate=(0.4, 0.8, 0.1), duration=0.6, jump_height=0.5)
STOP = replace(LEVEL, name="stop", end="at rest")


@pytest.fixture(scope="module")
def flown(solo12):
    maneuvers = (YAW, YAW_AND_PITCH, LEVEL, STOP)
    device = driven_device()
    plans = plan(solo12.mass_properties, device, maneuvers)
    references = {name: reference.trajectory for name, reference in plans.items()}
    runs = run_scenarios(Flights(solo12, device, maneuvers, references=references))
    return plans, {run.scenario: run for run in runs if run.ocs}


def test_two_wheels_turn_the_heading(flown):
    """90 degrees on the Moon; the legs move a little on their drives."""
    _, runs = flown
    assert runs["yaw"].passed, runs["yaw"].reason
    assert "heading turned by 90.0 deg" in runs["yaw"].reason
    metrics = runs["yaw"].metrics
    ends = metrics.heading_drift, metrics.touchdown_roll, metrics.touchdown_pitch
    np.testing.assert_allclose(np.degrees(ends), [90.0, 0.0, 0.0], rtol=0, atol=0.3)


def test_heading_and_pitch_together_end_at_the_attitude(flown):
    _, runs = flown
    metrics = runs["both"].metrics
    assert runs["both"].passed, runs["both"].reason
    ends = metrics.touchdown_roll, metrics.touchdown_pitch, metrics.heading_drift
    np.testing.assert_allclose(ends, landing_attitude(YAW_AND_PITCH), rtol=0, atol=np.radians(0.5))


def test_a_robot_that_turns_at_lift_off_is_levelled_or_stopped(flown):
    plans, runs = flown
    assert runs["catch"].passed
    assert runs["stop"].passed
    assert abs(runs["catch"].metrics.touchdown_pitch) < np.radians(0.3)
    assert runs["stop"].metrics.touchdown_pitch > np.radians(5.0)
    assert plans["catch"].trajectory.gains is None
    assert plans["stop"].trajectory.gains.shape[1:] == (2, 8)


def test_the_regulator_corrects_the_heading(solo12, flown):
    """Rates at lift-off distort the motion; only the time-varying gains correct the heading."""
    plans, _ = flown
    pushed = replace(YAW, rate=(0.04, -0.04, 0.0))
    trajectory = plans["yaw"].trajectory
    errors = []
    for gains in (trajectory.gains, None):
        tracked = {"yaw": replace(trajectory, gains=gains)}
        run = run_scenarios(Flights(solo12, driven_device(), [pushed], references=tracked))[0]
        errors.append(abs(np.degrees(run.metrics.heading_drift) - 90.0))
    assert errors[0] < 1.0
    assert errors[1] > 2.5


def test_a_turn_without_a_plan_fails(solo12):
    run = run_scenarios(Flights(solo12, driven_device(), [YAW]))[0]
    assert run.passed is False
    assert run.reason == "touches down with its heading turned by 0.0 of 90.0 deg"


def test_a_catch_starts_with_the_momentum_of_its_rate(solo12):
    """MuJoCo's angular momentum about the centre of mass, with wheels spun up beforehand."""
    spun = replace(LEVEL, wheel_speed=100.0)
    world = WorldBuilder(solo12, driven_device()).flight(spun, Wheels.ACTIVE)
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    mujoco.mj_forward(world.model, data)
    mujoco.mj_subtreeVel(world.model, data)
    turning = total_mass_properties(world.model, data).inertia @ spun.rate
    wheels = world.body.spin_inertia * world.body.axes @ [100.0, 100.0]
    np.testing.assert_allclose(data.subtree_angmom[0], turning + wheels, rtol=1e-9)
    np.testing.assert_allclose(data.subtree_linvel[0, :2], 0.0, atol=1e-12)
