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
    grid_surfaces = [
        (_relative_cell(body), _offsets(surface), np.ascontiguousarray(surface.faces.T))
        for body in bodies
        for surface in body.surfaces
    ]
    cell = FINEST_CELL * extent

    def triangle_count() -> int:
        """Number of triangles whose corners lie in three different cells."""
        count = 0
        for relative, offsets, faces in grid_surfaces:
            cells = _cells(offsets, relative * cell)
            count += len(np.unique(_face_keys(*(cells[column] for column in faces))[1]))
        return count

    while (count := triangle_count()) > most_triangles:
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


def _offsets(surface: Surface) -> list[FloatArray]:
    """Vertices relative to the lowest corner of the surface's box [m], columns of shape (n,)."""
    return [column - column.min() for column in surface.vertices.T]


def _cells(offsets: Sequence[FloatArray], cell: float) -> NDArray[np.int64]:
    """Cell number below 2^21 of each vertex."""
    x, y, z = (np.floor(column / cell).astype(np.int64) for column in offsets)
    number = (x * (int(y.max()) + 1) + y) * (int(z.max()) + 1) + z
    return number if number.max() < 1 << _BITS else _ranked(number)


def clustered(surface: Surface, cell: float) -> Surface:
    """Surface with one vertex per cell [m], without the triangles that collapse."""
    cell_index = _ranked(_cells(_offsets(surface), cell))
    # Faces of three corners, each once.
    face_cells = cell_index[surface.faces]
    is_face, key = _face_keys(*face_cells.T)
    faces = face_cells[is_face][np.unique(key, return_index=True)[1]]
    # Point of each cluster nearest to the planes of its triangles, at most a cell away.
    count = int(cell_index.max()) + 1
    weight = np.bincount(cell_index, minlength=count)[:, None]
    center = _sums(surface.vertices, cell_index, count) / weight
    # Sums of n n^T and n d over the triangles at each cluster, area-weighted, about `center`.
    corners = surface.vertices[surface.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outer = np.einsum("ni,nj->nij", normal, normal).reshape(-1, 9)
    quadric, vector = np.zeros((count, 9)), np.zeros((count, 3))
    for cells in face_cells.T:
        offset = np.einsum("ni,ni->n", normal, corners[:, 0] - center[cells])
        quadric += _sums(outer, cells, count)
        vector += _sums(normal * offset[:, None], cells, count)
    values, axes = np.linalg.eigh(quadric.reshape(-1, 3, 3))
    is_determined = values > _FLAT * values[:, -1:]
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=is_determined)
    step = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, vector)
    too_far = np.linalg.norm(step, axis=1) > cell
    step[too_far] = 0.0
    vertices = np.asarray(center + step)
    used, renumbered = np.unique(faces, return_inverse=True)
    return Surface(vertices[used], renumbered.reshape(-1, 3), surface.color)


def _ranked(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index of each value among the sorted distinct values."""
    return np.asarray(np.unique(values, return_inverse=True)[1].ravel())


def _face_keys(
    a: NDArray[np.int64], b: NDArray[np.int64], c: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Mask of faces with three distinct corners, and a key for each by its corners in any order."""
    is_face = (a != b) & (b != c) & (c != a)
    a, b, c = a[is_face], b[is_face], c[is_face]
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    return is_face, (low << 2 * _BITS) | ((a + b + c - low - high) << _BITS) | high


def _sums(values: FloatArray, index: NDArray[np.intp], count: int) -> FloatArray:
    """Sums of the rows of `values` by their index, shape (count, columns)."""
    columns = [np.bincount(index, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1)
