"""The device alone, put into robots the way that each snippet's own comment says."""

from dataclasses import replace
from xml.dom import minidom

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import xacro
from exported import mujoco_model, pinocchio_model
from hypothesis import given
from hypothesis import strategies as st
from robots import ROBOTS
from wheels import paper_device

from ocs_design.export.snippets import (
    snippet_mjcf,
    snippet_urdf,
    snippet_xacro,
)
from ocs_design.export.templates import in_comment
from ocs_design.export.urdf import robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot

TRUNK = "base_link"
MJCF = """<mujoco><asset><model name="ocs" file="ocs.xml"/></asset><worldbody>
  <body name="trunk"><freejoint/><geom size="0.1" mass="2"/>
    <body name="leg"><joint name="hip" axis="0 1 0"/><geom size="0.05" mass="1"/></body>
    <attach model="ocs" body="mount" prefix="ocs_"/>
  </body></worldbody></mujoco>"""


def carrier(trunk):
    return replace(robot_by_hand(2.5, (0.03, 0.05, 0.07)), trunk=trunk)


@pytest.mark.parametrize("snippet", [snippet_urdf, snippet_xacro, snippet_mjcf])
def test_any_name_of_a_trunk_leaves_well_formed_xml(tmp_path, snippet):
    text, path = snippet(paper_device(), carrier('a&"<b>--c--')), tmp_path / "ocs"
    if snippet is snippet_mjcf:
        assert mujoco.MjModel.from_xml_string(text).nu == 2
    else:
        path.write_text(text)
        assert xacro.process_file(str(path)).documentElement.tagName == "robot"


def test_keyframes_of_an_attaching_robot_are_as_the_snippet_says(tmp_path):
    (tmp_path / "ocs.xml").write_text(snippet_mjcf(paper_device(), carrier("trunk")))
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
        text = robot_urdf(robot, device).decode()
    elif form == "pasted":
        snippet = snippet_urdf(device, robot)
        part = snippet.split("<!-- from here -->")[1].split("<!-- to here -->")[0]
        text = HUMAN.read_text().replace("</robot>", part + "</robot>")
    else:
        (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(device, robot))
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
    model = mujoco_model(robot, device, tmp_path)
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


@given(st.text("-a b", max_size=12))
def test_any_text_may_stand_in_a_comment(text):
    whole = minidom.parseString(f"<x><!--{in_comment(text)}--></x>")
    found = whole.documentElement.firstChild.data if in_comment(text) else ""
    assert found.replace(" ", "").rstrip("-") == text.replace(" ", "").rstrip("-")
