"""Heights and extents of shapes: closed forms of primitives, triangles of meshes."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from anatomy import tree_of
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import ROBOTS, SOLO12

from ocs_design.common.frames import rotation_from_rpy
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.meshes import extent, longest_side, trunk_top
from ocs_design.robot.reader import read_robot
from ocs_design.robot.surface import STEP, surface_of, triangles_of, trunk_surface
from ocs_design.robot.tree import Shape, ShapeKind

SQUARE = np.array(
    [[[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.1, 0.1, 2.0]], [[0, 0, 1], [0.1, 0.1, 2], [0, 0.1, 2]]]
)


def shape(kind, size, rotation=None):
    rotation = np.eye(3) if rotation is None else rotation
    return Shape(kind, size, np.zeros(3), rotation, "trunk", collides=True)


def grid(limit, count=41):
    x, y = np.meshgrid(*2 * [np.linspace(-limit, limit, count)])
    return x.ravel(), y.ravel()


def test_a_slope_is_as_high_as_its_plane():
    surface = surface_of(SQUARE)
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(0.005, 0.1, 0.01)]))
    np.testing.assert_allclose(surface.height(x, y), 1.0 + y / 0.1, atol=10.0 * STEP)
    assert (surface.height(x + 0.2, y) == -np.inf).all()


def test_the_higher_of_two_surfaces_counts():
    low = SQUARE - [0.0, 0.0, 5.0]
    both, alone = surface_of(np.concatenate([SQUARE, low])), surface_of(SQUARE)
    np.testing.assert_array_equal(both.heights, alone.heights)


@pytest.mark.parametrize(
    ("kind", "size", "height"),
    [
        (ShapeKind.SPHERE, (0.1,), lambda x, y: np.sqrt(0.01 - x**2 - y**2)),
        (ShapeKind.BOX, (0.1, 0.1, 0.03), lambda x, y: 0.03 + 0.0 * x),
        (ShapeKind.CYLINDER, (0.1, 0.02), lambda x, y: 0.02 + 0.0 * x),
        (ShapeKind.CAPSULE, (0.1, 0.05), lambda x, y: 0.05 + np.sqrt(0.01 - x**2 - y**2)),
    ],
)
def test_primitives(kind, size, height):
    surface = surface_of(triangles_of(shape(kind, size)))
    x, y = grid(0.06)
    np.testing.assert_allclose(surface.height(x, y), height(x, y), atol=1.5e-3)


def test_a_lying_cylinder():
    """z = sqrt(r^2 - y^2) over its whole length."""
    across = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    surface = surface_of(triangles_of(shape(ShapeKind.CYLINDER, (0.1, 0.2), across)))
    x, y = grid(0.08)
    np.testing.assert_allclose(surface.height(2.0 * x, y), np.sqrt(0.01 - y**2), atol=1.5e-3)


@pytest.mark.parametrize(("half_x", "half_y"), [(0.02, 0.2), (0.1, 0.033)])
def test_a_box_covers_its_area(half_x, half_y):
    surface = surface_of(triangles_of(shape(ShapeKind.BOX, (half_x, half_y, 0.01))))
    covered = np.isfinite(surface.heights).sum() * surface.step**2
    assert covered == pytest.approx(4.0 * half_x * half_y, rel=2.0 * STEP / min(half_x, half_y))


@pytest.mark.parametrize("name", ["solo_description/robots/solo12", "bolt_description/robots/bolt"])
def test_the_highest_point_is_the_trunks_top(name):
    robot = read_robot(ROBOTS / f"{name}.urdf")
    top = trunk_surface(robot).heights.max()
    assert top == pytest.approx(trunk_top(robot.tree, robot.trunk), abs=1e-4)


def test_a_trunk_without_shapes_has_no_surface():
    robot = read_robot(SOLO12)
    bodies = tuple(replace(body, shapes=()) for body in robot.tree.bodies)
    assert trunk_surface(replace(robot, tree=replace(robot.tree, bodies=bodies))) is None


LENGTH = st.floats(0.05, 1.0)


def solid(kind, measures):
    """Sizes of a solid, and the same solid by trimesh, finely meshed."""
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
    rotation, position = rotation_from_rpy(*angles), np.array([0.3, -0.2, 0.1])
    direction = np.array(towards) / np.linalg.norm(towards)
    shape = Shape(kind, sizes, position, rotation, "link", collides=True)
    points = mesh.vertices - (mesh.bounds.mean(axis=0) if kind is ShapeKind.CAPSULE else 0.0)
    farthest = ((points @ rotation.T + position) @ direction).max()
    assert extent(shape, direction) == pytest.approx(farthest, abs=2e-3 * max(sizes))


def test_a_mesh_that_is_not_there_has_no_extent():
    shape = Shape(ShapeKind.MESH, (1.0, 1.0, 1.0), np.zeros(3), np.eye(3), "link", True, None)
    assert extent(shape, np.array([0.0, 0.0, 1.0])) is None


def test_trunk_top_of_solo12_is_the_top_of_its_mesh():
    (shape,) = (s for s in tree_of("solo_description/robots/solo12").bodies[0].shapes if s.collides)
    top = trimesh.load_mesh(shape.mesh).bounds[1, 2]
    assert trunk_top(tree_of("solo_description/robots/solo12"), "base_link") == pytest.approx(
        top, abs=1e-6
    )


def test_trunk_top_without_shapes_is_the_centre_of_mass():
    tree = tree_of("simple_humanoid_description/urdf/simple_humanoid")
    assert (
        trunk_top(tree, "torso") == tree.bodies[tree.body_of_link["torso"]].mass_properties.com[2]
    )


def test_a_box_by_hand_is_as_large_as_its_longest_side():
    """Sides 0.4, 0.2, 0.1 m of 12 kg."""
    robot = robot_by_hand(12.0, (0.05, 0.17, 0.20))
    assert longest_side(robot.tree, {}, "base") == pytest.approx(0.4)
    assert trunk_top(robot.tree, "base") == pytest.approx(0.05)
