"""From a file to a robot."""

import hashlib

import numpy as np
import pinocchio as pin
import pytest
from anatomy import ANATOMY
from robots import ROBOTS, SOLO12, one_of_each
from urdf_text import inertial, link, robot

from ocs_design.common.errors import RobotError
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Format

QUADRUPED = ROBOTS / "quadruped_description/urdf/quadruped.urdf"
HUMAN = ROBOTS / "human_description/robots/human.urdf"


def test_solo12_with_no_option():
    found = read_robot(SOLO12)
    assert found.name == "solo"
    assert found.format is Format.URDF
    assert (found.trunk, found.floating_base, found.posture_name) == (
        "base_link",
        "base_link",
        "stand",
    )
    assert found.sha256 == hashlib.sha256(SOLO12.read_bytes()).hexdigest()
    assert found.mass == pytest.approx(2.50000279)
    # 1000 N m: a placeholder, of a robot of 2.5 kg.
    (warning,) = found.warnings
    assert "efforts over 10 times" in warning


def test_solo12_at_its_nominal_posture_weighs_what_pinocchio_says():
    found = read_robot(SOLO12)
    model = pin.buildModelFromUrdf(str(SOLO12), pin.JointModelFreeFlyer())
    data, q = model.createData(), pin.neutral(model)
    for name, value in found.posture.items():
        q[model.joints[model.getJointId(name)].idx_q] = value
    pin.ccrba(model, data, q, np.zeros(model.nv))
    assert found.inertia == pytest.approx(data.Ig.inertia, rel=1e-12, abs=1e-15)
    assert found.com == pytest.approx(pin.centerOfMass(model, data, q), rel=1e-9, abs=1e-12)


def test_another_trunk_is_another_frame_of_the_same_robot():
    """The legs stay those of the robot; only where it is seen from changes."""
    whole = ROBOTS / "talos_data/robots/talos_reduced.urdf"
    pelvis, chest = read_robot(whole), read_robot(whole, trunk="torso_2_link")
    assert [leg.name for leg in chest.legs] == [leg.name for leg in pelvis.legs]
    assert dict(chest.posture) == pytest.approx(dict(pelvis.posture), abs=1e-6)
    assert chest.inertia == pytest.approx(pelvis.inertia, rel=1e-5, abs=1e-5)
    rise = pelvis.com[2] - chest.com[2]
    assert chest.standing_height - pelvis.standing_height == pytest.approx(rise, abs=1e-6)


def test_an_unknown_trunk_lists_the_nearest_links():
    with pytest.raises(RobotError) as caught:
        read_robot(SOLO12, trunk="base")
    assert caught.value.exit_code == 3
    assert "no link 'base'" in caught.value.message
    assert caught.value.hint.startswith("did you mean 'base_link'? available: base_link")


def test_sideways_and_upright_conventions_are_told():
    sideways = read_robot(QUADRUPED, trunk="base_link").warnings
    assert any("knees turn about the x axis" in text for text in sideways)
    lying = next(
        text for text in read_robot(HUMAN, trunk="middle_pelvis").warnings if "hang" in text
    )
    assert "-y" in lying
    assert "--trunk" in lying


@pytest.mark.parametrize("name", one_of_each(ANATOMY))
def test_no_warning_is_told_twice_and_few_are_of_the_frame(name):
    warnings = read_robot(ROBOTS / f"{name}.urdf").warnings
    assert len(set(warnings)) == len(warnings)
    of_frame = [text for text in warnings if "frame of the trunk" in text]
    assert len(of_frame) == (1 if "quadruped_desc" in name or "human_desc" in name else 0)


def test_a_robot_without_mass_is_refused(tmp_path):
    path = tmp_path / "light.urdf"
    path.write_bytes(robot(link("trunk")))
    with pytest.raises(RobotError, match="no mass"):
        read_robot(path)


def test_a_robot_that_cannot_exist_is_refused(tmp_path):
    path = tmp_path / "odd.urdf"
    path.write_bytes(robot(link("trunk", inertial(1.0, "0.1 0.1 0.9"))))
    with pytest.raises(RobotError) as caught:
        read_robot(path)
    assert caught.value.hint


def test_a_point_mass_has_nothing_to_turn(tmp_path):
    path = tmp_path / "point.urdf"
    path.write_bytes(robot(link("trunk", inertial(1.0, "0 0 0"))))
    with pytest.raises(RobotError, match="inertia"):
        read_robot(path)
