"""Whole robots with their device as URDF, read back by Pinocchio and by our own reader."""

import numpy as np
import pytest
from built_devices import DEVICES
from exported import LEGGED_PATHS, MJCF, check_wheels_in_pinocchio, pinocchio_model, robot_at
from robots import SOLO12, robot_parameters
from wheels import driven_device, paper_device

from ocs_design.common.errors import RobotError
from ocs_design.export.urdf import robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot

BY_HAND = robot_by_hand(2.5, (0.03, 0.05, 0.07, 0.001, 0.002, -0.003), com=(0.01, 0.0, -0.02))


def exported_text(robot: Robot, device=None) -> str:
    return robot_urdf(robot, device or paper_device()).decode()


@pytest.mark.parametrize("path", robot_parameters(LEGGED_PATHS))
def test_the_users_file_stays_byte_for_byte(path):
    robot = robot_at(path)
    content = robot.content
    result = robot_urdf(robot, paper_device())
    place = content.rindex(b"</robot>")
    assert result[:place].rstrip() == content[:place].rstrip()
    assert result[:place] == content[:place]
    assert result.endswith(content[place:])
    assert content == path.read_bytes()


def test_a_robot_by_hand_is_written_in_full():
    device = paper_device()
    model = pinocchio_model(exported_text(BY_HAND, device))
    check_wheels_in_pinocchio(model, device, BY_HAND.trunk)
    body = model.inertias[model.getJointId("root_joint")]
    assert body.mass == BY_HAND.mass
    np.testing.assert_allclose(body.lever, BY_HAND.com, atol=1e-15)
    np.testing.assert_allclose(body.inertia, BY_HAND.inertia, atol=1e-15)


def test_an_mjcf_robot_becomes_the_same_robot_in_urdf(tmp_path):
    (tmp_path / "robot.xml").write_text(MJCF)
    robot, device = read_robot(tmp_path / "robot.xml", posture="zero"), paper_device()
    text = exported_text(robot, device)
    (tmp_path / "robot.urdf").write_text(text)
    check_wheels_in_pinocchio(pinocchio_model(text), device, robot.trunk)
    reread = read_robot(tmp_path / "robot.urdf", trunk=robot.trunk, posture="zero")
    rng = np.random.default_rng(0)
    for _ in range(10):
        posture = {name: rng.uniform(-1.0, 1.0) for name in robot.tree.joints}
        expected = robot.tree.locked_mass_properties(posture, "rear")
        exported = reread.tree.locked_mass_properties(posture, "rear")
        ocs = reread.tree.bodies[reread.tree.body_of_link["ocs_left_flywheel"]]
        assert exported.mass - 2.0 * ocs.mass_properties.mass == pytest.approx(
            expected.mass, rel=1e-12
        )
    assert set(reread.tree.joints) == {*robot.tree.joints, "ocs_left", "ocs_right"}
    for name, joint in robot.tree.joints.items():
        limits = (reread.tree.joints[name].lower, reread.tree.joints[name].upper)
        assert limits == (joint.lower, joint.upper)


@pytest.mark.parametrize(
    ("element", "name"),
    [
        ("link", "ocs_left_flywheel"),
        ("joint", "ocs_right"),
        ("link", "ocs_left_motor"),
        ("joint", "ocs_left_motor"),
        ("link", "ocs_plate"),
    ],
)
def test_a_clash_of_names_is_an_error(tmp_path, element, name):
    """Names of motors and of a plate are free where the device has none."""
    link, joint = (name, "weld") if element == "link" else ("other", name)
    extra = (
        f'<link name="{link}"/><joint name="{joint}" type="fixed">'
        f'<parent link="base_link"/><child link="{link}"/></joint>'
    )
    (tmp_path / "in.urdf").write_text(SOLO12.read_text().replace("</robot>", extra + "</robot>"))
    robot = read_robot(tmp_path / "in.urdf")
    device = DEVICES["on a plate"] if name == "ocs_plate" else driven_device()
    with pytest.raises(RobotError, match=rf"{element} named '{name}'"):
        robot_urdf(robot, device)
    if name.endswith(("motor", "plate")):
        robot_urdf(robot, paper_device())


def test_names_that_need_escaping_are_escaped(tmp_path):
    text = SOLO12.read_text().replace('"base_link"', '"a&amp;&quot;b--"')
    (tmp_path / "in.urdf").write_text(text)
    robot = read_robot(tmp_path / "in.urdf")
    assert robot.trunk == 'a&"b--'
    (tmp_path / "out.urdf").write_bytes(robot_urdf(robot, paper_device()))
    reread = read_robot(tmp_path / "out.urdf", trunk=robot.trunk)
    assert "ocs_left" in reread.tree.joints
