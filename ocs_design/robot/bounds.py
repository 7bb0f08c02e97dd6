"""How far the robot's shapes extend."""

from collections.abc import Iterable, Mapping

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.files.mesh_bounds import mesh_bounds
from ocs_design.robot.tree import Body, Placement, Shape, ShapeKind, Tree

_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])


def extent(shape: Shape, direction: FloatArray) -> float | None:
    """How far a shape reaches along the unit vector `direction` of its body's frame [m].

    The support function of the solid, exact for primitives. A mesh counts as its bounding box in
    its own frame; None if its file is missing or cannot be read.
    """
    reach = _extent_in_own_frame(shape, shape.rotation.T @ direction)
    return None if reach is None else float(direction @ shape.position + reach)


def _extent_in_own_frame(shape: Shape, direction: FloatArray) -> float | None:
    size = shape.size
    match shape.kind:
        case ShapeKind.BOX:
            return float(np.abs(direction) @ np.array(size))
        case ShapeKind.SPHERE:
            return size[0]
        case ShapeKind.CYLINDER:
            return float(size[0] * np.hypot(*direction[:2]) + size[1] * abs(direction[2]))
        case ShapeKind.CAPSULE:
            return float(size[0] + size[1] * abs(direction[2]))
        case ShapeKind.MESH:
            return _mesh_extent(shape, direction)


def _mesh_extent(shape: Shape, direction: FloatArray) -> float | None:
    bounds = None if shape.mesh is None else mesh_bounds(shape.mesh, shape.size)
    if bounds is None:
        return None
    lower, upper = bounds
    return float((np.where(_CORNERS, upper, lower) @ direction).max())


def extent_of(shapes: Iterable[Shape], direction: FloatArray) -> float | None:
    """How far several shapes of a body reach along `direction` [m]; None if none is measurable."""
    reaches = [reach for shape in shapes if (reach := extent(shape, direction)) is not None]
    return max(reaches, default=None)


def solid_shapes(body: Body) -> tuple[Shape, ...]:
    """Collision shapes of a body that can be measured, else its visual ones."""
    up = np.array([0.0, 0.0, 1.0])
    for collides in (True, False):
        # Visual meshes are large: they are opened only where there is nothing else.
        shapes = [shape for shape in body.shapes if shape.collides is collides]
        known = tuple(shape for shape in shapes if extent(shape, up) is not None)
        if known:
            return known
    return ()


def reach_of_body(body: Body, direction: FloatArray) -> float:
    """How far a body reaches along `direction` of its frame [m].

    Without a shape that can be measured: the farthest of its link origins and its centre of mass.
    """
    reach = extent_of(solid_shapes(body), direction)
    if reach is not None:
        return reach
    points = [place.position for place in body.links.values()] + [body.mass_properties.com]
    return max(float(direction @ point) for point in points)


def trunk_top(tree: Tree, trunk: str) -> float:
    """Highest z in B of the trunk body's shapes, where the device stands [m].

    Without shapes: the height of the trunk body's centre of mass.
    """
    return trunk_extent(tree, trunk, np.array([0.0, 0.0, 1.0]))


def trunk_extent(tree: Tree, trunk: str, direction: FloatArray) -> float:
    """How far the trunk body's shapes reach along a unit vector of B [m].

    Without shapes: its centre of mass.
    """
    body = tree.bodies[tree.body_of_link[trunk]]
    base = body.links[trunk]
    along = base.rotation @ direction
    reach = extent_of(solid_shapes(body), along)
    farthest = float(along @ body.mass_properties.com) if reach is None else reach
    return farthest - float(along @ base.position)


def size(tree: Tree, posture: Mapping[str, float], trunk: str) -> float:
    """Longest side of the box along B's axes that holds the robot at `posture` [m]."""
    placements = tree.placements(posture)
    index = tree.body_of_link[trunk]
    to_base = (placements[index] @ tree.bodies[index].links[trunk]).inverse()
    seen = [to_base @ placement for placement in placements]
    return max(_farthest(tree, seen, axis) + _farthest(tree, seen, -axis) for axis in np.eye(3))


def _farthest(tree: Tree, placements: Iterable[Placement], direction: FloatArray) -> float:
    return max(
        float(direction @ place.position) + reach_of_body(body, place.rotation.T @ direction)
        for body, place in zip(tree.bodies, placements, strict=True)
    )
