"""A world of a device with real motors: its masses, and that it flies in a batch with the rest."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from wheels import EC45_BODY, braked_inertia, driven_device, geared, paper_device, paper_maneuvers

from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world import WorldBuilder


@pytest.fixture(scope="module")
def device():
    return driven_device(drive=geared(1.5))


@pytest.fixture(scope="module")
def builder(solo12, device):
    return WorldBuilder(solo12, device)


@pytest.fixture(scope="module")
def maneuvers(solo12):
    return paper_maneuvers(solo12)


def test_the_law_believes_in_robot_rims_and_carriers(solo12, device, builder, maneuvers):
    body = builder.flight(maneuvers[0], Wheels.ACTIVE).body
    expected = braked_inertia(solo12, device).inertia
    np.testing.assert_allclose(body.inertia, expected, rtol=0, atol=1e-9 * np.trace(expected))
    assert body.spin_inertia == device.flywheel.spin_inertia
    assert body.armature == device.motor.armature > 0.0


def test_turned_by_hand_the_carriers_turn_along(solo12, device, builder, maneuvers):
    flip = builder.flight(maneuvers[2], Wheels.ACTIVE)
    expected = braked_inertia(solo12, device.at_incidence(0.0)).inertia
    np.testing.assert_allclose(flip.body.inertia, expected, rtol=0, atol=1e-9 * np.trace(expected))


def test_what_is_absent_has_no_motors_either(solo12, builder, maneuvers):
    model = builder.flight(maneuvers[1], Wheels.ABSENT).model
    assert model.body_subtreemass[1] == pytest.approx(solo12.mass, rel=1e-8)


def test_all_worlds_fit_the_same_working_memory(builder, maneuvers):
    models = [builder.flight(maneuver, wheels).model for maneuver in maneuvers for wheels in Wheels]
    found = [name for name in dir(models[0]) if name.startswith("n")]
    sizes = [name for name in found if isinstance(getattr(models[0], name), int)]
    for name in sizes:
        assert len({getattr(model, name) for model in models}) == 1, name


def test_braked_wheels_hold_behind_a_gear_too(builder, maneuvers):
    """The brake is on the joint, whatever armature the motor has."""
    world = builder.level_landing(maneuvers[1])
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = world.qpos, world.qvel, world.ctrl
    data.qvel[3:6] = (1.0, 2.0, -0.5)
    mujoco.mj_step(world.model, data, 200)
    assert np.abs(data.qvel[list(world.addresses.wheels)]).max() < 1e-6


def test_limits_are_told_only_of_motors_that_run_and_have_some(solo12, builder, maneuvers):
    drop = maneuvers[1]
    assert builder.flight(drop, Wheels.ACTIVE).limits is not None
    assert builder.flight(drop, Wheels.ABSENT).limits is None
    assert WorldBuilder(solo12, paper_device()).flight(drop, Wheels.ACTIVE).limits is None


def test_a_device_without_carrier_has_the_bodies_that_it_had(solo12, maneuvers):
    """The assumed motor's path is as it was."""
    massless = replace(EC45_BODY, mass=0.0)
    with_none = WorldBuilder(solo12, driven_device(carrier=massless))
    model = with_none.flight(maneuvers[1], Wheels.ACTIVE).model
    bare = WorldBuilder(solo12, paper_device()).flight(maneuvers[1], Wheels.ACTIVE).model
    assert model.nbody == bare.nbody
