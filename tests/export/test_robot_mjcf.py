"""Whole robots with their device as MJCF, read back by MuJoCo."""

import re
import shutil
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest
from exported import LEGGED, LEGGED_PATHS, MJCF, check_wheels_in_mujoco, mujoco_model, robot_at
from robots import SOLO12
from scipy.spatial.transform import Rotation
from wheels import driven_device, paper_device, scaled_device

from ocs_design.device.bodies import joint_names
from ocs_design.export.formats import Subject
from ocs_design.export.mjcf import export_robot_mjcf, write
from ocs_design.export.physics import leg_joints
from ocs_design.export.robot_model import robot_model
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import MOMENTUM_GATE
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world_builder import WorldBuilder


def check_same(model, original):
    """The numbers are those of the model that was written, not rounded."""
    for field in EXACT:
        np.testing.assert_allclose(
            getattr(model, field), getattr(original, field), rtol=1e-12, atol=1e-15, err_msg=field
        )


EXACT = (
    "body_mass", "body_inertia", "body_ipos", "body_iquat", "body_pos", "body_quat", "geom_size",
    "site_pos", "jnt_axis", "jnt_pos", "jnt_range", "dof_damping", "dof_armature",
    "dof_frictionloss", "actuator_ctrlrange", "actuator_forcerange", "actuator_gainprm",
    "actuator_biasprm", "eq_data", "key_qpos", "key_ctrl",
)  # fmt: skip


def written(robot, device, folder):
    """Model and data at `ocs_home` of the robot's file."""
    return at_home(export_robot_mjcf(robot_model(robot, device), folder / "robot.xml"))


