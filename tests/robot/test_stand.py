"""The standing posture and lifted feet, checked by Pinocchio and the whole tree."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from anatomy import ANATOMY, LEGGED, legs_of, stand_of, tree_of
from pinocchio_robots import configuration, free_model
from robots import ROBOTS, robot_parameters

from ocs_design.robot.leg_geometry import leg_geometries, sole_depths
from ocs_design.robot.reader import read_robot
from ocs_design.robot.recognition import recognise
from ocs_design.robot.stance import SHARE_OF_LEG, lifted, stand
from ocs_design.robot.tree import joint_motion

SOLO12 = "solo_description/robots/solo12"
# Shares of the leg where ankles cannot bend enough: Romeo's by 30 degrees, those of the simple
# humanoids not backwards at all.
STRAIGHTER = {
    "icub_description/robots/icub": 0.85,
    "icub_description/robots/icub_reduced": 0.85,
    "romeo_description/urdf/romeo": 0.95,
    "romeo_description/urdf/romeo_small": 0.95,
    "romeo_description/urdf/romeo_laas_small": 0.95,
    "simple_humanoid_description/urdf/simple_humanoid": 1.0,
    "simple_humanoid_description/urdf/simple_humanoid_classical": 1.0,
}
HUMAN = "human_description/robots/human"
WHEELED = "centauro_description/urdf/centauro"
# Listed here, since reading every robot would delay the first test.
POINT_FEET = [
    name for name in LEGGED if name != WHEELED and (ANATOMY[name][1] == 4 or "bolt" in name)
]
WITH_SOLES = [name for name in LEGGED if name not in POINT_FEET and name != WHEELED]


def standing(name, share=SHARE_OF_LEG):
    tree, legs = tree_of(name), legs_of(name)
    stance = stand_of(name) if share == SHARE_OF_LEG else stand(tree, ANATOMY[name][0], legs, share)
    return tree, legs, stance


def height(name, stance):
    """Height of the trunk frame's origin over the lowest sole [m]."""
    return max(sole_depths(tree_of(name), ANATOMY[name][0], legs_of(name), stance.posture))


def up_of(name):
    return np.array([0.0, 1.0, 0.0] if name == HUMAN else [0.0, 0.0, 1.0])


def pinocchio_frames(name, posture):
    """Model and data of Pinocchio at a posture, its base in the origin."""
    model = free_model(ROBOTS / f"{name}.urdf")
    data = model.createData()
    pin.framesForwardKinematics(model, data, configuration(model, posture))
    return model, data


def soles(name, posture, tree, legs, up):
    """Lowest point of each foot in the base frame and the rotation of its body, by Pinocchio."""
    model, data = pinocchio_frames(name, posture)
    for leg in legs:
        place = data.oMf[model.getFrameId(tree.bodies[leg.body].name)]
        yield place.act(leg.foot) - leg.foot_radius * up, place.rotation


@pytest.mark.parametrize("name", robot_parameters(LEGGED))
def test_all_feet_stand_on_one_plane_within_the_joint_limits(name):
    tree, legs, stance = standing(name)
    assert (len(legs[0].joints) < 5) == (name in POINT_FEET)
    up = up_of(name)
    heights = [point @ up for point, _ in soles(name, stance.posture, tree, legs, up)]
    assert heights == pytest.approx([-height(name, stance)] * len(legs), abs=1e-3)
    for joint in tree.joints.values():
        assert joint.lower - 1e-9 <= stance.posture[joint.name] <= joint.upper + 1e-9
    assert stance.share == STRAIGHTER.get(name, SHARE_OF_LEG)
    assert len(stance.warnings) == (1 if name in STRAIGHTER else 0)


@pytest.mark.parametrize("name", POINT_FEET)
def test_point_feet_are_below_the_hinges_that_swing_them(name):
    """The hip is the last but one joint of these legs; along its axis the foot may be anywhere."""
    tree, legs, stance = standing(name)
    up = up_of(name)
    model, data = pinocchio_frames(name, stance.posture)
    for leg, (sole, _) in zip(legs, soles(name, stance.posture, tree, legs, up), strict=True):
        index = model.getJointId(leg.joints[-2])
        swing = np.cross(data.oMi[index].rotation @ tree.joints[leg.joints[-2]].axis, up)
        assert swing @ (sole - data.oMi[index].translation) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("name", robot_parameters(WITH_SOLES))
def test_soles_stay_as_level_as_they_are_at_zero(name):
    tree, legs, stance = standing(name)
    up = up_of(name)
    zero = dict.fromkeys(tree.joints, 0.0)
    stood, flat = (soles(name, p, tree, legs, up) for p in (stance.posture, zero))
    for (_, rotation), (_, level) in zip(stood, flat, strict=True):
        assert rotation @ level.T @ up == pytest.approx(up, abs=1e-4)


def test_solo12_bends_its_legs_as_two_equal_bars_do():
    _, _, stance = standing(SOLO12)
    angle = np.arccos(0.8)
    for leg, side in (("FL", 1.0), ("FR", 1.0), ("HL", -1.0), ("HR", -1.0)):
        assert stance.posture[f"{leg}_HAA"] == pytest.approx(0.0, abs=1e-6)
        assert stance.posture[f"{leg}_HFE"] == pytest.approx(side * angle, abs=1e-4)
        assert stance.posture[f"{leg}_KFE"] == pytest.approx(-2.0 * side * angle, abs=1e-4)
    assert height(SOLO12, stance) == pytest.approx(0.8 * 0.32 + 0.0164, abs=1e-4)


