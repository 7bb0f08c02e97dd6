"""Height maps of a trunk's upper surface and of its back, as far as its shapes are known.

They are made from the triangles of its shapes: of mesh files, and around primitives. Visual shapes
are used, because screws go into the real surface; collision shapes are only a substitute.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.common.frames import BACKWARDS
from ocs_design.robot.meshes import (
    binary_stl_corners,
    binary_stl_facets,
    check_mesh_file,
    load_with_trimesh,
)
from ocs_design.robot.robot import Robot, RobotFormat
from ocs_design.robot.tree import Shape, ShapeKind

STEP = 1e-3
"""Least distance between two places of a map [m]."""

MOST_STEPS = 800
"""Most steps of a map along its longer side."""

_CHUNK = 1 << 16
"""Pairs of triangle and place per chunk: few enough for the cache."""

_WINDOW = 1 << 9
"""Most places under a triangle that is handled together with others."""

MOST_BYTES = 16 << 20
"""Largest total size of the meshes that are read for a trunk [bytes]: a .dae takes 0.1 s per MB."""

_ROUND = 96
"""Corners of the polygon that stands for a circle."""


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Height of the highest point over each place of a grid.

    Attributes:
        x, y: of the first place in B [m].
        step: between places [m].
        heights: z in B, -inf where there is no surface [m], shape (m, n).
    """

    x: float
    y: float
    step: float
    heights: FloatArray

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights at places in B [m], from the nearest place of the grid."""
        rows, columns = self._bordered.shape
        i, j = (
            np.clip(np.rint((of - start) / self.step) + 1.0, 0.0, count - 1).astype(np.intp)
            for of, start, count in ((x, self.x, rows), (y, self.y, columns))
        )
        return np.asarray(self._bordered.ravel()[i * columns + j])

    def between(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights at places in B [m], interpolated between four places; nan: one has no surface."""
        rows, columns = self._bordered.shape
        (i, u), (j, v) = (
            (np.clip(np.floor(at), 0.0, count - 2.0).astype(np.intp), at - np.floor(at))
            for of, start, count in ((x, self.x, rows), (y, self.y, columns))
            for at in (np.clip((of - start) / self.step + 1.0, 0.0, count - 1.0),)
        )
        known = np.where(np.isfinite(self._bordered), self._bordered, np.nan)
        near, far = (known[i + side, j] * (1.0 - v) + known[i + side, j + 1] * v for side in (0, 1))
        return np.asarray(near * (1.0 - u) + far * u)

    @cached_property
    def _bordered(self) -> FloatArray:
        """The heights with a border of places without a surface [m]."""
        return frozen(np.pad(self.heights, 1, constant_values=-np.inf))

    def farthest(self, low: float, high: float, aside: float) -> float:
        """Largest height for x from `low` to `high` and |y| up to `aside` [m]; -inf: no surface."""
        (first, last), (right, left) = (
            np.rint((np.array(ends) - start) / self.step).astype(np.int64)
            for ends, start in (((low, high), self.x), ((-aside, aside), self.y))
        )
        cut = self.heights[max(0, first) : max(0, last + 1), max(0, right) : max(0, left + 1)]
        return float(cut.max(initial=-np.inf))

    @property
    def x_range(self) -> tuple[float, float]:
        """First and last x of the surface [m]."""
        return self.x, self.x + self.step * (len(self.heights) - 1)


@lru_cache(maxsize=1)
def trunk_surface(robot: Robot) -> HeightMap | None:
    """Upper surface of the trunk and everything fixed to it; None if its shapes are not known.

    Visual shapes are used; if none of them can be read, collision shapes.
    """
    triangles = trunk_triangles(robot)
    return None if triangles is None else surface_of(triangles)


@lru_cache(maxsize=1)
def trunk_back(robot: Robot) -> HeightMap | None:
    """Surface of the trunk's back, x up and z backwards; None if its shapes are not known."""
    triangles = trunk_triangles(robot)
    return None if triangles is None else surface_of(triangles @ BACKWARDS)


