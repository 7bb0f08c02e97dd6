"""Plans of push-offs: laws and limits, checked independently of the program."""

from dataclasses import replace

import numpy as np
import pytest
from robots import ROBOTS
from wheels import braked_inertia, driven_device

from ocs_design.common.frames import rotation_from_rpy
from ocs_design.jumping.jump import Jump, jump_of
from ocs_design.jumping.legged_body import LeggedBody, obstacle_to_jumping
from ocs_design.jumping.node import FRICTION
from ocs_design.jumping.planning import JumpPlanner, plan_jumps
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.robot.reader import read_robot

JUMP = Jump(0.4, 2.0, 9.81)


@pytest.fixture(scope="module")
def body(solo12):
    """Solo12 with the limits of its real joints, since those of its file are never active."""
    original = LeggedBody.of(solo12)
    joints = tuple(replace(joint, effort=2.7, velocity=40.0) for joint in original.joints)
    return replace(original, joints=joints)


@pytest.fixture(scope="module")
def planner(body):
    return JumpPlanner(body)


@pytest.fixture(scope="module")
def push_off(planner, body):
    return planner._push_offs.find(JUMP, body.trunk)


def test_trunk_and_legs_have_the_mass_of_the_robot(solo12, body):
    assert body.trunk.mass + body.leg_mass == pytest.approx(solo12.mass, rel=1e-12)


def test_the_ground_forces_give_the_momentum_of_the_jump(push_off, body):
    """Newton's second law over the push-off; forces are linear between nodes."""
    mass = body.trunk.mass + body.leg_mass
    impulse = np.trapezoid(push_off.force.sum(axis=1), push_off.time, axis=0)
    weight = np.array([0.0, 0.0, mass * JUMP.gravity * push_off.time[-1]])
    gained = (impulse - weight) / mass
    np.testing.assert_allclose(gained, (JUMP.forward, 0.0, JUMP.upward), atol=0.02)


def test_forces_stay_inside_the_friction_cone(push_off):
    x, y, z = np.moveaxis(push_off.force[:-1], 2, 0)
    assert (z > 0.0).all()
    assert (np.hypot(x, y) <= FRICTION * z + 1e-6).all()


def test_torques_and_speeds_are_within_the_joint_limits(push_off):
    assert push_off.forbidden == ""
    assert np.abs(push_off.torque).max() <= 2.7 * (1.0 + 1e-3)
    assert np.abs(push_off.v[:, 6:]).max() <= 40.0 * (1.0 + 1e-3)


def test_a_push_off_starts_at_rest_in_the_stance_and_ends_level(push_off, body):
    np.testing.assert_allclose(push_off.y[0, 6:], body.posture, atol=1e-9)
    np.testing.assert_allclose(push_off.v[0], 0.0, atol=1e-9)
    np.testing.assert_allclose(push_off.y[-1, 3:6], 0.0, atol=1e-9)


def test_feet_roll_without_sliding(push_off, body):
    """By the kinematics of the legs; a ball of radius r that turns by phi rolls by r phi."""
    for leg, where in body.joint_slices:
        centers, angles = [], []
        for y in push_off.y:
            pose = leg.chain.pose(y[6:][where])
            trunk = rotation_from_rpy(*y[3:6])
            centers.append(y[:3] + trunk @ pose.point(leg.foot))
            shank = trunk @ pose.end.rotation
            angles.append(np.arctan2(shank[0, 2], shank[2, 2]))
        rolled = leg.foot_radius * (np.array(angles) - angles[0])
        moved = np.array(centers) - centers[0]
        np.testing.assert_allclose(moved[:, 0], rolled, atol=2e-4)
        np.testing.assert_allclose(moved[:, 2], 0.0, atol=2e-4)


@pytest.mark.slow
def test_the_legs_return_to_the_stance_in_flight(planner, body):
    legs = planner.plan(JUMP, body.trunk).plan.legs
    assert legs.time[-1] < legs.lift_off + JUMP.flight_time
    np.testing.assert_allclose(legs.position[-1], body.posture, atol=1e-9)
    np.testing.assert_allclose(legs.velocity[-1], 0.0, atol=1e-9)
    # References are continuous between push-off and flight.
    steps = np.abs(np.diff(legs.position, axis=0)) / np.diff(legs.time)[:, None]
    assert steps.max() < 1.5 * np.abs(legs.velocity).max()


@pytest.mark.slow
def test_the_limit_that_prevents_a_jump_is_named(planner, body):
    note = planner.plan(Jump(0.0, 6.0, 9.81), body.trunk).plan.note
    assert "of joint '" in note
    assert "more than its" in note


def test_free_wheels_do_not_add_inertia_about_their_axes(solo12):
    """About their axes the free wheels do not rotate with the trunk: J = I - h A A^T."""
    device = driven_device()
    braked = braked_inertia(solo12, device)
    axes = device.axes
    expected = braked.inertia - device.flywheel.spin_inertia * axes @ axes.T
    bare = solo12.mass_properties
    carried = device.on(bare, free=True)
    assert carried.mass == pytest.approx(braked.mass)
    np.testing.assert_allclose(carried.com, braked.com, atol=1e-12)
    np.testing.assert_allclose(carried.inertia, expected, atol=1e-12)


def test_a_drop_has_no_push_off(solo12):
    drop = default_maneuvers(solo12)[1]
    assert jump_of(drop) is None
    assert plan_jumps(solo12, driven_device(), [drop]) == {}


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("talos_data/robots/talos_reduced", "stands on a sole"),
        ("centauro_description/urdf/centauro", "ends in a wheel"),
        ("panda_description/urdf/panda", "no legs"),
    ],
)
def test_robots_without_a_plan_start_in_flight_with_a_reason(name, words):
    robot = read_robot(ROBOTS / f"{name}.urdf")
    assert words in obstacle_to_jumping(robot)
    plans = plan_jumps(robot, driven_device(), [default_maneuvers(robot)[0]])
    assert plans["disturbance"].carrying.legs is None
    assert plans["disturbance"].bare.note.startswith("starts at lift-off: ")
