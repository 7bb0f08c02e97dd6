import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from robots import SOLO12

from ocs_design.common.frames import Placement, rotation_from_quaternion
from ocs_design.robot.urdf import read_urdf

TREE = read_urdf(SOLO12.read_bytes(), find_mesh=lambda _: None)
seeds = st.integers(min_value=0, max_value=2**32 - 1)


def random_placement(rng: np.random.Generator) -> Placement:
    return Placement(rotation_from_quaternion(rng.normal(size=4)), rng.normal(size=3))


def assert_same(a: Placement, b: Placement) -> None:
    np.testing.assert_allclose(a.rotation, b.rotation, atol=1e-13)
    np.testing.assert_allclose(a.position, b.position, atol=1e-12)


@given(seeds)
def test_placements_are_a_group(seed):
    rng = np.random.default_rng(seed)
    a, b, c = (random_placement(rng) for _ in range(3))
    assert_same(a @ a.inverse(), Placement.identity())
    assert_same(a @ Placement.identity(), a)
    assert_same((a @ b) @ c, a @ (b @ c))
    assert_same((a @ b).inverse(), b.inverse() @ a.inverse())


def test_missing_joints_stand_at_zero_and_unknown_ones_are_ignored():
    assert set(TREE.complete({"nobody": 1.0})) == set(TREE.joints)
    assert set(TREE.complete({}).values()) == {0.0}
