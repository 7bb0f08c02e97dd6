"""A robot given by mass and inertia; MuJoCo weighs the box that stands for it."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mass_oracles import assert_same_mass_properties, mujoco_mass_properties

from ocs_design.common.errors import RobotError, UsageError
from ocs_design.common.frames import rotation_from_rpy
from ocs_design.robot.manual import (
    BACK,
    HEIGHT_OF_MASS,
    MID_TRUNK,
    PITCH_GYRATION,
    ROLL_GYRATION,
    YAW_GYRATION,
    person,
    robot_by_hand,
)
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.free_place import place_on_top

SOLO12 = (0.0300029, 0.0514912, 0.0680453)


def box_by_mujoco(robot):
    """Mass properties of the robot's box, which MuJoCo computes from shape and mass alone."""
    (shape,) = robot.tree.bodies[0].shapes
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="box")
    body.add_freejoint()
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, shape.rotation.flatten())
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=shape.size,
        pos=shape.position,
        quat=quaternion,
        mass=robot.mass,
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return mujoco_mass_properties(model, data)


def test_the_box_of_solo12():
    robot = robot_by_hand(2.5, SOLO12)
    (shape,) = robot.tree.bodies[0].shapes
    assert shape.rotation == pytest.approx(np.eye(3), abs=0.0)
    assert (robot.trunk, robot.floating_base, robot.source) == ("base", "base", "by hand")
    assert (robot.legs, robot.standing_height, dict(robot.posture)) == ((), None, {})
    assert robot.inertia == pytest.approx(np.diag(SOLO12))


@given(
    density=st.floats(10.0, 10_000.0),
    sides=st.tuples(*[st.floats(0.05, 2.0)] * 3),
    angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
)
def test_the_box_has_the_mass_properties_that_were_given(density, sides, angles):
    mass = density * np.prod(sides)
    a, b, c = (side * side for side in sides)
    rotation = rotation_from_rpy(*angles)
    inertia = rotation @ np.diag([b + c, a + c, a + b]) @ rotation.T * mass / 12.0
    upper = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    robot = robot_by_hand(mass, upper, com=(0.1, -0.2, 0.3))
    given = MassProperties(mass, [0.1, -0.2, 0.3], inertia)
    assert_same_mass_properties(box_by_mujoco(robot), given, 1e-9)
    assert sorted(robot.tree.bodies[0].shapes[0].size) == pytest.approx(
        np.sort(sides) / 2, rel=1e-6
    )


@pytest.mark.parametrize(
    ("mass", "inertia", "message"),
    [
        (2.5, (0.03, 0.05, 0.09), "triangle inequality (0.03 + 0.05 < 0.09"),
        (2.5, (-0.03, 0.05, 0.05), "negative principal moment -0.03"),
        (2.5, (0.03, 0.03, 0.03, 0.05, 0.0, 0.0), "negative principal moment -0.02"),
        (-1.0, SOLO12, "negative mass -1 kg"),
        (0.0, SOLO12, "no mass"),
        (2.5, (0.0, 0.05, 0.05), "principal moment is 0"),
        (float("nan"), SOLO12, "not finite"),
        (2.5, (float("inf"), 0.05, 0.05), "not finite"),
    ],
)
def test_unphysical_mass_properties_are_refused_with_their_values(mass, inertia, message):
    with pytest.raises(RobotError) as caught:
        robot_by_hand(mass, inertia)
    assert message in caught.value.message
    assert caught.value.hint


def test_an_inertia_has_three_or_six_numbers():
    with pytest.raises(UsageError, match="not 4"):
        robot_by_hand(2.5, (1.0, 1.0, 1.0, 0.0))
    with pytest.raises(UsageError, match="not 3 x 3"):
        robot_by_hand(2.5, np.diag(SOLO12))


def test_a_robot_denser_than_tungsten_is_refused_as_a_wrong_unit():
    """A ball of tungsten is accepted; Solo12 with its inertia divided by 10^6 is not."""
    radius = 0.01
    mass = 4.0 / 3.0 * np.pi * radius**3 * 19_299.0
    robot_by_hand(mass, [0.4 * mass * radius**2] * 3)
    with pytest.raises(RobotError, match="denser than a ball of tungsten") as caught:
        robot_by_hand(2.5, [1e-6 * moment for moment in SOLO12])
    assert "kg m^2" in caught.value.hint


MEASURED = [
    (72.2, 173.5, 3.62, 32.2, (132.0, 119.0, 13.1)),
    (67.4, 147.3, 3.50, 29.8, (95.6, 81.9, 10.3)),
    (73.3, 203.0, 3.81, 31.8, (144.0, 129.0, 14.2)),
]
"""Three adults standing: height [in], weight [lb], distances of the centre of mass from the
back and from the crown [in], inertia [lb in s^2] (guwsmedical.info/body-dynamics, table A.2.1)."""

INCH, POUND, LB_IN_S2 = 0.0254, 0.45359237, 0.112984829


@pytest.mark.parametrize(("height", "weight", "from_back", "from_crown", "moments"), MEASURED)
def test_a_person_has_the_inertia_that_was_measured(height, weight, from_back, from_crown, moments):
    adult = person(weight * POUND, height * INCH)
    assert np.diag(adult.inertia) / LB_IN_S2 == pytest.approx(moments, rel=0.095)
    assert adult.standing_height == pytest.approx((height - from_crown) * INCH, rel=0.013)
    assert BACK * height == pytest.approx(from_back, rel=0.025)


def test_gyration_radii_of_a_person_are_the_means_of_those_measured():
    squares = [np.array(i) * LB_IN_S2 / (w * POUND * (h * INCH) ** 2) for h, w, _, _, i in MEASURED]
    assert np.mean(squares, axis=0)[1:] == pytest.approx((PITCH_GYRATION, YAW_GYRATION), rel=5e-3)
    assert np.mean(squares, axis=0)[0] == pytest.approx(ROLL_GYRATION, rel=0.05)


def test_a_payload_is_a_second_body_on_the_back():
    alone, loaded = person(75.0, 1.75), person(75.0, 1.75, 10.0)
    point = np.array([-BACK, 0.0, MID_TRUNK - HEIGHT_OF_MASS]) * 1.75
    masses = ((alone, 75.0, alone.com), (None, 10.0, point))
    expected = alone.inertia.copy()
    for _, mass, position in masses:
        arm = position - loaded.com
        expected += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    np.testing.assert_allclose(loaded.com, 10.0 / 85.0 * point)
    np.testing.assert_allclose(loaded.inertia, expected)
    assert place_on_top(loaded)(0.1, 0.02)[:, 0].max() < -BACK * 1.75
