"""The device alone, inserted into robots as the comment of each snippet says."""

import re
from dataclasses import replace
from xml.dom import minidom
from xml.etree import ElementTree as ET

import mujoco
import numpy as np
import pytest
import xacro
from exported import (
    check_total,
    check_wheels_in_mujoco,
    check_wheels_in_pinocchio,
    mujoco_model,
    pinocchio_model,
    robot_at,
    total_by_mujoco,
    total_by_pinocchio,
)
from hypothesis import given
from hypothesis import strategies as st
from robots import ROBOTS
from seats import TRUNK, TrunkOnly, expand_macro
from wheels import driven_device, geared, motor, paper_device

from ocs_design.export.mjcf import precise_xml
from ocs_design.export.snippets import (
    snippet_mjcf,
    snippet_ros2_control,
    snippet_sdf,
    snippet_urdf,
    snippet_xacro,
    snippets,
)
from ocs_design.export.templates import in_comment
from ocs_design.export.urdf import MOCK_PLUGIN, robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mujoco_model import build_spec

DEVICE = driven_device()
OTHER_ROBOTS = {
    "solo12": "solo_description/robots/solo12",
    "a1": "a1_description/urdf/a1",
    "anymal_c": "anymal_c_simple_description/urdf/anymal",
    "go2": "go2_description/urdf/go2",
    "hyq": "hyq_description/robots/hyq_no_sensors",
    "bolt": "bolt_description/robots/bolt",
    "talos": "talos_data/robots/talos_reduced",
}


@pytest.fixture(params=OTHER_ROBOTS.values(), ids=OTHER_ROBOTS)
def other_robot(request, tmp_path):
    """A robot as published, with the snippets of the device beside it."""
    for name, text in snippets(DEVICE, TrunkOnly()).items():
        (tmp_path / name).write_text(text)
    return robot_at(ROBOTS / f"{request.param}.urdf", posture="zero")


def pasted(robot, *snippets):
    """The robot's URDF with the marked part of each snippet, for the robot's trunk."""
    text = robot.content.decode()
    for snippet in snippets:
        content = snippet.read_text()
        assert content.count("<!-- from here -->") == content.count("<!-- to here -->") == 1
        part = content.split("<!-- from here -->")[1].split("<!-- to here -->")[0]
        part = part.replace(f'<parent link="{TRUNK}"/>', f'<parent link="{robot.trunk}"/>')
        text = text.replace("</robot>", part + "</robot>")
    return text


def with_macro(robot, folder, arguments=""):
    """The robot's URDF as xacro, with the two lines that the macro's comment gives."""
    comment = (folder / "ocs.urdf.xacro").read_text().partition("-->")[0]
    include, call = re.findall(r"<xacro:.*/>", comment)
    call = call.replace(f'parent="{TRUNK}"', f'parent="{robot.trunk}"{arguments}')
    text = re.sub(
        r"<robot\b(?![^>]*xmlns:xacro)",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"',
        robot.content.decode(),
    )
    (folder / "third.urdf.xacro").write_text(text.replace("</robot>", include + call + "</robot>"))
    return xacro.process_file(str(folder / "third.urdf.xacro")).toxml()


def with_attachment(robot, folder):
    """The robot as MJCF, with the two elements that the model's comment gives."""
    spec = build_spec(robot, visuals=False).spec
    root = ET.fromstring(precise_xml(spec, spec.compile(), assets="."))
    for name, content in spec.assets.items():
        (folder / name).write_bytes(content)
    comment = (folder / "ocs.xml").read_text().partition("-->")[0]
    model, attach = re.findall(r"<(?:model|attach) .*/>", comment)
    asset = root.find("asset")
    (ET.SubElement(root, "asset") if asset is None else asset).append(ET.fromstring(model))
    root.find(f".//body[@name='{robot.trunk}']").append(ET.fromstring(attach))
    (folder / "third.xml").write_bytes(ET.tostring(root))
    return mujoco.MjModel.from_xml_path(str(folder / "third.xml"))


