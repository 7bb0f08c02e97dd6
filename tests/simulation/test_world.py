"""The world of a maneuver: masses, start, settings, and attitude of the trunk."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from built_devices import DEVICES
from robots import ROBOTS, SOLO12
from wheels import EC45_BODY, braked_inertia, driven_device, geared, paper_device, paper_maneuvers

from ocs_design.common import quaternions
from ocs_design.common.errors import SpecificationError
from ocs_design.export.physics import HELD_ARMATURE, lowest_point, set_gains, set_trunk
from ocs_design.requirement.froude import wheel_gains
from ocs_design.requirement.turns import Drop
from ocs_design.robot.mujoco_model import build_spec, trunk_body
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.metrics import measure
from ocs_design.simulation.scene import Wheels, compile_scene, robot_scene
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world import TrunkChain
from ocs_design.simulation.world_builder import WorldBuilder, addresses

GEARED = driven_device(drive=geared(1.5))


@pytest.fixture(scope="module", params=[paper_device(), GEARED], ids=["ideal", "geared"])
def device(request):
    return request.param


@pytest.fixture(scope="module")
def any_builder(device, solo12):
    return WorldBuilder(solo12, device)


@pytest.fixture(scope="module")
def maneuvers(solo12):
    return paper_maneuvers(solo12)


def data_at_start(world):
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    mujoco.mj_forward(world.model, data)
    return data


def test_the_law_uses_the_inertia_of_robot_rims_and_carriers(
    solo12, device, any_builder, maneuvers
):
    """For a flip the modules are turned by hand, with their carriers."""
    spin = device.flywheel.spin_inertia
    for maneuver, placed in ((maneuvers[0], device), (maneuvers[2], device.at_incidence(0.0))):
        body = any_builder.flight(maneuver, Wheels.ACTIVE).body
        expected = braked_inertia(solo12, placed).inertia
        np.testing.assert_allclose(body.inertia, expected, rtol=0, atol=1e-9 * np.trace(expected))
        reacting = spin**2 / (spin + device.motor.armature)
        actuated = expected - reacting * placed.axes @ placed.axes.T
        np.testing.assert_allclose(body.actuated_inertia, actuated, atol=1e-9)
        assert (body.spin_inertia, body.armature) == (spin, device.motor.armature)


def test_absent_wheels_leave_exactly_the_bare_robot(solo12, builder, maneuvers):
    """Compared with a model without wheels, through flight and landing."""
    drop = maneuvers[1]
    world = builder.flight(drop, Wheels.ABSENT)
    scene = robot_scene(solo12)
    scene.option.gravity = [0.0, 0.0, -drop.gravity]
    bare = scene.compile()
    data, without = data_at_start(world), mujoco.MjData(bare)
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


@pytest.mark.parametrize("name", DEVICES)
def test_an_absent_device_has_no_mass(solo12, name, maneuvers):
    """Neither wheels nor motors, nor their carriers and plates."""
    model = WorldBuilder(solo12, DEVICES[name]).flight(maneuvers[1], Wheels.ABSENT).model
    assert model.body_subtreemass[1] == pytest.approx(solo12.mass, rel=1e-8)


def test_all_worlds_have_the_same_sizes(any_builder, maneuvers):
    """MuJoCo's rollout runs them in one MjData and checks only a few of these sizes."""
    models = [
        any_builder.flight(maneuver, wheels).model for maneuver in maneuvers for wheels in Wheels
    ]
    names = [name for name in dir(models[0]) if name.startswith("n")]
    sizes = [name for name in names if isinstance(getattr(models[0], name), int)]
    assert {"nv", "nbvh", "ngeom", "nC", "nD"} <= set(sizes)
    for name in sizes:
        assert len({getattr(model, name) for model in models}) == 1, name


def test_braked_wheels_are_part_of_the_trunk(any_builder, maneuvers):
    """For any armature of the motor, since the brake acts on the joint."""
    world = any_builder.flight(maneuvers[0], Wheels.BRAKED)
    data = data_at_start(world)
    data.qvel[3:6] = (1.0, 2.0, -0.5)
    data.ctrl[:] = world.ctrl
    mujoco.mj_step(world.model, data, 300)
    assert np.abs(data.qvel[list(world.addresses.wheels)]).max() < 1e-6


