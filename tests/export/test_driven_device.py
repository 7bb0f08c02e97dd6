"""A device with real motors in every file: the whole robot's inertia, armature, limits, names."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import xacro
from exported import LEGGED, LEGGED_PATHS, mujoco_model, pinocchio_model
from robots import SOLO12
from wheels import EC45, EC45_BODY, braked_inertia, driven_device, geared, layout_device

from ocs_design.common.errors import RobotError
from ocs_design.device.bodies import carrier_inertial, flywheel_inertial
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.robot_model import robot_model
from ocs_design.export.snippets import (
    snippet_mjcf,
    snippet_urdf,
    snippet_xacro,
)
from ocs_design.export.urdf import robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mass import MassProperties, physical_defect
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scene import locked_inertia

DEVICES = {
    "direct": driven_device(),
    "reducing": driven_device(drive=geared(1.5)),
    "reversing": driven_device(drive=geared(1.5, reverses=True)),
    "speeding up": driven_device(drive=geared(0.5, inertia=0.0)),
}
DEVICES |= {
    name.value: layout_device(Layout(name))
    for name in LayoutName
    if name not in {LayoutName.PAIR, LayoutName.BY_HAND}
}
BLOCK = robot_by_hand(2.5, (0.03, 0.05, 0.07, 0.001, 0.002, -0.003), com=(0.01, 0.0, -0.02))
MOTORS = ("ocs_left_motor", "ocs_right_motor")


@pytest.fixture(params=DEVICES)
def device(request):
    return DEVICES[request.param]


def seen_by_mujoco(model, robot) -> MassProperties:
    """The whole model in the robot's posture, in the frame of its trunk."""
    data = mujoco.MjData(model)
    for name, value in robot.posture.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_forward(model, data)
    trunk = data.body(robot.trunk)
    rotation = trunk.xmat.reshape(3, 3)
    com = rotation.T @ (data.subtree_com[1] - trunk.xpos)
    return MassProperties(
        float(model.body_subtreemass[1]), com, locked_inertia(model, data, rotation)
    )


def seen_by_pinocchio(text, robot) -> MassProperties:
    """The same of a URDF, its wheels at rest."""
    model = pinocchio_model(text)
    data, q = model.createData(), pin.neutral(model)
    for name, value in robot.posture.items():
        q[model.joints[model.getJointId(name)].idx_q] = value
    pin.ccrba(model, data, q, np.zeros(model.nv))
    pin.updateFramePlacements(model, data)
    trunk = data.oMf[model.getFrameId(robot.trunk, pin.FrameType.BODY)]
    com = trunk.actInv(pin.centerOfMass(model, data, q))
    return MassProperties(data.Ig.mass, com, trunk.rotation.T @ data.Ig.inertia @ trunk.rotation)


def check_whole(seen, robot, device):
    expected = braked_inertia(robot, device)
    assert seen.mass == pytest.approx(expected.mass, rel=1e-9)
    assert expected.mass == pytest.approx(robot.mass + device.mass, rel=1e-12)
    np.testing.assert_allclose(seen.com, expected.com, rtol=0, atol=1e-9)
    scale = np.trace(expected.inertia)
    np.testing.assert_allclose(seen.inertia, expected.inertia, rtol=0, atol=1e-9 * scale)


def test_mujoco_sees_the_whole_robot(device, tmp_path):
    robot = read_robot(SOLO12)
    check_whole(seen_by_mujoco(mujoco_model(robot, device, tmp_path), robot), robot, device)


def test_pinocchio_sees_the_whole_robot(device):
    robot = read_robot(SOLO12)
    text = robot_urdf(robot, device).decode()
    check_whole(seen_by_pinocchio(text, robot), robot, device)


