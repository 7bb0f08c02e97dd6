"""The device in SDF, read by a general XML reader.

libsdformat 12.3, Gazebo's own reader, accepts the files without a warning; it is not on PyPI.
"""

from collections import Counter
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from robots import ROBOTS
from scipy.spatial.transform import Rotation
from seats import TRUNK, TrunkOnly
from wheels import EC45_BODY, driven_device, geared, paper_device

from ocs_design.export.snippets import snippet_sdf
from ocs_design.robot.reader import read_robot


def model_of(device, seat):
    return ET.fromstring(snippet_sdf(device, seat).encode()).find("model")


def link_of(model, name):
    return model.find(f"link[@name='{name}']")


def numbers(text):
    return np.array([float(word) for word in text.split()])


def inertial(link):
    tags = ("ixx", "iyy", "izz")
    return float(link.findtext("inertial/mass")), [
        float(link.findtext(f"inertial/inertia/{tag}")) for tag in tags
    ]


@pytest.mark.parametrize("device", [paper_device(), driven_device(), driven_device(0.0)])
def test_wheels_have_the_designed_pose_axis_and_mass(device):
    model, wheel = model_of(device, TrunkOnly()), device.flywheel
    for module in device.modules:
        link = link_of(model, f"ocs_{module.name}_flywheel")
        assert link.find("pose").get("relative_to") == TRUNK
        pose = numbers(link.findtext("pose"))
        np.testing.assert_array_equal(pose[:3], module.position)
        axis = Rotation.from_euler("xyz", pose[3:]).as_matrix()[:, 2]
        np.testing.assert_allclose(axis, module.axis, rtol=0.0, atol=1e-15)
        mass, moments = inertial(link)
        assert (mass, moments[2]) == (wheel.mass, wheel.spin_inertia)
        assert moments[0] == moments[1]
        joint = model.find(f"joint[@name='ocs_{module.name}']")
        assert joint.get("type") == "continuous"
        assert (joint.findtext("parent"), joint.findtext("child")) == (TRUNK, link.get("name"))
        np.testing.assert_array_equal(numbers(joint.findtext("axis/xyz")), [0.0, 0.0, 1.0])


def test_motors_are_fixed_to_the_trunk():
    model = model_of(driven_device(), TrunkOnly())
    for side in ("left", "right"):
        mass, _ = inertial(link_of(model, f"ocs_{side}_motor"))
        assert mass == EC45_BODY.mass
    assert [joint.get("type") for joint in model.iter("joint")].count("fixed") == 2
    assert model_of(paper_device(), TrunkOnly()).find("joint/axis/limit") is None
    limit = model.find("joint/axis/limit")
    assert (float(limit.findtext("effort")), float(limit.findtext("velocity"))) == (1.0, 650.4)


@pytest.mark.parametrize("device", [paper_device(), driven_device()])
def test_names_within_a_model_are_unique(device):
    """In SDF links, joints and frames share one namespace."""
    names = Counter(element.get("name") for element in model_of(device, TrunkOnly()))
    names.pop(None, None)
    assert max(names.values()) == 1


def test_armature_is_a_comment():
    text = snippet_sdf(driven_device(drive=geared(4.0)), TrunkOnly())
    assert f"<!-- armature {geared(4.0).armature!r} kg m^2 is left out -->" in text


def test_a_robot_with_y_up_gets_a_frame_with_z_up():
    robot, device = read_robot(next(ROBOTS.rglob("human.urdf"))), paper_device()
    model = model_of(device, robot)
    frame = model.find("frame")
    assert frame.get("attached_to") == robot.mount.link
    pose = numbers(frame.findtext("pose"))
    np.testing.assert_allclose(
        Rotation.from_euler("xyz", pose[3:]).as_matrix(), robot.mount.placement.rotation, atol=1e-15
    )
    assert link_of(model, "ocs_left_flywheel").find("pose").get("relative_to") == frame.get("name")