def test_jumps_start_level_with_the_feet_just_clear(builder, maneuvers):
    for maneuver in (maneuvers[0], maneuvers[2]):
        world = builder.flight(maneuver, Wheels.ACTIVE)
        data = data_at_start(world)
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
    with pytest.raises(SpecificationError, match="there is no fall"):
        builder.flight(Drop(name="low", height=0.1, pitch=0.5), Wheels.ACTIVE)


def test_gains_scale_with_the_froude_time(solo12):
    gains = wheel_gains(solo12)
    assert gains.stiffness == pytest.approx(60.0, rel=0.01)
    assert gains.damping == pytest.approx(12.0, rel=0.01)
    larger = wheel_gains(replace(solo12, standing_height=4.0 * solo12.standing_height))
    # The scale is rounded to six digits.
    assert larger.stiffness == pytest.approx(gains.stiffness / 4.0, rel=1e-5)
    assert larger.damping == pytest.approx(gains.damping / 2.0, rel=1e-5)


@pytest.mark.parametrize("supported", [True, False])
def test_feed_forward_of_the_load_keeps_a_robot_level(supported):
    """Without it A1 sinks by a quarter and leans by 12 deg."""
    robot = read_robot(ROBOTS / "a1_description" / "urdf" / "a1.urdf")
    drop = Drop(name="drop", height=1.01 * robot.standing_height, pitch=0.0)
    world = WorldBuilder(robot, paper_device()).flight(drop, Wheels.BRAKED, level=True)
    world = world if supported else replace(world, support=0.0 * world.support)
    metrics = measure(simulate([world]), 0, world)
    leans = abs(metrics.final_pitch) > np.radians(5.0)
    assert leans is not supported
    if supported:
        assert abs(metrics.final_pitch) < np.radians(1.0)


def test_limits_are_recorded_only_of_active_motors_that_have_some(solo12, builder, maneuvers):
    drop, geared_builder = maneuvers[1], WorldBuilder(solo12, GEARED)
    assert geared_builder.flight(drop, Wheels.ACTIVE).limits is not None
    assert geared_builder.flight(drop, Wheels.ABSENT).limits is None
    assert builder.flight(drop, Wheels.ACTIVE).limits is None


def test_a_device_without_carrier_has_no_bodies_for_it(solo12, builder, maneuvers):
    massless = driven_device(carrier=replace(EC45_BODY, mass=0.0))
    with_none = WorldBuilder(solo12, massless).flight(maneuvers[1], Wheels.ACTIVE).model
    assert with_none.nbody == builder.flight(maneuvers[1], Wheels.ACTIVE).model.nbody


TALOS = ROBOTS / "talos_data" / "robots" / "talos_full_v2.urdf"


@pytest.mark.parametrize(
    ("path", "trunk", "hinges"),
    [(SOLO12, "base_link", 0), (TALOS, "imu_link", 2), (TALOS, "base_link", 0)],
)
def test_attitude_and_rate_are_those_of_mujoco(path, trunk, hinges):
    robot = read_robot(path, trunk=trunk)
    spec = build_spec(robot, visuals=False).spec
    body, frame = trunk_body(spec, robot)
    model, name = spec.compile(), body.name
    data = mujoco.MjData(model)
    chain = TrunkChain.of(robot, model)
    assert len(chain.links) == hinges
    random = np.random.default_rng(0)
    mujoco.mj_integratePos(model, data.qpos, random.normal(size=model.nv), 1.0)
    data.qvel[:] = random.normal(size=model.nv)
    mujoco.mj_forward(model, data)
    expected = data.body(name).xmat.reshape(3, 3) @ frame.rotation
    qpos, qvel = data.qpos[None], data.qvel[None]
    rotation = quaternions.matrix(chain.attitude(qpos))[0]
    np.testing.assert_allclose(rotation, expected, atol=1e-12)
    velocity = np.empty(6)
    mujoco.mj_objectVelocity(
        model, data, mujoco.mjtObj.mjOBJ_XBODY, model.body(name).id, velocity, 0
    )
    np.testing.assert_allclose(chain.rate(qpos, qvel)[0], expected.T @ velocity[:3], atol=1e-12)


