"""Mesh decimation: the vertices in each cell of a grid are merged into one.

The merged vertex is computed from the planes of the surrounding triangles, so that edges and
corners stay in place (P. Lindstrom, "Out-of-core simplification of large polygonal models",
Proceedings of SIGGRAPH 2000).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.device.bodies import PREFIX
from ocs_design.report.bodies import ShownBody, Surface

FINEST = 1.0 / 4096.0
"""Smallest cell in which points are merged, relative to the size of the robot."""

DEVICE_GRAIN = 0.2
"""Size of the device's cells relative to the robot's."""

_LEAST_GROWTH = 1.1
"""Smallest growth factor of the cell from one attempt to the next."""

_BITS = 21
"""Bits of a vertex number: three vertex numbers make a face number."""

_FLAT = 0.05
"""Relative eigenvalue of a quadric below which it does not determine the position."""


def decimated(bodies: Sequence[ShownBody], most_triangles: int) -> tuple[ShownBody, ...]:
    """The bodies with at most so many triangles, decimated with a common cell size."""
    points = [surface.vertices for body in bodies for surface in body.surfaces]
    extent = max((float(np.ptp(each, axis=0).max()) for each in points), default=0.0)
    if extent == 0.0:
        return tuple(bodies)
    boxed = [
        (_grain(body), _offsets(surface), np.ascontiguousarray(surface.faces.T))
        for body in bodies
        for surface in body.surfaces
    ]
    cell = FINEST * extent

    def left() -> int:
        """Number of triangles whose corners lie in three different cells."""
        count = 0
        for grain, places, faces in boxed:
            cells = _cells(places, grain * cell)
            count += len(np.unique(_keyed(*(cells[column] for column in faces))[1]))
        return count

    while (count := left()) > most_triangles:
        # The number of cells is proportional to the area of a surface.
        cell *= max(_LEAST_GROWTH, float(np.sqrt(count / most_triangles)))
    made = []
    for body in bodies:
        found = (clustered(surface, _grain(body) * cell) for surface in body.surfaces)
        made.append(replace(body, surfaces=tuple(each for each in found if len(each.faces))))
    return tuple(made)


def _grain(body: ShownBody) -> float:
    """Relative cell size of a body: finer for the device, on which the interest lies."""
    return DEVICE_GRAIN if body.name.startswith(PREFIX) else 1.0


def _offsets(surface: Surface) -> list[FloatArray]:
    """Vertices relative to the lowest corner of the surface's box [m], columns of shape (n,)."""
    return [column - column.min() for column in surface.vertices.T]


def _cells(offsets: Sequence[FloatArray], cell: float) -> NDArray[np.int64]:
    """Cell number below 2^21 of each vertex."""
    x, y, z = (np.floor(column / cell).astype(np.int64) for column in offsets)
    number = (x * (int(y.max()) + 1) + y) * (int(z.max()) + 1) + z
    return number if number.max() < 1 << _BITS else _numbered(number)


def clustered(surface: Surface, cell: float) -> Surface:
    """Surface with one vertex per cell [m], without the triangles that collapse."""
    cluster = _numbered(_cells(_offsets(surface), cell))
    # Faces of three corners, each once.
    moved = cluster[surface.faces]
    kept, key = _keyed(*moved.T)
    faces = moved[kept][np.unique(key, return_index=True)[1]]
    # Point of each cluster nearest to the planes of its triangles, at most a cell away.
    count = int(cluster.max()) + 1
    weight = np.bincount(cluster, minlength=count)[:, None]
    middle = _summed(surface.vertices, cluster, count) / weight
    # Sums of n n^T and n d over the triangles at each cluster, area-weighted, about `middle`.
    corners = surface.vertices[surface.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outer = np.einsum("ni,nj->nij", normal, normal).reshape(-1, 9)
    quadric, vector = np.zeros((count, 9)), np.zeros((count, 3))
    for at in cluster[surface.faces.T]:
        offset = np.einsum("ni,ni->n", normal, corners[:, 0] - middle[at])
        quadric += _summed(outer, at, count)
        vector += _summed(normal * offset[:, None], at, count)
    values, axes = np.linalg.eigh(quadric.reshape(-1, 3, 3))
    says = values > _FLAT * values[:, -1:]
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=says)
    step = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, vector)
    far = np.linalg.norm(step, axis=1) > cell
    step[far] = 0.0
    vertices = np.asarray(middle + step)
    used, renumbered = np.unique(faces, return_inverse=True)
    return Surface(vertices[used], renumbered.reshape(-1, 3), surface.color)


def _numbered(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index of each value among the sorted distinct values."""
    return np.asarray(np.unique(values, return_inverse=True)[1].ravel())


def _keyed(
    a: NDArray[np.int64], b: NDArray[np.int64], c: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Mask of faces with three distinct corners, and a key for each by its corners in any order."""
    kept = (a != b) & (b != c) & (c != a)
    a, b, c = a[kept], b[kept], c[kept]
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    return kept, (low << 2 * _BITS) | ((a + b + c - low - high) << _BITS) | high


def _summed(values: FloatArray, at: NDArray[np.intp], count: int) -> FloatArray:
    """Sums of the rows of `values` by their index `at`, shape (count, columns)."""
    columns = [np.bincount(at, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1)
