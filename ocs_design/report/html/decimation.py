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

FINEST_CELL = 1.0 / 4096.0
"""Smallest cell in which points are merged, relative to the size of the robot."""

DEVICE_CELL = 0.2
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
    extent = max((float(np.ptp(points, axis=0).max()) for points in points), default=0.0)
    if extent == 0.0:
        return tuple(bodies)
    cell = FINEST_CELL * extent
    while (count := _triangle_count(bodies, cell)) > most_triangles:
        # The number of cells is proportional to the area of a surface.
        cell *= max(_LEAST_GROWTH, float(np.sqrt(count / most_triangles)))
    coarser = []
    for body in bodies:
        clusters = (clustered(surface, _relative_cell(body) * cell) for surface in body.surfaces)
        coarser.append(
            replace(body, surfaces=tuple(surface for surface in clusters if len(surface.faces)))
        )
    return tuple(coarser)


def _relative_cell(body: ShownBody) -> float:
    """Relative cell size of a body: finer for the device, which matters most."""
    return DEVICE_CELL if body.name.startswith(PREFIX) else 1.0


def _triangle_count(bodies: Sequence[ShownBody], cell: float) -> int:
    """Number of triangles of the bodies decimated with a cell size [m]."""
    return sum(
        len(_clusters(surface, _relative_cell(body) * cell)[1])
        for body in bodies
        for surface in body.surfaces
    )


def _clusters(surface: Surface, cell: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cluster of each vertex, and the triangles between three different clusters, each once."""
    x, y, z = (np.floor((column - column.min()) / cell) for column in surface.vertices.T)
    number = (x * (y.max() + 1.0) + y) * (z.max() + 1.0) + z
    cluster = np.unique(number, return_inverse=True)[1].ravel()
    corners = cluster[surface.faces]
    a, b, c = corners.T
    faces = corners[(a != b) & (b != c) & (c != a)]
    # Equal for the same corners in any order.
    key = np.sort(faces, axis=1) @ (1 << _BITS * np.array([2, 1, 0]))
    return cluster, faces[np.unique(key, return_index=True)[1]]


def clustered(surface: Surface, cell: float) -> Surface:
    """Surface with one vertex per cell [m], without the triangles that collapse."""
    cluster, faces = _clusters(surface, cell)
    # Point of each cluster nearest to the planes of its triangles, at most a cell away.
    count = int(cluster.max()) + 1
    weight = np.bincount(cluster, minlength=count)[:, None]
    center = _sums(surface.vertices, cluster, count) / weight
    # Sums of n n^T and n d over the triangles at each cluster, area-weighted, about `center`.
    corners = surface.vertices[surface.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outer = np.einsum("ni,nj->nij", normal, normal).reshape(-1, 9)
    quadric, vector = np.zeros((count, 9)), np.zeros((count, 3))
    for clusters in cluster[surface.faces].T:
        offset = np.einsum("ni,ni->n", normal, corners[:, 0] - center[clusters])
        quadric += _sums(outer, clusters, count)
        vector += _sums(normal * offset[:, None], clusters, count)
    values, axes = np.linalg.eigh(quadric.reshape(-1, 3, 3))
    is_determined = values > _FLAT * values[:, -1:]
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=is_determined)
    step = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, vector)
    too_far = np.linalg.norm(step, axis=1) > cell
    step[too_far] = 0.0
    vertices = np.asarray(center + step)
    used, renumbered = np.unique(faces, return_inverse=True)
    return Surface(vertices[used], renumbered.reshape(-1, 3), surface.color)


def _sums(values: FloatArray, index: NDArray[np.intp], count: int) -> FloatArray:
    """Sums of the rows of `values` by their index, shape (count, columns)."""
    columns = [np.bincount(index, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1)