def at_home(path):
    """Model of a file and its data at `ocs_home`, as a viewer loads it."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("ocs_home").id)
    mujoco.mj_forward(model, data)
    return model, data


def compiled(robot, device):
    return robot_model(robot, device).compiled


@pytest.mark.parametrize("form", ["URDF", "MJCF"])
def test_every_number_of_a_robot_is_written_exactly(form, tmp_path):
    (tmp_path / "in.xml").write_text(MJCF)
    robot = read_robot(SOLO12 if form == "URDF" else tmp_path / "in.xml", posture="zero")
    device = paper_device()
    model = mujoco_model(robot, device, tmp_path)
    check_same(model, compiled(robot, device))
    check_wheels_in_mujoco(model, device, robot.trunk)


def test_meshes_of_an_mjcf_robot_are_copied(tmp_path):
    (tmp_path / "in" / "a").mkdir(parents=True)
    (tmp_path / "in" / "b").mkdir()
    cube = "\n".join(f"v {x} {y} {z}" for x in (0, 1) for y in (0, 1) for z in (0, 1))
    for folder, size in (("a", 1), ("b", 2)):
        text = cube.replace("1", str(size)) + "\nf 1 2 4\nf 5 6 8\nf 1 3 7\n"
        (tmp_path / "in" / folder / "part.obj").write_text(text)
    (tmp_path / "in" / "robot.xml").write_text(
        '<mujoco><asset><mesh name="a" file="a/part.obj" inertia="shell"/>'
        '<mesh name="b" file="b/part.obj" inertia="shell"/></asset><worldbody>'
        '<body name="trunk"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        '<geom type="mesh" mesh="a"/><geom type="mesh" mesh="b"/></body></worldbody></mujoco>'
    )
    (tmp_path / "out").mkdir()
    robot = read_robot(tmp_path / "in" / "robot.xml", posture="zero")
    export_robot_mjcf(robot_model(robot, paper_device()), tmp_path / "out" / "robot.xml")
    shutil.rmtree(tmp_path / "in")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "robot.xml"))
    assert model.nmesh == 3
    sizes = model.geom_aabb[:2, 3:].max(axis=1)
    assert sizes[1] == pytest.approx(2.0 * sizes[0])


@pytest.mark.slow
@pytest.mark.parametrize("path", LEGGED_PATHS[::3], ids=LEGGED[::3])
def test_a_free_flight_of_the_file_conserves_angular_momentum(path, tmp_path):
    """2 s with fast wheels and a rotating trunk, within the tolerance of the validation flights."""
    robot = robot_at(path)
    device = scaled_device(robot)
    model, data = written(robot, device, tmp_path)
    data.qpos[2] += 40.0
    data.qvel[3:6] = 0.5, 2.0, 0.3
    for name, speed in zip(joint_names(device), (600.0, -300.0), strict=True):
        data.joint(name).qvel[0] = speed
    # A motor that brakes its wheel rotates the trunk as well.
    data.actuator("ocs_left").ctrl[0] = -300.0 * device.flywheel.spin_inertia
    momentum = []
    for _ in range(200):
        mujoco.mj_forward(model, data)
        mujoco.mj_subtreeVel(model, data)
        momentum.append(data.subtree_angmom[1].copy())
        mujoco.mj_step(model, data, round(0.01 / model.opt.timestep))
    assert data.time == pytest.approx(2.0)
    initial = np.linalg.norm(momentum[0])
    assert initial > 100.0 * device.flywheel.spin_inertia
    assert np.linalg.norm(np.array(momentum) - momentum[0], axis=1).max() < MOMENTUM_GATE * initial


@pytest.mark.slow
@pytest.mark.parametrize("path", LEGGED_PATHS[:5:2], ids=LEGGED[:5:2])
def test_a_quadruped_stands_in_its_scene(path, tmp_path):
    robot, device = robot_at(path), paper_device()
    write(Subject.of(robot, device, "robot"), tmp_path)
    ET.parse(tmp_path / "scene.xml")  # MuJoCo's own parser is less strict
    model, data = at_home(tmp_path / "scene.xml")
    assert model.joint(0).type == mujoco.mjtJoint.mjJNT_FREE and model.joint(0).name
    height, base = robot.standing_height, data.site("ocs_imu")
    assert base.xpos[2] == pytest.approx(height, rel=0.01)
    for name in leg_joints(robot):
        effort = robot.tree.joints[name].effort
        limit = [-effort, effort] if 0.0 < effort < np.inf else [0.0, 0.0]
        np.testing.assert_array_equal(model.actuator(name).forcerange, limit)
    mujoco.mj_step(model, data, 2000)
    assert data.time == pytest.approx(2.0)
    assert base.xpos[2] == pytest.approx(height, rel=0.02)
    assert base.xmat[8] > np.cos(np.radians(2.0))
    posture = np.array([data.joint(name).qpos[0] - value for name, value in robot.posture.items()])
    assert np.abs(posture).max() < 0.05


def test_drives_and_options_are_those_of_the_flights(tmp_path):
    robot, device = robot_at(SOLO12), paper_device()
    model, _ = written(robot, device, tmp_path)
    world = WorldBuilder(robot, device).flight(default_maneuvers(robot)[0], Wheels.ACTIVE)
    for name in leg_joints(robot):
        ours, flown = model.actuator(name), world.model.actuator(name)
        for field in ("gainprm", "biasprm", "forcerange"):
            expected = getattr(flown, field)
            np.testing.assert_allclose(getattr(ours, field), expected, rtol=1e-12, err_msg=field)
        assert model.joint(name).damping[0] == world.model.joint(name).damping[0]
    for option in ("integrator", "timestep", "tolerance", "jacobian", "iterations", "gravity"):
        ours, flown = getattr(model.opt, option), getattr(world.model.opt, option)
        np.testing.assert_array_equal(ours, flown)


@pytest.mark.slow
def test_joints_in_no_leg_are_held_until_they_are_released(tmp_path):
    robot = robot_at(LEGGED_PATHS[6])
    model, data = written(robot, paper_device(), tmp_path)
    others = sorted(set(robot.tree.joints) - set(leg_joints(robot)))
    assert [model.eq(f"ocs_hold_{name}").id for name in others]
    data.qpos[2] += 5.0
    mujoco.mj_step(model, data, 500)
    for name in others:
        assert data.joint(name).qpos[0] == pytest.approx(robot.posture[name], abs=1e-2)


def test_links_collide_with_the_floor_alone_unless_their_mjcf_says_so(tmp_path):
    model = compiled(robot_at(LEGGED_PATHS[3]), paper_device())
    links = np.array(["flywheel" not in model.geom(i).name for i in range(model.ngeom)])
    assert not model.geom_contype.any()
    assert set(model.geom_conaffinity[links]) == {0, 1}
    (tmp_path / "in.xml").write_text(MJCF)
    own = compiled(read_robot(tmp_path / "in.xml", posture="zero"), paper_device())
    assert own.geom_contype[own.geom_conaffinity == 1].all()


def test_no_actuators_are_added_to_those_of_the_robot(tmp_path):
    (tmp_path / "in.xml").write_text(MJCF)
    robot = read_robot(tmp_path / "in.xml", posture="zero", joints={"swing": 0.3})
    model, data = written(robot, paper_device(), tmp_path)
    assert [model.actuator(i).name for i in range(model.nu)] == ["swing", "ocs_left", "ocs_right"]
    # A position servo holds the posture where its command is the joint's position.
    assert data.joint("swing").qpos[0] == 0.3
    assert data.actuator("swing").ctrl[0] == pytest.approx(0.3)
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4


def test_the_floor_of_the_scene_collides_with_both_wheels(tmp_path):
    write(Subject.of(robot_at(SOLO12), paper_device(), "robot"), tmp_path)
    model, data = at_home(tmp_path / "scene.xml")
    # The robot lies on its back, the wheels are lowest.
    data.qpos[2:7] = 0.05, 0.0, 1.0, 0.0, 0.0
    mujoco.mj_forward(model, data)
    touching = {model.geom(i).name for i in data.contact.geom.ravel().tolist()}
    assert {"ocs_floor", "ocs_left_flywheel", "ocs_right_flywheel"} <= touching


def test_the_readme_has_the_designs_figures_and_a_picture(tmp_path):
    robot, device = robot_at(SOLO12), driven_device()
    write(Subject.of(robot, device, "solo"), tmp_path)
    page = (tmp_path / "README.md").read_text()
    for figure in (
        f"{robot.mass + device.mass:.4g} kg",
        f"{1e3 * device.mass:.4g} g",
        "6,211 rpm (650.4 rad/s)",
        "| 1 N m |",
        "(0.6428, 0.766, 0), (-0.6428, 0.766, 0)",
        "0.272 m",
        "12 position servos",
        "65536",
    ):
        assert figure in page, figure
    assert "@" not in page
    assert "NOT" not in page
    for file in re.findall(r"`([a-z_]+\.xml|meshes/)`|\]\((.*)\)", page):
        assert (tmp_path / "".join(file)).exists(), file


def test_wheels_look_like_rims_and_collide_as_cylinders(tmp_path):
    model = mujoco_model(robot_by_hand(2.5, (0.03, 0.05, 0.07)), paper_device(), tmp_path)
    rim = model.mesh("ocs_flywheel")
    vertices = model.mesh_vert[rim.vertadr[0] : rim.vertadr[0] + rim.vertnum[0]].astype(float)
    # MuJoCo rotates meshes into their principal axes and keeps the rotation.
    rotated = Rotation.from_quat(model.mesh_quat[rim.id], scalar_first=True).apply(vertices)
    radii = np.linalg.norm((rotated + model.mesh_pos[rim.id])[:, :2], axis=1)
    wheel = paper_device().flywheel
    np.testing.assert_allclose(
        [radii.min(), radii.max()], [wheel.inner_radius, wheel.outer_radius], rtol=1e-4
    )
    drawn = [geom for geom in map(model.geom, range(model.ngeom)) if geom.dataid[0] == rim.id]
    assert len(drawn) == 2
    assert not any(geom.contype[0] or geom.conaffinity[0] for geom in drawn)
    assert model.geom("ocs_left_flywheel").type[0] == mujoco.mjtGeom.mjGEOM_CYLINDER
