"""What ros2_control is told of the wheels."""

from xml.etree import ElementTree as ET

import pytest
from seats import TRUNK, TrunkOnly, expanded
from wheels import driven_device, geared, motor, paper_device

from ocs_design.export.device_urdf import MOCK_PLUGIN
from ocs_design.export.snippets import snippet_ros2_control, snippet_xacro

CALL = f'<xacro:ocs parent="{TRUNK}" prefix="front_" ros2_control="true" hardware_plugin="a/B"/>'


def systems(text):
    return list(ET.fromstring(text).iter("ros2_control"))


def check_system(system, device, prefix, plugin):
    assert system.attrib == {"name": f"{prefix}ocs", "type": "system"}
    assert system.findtext("hardware/plugin") == plugin
    names = [f"{prefix}ocs_{module.name}" for module in device.modules]
    assert [joint.get("name") for joint in system.iter("joint")] == names
    for joint in system.iter("joint"):
        assert [each.get("name") for each in joint.iter("command_interface")] == ["effort"]
        states = [each.get("name") for each in joint.iter("state_interface")]
        assert states == ["position", "velocity", "effort"]


def bounds(system):
    return [
        (param.get("name"), float(param.text))
        for param in system.findall("joint/command_interface/param")
    ]


def test_the_macro_declares_nothing_unless_asked(tmp_path):
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(driven_device(), TrunkOnly()))
    assert not systems(expanded(tmp_path, f'<xacro:ocs parent="{TRUNK}"/>'))


def test_the_macro_declares_both_motors_when_asked(tmp_path):
    device = driven_device()
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(device, TrunkOnly()))
    text = expanded(tmp_path, CALL)
    (system,) = systems(text)
    check_system(system, device, "front_", "a/B")
    joints = {joint.get("name") for joint in ET.fromstring(text).findall("joint")}
    assert {joint.get("name") for joint in system.iter("joint")} <= joints


@pytest.mark.parametrize("drive", [motor(754.0, torque_limit=0.7), geared(3.0)])
def test_the_command_is_bounded_by_the_motor(drive):
    device = driven_device(drive=drive)
    (system,) = systems(snippet_ros2_control(device))
    check_system(system, device, "", MOCK_PLUGIN)
    limit = drive.torque_limit
    assert bounds(system) == 2 * [("min", -limit), ("max", limit)]


def test_a_motor_without_limit_has_no_bounds():
    (system,) = systems(snippet_ros2_control(paper_device()))
    check_system(system, paper_device(), "", MOCK_PLUGIN)
    assert not bounds(system)