@pytest.mark.parametrize(
    ("name", "knees"),
    [
        (SOLO12, {"FL_LOWER_LEG": -1, "FR_LOWER_LEG": -1, "HL_LOWER_LEG": 1, "HR_LOWER_LEG": 1}),
        ("anymal_b_simple_description/robots/anymal", {"LF_SHANK": -1, "RH_SHANK": 1}),
        ("bolt_description/robots/bolt", {"FL_LOWER_LEG": 1, "FR_LOWER_LEG": 1}),
        ("g1_description/urdf/g1_29dof_rev_1_0", {"left_knee_link": 1, "right_knee_link": 1}),
        # Limits leave no choice: all knees back, and iCub's x axis points backwards.
        ("a1_description/urdf/a1", {"FL_calf": -1, "RL_calf": -1}),
        ("icub_description/robots/icub", {"l_lower_leg": -1, "r_lower_leg": -1}),
    ],
)
def test_knees_point_to_the_usual_side(name, knees):
    tree, legs, stance = standing(name)
    model, data = pinocchio_frames(name, stance.posture)
    feet = {tree.bodies[leg.body].name: leg for leg in legs}
    for knee, side in knees.items():
        index = tree.body_of_link[knee]
        thigh = tree.bodies[tree.bodies[index].parent].name
        foot = next(name for name, leg in feet.items() if index in tree.ancestors(leg.body))
        end = data.oMf[model.getFrameId(foot)].act(feet[foot].foot)
        middle = 0.5 * (data.oMf[model.getFrameId(thigh)].translation + end)
        assert side * (data.oMf[model.getFrameId(knee)].translation - middle)[0] > 0.01


def test_the_share_sets_the_height():
    heights = [height(SOLO12, standing(SOLO12, share)[2]) for share in (0.6, 0.7, 0.8, 0.9)]
    assert np.diff(heights) == pytest.approx([0.032] * 3, abs=1e-5)


def test_an_unreachable_stance_raises_a_warning():
    """For a stance lower than the knees can bend the nearest one is taken."""
    tree = tree_of("romeo_description/urdf/romeo")
    legs = legs_of("romeo_description/urdf/romeo")
    low = stand(tree, "base_link", legs, 0.3)
    assert low.warnings
    for name in legs[0].joints:
        assert tree.joints[name].lower <= low.posture[name] <= tree.joints[name].upper


HEIGHTS = np.array([0.0, 0.02, 0.04, -0.02])


@pytest.fixture(scope="module")
def robot():
    return read_robot(ROBOTS / f"{SOLO12}.urdf")


@pytest.fixture(scope="module", params=range(4))
def leg(robot, request):
    return leg_geometries(robot.tree, robot.trunk, robot.legs)[request.param]


def posture_of(robot, leg):
    return np.array([robot.posture[name] for name in leg.chain.names])


def test_a_foot_goes_straight_up_and_down_in_the_whole_robot(robot, leg):
    joint_values = lifted(leg.chain, leg.leg.foot, leg.leg.length, posture_of(robot, leg), HEIGHTS)
    feet = []
    for values in joint_values:
        posture = {**robot.posture, **dict(zip(leg.chain.names, values, strict=True))}
        shank = robot.tree.placements_from(robot.trunk, posture)[leg.leg.body]
        feet.append(shank.point(leg.leg.foot))
    moved = np.array(feet) - feet[0]
    np.testing.assert_allclose(moved[:, :2], 0.0, atol=1e-9)
    np.testing.assert_allclose(moved[:, 2], HEIGHTS, atol=1e-9)


def test_a_foot_out_of_reach_stays_within_the_joint_limits(robot, leg):
    height = np.array([-2.0 * leg.leg.length])
    (values,) = lifted(leg.chain, leg.leg.foot, leg.leg.length, posture_of(robot, leg), height)
    assert np.all((values >= leg.chain.lower) & (values <= leg.chain.upper))
    assert np.isfinite(values).all()


@pytest.mark.parametrize("outwards", [0.3, -0.6])
@pytest.mark.parametrize(
    "name", [SOLO12, "go2_description/urdf/go2", "bolt_description/robots/bolt"]
)
def test_legs_that_are_spread_at_zero_stand_as_they_do_without(name, outwards):
    """Where an encoder has its zero changes neither the robot nor how it stands."""
    tree, legs, stance = standing(name)
    rolls = {leg.joints[0]: outwards * (1 if "L" in leg.joints[0][:2] else -1) for leg in legs}

    def spread(body):
        """The body with the zero of its joint turned outwards."""
        if body.joint is None or body.joint.name not in rolls:
            return body
        joint, angle = body.joint, rolls[body.joint.name]
        limits = {"lower": joint.lower - angle, "upper": joint.upper - angle}
        placement = body.placement @ joint_motion(joint, angle)
        return replace(body, placement=placement, joint=replace(joint, **limits))

    turned = replace(tree, bodies=tuple(map(spread, tree.bodies)))
    recognition = recognise(turned)
    assert recognition.sure
    found = recognition.reading
    assert [leg.length for leg in found.legs] == pytest.approx([leg.length for leg in legs])
    posture = stand(turned, found.trunk, found.legs).posture
    for joint, value in stance.posture.items():
        assert posture[joint] + rolls.get(joint, 0.0) == pytest.approx(value, abs=1e-4)
