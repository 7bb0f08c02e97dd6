import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import SOLO12

from ocs_design.common.frames import Placement, rotation_from_quaternion
from ocs_design.robot.tree import Joint, JointKind, joint_motion
from ocs_design.robot.urdf import read_urdf

TREE = read_urdf(SOLO12.read_bytes(), find_mesh=lambda _: None)
seeds = st.integers(min_value=0, max_value=2**32 - 1)


def random_placement(rng: np.random.Generator) -> Placement:
    return Placement(rotation_from_quaternion(rng.normal(size=4)), rng.normal(size=3))


def random_posture(rng: np.random.Generator) -> dict[str, float]:
    return {name: rng.uniform(-3, 3) for name in TREE.joints}


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


@given(seeds)
def test_motions_of_one_joint_add_up(seed):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    first, second = rng.uniform(-4, 4, 2)
    for kind in JointKind:
        joint = Joint("j", kind, axis / np.linalg.norm(axis))
        together = joint_motion(joint, first) @ joint_motion(joint, second)
        assert_same(together, joint_motion(joint, first + second))


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_principal_moments_are_the_same_seen_from_every_link(seed):
    posture = random_posture(np.random.default_rng(seed))
    seen = [TREE.locked_mass_properties(posture, link) for link in TREE.body_of_link]
    moments = [np.linalg.eigvalsh(each.inertia) for each in seen]
    np.testing.assert_allclose(moments, np.broadcast_to(moments[0], np.shape(moments)), rtol=1e-12)


def test_missing_joints_stand_at_zero_and_unknown_ones_are_ignored():
    assert set(TREE.complete({"nobody": 1.0})) == set(TREE.joints)
    assert set(TREE.complete({}).values()) == {0.0}
