from dataclasses import replace

import mujoco
import numpy as np
import pytest
from robots import ROBOTS
from wheels import PAPER_WHEEL, paper_device, paper_maneuvers

from ocs_design.common.errors import SpecificationError
from ocs_design.export.physics import lowest_point, set_gains
from ocs_design.requirement.maneuver import Drop
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.engine import simulate
from ocs_design.simulation.metrics import measure
from ocs_design.simulation.scene import Wheels, robot_scene
from ocs_design.simulation.world import WorldBuilder, wheel_gains


@pytest.fixture(scope="module")
def builder(solo12):
    return WorldBuilder(solo12, paper_device())


@pytest.fixture(scope="module")
def maneuvers(solo12):
    return paper_maneuvers(solo12)


def placed(world):
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    mujoco.mj_forward(world.model, data)
    return data


def test_the_law_believes_in_the_inertia_of_robot_and_wheels(solo12, builder, maneuvers):
    device = paper_device()
    spin, across = PAPER_WHEEL.spin_inertia, PAPER_WHEEL.transverse_inertia
    wheels = [
        MassProperties(
            PAPER_WHEEL.mass,
            module.position,
            across * np.eye(3) + (spin - across) * np.outer(module.axis, module.axis),
        )
        for module in device.modules
    ]
    expected = combine([solo12.mass_properties, *wheels]).inertia
    body = builder.flight(maneuvers[0], Wheels.ACTIVE).body
    np.testing.assert_allclose(body.inertia, expected, atol=1e-9)
    actuated = expected - spin * device.axes @ device.axes.T
    np.testing.assert_allclose(body.actuated_inertia, actuated, atol=1e-9)


def test_absent_wheels_leave_exactly_the_bare_robot(solo12, builder, maneuvers):
    """Against a model that has no wheels at all, through the flight and the landing."""
    drop = maneuvers[1]
    world = builder.flight(drop, Wheels.ABSENT)
    scene = robot_scene(solo12)
    scene.option.gravity = [0.0, 0.0, -drop.gravity]
    bare = scene.compile()
    data, without = placed(world), mujoco.MjData(bare)
    assert bare.nv == world.model.nv - 2
    without.qpos[:] = world.qpos[: bare.nq]
    mujoco.mj_forward(bare, without)
    set_gains(bare, without, solo12)
    np.testing.assert_allclose(bare.actuator_gainprm[:, 0], world.model.actuator_gainprm[:-2, 0])
    data.ctrl[:], without.ctrl[:] = world.ctrl, world.ctrl[: bare.nu]
    for flight, tolerance in ((350, 1e-9), (150, 1e-5)):
        mujoco.mj_step(world.model, data, flight)
        mujoco.mj_step(bare, without, flight)
        np.testing.assert_allclose(data.qpos[: bare.nq], without.qpos, atol=tolerance)
    assert data.ncon > 0


def test_all_worlds_fit_the_same_working_memory(builder, maneuvers):
    """MuJoCo's rollout runs them in one MjData and checks only a few of these."""
    models = [builder.flight(maneuver, wheels).model for maneuver in maneuvers for wheels in Wheels]
    found = [name for name in dir(models[0]) if name.startswith("n")]
    sizes = [name for name in found if isinstance(getattr(models[0], name), int)]
    assert {"nv", "nbvh", "ngeom", "nC", "nD"} <= set(sizes)
    for name in sizes:
        assert len({getattr(model, name) for model in models}) == 1, name


def test_braked_wheels_are_part_of_the_trunk(builder, maneuvers):
    world = builder.flight(maneuvers[0], Wheels.BRAKED)
    data = placed(world)
    data.qvel[3:6] = (1.0, 2.0, -0.5)
    data.ctrl[:] = world.ctrl
    mujoco.mj_step(world.model, data, 300)
    assert np.abs(data.qvel[list(world.addresses.wheels)]).max() < 1e-6


def test_jumps_start_level_with_the_feet_just_clear(builder, maneuvers):
    for maneuver in (maneuvers[0], maneuvers[2]):
        world = builder.flight(maneuver, Wheels.ACTIVE)
        data = placed(world)
        assert data.ncon == 0
        assert 0.0 < lowest_point(world.model, data) < 1e-3
        np.testing.assert_allclose(world.qpos[3:7], (1.0, 0.0, 0.0, 0.0), atol=1e-12)
    forward, up = maneuvers[0].takeoff_velocity
    jump = builder.flight(maneuvers[0], Wheels.ACTIVE)
    np.testing.assert_allclose(jump.qvel[:3], (forward, 0.0, up))
    assert jump.flight_time == pytest.approx(2.0 * up / 9.81)


def test_a_flip_rises_by_its_height(builder, maneuvers):
    world = builder.flight(maneuvers[2], Wheels.ACTIVE)
    assert world.qvel[2] ** 2 / (2.0 * 1.62) == pytest.approx(maneuvers[2].jump_height)
    np.testing.assert_allclose(world.body.axes[:, 0], (0.0, 1.0, 0.0), atol=1e-12)


def test_a_drop_starts_tilted_and_ends_level(builder):
    drop = Drop(name="drop", height=1.0, pitch=0.4, roll=-0.3)
    world = builder.flight(drop, Wheels.ACTIVE)
    attitude = world.chain.attitude(world.qpos)
    assert world.qpos[2] == pytest.approx(1.0)
    half = 0.5 * world.turn.angle(np.array([0.0, 9.0]))
    start = np.concatenate([[np.cos(half[0])], np.sin(half[0]) * world.turn.axis])
    np.testing.assert_allclose(attitude, start, atol=1e-12)
    assert half[1] == 0.0


def test_a_drop_from_below_the_standing_height_is_refused(builder):
    with pytest.raises(SpecificationError, match="the robot stands"):
        builder.flight(Drop(name="low", height=0.1, pitch=0.5), Wheels.ACTIVE)


def test_gains_scale_with_the_froude_time(solo12):
    gains = wheel_gains(solo12)
    assert gains.stiffness == pytest.approx(60.0, rel=0.01)
    assert gains.damping == pytest.approx(12.0, rel=0.01)
    larger = wheel_gains(replace(solo12, standing_height=4.0 * solo12.standing_height))
    # The scale is rounded to six digits.
    assert larger.stiffness == pytest.approx(gains.stiffness / 4.0, rel=1e-5)
    assert larger.damping == pytest.approx(gains.damping / 2.0, rel=1e-5)


@pytest.mark.parametrize("held", [True, False])
def test_legs_that_are_told_their_load_stand_as_they_should(held):
    """A1 sinks by a quarter and leans by 12 deg where its drives hold the posture alone."""
    robot = read_robot(ROBOTS / "a1_description" / "urdf" / "a1.urdf")
    drop = Drop(name="drop", height=1.01 * robot.standing_height, pitch=0.0)
    world = WorldBuilder(robot, paper_device()).level_landing(drop)
    world = world if held else replace(world, support=0.0 * world.support)
    metrics = measure(simulate([world]), 0, world)
    leans = abs(metrics.final_pitch) > np.radians(5.0)
    assert leans is not held
    if held:
        assert abs(metrics.final_pitch) < np.radians(1.0)
