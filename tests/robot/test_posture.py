"""Postures by name and joint by joint."""

from dataclasses import replace

import pytest
from anatomy import legs_of, stand_of, tree_of

from ocs_design.common.errors import RobotError
from ocs_design.robot.posture import resolve_posture

SOLO12 = "solo_description/robots/solo12"
UR5 = "ur_description/urdf/ur5_robot"


def solo12(name=None, joints=None, tree=None):
    return resolve_posture(
        tree or tree_of(SOLO12), "base_link", legs_of(SOLO12), name, joints or {}
    )


STANDING = 0.8 * 0.32 + 0.0164
"""Standing height of legs with thighs and shanks of 160 mm and round feet [m]."""


@pytest.mark.parametrize(
    ("requested", "joints", "name", "values", "height"),
    [
        (None, {}, "stand", lambda: stand_of(SOLO12).posture, STANDING),
        ("zero", {}, "zero", dict, 0.32 + 0.0164),
        ("zero", {"FL_KFE": -0.5}, "zero + joints", lambda: {"FL_KFE": -0.5}, None),
        ("standing", {}, "standing", lambda: tree_of(SOLO12).named_postures["standing"], None),
    ],
)
def test_a_posture_is_by_name_and_joint_by_joint(requested, joints, name, values, height):
    posture, zero = solo12(requested, joints), dict.fromkeys(tree_of(SOLO12).joints, 0.0)
    assert posture.name == name
    assert posture.values == zero | values()
    if height is not None:
        assert posture.standing_height == pytest.approx(height, abs=1e-4)


def test_a_robot_without_legs_is_at_zero():
    posture = resolve_posture(tree_of(UR5), "base_link", (), None, {})
    assert posture.name == "zero"
    assert set(posture.values.values()) == {0.0}
    assert posture.standing_height is None


def test_joints_of_a_partial_posture_rest_within_their_limits():
    """A1's knees cannot be straight: -0.916 rad is as near to zero as they come."""
    name = "a1_description/urdf/a1"
    tree = replace(tree_of(name), named_postures={"sit": {"FL_thigh_joint": 1.0}})
    values = resolve_posture(tree, "base", legs_of(name), "sit", {}).values
    assert values["FL_thigh_joint"] == 1.0
    assert values["FL_calf_joint"] == tree.joints["FL_calf_joint"].upper < 0.0


def test_values_outside_the_limits_raise_a_warning():
    name = "a1_description/urdf/a1"
    posture = resolve_posture(tree_of(name), "base", legs_of(name), "zero", {})
    (warning,) = posture.warnings
    assert "limits" in warning
    assert "FL_calf_joint" in warning


def test_a_posture_of_the_file_with_a_built_in_name_raises_a_warning():
    tree = replace(tree_of(SOLO12), named_postures={"stand": {"FL_KFE": 1.0}})
    (warning,) = solo12("stand", tree=tree).warnings
    assert "'stand'" in warning


@pytest.mark.parametrize(
    ("arguments", "wrong", "right"),
    [
        ({"name": "standin"}, "posture 'standin'", "stand"),
        ({"joints": {"FL_HF": 0.1}}, "moving joint 'FL_HF'", "FL_HFE"),
    ],
)
def test_an_unknown_name_lists_the_nearest_first(arguments, wrong, right):
    with pytest.raises(RobotError) as caught:
        solo12(**arguments)
    assert wrong in caught.value.message
    assert caught.value.hint.startswith(f"did you mean '{right}")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1e308])
def test_impossible_joint_values_are_refused(value):
    with pytest.raises(RobotError, match="FL_HFE"):
        solo12(joints={"FL_HFE": value})


def test_stand_needs_legs():
    with pytest.raises(RobotError, match="no legs"):
        resolve_posture(tree_of(UR5), "base_link", (), "stand", {})


def test_a_joint_that_follows_another_cannot_be_set():
    tree = tree_of("tiago_pro_description/robots/tiago_pro")
    follower = next(joint for joint in tree.joints.values() if joint.mimic is not None)
    with pytest.raises(RobotError) as caught:
        resolve_posture(tree, "base_footprint", (), "zero", {follower.name: 0.1})
    assert follower.mimic[0] in caught.value.hint
