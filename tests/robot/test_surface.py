"""Heights of a trunk over a grid: of primitives in closed form, of meshes as of their triangles."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import ROBOTS, SOLO12

from ocs_design.robot.meshes import trunk_top
from ocs_design.robot.reader import read_robot
from ocs_design.robot.surface import STEP, surface_of, triangles_of, trunk_surface
from ocs_design.robot.tree import Shape, ShapeKind

SQUARE = np.array(
    [[[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.1, 0.1, 2.0]], [[0, 0, 1], [0.1, 0.1, 2], [0, 0.1, 2]]]
)


def shape(kind, size, rotation=None):
    turn = np.eye(3) if rotation is None else rotation
    return Shape(kind, size, np.zeros(3), turn, "trunk", collides=True)


def spread(limit, count=41):
    x, y = np.meshgrid(*2 * [np.linspace(-limit, limit, count)])
    return x.ravel(), y.ravel()


def test_a_slope_is_as_high_as_its_plane():
    surface = surface_of(SQUARE)
    x, y = (each.ravel() for each in np.meshgrid(*2 * [np.arange(0.005, 0.1, 0.01)]))
    np.testing.assert_allclose(surface.height(x, y), 1.0 + y / 0.1, atol=10.0 * STEP)
    assert (surface.height(x + 0.2, y) == -np.inf).all()


def test_of_two_the_higher_counts():
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
    x, y = spread(0.06)
    np.testing.assert_allclose(surface.height(x, y), height(x, y), atol=1.5e-3)


def test_a_cylinder_that_lies():
    """z = sqrt(r^2 - y^2) over its whole length."""
    across = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    surface = surface_of(triangles_of(shape(ShapeKind.CYLINDER, (0.1, 0.2), across)))
    x, y = spread(0.08)
    np.testing.assert_allclose(surface.height(2.0 * x, y), np.sqrt(0.01 - y**2), atol=1.5e-3)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.02, 0.3), st.floats(0.02, 0.3))
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
