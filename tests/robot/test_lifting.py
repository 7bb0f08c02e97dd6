"""Feet that are lifted, against the tree's own kinematics."""

import numpy as np
import pytest
from robots import SOLO12

from ocs_design.robot.leg_geometry import leg_geometries
from ocs_design.robot.reader import read_robot
from ocs_design.robot.stance import lifted

HEIGHTS = np.array([0.0, 0.02, 0.04, -0.02])


@pytest.fixture(scope="module")
def robot():
    return read_robot(SOLO12)


@pytest.fixture(scope="module", params=range(4))
def leg(robot, request):
    return leg_geometries(robot.tree, robot.trunk, robot.legs)[request.param]


def posture_of(robot, leg):
    return np.array([robot.posture[name] for name in leg.chain.names])


def test_a_foot_goes_straight_up_and_down_in_the_whole_robot(robot, leg):
    found = lifted(leg.chain, leg.leg.foot, leg.leg.length, posture_of(robot, leg), HEIGHTS)
    feet = []
    for values in found:
        posture = {**robot.posture, **dict(zip(leg.chain.names, values, strict=True))}
        shank = robot.tree.placements_from(robot.trunk, posture)[leg.leg.body]
        feet.append(shank.rotation @ leg.leg.foot + shank.position)
    moved = np.array(feet) - feet[0]
    np.testing.assert_allclose(moved[:, :2], 0.0, atol=1e-9)
    np.testing.assert_allclose(moved[:, 2], HEIGHTS, atol=1e-9)


def test_what_is_out_of_reach_stays_within_the_limits(robot, leg):
    far = np.array([-2.0 * leg.leg.length])
    (values,) = lifted(leg.chain, leg.leg.foot, leg.leg.length, posture_of(robot, leg), far)
    assert np.all((values >= leg.chain.lower) & (values <= leg.chain.upper))
    assert np.isfinite(values).all()