FORMS = {
    "pasted": lambda robot, folder: pasted(robot, folder / "ocs.urdf"),
    "pasted with ros2_control": lambda robot, folder: pasted(
        robot, folder / "ocs.urdf", folder / "ocs_ros2_control.urdf"
    ),
    "macro": with_macro,
    "macro with ros2_control": lambda robot, folder: with_macro(
        robot, folder, ' ros2_control="true"'
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_urdf_and_macro_go_into_any_robot(other_robot, tmp_path, form):
    text = FORMS[form](other_robot, tmp_path)
    check_total(total_by_pinocchio(text, other_robot), other_robot, DEVICE)
    model = pinocchio_model(text)
    check_wheels_in_pinocchio(model, DEVICE, other_robot.trunk)
    wheel = model.idx_vs[model.getJointId("ocs_left")]
    assert model.upperEffortLimit[wheel] == DEVICE.motor.torque_limit
    declared = ET.fromstring(text).findall("ros2_control/joint")
    joints = ["ocs_left", "ocs_right"] if "ros2_control" in form else []
    assert [joint.get("name") for joint in declared] == joints


def test_the_model_attaches_to_any_robot(other_robot, tmp_path):
    model = with_attachment(other_robot, tmp_path)
    check_total(total_by_mujoco(model, other_robot), other_robot, DEVICE)
    check_wheels_in_mujoco(model, DEVICE, other_robot.trunk)
    limit = DEVICE.motor.torque_limit
    for module in DEVICE.modules:
        actuator = model.actuator(f"ocs_{module.name}")
        np.testing.assert_array_equal(actuator.ctrlrange, [-limit, limit])
    assert [model.sensor(i).name for i in range(model.nsensor)][-1] == "ocs_imu_rate"


MJCF = """<mujoco><asset><model name="ocs" file="ocs.xml"/></asset><worldbody>
  <body name="trunk"><freejoint/><geom size="0.1" mass="2"/>
    <body name="leg"><joint name="hip" axis="0 1 0"/><geom size="0.05" mass="1"/></body>
    <attach model="ocs" body="mount" prefix="ocs_"/>
  </body></worldbody></mujoco>"""


def robot_with_trunk(trunk):
    return replace(robot_by_hand(2.5, (0.03, 0.05, 0.07)), trunk=trunk)


@pytest.mark.parametrize("snippet", [snippet_urdf, snippet_xacro, snippet_mjcf, snippet_sdf])
def test_any_name_of_the_trunk_gives_well_formed_xml(tmp_path, snippet):
    text, path = snippet(paper_device(), robot_with_trunk('a&"<b>--c--')), tmp_path / "ocs"
    if snippet is snippet_mjcf:
        assert mujoco.MjModel.from_xml_string(text).nu == 2
    elif snippet is snippet_sdf:
        assert ET.fromstring(text.encode()).findtext("model/joint/parent") == 'a&"<b>--c--'
    else:
        path.write_text(text)
        assert xacro.process_file(str(path)).documentElement.tagName == "robot"


def test_keyframes_of_an_attaching_robot_are_as_the_snippet_says(tmp_path):
    (tmp_path / "ocs.xml").write_text(snippet_mjcf(paper_device(), robot_with_trunk("trunk")))
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
    expected = {"hip": 0.5, "ocs_left": 0.0, "ocs_right": 0.0, "last": 0.7}
    assert {name: float(data.joint(name).qpos[0]) for name in expected} == expected


HUMAN = next(ROBOTS.rglob("human.urdf"))


@pytest.mark.parametrize("form", ["urdf", "mjcf", "pasted", "macro"])
def test_wheels_of_a_robot_with_y_up_stand_in_its_base_frame(tmp_path, form):
    robot, device = robot_at(HUMAN), paper_device()
    link, place = robot.mount.link, robot.mount.placement
    modules = [
        replace(module, axis=place.rotation @ module.axis, position=place.point(module.position))
        for module in device.modules
    ]
    rotated = replace(device, modules=tuple(modules))
    if form == "mjcf":
        check_wheels_in_mujoco(mujoco_model(robot, device, tmp_path), rotated, link)
        return
    for name, text in snippets(device, robot).items():
        (tmp_path / name).write_text(text)
    text = robot_urdf(robot, device).decode() if form == "urdf" else FORMS[form](robot, tmp_path)
    check_wheels_in_pinocchio(pinocchio_model(text), rotated, link)


@given(st.text("-a b", max_size=12))
def test_any_text_may_stand_in_a_comment(text):
    document = minidom.parseString(f"<x><!--{in_comment(text)}--></x>")
    comment = document.documentElement.firstChild.data if in_comment(text) else ""
    assert comment.replace(" ", "").rstrip("-") == text.replace(" ", "").rstrip("-")


CALL = f'<xacro:ocs parent="{TRUNK}" prefix="front_" ros2_control="true" hardware_plugin="a/B"/>'


def systems(text):
    return list(ET.fromstring(text).iter("ros2_control"))


def check_system(system, device, prefix, plugin):
    assert system.attrib == {"name": f"{prefix}ocs", "type": "system"}
    assert system.findtext("hardware/plugin") == plugin
    names = [f"{prefix}ocs_{module.name}" for module in device.modules]
    assert [joint.get("name") for joint in system.iter("joint")] == names
    for joint in system.iter("joint"):
        assert [command.get("name") for command in joint.iter("command_interface")] == ["effort"]
        states = [state.get("name") for state in joint.iter("state_interface")]
        assert states == ["position", "velocity", "effort"]


def bounds(system):
    return [
        (param.get("name"), float(param.text))
        for param in system.findall("joint/command_interface/param")
    ]


def test_the_macro_declares_both_motors_on_request(tmp_path):
    device = driven_device()
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(device, TrunkOnly()))
    text = expand_macro(tmp_path, CALL)
    (system,) = systems(text)
    check_system(system, device, "front_", "a/B")
    joints = {joint.get("name") for joint in ET.fromstring(text).findall("joint")}
    assert {joint.get("name") for joint in system.iter("joint")} <= joints


@pytest.mark.parametrize("drive", [motor(754.0, torque_limit=0.7), geared(3.0), motor()])
def test_the_command_is_bounded_by_the_torque_limit(drive):
    device = driven_device(drive=drive)
    (system,) = systems(snippet_ros2_control(device))
    check_system(system, device, "", MOCK_PLUGIN)
    limit = drive.torque_limit
    assert bounds(system) == ([] if limit is None else 2 * [("min", -limit), ("max", limit)])
