"""A limb's kinematics against the whole tree's, finite differences and brute force; frames."""

import numpy as np
import pytest
from anatomy import legs_of, tree_of
from hypothesis import given
from hypothesis import strategies as st
from urdf_text import inertial, joint, link, robot

from ocs_design.common.frames import Placement
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.robot.chain import chain_of, nearest_turn, neutral_posture
from ocs_design.robot.urdf import read_urdf

TALOS = "talos_data/robots/talos_reduced"
SOLO12 = "solo_description/robots/solo12"
A1 = "a1_description/urdf/a1"


def first_leg(name):
    tree, legs = tree_of(name), legs_of(name)
    placements = tree.placements(neutral_posture(tree))
    return tree, legs[0], chain_of(tree, legs[0].base, legs[0].body, placements)


def random_values(chain, seed):
    lower, upper = np.maximum(chain.lower, -2.0), np.minimum(chain.upper, 2.0)
    return np.random.default_rng(seed).uniform(lower, upper)


@pytest.mark.parametrize("name", [TALOS, SOLO12, A1])
@pytest.mark.parametrize("seed", range(3))
def test_pose_is_that_of_the_tree(name, seed):
    tree, leg, chain = first_leg(name)
    values = random_values(chain, seed)
    pose = chain.pose(values)
    place = tree.placements(dict(zip(chain.names, values, strict=True)))[leg.body]
    assert pose.end.position == pytest.approx(place.position, abs=1e-14)
    assert pose.end.rotation == pytest.approx(place.rotation, abs=1e-14)


@pytest.mark.parametrize("seed", range(3))
def test_jacobians_are_the_derivatives(seed):
    _, leg, chain = first_leg(TALOS)
    values, step = random_values(chain, seed), 1e-6
    pose = chain.pose(values)
    direction = np.array([0.0, 0.6, 0.8])
    points = chain.point_jacobian(pose, pose.point(leg.foot))
    directions = chain.direction_jacobian(pose, pose.end.rotation @ direction)
    for column in range(len(values)):
        ahead, behind = (
            chain.pose(values + sign * step * np.eye(len(values))[column]) for sign in (1, -1)
        )
        slope = (ahead.point(leg.foot) - behind.point(leg.foot)) / (2 * step)
        assert points[:, column] == pytest.approx(slope, abs=1e-8)
        rotation_rate = (ahead.end.rotation - behind.end.rotation) @ direction / (2 * step)
        assert directions[:, column] == pytest.approx(rotation_rate, abs=1e-8)


@pytest.mark.parametrize("name", [SOLO12, A1])
def test_stretched_reaches_as_deep_as_a_grid_over_all_joints(name):
    _, leg, chain = first_leg(name)
    down = np.array([0.0, 0.0, -1.0])
    depth = down @ chain.pose(chain.stretched(leg.foot, down)).point(leg.foot)
    ranges = [
        np.linspace(max(low, -np.pi), min(high, np.pi), 25)
        for low, high in zip(chain.lower, chain.upper, strict=True)
    ]
    grid = np.stack(np.meshgrid(*ranges), axis=-1).reshape(-1, len(ranges))
    best = max(down @ chain.pose(values).point(leg.foot) for values in grid[::3])
    assert depth >= best
    assert depth == pytest.approx(best, abs=0.02)


def test_a_mimic_moves_with_its_leader():
    mimic = '<mimic joint="a" multiplier="-2" offset="0.1"/>'
    hinge = '<axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/>'
    origin = '<origin xyz="0 0 -0.3"/>'
    tree = read_urdf(
        robot(
            *(link(name, inertial()) for name in ("trunk", "thigh", "shank")),
            joint("a", "trunk", "thigh", hinge),
            joint("b", "thigh", "shank", origin, hinge, mimic),
        ),
        find_mesh=lambda _: None,
    )
    chain = chain_of(tree, 0, 2, tree.placements({}))
    assert chain.names == ("a",)
    pose, place = chain.pose(np.array([0.4])), tree.placements({"a": 0.4})[2]
    assert pose.end.rotation == pytest.approx(place.rotation, abs=1e-15)
    tip, step = np.array([0.0, 0.0, -0.3]), 1e-6
    slope = (chain.pose(np.array([0.4 + step])).point(tip) - pose.point(tip)) / step
    assert chain.point_jacobian(pose, pose.point(tip))[:, 0] == pytest.approx(slope, abs=1e-5)


def random_placement(rng):
    return Placement(rotation_from_quaternion(rng.normal(size=4)), rng.normal(size=3))


def assert_same(one, other):
    np.testing.assert_allclose(one.rotation, other.rotation, atol=1e-13)
    np.testing.assert_allclose(one.position, other.position, atol=1e-12)


@given(st.integers(min_value=0, max_value=2**32 - 1))
def test_placements_are_a_group(seed):
    rng = np.random.default_rng(seed)
    a, b, c = (random_placement(rng) for _ in range(3))
    assert_same(a @ a.inverse(), Placement.identity())
    assert_same(a @ Placement.identity(), a)
    assert_same((a @ b) @ c, a @ (b @ c))
    assert_same((a @ b).inverse(), b.inverse() @ a.inverse())
    np.testing.assert_allclose((a @ b).point(c.position), a.point(b.point(c.position)), atol=1e-12)


def test_missing_joints_stand_at_zero_and_unknown_ones_are_ignored():
    tree = tree_of(SOLO12)
    assert set(tree.complete({"nobody": 1.0})) == set(tree.joints)
    assert set(tree.complete({}).values()) == {0.0}


@given(angle=st.floats(-20.0, 20.0), middle=st.floats(-4.0, 4.0), half=st.floats(0.1, 3.0))
def test_nearest_turn_is_the_best_cosine_within_the_limits(angle, middle, half):
    nearest = nearest_turn(angle, middle - half, middle + half)
    assert middle - half <= nearest <= middle + half
    grid = np.linspace(middle - half, middle + half, 201)
    assert np.cos(nearest - angle) >= np.cos(grid - angle).max() - 1e-9