DEFAULTS = """<default>
  <motor gear="75" ctrllimited="true" ctrlrange="-1 1" forcelimited="true" forcerange="-5 5"/>
  <general dyntype="filter" dynprm="0.1"/><geom margin="0.01" gap="0.001"/></default>"""
OPTION = """<option iterations="1" ls_iterations="5" noslip_iterations="4" tolerance="1e-3"
  timestep="0.01" integrator="Euler" density="1000" viscosity="0.1" wind="1 0 0">
  <flag eulerdamp="disable" warmstart="disable" contact="disable" gravity="disable"/></option>"""


@pytest.fixture(scope="module")
def compiled(solo12, tmp_path_factory):
    """Scenes of Solo12 as MJCF, without and with options and defaults in the file."""
    text = build_spec(solo12, visuals=False).spec.to_xml()
    opened = text.index(">", text.index("<mujoco")) + 1
    folder = tmp_path_factory.mktemp("solo12")
    models = []
    for settings in ("", OPTION, DEFAULTS):
        path = folder / "robot.xml"
        path.write_text(text[:opened] + settings + text[opened:])
        mujoco.MjModel.from_xml_path(str(path))
        robot = read_robot(path, trunk=solo12.trunk)
        models.append(
            compile_scene(robot_scene(robot), robot, driven_device(), Wheels.ACTIVE, 9.81)
        )
    return models


@pytest.mark.parametrize("case", [1, 2], ids=["options", "defaults"])
def test_settings_of_the_file_do_not_affect_the_simulation(compiled, case):
    plain, other = compiled[0], compiled[case]
    assert plain.nu == other.nu > 0
    for name in dir(plain):
        if name.startswith(("actuator_", "geom_margin", "geom_gap")):
            np.testing.assert_array_equal(getattr(other, name), getattr(plain, name), name)
    for name in dir(plain.opt):
        if not name.startswith("_"):
            np.testing.assert_array_equal(getattr(other.opt, name), getattr(plain.opt, name), name)


def test_gravity_compensation_of_the_file_is_off(solo12, tmp_path):
    text = build_spec(solo12, visuals=False).spec.to_xml()
    (path := tmp_path / "robot.xml").write_text(text.replace("<body ", '<body gravcomp="1" '))
    scene = robot_scene(read_robot(path, trunk=solo12.trunk))
    assert not scene.compile().body_gravcomp.any()


def test_a_ball_joint_is_held_as_in_the_robots_tree(solo12, tmp_path):
    spec = build_spec(solo12, visuals=False).spec
    tail = trunk_body(spec, solo12)[0].add_body(name="tail")
    tail.add_joint(name="b", type=mujoco.mjtJoint.mjJNT_BALL)
    tail.add_geom(size=[0.05, 0.0, 0.0], pos=[0.3, 0.0, 0.0])
    (path := tmp_path / "robot.xml").write_text(spec.to_xml())
    robot = read_robot(path, trunk=solo12.trunk)
    assert "b" not in robot.tree.joints
    model = robot_scene(robot).compile()
    first = model.joint("b").dofadr[0]
    np.testing.assert_array_equal(model.dof_armature[first : first + 3], HELD_ARMATURE)


def test_heights_are_those_of_the_base_frame(solo12, tmp_path):
    """Its trunk may be a link far from the origin of the body that it is part of."""
    root = (
        '<link name="footprint"/><joint name="up" type="fixed"><parent link="footprint"/>'
        '<child link="base_link"/><origin xyz="0 0 0.25"/></joint></robot>'
    )
    text = SOLO12.read_text().replace("</robot>", root)
    (path := tmp_path / "robot.urdf").write_text(text)
    robot = read_robot(path, trunk="base_link", package_paths={"example-robot-data": ROBOTS.parent})
    model = compile_scene(robot_scene(robot), robot, driven_device(), Wheels.ACTIVE, 9.81)
    data = mujoco.MjData(model)
    set_trunk(robot, model, data, np.eye(3), robot.standing_height)
    mujoco.mj_forward(model, data)
    height = data.sensordata[addresses(model, driven_device()).height]
    assert height == pytest.approx(robot.standing_height, abs=1e-9)
