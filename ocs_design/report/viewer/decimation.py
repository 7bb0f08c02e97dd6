"""Fewer triangles for the same shape: vertices in one cell of a grid become one.

Where that one lies comes from the planes of the triangles around it, so that edges and corners stay
where they are (P. Lindstrom, "Out-of-core simplification of large polygonal models", Proceedings of
SIGGRAPH 2000).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.export.naming import PREFIX
from ocs_design.report.viewer.bodies import ShownBody, Surface

FINEST = 1.0 / 4096.0
"""Cell that points are merged in at least, over the size of the robot."""

DEVICE_GRAIN = 0.2
"""Of the device's cells, over those of the robot."""

_LEAST_GROWTH = 1.1
"""Of the cell from one attempt to the next."""

_FLAT = 0.05
"""Singular values of a quadric below this part of its largest one say nothing of the place."""


def decimated(bodies: Sequence[ShownBody], most_triangles: int) -> tuple[ShownBody, ...]:
    """The bodies with at most so many triangles, all in one grain."""
    points = [surface.vertices for body in bodies for surface in body.surfaces]
    extent = max((float(np.ptp(each, axis=0).max()) for each in points), default=0.0)
    if extent == 0.0:
        return tuple(bodies)
    cell = FINEST * extent
    while (count := _count(bodies, cell)) > most_triangles:
        # A surface takes as many cells as it has area.
        cell *= max(_LEAST_GROWTH, float(np.sqrt(count / most_triangles)))
    return tuple(_clustered_body(body, _cell(body, cell)) for body in bodies)


def _cell(body: ShownBody, cell: float) -> float:
    """The device is what one looks for: it keeps its edges."""
    return DEVICE_GRAIN * cell if body.name.startswith(PREFIX) else cell


def triangles_of(bodies: Sequence[ShownBody]) -> int:
    """How many triangles there are."""
    return sum(len(surface.faces) for body in bodies for surface in body.surfaces)


def _clustered_body(body: ShownBody, cell: float) -> ShownBody:
    found = (clustered(surface, cell) for surface in body.surfaces)
    return replace(body, surfaces=tuple(surface for surface in found if len(surface.faces)))


def _count(bodies: Sequence[ShownBody], cell: float) -> int:
    return sum(
        len(_distinct(_clusters(surface, _cell(body, cell))[surface.faces]))
        for body in bodies
        for surface in body.surfaces
    )


def clustered(surface: Surface, cell: float) -> Surface:
    """A surface whose vertices in one cell [m] are one; triangles that shrink to nothing go."""
    cluster = _clusters(surface, cell)
    faces = _distinct(cluster[surface.faces])
    vertices = _representatives(surface, cluster, cell)
    used, renumbered = np.unique(faces, return_inverse=True)
    return Surface(vertices[used], renumbered.reshape(-1, 3), surface.color)


def _clusters(surface: Surface, cell: float) -> NDArray[np.intp]:
    """Number of the cell that each vertex lies in; only cells with a vertex count."""
    low = surface.vertices.min(axis=0)
    x, y, z = np.floor((surface.vertices - low) / cell).astype(np.int64).T
    _, cluster = np.unique((x << 42) | (y << 21) | z, return_inverse=True)
    return np.asarray(cluster.ravel())


def _distinct(faces: NDArray[np.intp]) -> NDArray[np.intp]:
    """Faces of three corners, each once."""
    a, b, c = faces.T
    kept = faces[(a != b) & (b != c) & (c != a)]
    low, middle, high = np.sort(kept, axis=1).astype(np.int64).T
    _, first = np.unique((low << 42) | (middle << 21) | high, return_index=True)
    return np.asarray(kept[first])


def _representatives(surface: Surface, cluster: NDArray[np.intp], cell: float) -> FloatArray:
    """For each cluster the point nearest to the planes of its triangles, no further than a cell."""
    count = int(cluster.max()) + 1
    weight = np.bincount(cluster, minlength=count)[:, None]
    middle = _summed(surface.vertices, cluster, count) / weight
    quadric, vector = _quadrics(surface, cluster, middle)
    values, axes = np.linalg.eigh(quadric)
    says = values > _FLAT * values[:, -1:]
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=says)
    step = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, vector)
    far = np.linalg.norm(step, axis=1) > cell
    step[far] = 0.0
    return np.asarray(middle + step)


def _quadrics(
    surface: Surface, cluster: NDArray[np.intp], middle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Sums of n n^T and n d over the triangles at each cluster, areas as weights, from `middle`."""
    corners = surface.vertices[surface.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    quadric, vector = np.zeros((len(middle), 9)), np.zeros((len(middle), 3))
    outer = np.einsum("ni,nj->nij", normal, normal).reshape(-1, 9)
    for corner in range(3):
        at = cluster[surface.faces[:, corner]]
        offset = np.einsum("ni,ni->n", normal, corners[:, 0] - middle[at])
        quadric += _summed(outer, at, len(middle))
        vector += _summed(normal * offset[:, None], at, len(middle))
    return quadric.reshape(-1, 3, 3), vector


def _summed(values: FloatArray, at: NDArray[np.intp], count: int) -> FloatArray:
    """Rows of `values` added up by where they belong, shape (count, columns)."""
    columns = [np.bincount(at, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1)
