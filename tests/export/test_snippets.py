"""The device alone, put into robots the way that each snippet's own comment says."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import xacro
from exported import check_moments, check_wheels_in_pinocchio, pinocchio_model
from robots import ROBOTS, SOLO12
from wheels import motor, paper_device

from ocs_design.export.mjcf import export_robot_mjcf
from ocs_design.export.robot_model import robot_model
from ocs_design.export.snippets import (
    export_snippet_mjcf,
    export_snippet_urdf,
    export_snippet_xacro,
)
from ocs_design.export.urdf import export_robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot

TRUNK = "base_link"
ROBOT = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="ocs.urdf.xacro"/>
  <link name="{TRUNK}"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  CALL
</robot>"""
MJCF = """<mujoco><asset><model name="ocs" file="ocs.xml"/></asset><worldbody>
  <body name="trunk"><freejoint/><geom size="0.1" mass="2"/>
    <body name="leg"><joint name="hip" axis="0 1 0"/><geom size="0.05" mass="1"/></body>
    <attach model="ocs" body="mount" prefix="ocs_"/>
  </body></worldbody></mujoco>"""


def carrier(trunk):
    return replace(robot_by_hand(2.5, (0.03, 0.05, 0.07)), trunk=trunk)


@pytest.mark.parametrize("drive", [motor(), motor(754.0, torque_limit=1.0)])
def test_the_urdf_snippet_is_a_urdf(tmp_path, drive):
    device = paper_device(drive=drive)
    text = export_snippet_urdf(device, carrier(TRUNK), tmp_path / "ocs.urdf").read_text()
    check_wheels_in_pinocchio(pinocchio_model(text), device, TRUNK)


def test_the_urdf_snippet_can_be_pasted(tmp_path):
    device = paper_device()
    text = export_snippet_urdf(device, carrier(TRUNK), tmp_path / "ocs.urdf").read_text()
    part = text.split("<!-- from here -->")[1].split("<!-- to here -->")[0]
    model = pinocchio_model(SOLO12.read_text().replace("</robot>", part + "</robot>"))
    check_wheels_in_pinocchio(model, device, TRUNK)


def expand(folder, call):
    (folder / "robot.urdf.xacro").write_text(ROBOT.replace("CALL", call))
    return xacro.process_file(str(folder / "robot.urdf.xacro")).toxml()


def test_the_macro_gives_the_device(tmp_path):
    device = paper_device()
    export_snippet_xacro(device, carrier(TRUNK), tmp_path / "ocs.urdf.xacro")
    text = expand(tmp_path, f'<xacro:ocs parent="{TRUNK}"/>')
    check_wheels_in_pinocchio(pinocchio_model(text), device, TRUNK)


def test_the_macro_takes_another_angle_and_a_prefix(tmp_path):
    export_snippet_xacro(paper_device(), carrier(TRUNK), tmp_path / "ocs.urdf.xacro")
    call = f'<xacro:ocs parent="{TRUNK}" prefix="front_" incidence="0.25"/>'
    model = pinocchio_model(expand(tmp_path, call))
    check_wheels_in_pinocchio(model, paper_device(0.25), TRUNK, prefix="front_")


def test_the_call_in_the_macros_comment_works(tmp_path):
    text = export_snippet_xacro(
        paper_device(), carrier(TRUNK), tmp_path / "ocs.urdf.xacro"
    ).read_text()
    calls = re.findall(r"<xacro:ocs .*/>", text)
    assert calls
    check_wheels_in_pinocchio(pinocchio_model(expand(tmp_path, calls[0])), paper_device(), TRUNK)


def test_the_mjcf_snippet_can_be_attached(tmp_path):
    device = paper_device(drive=motor(754.0, torque_limit=1.0))
    text = export_snippet_mjcf(device, carrier("trunk"), tmp_path / "ocs.xml").read_text()
    assert all(line.strip() in text for line in re.findall(r"<(?:model|attach) .*/>", MJCF))
    (tmp_path / "robot.xml").write_text(MJCF)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for module in device.modules:
        name = f"ocs_{module.name}"
        check_moments(np.diag(model.body(f"{name}_flywheel").inertia), device)
        np.testing.assert_allclose(data.joint(name).xaxis, module.axis, atol=1e-9)
        np.testing.assert_allclose(data.joint(name).xanchor, module.position, atol=1e-9)
        np.testing.assert_array_equal(model.actuator(name).ctrlrange, [-1.0, 1.0])


