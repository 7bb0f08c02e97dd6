"""How far shapes reach, against points on their surface and trimesh's primitives."""

import numpy as np
import pytest
import trimesh
from anatomy import stand_of, tree_of
from hypothesis import given, settings
from hypothesis import strategies as st

from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.meshes import extent, size, trunk_top
from ocs_design.robot.rotations import rotation_from_rpy
from ocs_design.robot.tree import Shape, ShapeKind

SOLO12 = "solo_description/robots/solo12"
LENGTH = st.floats(0.05, 1.0)


def solid(kind, measures):
    """The same solid by trimesh, finely meshed."""
    a, b, c = measures
    if kind is ShapeKind.BOX:
        return (a, b, c), trimesh.creation.box(extents=(2 * a, 2 * b, 2 * c))
    if kind is ShapeKind.SPHERE:
        return (a,), trimesh.creation.icosphere(subdivisions=4, radius=a)
    if kind is ShapeKind.CYLINDER:
        return (a, b), trimesh.creation.cylinder(radius=a, height=2 * b, sections=256)
    return (a, b), trimesh.creation.capsule(radius=a, height=2 * b, count=[128, 128])


@settings(max_examples=25)
@pytest.mark.parametrize(
    "kind", [ShapeKind.BOX, ShapeKind.SPHERE, ShapeKind.CYLINDER, ShapeKind.CAPSULE]
)
@given(
    measures=st.tuples(LENGTH, LENGTH, LENGTH),
    angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    towards=st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1),
)
def test_extent_is_that_of_the_farthest_point(kind, measures, angles, towards):
    sizes, mesh = solid(kind, measures)
    turn, place = rotation_from_rpy(*angles), np.array([0.3, -0.2, 0.1])
    direction = np.array(towards) / np.linalg.norm(towards)
    shape = Shape(kind, sizes, place, turn, "link", collides=True)
    points = mesh.vertices - (mesh.bounds.mean(axis=0) if kind is ShapeKind.CAPSULE else 0.0)
    farthest = ((points @ turn.T + place) @ direction).max()
    assert extent(shape, direction) == pytest.approx(farthest, abs=2e-3 * max(sizes))


def test_a_mesh_that_is_not_there_has_no_extent():
    shape = Shape(ShapeKind.MESH, (1.0, 1.0, 1.0), np.zeros(3), np.eye(3), "link", True, None)
    assert extent(shape, np.array([0.0, 0.0, 1.0])) is None


def test_trunk_top_of_solo12_is_the_top_of_its_mesh():
    (shape,) = (s for s in tree_of(SOLO12).bodies[0].shapes if s.collides)
    top = trimesh.load_mesh(shape.mesh).bounds[1, 2]
    assert trunk_top(tree_of(SOLO12), "base_link") == pytest.approx(top, abs=1e-6)


def test_trunk_top_without_shapes_is_the_centre_of_mass():
    tree = tree_of("simple_humanoid_description/urdf/simple_humanoid")
    assert (
        trunk_top(tree, "torso") == tree.bodies[tree.body_of_link["torso"]].mass_properties.com[2]
    )


def test_a_box_by_hand_is_as_large_as_its_longest_side():
    """Sides 0.4, 0.2, 0.1 m of 12 kg."""
    robot = robot_by_hand(12.0, (0.05, 0.17, 0.20))
    assert size(robot.tree, {}, "base") == pytest.approx(0.4)
    assert trunk_top(robot.tree, "base") == pytest.approx(0.05)


def test_solo12_is_less_than_half_a_metre_long():
    assert 0.40 < size(tree_of(SOLO12), stand_of(SOLO12).posture, "base_link") < 0.50
