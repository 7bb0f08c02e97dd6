"""Legs and trunks of real robots, and of a humanoid whose root is its chest."""

import numpy as np
import pytest
from anatomy import ANATOMY, LEGGED, legs_of, reading_of, tree_of
from pinocchio_robots import free_model
from robots import ALL_URDFS, ROBOTS, robot_parameters

from ocs_design.robot.reader import read_robot

# Foot links whose origin is the centre of the ball, in files without a sphere that says so.
BARE_FOOT_RADIUS = {"solo_description/robots/solo12": 0.016, "go2_description/urdf/go2": 0.022}


def test_anatomy_covers_every_robot_that_can_be_read():
    names = {str(path.relative_to(ROBOTS).with_suffix("")) for path in ALL_URDFS}
    assert names - set(ANATOMY) == {"ur_description/urdf/ur3"}


@pytest.mark.parametrize("name", robot_parameters(ANATOMY))
def test_trunk_and_legs_are_found_and_nothing_else(name):
    trunk, count = ANATOMY[name]
    legs = legs_of(name)
    assert reading_of(name).trunk == trunk
    assert len({leg.name for leg in legs}) == len(legs) == count


@pytest.mark.parametrize("name", robot_parameters(LEGGED))
def test_the_trunk_is_the_free_flyer_and_legs_are_alike(name):
    legs, root = legs_of(name), tree_of(name).bodies[0]
    assert reading_of(name).trunk == root.name
    assert (root.links[root.name].position == 0.0).all()
    assert len({len(leg.joints) for leg in legs}) == 1
    assert np.ptp([leg.length for leg in legs]) < 0.01 * legs[0].length
    assert np.ptp([leg.foot_radius for leg in legs]) < 1e-3


@pytest.mark.parametrize("name", robot_parameters(LEGGED))
def test_leg_joints_lead_from_trunk_to_foot_in_pinocchio(name):
    model = free_model(ROBOTS / f"{name}.urdf")
    for leg in legs_of(name):
        support = [model.names[i] for i in model.supports[model.getJointId(leg.joints[-1])]]
        assert support[-len(leg.joints) :] == list(leg.joints)
        foot = model.frames[model.getFrameId(leg.name)]
        assert model.names[foot.parentJoint] == leg.joints[-1]


@pytest.mark.parametrize(
    ("name", "length"),
    [
        ("solo_description/robots/solo12", 0.32),  # thigh and shank of 160 mm
        ("bolt_description/robots/bolt", 0.40),  # 200 mm each
        ("quadruped_description/urdf/quadruped", 0.32),
        # Thigh and shank of 200 mm, of which the knee's limit of 0.916297857 rad takes some.
        ("a1_description/urdf/a1", 0.4 * np.cos(0.5 * 0.916297857)),
    ],
)
def test_length_is_that_of_thigh_and_shank(name, length):
    assert legs_of(name)[0].length == pytest.approx(length, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "radius"),
    [
        ("a1_description/urdf/a1", 0.02),
        ("anymal_b_simple_description/robots/anymal", 0.031),
        ("hyq_description/robots/hyq_no_sensors", 0.02175),
        ("laikago_description/urdf/laikago", 0.0265),
    ],
)
def test_foot_is_the_collision_sphere_of_the_file(name, radius):
    assert {leg.foot_radius for leg in legs_of(name)} == {radius}


@pytest.mark.parametrize("name", BARE_FOOT_RADIUS)
def test_foot_radius_from_a_mesh_is_that_of_the_ball(name):
    for leg in legs_of(name):
        assert leg.foot_radius == pytest.approx(BARE_FOOT_RADIUS[name], abs=1e-3)


def test_wheels_are_feet_with_the_radius_of_the_wheel():
    for leg in legs_of("centauro_description/urdf/centauro"):
        assert leg.joints[-1].startswith("j_wheel")
        assert leg.foot_radius == pytest.approx(0.124, abs=1e-3)
        assert leg.foot == pytest.approx(np.zeros(3), abs=1e-3)


def mjcf_leg(side: str, y: float) -> str:
    """Hip with three hinges in one body, knee, ankle with two, and two bars for a foot."""
    bars = "".join(
        f'<geom type="capsule" fromto="-0.05 {b} -0.06 0.15 {b} -0.06" size="0.02"/>'
        for b in (-0.03, 0.03)
    )
    return f"""
    <body name="{side}_thigh" pos="0 {y} -0.05">
      <joint name="{side}_roll" axis="1 0 0" range="-0.5 0.5"/>
      <joint name="{side}_yaw" axis="0 0 1" range="-1 1"/>
      <joint name="{side}_pitch" axis="0 1 0" range="-2 0.5"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.05"/>
      <body name="{side}_shank" pos="0 0 -0.4">
        <joint name="{side}_knee" axis="0 1 0" range="0 2.5"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.04"/>
        <body name="{side}_foot" pos="0 0 -0.4">
          <joint name="{side}_flex" axis="0 1 0" range="-1 1"/>
          <joint name="{side}_tilt" axis="1 0 0" range="-1 1"/>
          {bars}
        </body>
      </body>
    </body>"""


def mjcf_arm(side: str, y: float) -> str:
    return f"""
    <body name="{side}_arm" pos="0 {y} 0.2">
      <joint name="{side}_shoulder" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.03"/>
      <body name="{side}_hand" pos="0 0 -0.3">
        <joint name="{side}_elbow" axis="0 1 0" range="-2 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.03"/>
      </body>
    </body>"""


def test_a_humanoid_whose_root_is_its_chest(tmp_path):
    """MJCF humanoids start at the torso: the pelvis and the legs hang below it."""
    path = tmp_path / "humanoid.xml"
    path.write_text(
        f"""<mujoco model="humanoid"><compiler angle="radian"/><worldbody>
        <body name="torso" pos="0 0 1.3"><freejoint/>
          <geom type="box" size="0.1 0.2 0.2"/>
          {mjcf_arm("left", 0.25)}{mjcf_arm("right", -0.25)}
          <body name="pelvis" pos="0 0 -0.3"><joint name="waist" axis="0 0 1"/>
            <geom type="box" size="0.1 0.15 0.05"/>
            {mjcf_leg("left", 0.1)}{mjcf_leg("right", -0.1)}
          </body>
        </body></worldbody></mujoco>"""
    )
    humanoid = read_robot(path)
    assert (humanoid.trunk, humanoid.floating_base) == ("pelvis", "torso")
    assert [leg.name for leg in humanoid.legs] == ["left_foot", "right_foot"]
    hinges = ("roll", "yaw", "pitch", "knee", "flex", "tilt")
    assert humanoid.legs[0].joints == tuple(f"left_{hinge}" for hinge in hinges)
    # The centre of the sole: 0.05 m ahead of the ankle, 0.06 + 0.02 m below it.
    assert humanoid.legs[0].foot == pytest.approx([0.05, 0.0, -0.08], abs=1e-9)
    assert humanoid.standing_height == pytest.approx(0.05 + 0.8 * humanoid.legs[0].length, abs=1e-4)
    assert humanoid.posture["left_knee"] > 0.5