def test_the_mjcf_snippet_stands_alone(tmp_path):
    path = export_snippet_mjcf(paper_device(), carrier("trunk"), tmp_path / "ocs.xml")
    assert mujoco.MjModel.from_xml_path(str(path)).nu == 2


@pytest.mark.parametrize("export", [export_snippet_urdf, export_snippet_xacro, export_snippet_mjcf])
def test_any_name_of_a_trunk_leaves_well_formed_xml(tmp_path, export):
    path = export(paper_device(), carrier('a&"<b>--c--'), tmp_path / "ocs")
    if export is export_snippet_mjcf:
        model = mujoco.MjModel.from_xml_path(str(path.rename(tmp_path / "ocs.xml")))
        assert model.nu == 2
    else:
        assert xacro.process_file(str(path)).documentElement.tagName == "robot"


def test_keyframes_of_an_attaching_robot_are_as_the_snippet_says(tmp_path):
    export_snippet_mjcf(paper_device(), carrier("trunk"), tmp_path / "ocs.xml")
    values = "0 0 1 1 0 0 0 0.5 0 0 0.7"
    text = MJCF.replace(
        "</worldbody>",
        '<body><joint name="last"/><geom size="0.1"/></body></worldbody>'
        f'<keyframe><key name="home" qpos="{values}"/></keyframe>',
    )
    (tmp_path / "robot.xml").write_text(text)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    asked = {"hip": 0.5, "ocs_left": 0.0, "ocs_right": 0.0, "last": 0.7}
    assert {name: float(data.joint(name).qpos[0]) for name in asked} == asked


HUMAN = next(ROBOTS.rglob("human.urdf"))


def check_turned_wheels(model, device, mount):
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    pin.updateFramePlacements(model, data)
    trunk = data.oMf[model.getFrameId(mount.link)]
    for module in device.modules:
        wheel = trunk.inverse() * data.oMi[model.getJointId(f"ocs_{module.name}")]
        rotation, position = mount.placement.rotation, mount.placement.position
        np.testing.assert_allclose(wheel.rotation[:, 2], rotation @ module.axis, atol=1e-9)
        np.testing.assert_allclose(
            wheel.translation, rotation @ module.position + position, atol=1e-9
        )


@pytest.mark.parametrize("form", ["robot", "pasted", "macro"])
def test_wheels_of_a_robot_with_y_up_stand_in_its_base_frame(tmp_path, form):
    robot, device = read_robot(HUMAN), paper_device()
    if form == "robot":
        text = export_robot_urdf(robot, device, tmp_path / "h.urdf").read_text()
    elif form == "pasted":
        snippet = export_snippet_urdf(device, robot, tmp_path / "ocs.urdf").read_text()
        part = snippet.split("<!-- from here -->")[1].split("<!-- to here -->")[0]
        text = HUMAN.read_text().replace("</robot>", part + "</robot>")
    else:
        export_snippet_xacro(device, robot, tmp_path / "ocs.urdf.xacro")
        call = f'<xacro:include filename="ocs.urdf.xacro"/><xacro:ocs parent="{robot.mount.link}"/>'
        (tmp_path / "h.xacro").write_text(
            HUMAN.read_text()
            .replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ', 1)
            .replace("</robot>", call + "</robot>")
        )
        text = xacro.process_file(str(tmp_path / "h.xacro")).toxml()
    check_turned_wheels(pinocchio_model(text), device, robot.mount)


def test_mjcf_of_a_robot_with_y_up_has_its_wheels_in_its_base_frame(tmp_path):
    robot, device = read_robot(HUMAN), paper_device()
    model = mujoco.MjModel.from_xml_path(
        str(export_robot_mjcf(robot_model(robot, device), tmp_path / "h.xml"))
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    trunk = data.body(robot.mount.link)
    rotation = trunk.xmat.reshape(3, 3) @ robot.mount.placement.rotation
    for module in device.modules:
        joint = data.joint(f"ocs_{module.name}")
        np.testing.assert_allclose(joint.xaxis, rotation @ module.axis, atol=1e-9)
        np.testing.assert_allclose(
            joint.xanchor - trunk.xpos, rotation @ module.position, atol=1e-9
        )