def surface_of(triangles: FloatArray) -> HeightMap:
    """Map of the highest point of any triangle over each place of a grid.

    Args:
        triangles: corners in B [m], shape (n, 3, 3).
    """
    flat = triangles[..., :2]
    low, high = flat.reshape(-1, 2).min(axis=0), flat.reshape(-1, 2).max(axis=0)
    step = max(STEP, float((high - low).max()) / MOST_STEPS)
    # Half a step off the edge, so that the first place is not on it.
    origin = low + step / 2.0
    shape = np.maximum(1, np.ceil((high - low) / step).astype(np.int64))
    heights = np.full(shape, -np.inf)
    first = np.ceil((flat.min(axis=1) - origin) / step - 1e-9).astype(np.int64)
    last = np.floor((flat.max(axis=1) - origin) / step + 1e-9).astype(np.int64)
    first, last = np.maximum(first, 0), np.minimum(last, shape - 1)
    count = np.maximum(last - first + 1, 0)
    pairs = count.prod(axis=1)
    # Small triangles together, one row per pair of triangle and place; large ones one by one.
    large = pairs > _WINDOW
    order = np.argsort(pairs, kind="stable")
    order = order[(pairs[order] > 0) & ~large[order]]
    batches = np.cumsum(pairs[order]) // _CHUNK
    for batch in np.unique(batches):
        rows = order[batches == batch]
        counts = pairs[rows]
        owner = np.repeat(rows, counts)
        within = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        i = first[owner, 0] + within // count[owner, 1]
        j = first[owner, 1] + within % count[owner, 1]
        x, y = origin[:, None] + step * np.stack([i, j])
        z = _heights_on(triangles[owner].transpose(1, 2, 0), x, y)
        np.maximum.at(heights.reshape(-1), i * shape[1] + j, z)
    for row in np.flatnonzero(large):
        i, j = (np.arange(low, high + 1) for low, high in zip(first[row], last[row], strict=True))
        window = heights[i[0] : i[-1] + 1, j[0] : j[-1] + 1]
        x, y = origin[0] + step * i[:, None], origin[1] + step * j
        np.maximum(window, _heights_on(triangles[row], x, y), out=window)
    return HeightMap(float(origin[0]), float(origin[1]), step, frozen(heights))


def _heights_on(corners: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Heights of triangles at places [m], -inf outside a triangle.

    Args:
        corners: of one, shape (3, 3), or of one for each place, shape (3, 3, n).
        x, y: of the places, shapes that broadcast.
    """
    a, b, c = corners
    one, two = b - a, c - a
    to_x, to_y = x - a[0], y - a[1]
    area = one[0] * two[1] - one[1] * two[0]
    # Triangles seen edge-on have no inside; their neighbours include their edges.
    solid = np.abs(area) > 1e-16
    area = np.where(solid, area, 1.0)
    u = (to_x * two[1] - to_y * two[0]) / area
    v = (one[0] * to_y - one[1] * to_x) / area
    inside = solid & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9)
    return np.where(inside, a[2] + u * one[2] + v * two[2], -np.inf)


def trunk_triangles(robot: Robot) -> FloatArray | None:
    """Triangles of the trunk's shapes in B [m], shape (n, 3, 3); None if they are not known."""
    # The box of a robot given by hand only represents its inertia.
    if robot.format is RobotFormat.MANUAL:
        return None
    body = robot.tree.bodies[robot.tree.body_of_link[robot.trunk]]
    base = body.links[robot.trunk]
    for collides in (False, True):
        shapes = [shape for shape in body.shapes if shape.collides is collides]
        paths = {shape.mesh for shape in shapes if shape.mesh is not None}
        if sum(path.stat().st_size for path in paths) > MOST_BYTES:
            continue
        triangle_lists = [
            triangles for shape in shapes if (triangles := triangles_of(shape)) is not None
        ]
        if triangle_lists:
            points = np.concatenate(triangle_lists)
            return frozen((points - base.position) @ base.rotation)
    return None


def triangles_of(shape: Shape) -> FloatArray | None:
    """Triangles of a shape in its body's frame [m], shape (n, 3, 3); None if it cannot be read."""
    if shape.kind is ShapeKind.MESH:
        if shape.mesh is None:
            return None
        try:
            check_mesh_file(shape.mesh)
            is_plain = binary_stl_facets(shape.mesh) > 0
            read = (
                binary_stl_corners(shape.mesh)
                if is_plain
                else load_with_trimesh(shape.mesh).triangles
            )
            local = np.array(read, dtype=np.float64)
        except Exception:  # A mesh reader fails in as many ways as there are broken meshes.
            return None
        if not (len(local) and np.isfinite(local).all()):
            return None
        local = local * np.asarray(shape.size)
    else:
        local = _primitive_triangles(shape.kind, shape.size)
    return np.asarray(local @ shape.rotation.T + shape.position)


def _primitive_triangles(kind: ShapeKind, size: tuple[float, ...]) -> FloatArray:
    """Triangles around a primitive in its own frame; round ones become polygonal prisms."""
    if kind is ShapeKind.BOX:
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
        # Two triangles for each side and each of its diagonals.
        sides = [corners[corners[:, axis] == end] for axis in range(3) for end in (-1.0, 1.0)]
        threes = [
            side[list(corner_indices)]
            for side in sides
            for corner_indices in combinations(range(4), 3)
        ]
        return np.asarray(np.array(threes) * np.array(size))
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
