"""Snippets made for one robot, put into others by doing what their own comments say."""

import re
from xml.etree import ElementTree as ET

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import xacro
from exported import pinocchio_model
from robots import ROBOTS
from seats import TRUNK, TrunkOnly
from wheels import braked_inertia, driven_device

from ocs_design.export.mjcf import precise_xml
from ocs_design.export.snippets import snippets
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot

DEVICE = driven_device()
THIRD = {
    "solo12": "solo_description/robots/solo12",
    "a1": "a1_description/urdf/a1",
    "anymal_c": "anymal_c_simple_description/urdf/anymal",
    "go2": "go2_description/urdf/go2",
    "hyq": "hyq_description/robots/hyq_no_sensors",
    "bolt": "bolt_description/robots/bolt",
    "talos": "talos_data/robots/talos_reduced",
}


@pytest.fixture(params=THIRD.values(), ids=THIRD)
def third(request, tmp_path):
    """Another robot as it came, with the snippets of ours beside it."""
    for name, text in snippets(DEVICE, TrunkOnly()).items():
        (tmp_path / name).write_text(text)
    return read_robot(ROBOTS / f"{request.param}.urdf", posture="zero")


def pasted(robot, *snippets):
    """The robot's URDF with what stands between the marks of each, for its own trunk."""
    text = robot.content.decode()
    for snippet in snippets:
        words = snippet.read_text()
        assert words.count("<!-- from here -->") == words.count("<!-- to here -->") == 1
        part = words.split("<!-- from here -->")[1].split("<!-- to here -->")[0]
        part = part.replace(f'<parent link="{TRUNK}"/>', f'<parent link="{robot.trunk}"/>')
        text = text.replace("</robot>", part + "</robot>")
    return text


def with_macro(robot, folder, arguments=""):
    """The robot's URDF as xacro with the two lines of the macro's comment."""
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
    """The robot as MJCF with the two elements of the model's comment."""
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


def check_whole(mass, com, inertia, robot):
    """Robot and braked device together, in the trunk's frame."""
    expected = braked_inertia(robot, DEVICE)
    assert mass == pytest.approx(expected.mass, rel=1e-9)
    np.testing.assert_allclose(com, expected.com, rtol=0.0, atol=1e-9)
    scale = np.abs(expected.inertia).max()
    np.testing.assert_allclose(inertia, expected.inertia, rtol=0.0, atol=1e-9 * scale)


def check_in_pinocchio(text, robot):
    model = pinocchio_model(text)
    data, rest = model.createData(), pin.neutral(model)
    pin.ccrba(model, data, rest, np.zeros(model.nv))
    pin.framesForwardKinematics(model, data, rest)
    trunk = data.oMf[model.getFrameId(robot.trunk, pin.FrameType.BODY)]
    rotation = trunk.rotation
    check_whole(
        data.Ig.mass, trunk.actInv(data.com[0]), rotation.T @ data.Ig.inertia @ rotation, robot
    )
    for module in DEVICE.modules:
        index = model.getJointId(f"ocs_{module.name}")
        wheel = trunk.actInv(data.oMi[index])
        np.testing.assert_allclose(wheel.rotation[:, 2], module.axis, rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(wheel.translation, module.position, rtol=0.0, atol=1e-9)
        assert model.upperEffortLimit[model.idx_vs[index]] == DEVICE.motor.torque_limit


def test_the_urdf_pasted(third, tmp_path):
    check_in_pinocchio(pasted(third, tmp_path / "ocs.urdf"), third)


def test_the_urdf_and_its_ros2_control_pasted(third, tmp_path):
    text = pasted(third, tmp_path / "ocs.urdf", tmp_path / "ocs_ros2_control.urdf")
    check_in_pinocchio(text, third)
    root = ET.fromstring(text)
    joints = {joint.get("name") for joint in root.findall("joint")}
    declared = [joint.get("name") for joint in root.findall("ros2_control/joint")]
    assert declared == ["ocs_left", "ocs_right"]
    assert joints.issuperset(declared)


@pytest.mark.parametrize("arguments", ["", ' ros2_control="true"'])
def test_the_macro_called(third, tmp_path, arguments):
    check_in_pinocchio(with_macro(third, tmp_path, arguments), third)


def test_the_model_attached(third, tmp_path):
    model = with_attachment(third, tmp_path)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = data.body(third.trunk)
    rotation = body.xmat.reshape(3, 3)
    check_whole(*composite(model, data, rotation, body.xpos), third)
    for module in DEVICE.modules:
        joint = data.joint(f"ocs_{module.name}")
        np.testing.assert_allclose(rotation.T @ joint.xaxis, module.axis, rtol=0.0, atol=1e-9)
        spin_inertia = model.body(f"ocs_{module.name}_flywheel").inertia[2]
        assert spin_inertia == pytest.approx(DEVICE.flywheel.spin_inertia, rel=1e-12)
        limit = DEVICE.motor.torque_limit
        np.testing.assert_array_equal(
            model.actuator(f"ocs_{module.name}").ctrlrange, [-limit, limit]
        )
    assert [model.sensor(i).name for i in range(model.nsensor)][-1] == "ocs_imu_rate"


def composite(model, data, rotation, origin):
    """Mass, centre of mass and inertia about it of everything, in a frame of the world."""
    mass, centres = model.body_mass[1:], data.xipos[1:]
    com = mass @ centres / mass.sum()
    turned = data.ximat[1:].reshape(-1, 3, 3)
    own = turned @ (model.body_inertia[1:, :, None] * turned.transpose(0, 2, 1))
    arms = centres - com
    far = mass[:, None, None] * (
        np.sum(arms**2, axis=1)[:, None, None] * np.eye(3) - arms[:, :, None] * arms[:, None, :]
    )
    inertia = rotation.T @ (own + far).sum(axis=0) @ rotation
    return mass.sum(), rotation.T @ (com - origin), inertia