@pytest.mark.parametrize("path", LEGGED_PATHS[:6], ids=LEGGED[:6])
def test_all_kinds_of_robots_carry_their_motors(path, tmp_path):
    robot, device = read_robot(path), driven_device()
    text = robot_urdf(robot, device).decode()
    check_whole(seen_by_pinocchio(text, robot), robot, device)
    check_whole(seen_by_mujoco(mujoco_model(robot, device, tmp_path), robot), robot, device)


def test_a_robot_by_hand_carries_them_in_full(device):
    text = robot_urdf(BLOCK, device).decode()
    check_whole(seen_by_pinocchio(text, BLOCK), BLOCK, device)


def test_the_wheel_has_its_momentum_and_the_joint_its_armature(device, tmp_path):
    model = mujoco_model(BLOCK, device, tmp_path)
    full = np.empty((model.nv, model.nv))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, full)
    for module in device.modules:
        at = int(model.joint(f"ocs_{module.name}").dofadr[0])
        h = device.flywheel.spin_inertia
        assert full[at, at] == pytest.approx(h + device.motor.armature, rel=1e-12)
        np.testing.assert_allclose(full[at, 3:6], h * module.axis, rtol=0, atol=1e-12 * h)


@pytest.mark.parametrize("rotor", [0.0, 1e-5, 3e-5, 1e-4, -1e-4])
def test_bodies_can_exist_whatever_the_rotor(rotor):
    """Triangle inequality of moments of inertia, all of them positive."""
    drive = replace(EC45, rotor_inertia=rotor)
    device = driven_device(drive=drive)
    device = replace(device, flywheel=replace(device.flywheel, spin_inertia=1.5e-4 + rotor))
    device = replace(device, flywheel=replace(device.flywheel, transverse_inertia=0.76e-4))
    for body in (flywheel_inertial(device), carrier_inertial(device, device.modules[0])):
        assert physical_defect(body, 0.0) is None


def test_a_rotor_heavier_than_its_carrier_leaves_a_little_of_it():
    """The only case in which the files have more inertia than the module, and by how much."""
    rotor = 3.0 * EC45_BODY.axial_inertia
    device = driven_device(drive=replace(EC45, rotor_inertia=rotor))
    left = carrier_inertial(device, device.modules[0]).inertia[2, 2]
    assert left == pytest.approx(0.01 * EC45_BODY.axial_inertia)


def check_snippet(text, device):
    """The device's own links on a trunk without mass."""
    nothing = replace(
        BLOCK, mass_properties=MassProperties(0.0, np.zeros(3), np.zeros((3, 3))), trunk="base_link"
    )
    check_whole(seen_by_pinocchio(text, nothing), nothing, device)


def test_the_urdf_snippet_has_them(device):
    robot = replace(BLOCK, trunk="base_link")
    check_snippet(snippet_urdf(device, robot), device)


def test_the_macro_has_them_at_any_angle_and_with_a_prefix(tmp_path):
    robot = replace(BLOCK, trunk="base_link")
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(driven_device(), robot))
    (tmp_path / "robot.urdf.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="ocs.urdf.xacro"/><link name="base_link"/>'
        '<xacro:ocs parent="base_link" prefix="front_" incidence="0.25"/></robot>'
    )
    text = xacro.process_file(str(tmp_path / "robot.urdf.xacro")).toxml()
    assert 'link name="front_ocs_left_motor"' in text
    check_snippet(text, driven_device(0.25))


def test_the_mjcf_snippet_has_them(device, tmp_path):
    (tmp_path / "ocs.xml").write_text(snippet_mjcf(device, replace(BLOCK, trunk="base_link")))
    (tmp_path / "robot.xml").write_text(
        '<mujoco><asset><model name="ocs" file="ocs.xml"/></asset><worldbody>'
        f'<body name="base"><freejoint/><inertial pos="0.01 0 -0.02" mass="2.5" fullinertia="'
        f'{" ".join(map(repr, [0.03, 0.05, 0.07, 0.001, 0.002, -0.003]))}"/>'
        '<attach model="ocs" body="mount" prefix="ocs_"/></body></worldbody></mujoco>'
    )
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    check_whole(seen_by_mujoco(model, replace(BLOCK, trunk="base")), BLOCK, device)
    for module in device.modules:
        assert model.joint(f"ocs_{module.name}").armature[0] == device.motor.armature
        assert model.body(f"ocs_{module.name}_motor").name


