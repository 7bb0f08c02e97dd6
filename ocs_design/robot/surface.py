"""The upper surface of a trunk, and its back: how high they are, as far as its shapes are known."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot.tree import BACKWARDS
from ocs_design.robot.triangles import trunk_triangles

STEP = 1e-3
"""Distance of two places of a map, at the least [m]."""

MOST_STEPS = 800
"""Most steps of a map along its longer side."""


_CHUNK = 1 << 16
"""Pairs of triangles and places at once: few enough for the cache."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Heights of what is highest over each place of a grid.

    Attributes:
        x, y: of the first place in B [m].
        step: between places [m].
        heights: z in B, -inf where there is nothing [m], shape (m, n).
    """

    x: float
    y: float
    step: float
    heights: FloatArray

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights at places in B [m], each that of the nearest place of the grid."""
        rows, columns = self._bordered.shape
        i, j = (
            np.clip(np.rint((of - start) / self.step) + 1.0, 0.0, count - 1).astype(np.intp)
            for of, start, count in ((x, self.x, rows), (y, self.y, columns))
        )
        return np.asarray(self._bordered.ravel()[i * columns + j])

    @cached_property
    def _bordered(self) -> FloatArray:
        """The heights with a border of places where there is nothing [m]."""
        return frozen(np.pad(self.heights, 1, constant_values=-np.inf))

    def farthest(self, low: float, high: float, aside: float) -> float:
        """Largest height between two x and so far to both sides of y = 0 [m]; -inf: nothing."""
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
def trunk_surface(robot: Robot) -> Surface | None:
    """Upper surface of the trunk, with all that is fixed to it; None if its shapes are not known.

    Shapes to look at count; where none of them can be read, those that collide.
    """
    # The box of a robot by hand stands for its inertia.
    triangles = None if robot.format is Format.MANUAL else trunk_triangles(robot)
    return None if triangles is None else surface_of(triangles)


@lru_cache(maxsize=1)
def trunk_back(robot: Robot) -> Surface | None:
    """The trunk as it is seen from behind, x up and z backwards; None likewise."""
    triangles = None if robot.format is Format.MANUAL else trunk_triangles(robot)
    return None if triangles is None else surface_of(triangles @ BACKWARDS)


def surface_of(triangles: FloatArray) -> Surface:
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
    heights = np.full(int(shape.prod()), -np.inf)
    first = np.ceil((flat.min(axis=1) - origin) / step - 1e-9).astype(np.int64)
    last = np.floor((flat.max(axis=1) - origin) / step + 1e-9).astype(np.int64)
    first, last = np.maximum(first, 0), np.minimum(last, shape - 1)
    count = np.maximum(last - first + 1, 0)
    pairs = count.prod(axis=1)
    order = np.argsort(pairs, kind="stable")
    order = order[pairs[order] > 0]
    batches = np.cumsum(pairs[order]) // _CHUNK
    for batch in np.unique(batches):
        rows = order[batches == batch]
        each = pairs[rows]
        owner = np.repeat(rows, each)
        within = np.arange(len(owner)) - np.repeat(np.cumsum(each) - each, each)
        i = first[owner, 0] + within // count[owner, 1]
        j = first[owner, 1] + within % count[owner, 1]
        _raise(
            heights, i * shape[1] + j, triangles[owner], origin + step * np.stack([i, j], axis=1)
        )
    return Surface(
        float(origin[0]), float(origin[1]), step, frozen(heights.reshape(shape[0], shape[1]))
    )


def _raise(
    heights: FloatArray, cells: NDArray[np.int64], triangles: FloatArray, places: FloatArray
) -> None:
    """Raise each place to the triangle above or below it, where it is within that."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    one, two, to = b - a, c - a, places - a[:, :2]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    # Triangles on edge have no inside; those beside them have their edges.
    solid = np.abs(area) > 1e-16
    area = np.where(solid, area, 1.0)
    u = (to[:, 0] * two[:, 1] - to[:, 1] * two[:, 0]) / area
    v = (one[:, 0] * to[:, 1] - one[:, 1] * to[:, 0]) / area
    inside = solid & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9)
    z = a[:, 2] + u * one[:, 2] + v * two[:, 2]
    np.maximum.at(heights, cells[inside], z[inside])
