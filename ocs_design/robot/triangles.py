"""Triangles of a robot's shapes: of the meshes in their files, and around primitives.

What is seen counts, for screws go into what is there; collision shapes only stand in for it.
"""

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.robot.meshes import binary_stl_facets, check_mesh_file, load_with_trimesh
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Shape, ShapeKind

MOST_BYTES = 16 << 20
"""Sum of the meshes that are read to look at a trunk: a .dae takes 0.1 s a MB."""

_ROUND = 96
"""Corners of a circle."""


def trunk_triangles(robot: Robot) -> FloatArray | None:
    """Triangles of the trunk's shapes in B [m], shape (n, 3, 3)."""
    body = robot.tree.bodies[robot.tree.body_of_link[robot.trunk]]
    base = body.links[robot.trunk]
    for collides in (False, True):
        shapes = [shape for shape in body.shapes if shape.collides is collides]
        paths = {shape.mesh for shape in shapes if shape.mesh is not None}
        if sum(path.stat().st_size for path in paths) > MOST_BYTES:
            continue
        found = [triangles for shape in shapes if (triangles := triangles_of(shape)) is not None]
        if found:
            points = np.concatenate(found)
            return frozen((points - base.position) @ base.rotation)
    return None


def triangles_of(shape: Shape) -> FloatArray | None:
    """Triangles of a shape in its body's frame [m], shape (n, 3, 3); None if it cannot be read."""
    if shape.kind is ShapeKind.MESH:
        own = None if shape.mesh is None else _mesh_triangles(shape.mesh)
        if own is None or not len(own):
            return None
        own = own * np.asarray(shape.size)
    else:
        own = _primitive_triangles(shape.kind, shape.size)
    return np.asarray(own @ shape.rotation.T + shape.position)


def _mesh_triangles(path: Path) -> FloatArray | None:
    """Triangles of a mesh's file, shape (n, 3, 3)."""
    try:
        check_mesh_file(path)
        count = binary_stl_facets(path)
        if count:
            facet = np.dtype([("n", "<f4", 3), ("corners", "<f4", (3, 3)), ("a", "<u2")])
            facets = np.frombuffer(path.read_bytes(), facet, count, offset=84)
            found = np.asarray(facets["corners"], dtype=np.float64)
        else:
            found = np.array(load_with_trimesh(path).triangles, dtype=np.float64)
    except Exception:  # A mesh reader fails in as many ways as there are broken meshes.
        return None
    return found if np.isfinite(found).all() else None


def _primitive_triangles(kind: ShapeKind, size: tuple[float, ...]) -> FloatArray:
    """Triangles around a primitive in its own frame, round ones as prisms of many corners."""
    if kind is ShapeKind.BOX:
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
        return np.array(list(_hull_faces(corners * np.array(size))))
    angles = np.linspace(0.0, 2.0 * np.pi, _ROUND, endpoint=False)
    radius, half = size[0], 0.0 if kind is ShapeKind.SPHERE else size[1]
    if kind is ShapeKind.CYLINDER:
        profile = np.array([[0.0, -half], [radius, -half], [radius, half], [0.0, half]])
    else:
        arc = np.linspace(-np.pi / 2.0, np.pi / 2.0, _ROUND // 2 + 1)
        profile = radius * np.stack([np.cos(arc), np.sin(arc)], axis=1)
        profile[:, 1] += np.where(np.arange(len(arc)) > len(arc) // 2, half, -half)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate(
        [
            profile[:, :1, None] * ring[None],
            np.broadcast_to(profile[:, 1:, None], (len(profile), _ROUND, 1)),
        ],
        axis=2,
    )
    low, high = points[:-1], points[1:]
    after_low, after_high = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    first = np.stack([low, after_low, high], axis=2).reshape(-1, 3, 3)
    second = np.stack([after_low, after_high, high], axis=2).reshape(-1, 3, 3)
    return np.concatenate([first, second])


def _hull_faces(corners: FloatArray) -> Iterator[FloatArray]:
    """Two triangles for each side of a box, of its eight corners."""
    for axis in range(3):
        for side in (corners[:, axis].min(), corners[:, axis].max()):
            face = corners[corners[:, axis] == side]
            yield from (face[list(three)] for three in combinations(range(4), 3))