@pytest.mark.parametrize("name", ["direct", "single", "triad", "orthogonal", "pyramid"])
def test_the_xacro_macro_makes_every_layout(name, tmp_path):
    device, robot = DEVICES[name], replace(BLOCK, trunk="base_link")
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(device, robot))
    (tmp_path / "robot.urdf.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="ocs.urdf.xacro"/><link name="base_link"><inertial>'
        '<origin xyz="0.01 0 -0.02"/><mass value="2.5"/><inertia ixx="0.03" iyy="0.05" izz="0.07" '
        'ixy="0.001" ixz="0.002" iyz="-0.003"/></inertial></link>'
        '<xacro:ocs parent="base_link"/></robot>'
    )
    text = xacro.process_file(str(tmp_path / "robot.urdf.xacro")).toxml()
    check_whole(seen_by_pinocchio(text, robot), BLOCK, device)


def test_urdf_says_what_it_cannot_hold():
    drive = geared(3.0)
    text = robot_urdf(BLOCK, driven_device(drive=drive)).decode()
    said = re.findall(r"<!-- armature (\S+) kg m\^2, which URDF cannot say -->", text)
    assert [float(value) for value in said] == [drive.armature] * 2
    plain = robot_urdf(BLOCK, driven_device()).decode()
    assert "armature" not in plain


@pytest.mark.parametrize(("top", "velocity"), [(400.0, 400.0), (None, 650.4), (1047.2, 650.4)])
def test_the_slower_of_voltage_and_mechanics_is_the_joints_limit(top, velocity):
    device = driven_device(drive=replace(EC45, speed_max=top))
    model = pinocchio_model(robot_urdf(BLOCK, device).decode())
    index = model.idx_vs[model.getJointId("ocs_left")]
    assert model.upperVelocityLimit[index] == velocity
    assert model.upperEffortLimit[index] == 1.0


def test_without_mass_there_is_no_motor_body(tmp_path):
    device = driven_device(carrier=replace(EC45_BODY, mass=0.0))
    assert "_motor" not in robot_urdf(BLOCK, device).decode()
    model = mujoco_model(BLOCK, device, tmp_path)
    assert not [i for i in range(model.nbody) if model.body(i).name.endswith("_motor")]


@pytest.mark.parametrize("element", ["link", "joint"])
def test_a_clash_of_names_is_an_error_only_where_there_are_motors(tmp_path, element):
    link, joint = ("ocs_left_motor", "weld") if element == "link" else ("other", "ocs_left_motor")
    extra = (
        f'<link name="{link}"/><joint name="{joint}" type="fixed">'
        f'<parent link="base_link"/><child link="{link}"/></joint>'
    )
    (tmp_path / "in.urdf").write_text(SOLO12.read_text().replace("</robot>", extra + "</robot>"))
    robot = read_robot(tmp_path / "in.urdf")
    with pytest.raises(RobotError, match=f"{element} named 'ocs_left_motor'"):
        robot_urdf(robot, driven_device())
    massless = driven_device(carrier=replace(EC45_BODY, mass=0.0))
    robot_urdf(robot, massless)


def test_a_body_of_that_name_is_a_clash_in_mjcf(tmp_path):
    (tmp_path / "in.xml").write_text(
        '<mujoco><worldbody><body name="trunk"><freejoint/><geom size="0.1"/>'
        '<body name="ocs_left_motor"><joint/><geom size="0.1"/></body></body></worldbody></mujoco>'
    )
    robot = read_robot(tmp_path / "in.xml", trunk="trunk", posture="zero")
    with pytest.raises(RobotError, match="body named 'ocs_left_motor'"):
        robot_model(robot, driven_device())
