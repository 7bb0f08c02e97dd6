"""How Solo12's inertia changes with its posture, against the figures of the theory."""

from dataclasses import replace

import numpy as np
import pytest
from robots import ROBOTS, SOLO12

from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.posture import posture_sensitivity, resolve_posture
from ocs_design.robot.reader import read_robot


@pytest.fixture(scope="module")
def rows():
    return posture_sensitivity(read_robot(SOLO12))


def roll_to_pitch(mass_properties):
    return mass_properties.inertia[0, 0] / mass_properties.inertia[1, 1]


def test_the_ratio_spans_the_range_of_the_theory(rows):
    """tan alpha* (docs/theory.md) rises with abduction; 40 degrees belong to 0.75 to 1 rad."""
    angles = ("0.25", "0.5", "0.75", "1")
    ratios = [roll_to_pitch(rows[f"legs spread by {angle} rad"]) for angle in angles]
    assert (np.diff(ratios) > 0.0).all()
    assert ratios[2] < np.tan(np.radians(40.0)) < ratios[3]
    assert min(map(roll_to_pitch, rows.values())) > 0.44
    assert max(map(roll_to_pitch, rows.values())) < 0.89


def test_lower_stands_have_less_inertia(rows):
    traces = [np.trace(rows[f"stand at {share}% of the leg"].inertia) for share in (60, 70, 80, 90)]
    assert (np.diff(traces) > 0.0).all()


def test_named_postures_are_those_of_the_option():
    """A1's knees cannot be straight: a posture that does not name them leaves them at the limit."""
    robot = read_robot(ROBOTS / "a1_description/urdf/a1.urdf")
    named = {"sit": {"FL_thigh_joint": 1.0}, "zero": {"FL_thigh_joint": 0.5}}
    robot = replace(robot, tree=replace(robot.tree, named_postures=named))
    rows = posture_sensitivity(robot)
    postures = {
        name: resolve_posture(robot.tree, robot.trunk, robot.legs, name, {}).values
        for name in named
    }
    assert postures["sit"]["FR_calf_joint"] < -0.9
    assert not any(postures["zero"].values())
    for name, values in postures.items():
        expected = robot.tree.locked_mass_properties(values, robot.trunk)
        np.testing.assert_allclose(rows[name].inertia, expected.inertia, rtol=1e-12)
        np.testing.assert_allclose(rows[name].com, expected.com, rtol=1e-12, atol=1e-15)


def test_postures_beyond_the_limits_are_left_out():
    """Talos cannot spread its legs by more than 0.5 rad."""
    robot = read_robot(ROBOTS / "talos_data/robots/talos_reduced.urdf")
    labels = posture_sensitivity(robot)
    assert "legs spread by 0.5 rad" in labels
    assert "legs spread by 0.75 rad" not in labels
    assert robot.tree.joints["leg_left_2_joint"].upper < 0.75


def test_a_robot_without_joints_has_one_inertia():
    rows = posture_sensitivity(robot_by_hand(2.0, (0.02, 0.03, 0.04)))
    assert all(np.diag(row.inertia) == pytest.approx([0.02, 0.03, 0.04]) for row in rows.values())
