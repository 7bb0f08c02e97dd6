"""How Solo12's inertia moves with its posture, against the figures of the theory."""

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


def ratio(weighed):
    return weighed.inertia[0, 0] / weighed.inertia[1, 1]


def test_the_ratio_spans_what_the_theory_says(rows):
    """Of alpha* (docs/theory.md): it rises with abduction; 40 degrees belong to 0.75 to 1 rad."""
    spread = [ratio(rows[f"legs spread by {angle} rad"]) for angle in ("0.25", "0.5", "0.75", "1")]
    assert (np.diff(spread) > 0.0).all()
    assert spread[2] < np.tan(np.radians(40.0)) < spread[3]
    assert min(map(ratio, rows.values())) > 0.44
    assert max(map(ratio, rows.values())) < 0.89


def test_lower_stands_weigh_less_about_every_axis(rows):
    traces = [np.trace(rows[f"stand at {share}% of the leg"].inertia) for share in (60, 70, 80, 90)]
    assert (np.diff(traces) > 0.0).all()


def test_named_postures_are_those_that_can_be_asked_for():
    """A1's knees cannot be straight: what does not name them leaves them at their limit."""
    robot = read_robot(ROBOTS / "a1_description/urdf/a1.urdf")
    named = {"sit": {"FL_thigh_joint": 1.0}, "zero": {"FL_thigh_joint": 0.5}}
    robot = replace(robot, tree=replace(robot.tree, named_postures=named))
    rows = posture_sensitivity(robot)
    asked = {
        name: resolve_posture(robot.tree, robot.trunk, robot.legs, name, {}).values
        for name in named
    }
    assert asked["sit"]["FR_calf_joint"] < -0.9
    assert not any(asked["zero"].values())
    for name, values in asked.items():
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
