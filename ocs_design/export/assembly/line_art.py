"""Line drawings of triangle meshes with hidden lines removed, and sections through meshes."""

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.ndimage import minimum_filter

from ocs_design.common.arrays import FloatArray
from ocs_design.export.meshes import Mesh
from ocs_design.export.raster import covered_pixels, ranges

PIXEL = 0.2e-3
"""Minimum pixel size of the depth map [m]."""

MOST_PIXELS = 16e6
"""Maximum number of pixels; large subjects, such as an exploded humanoid device, get larger ones.
"""

_CHUNK = 1 << 12
"""Triangles filled per pass: all at once would take a hundred megabytes."""

_CREASE = np.cos(np.radians(25.0))
"""Cosine of the angle between face normals below which the common edge is drawn as a crease."""


def visible_lines(meshes: Sequence[Mesh]) -> tuple[tuple[FloatArray, ...], ...]:
    """Visible creases and outlines of each mesh as chains of points, shape (k, 2) [m].

    Meshes are in the picture's axes. A point of a line is visible if no surrounding surface hides
    it in the depth map.
    """
    depth = _DepthMap(np.concatenate([mesh.corners for mesh in meshes]))
    return tuple(_chains(_visible_parts(mesh, depth)) for mesh in meshes)


def section_lines(mesh: Mesh) -> tuple[FloatArray, ...]:
    """Section of a mesh in the plane x = 0, as chains of points (y, z), shape (k, 2) [m]."""
    start = mesh.corners
    # Shifted so that no corner lies exactly in the plane.
    before = start[:, :, 0] - 1e-9
    end, after = np.roll(start, -1, axis=1), np.roll(before, -1, axis=1)
    # Zero or two sides of each triangle cross it.
    crossing = (before > 0.0) != (after > 0.0)
    share = before[crossing] / (before[crossing] - after[crossing])
    points = start[crossing] + share[:, None] * (end[crossing] - start[crossing])
    return _chains(points[:, 1:].reshape(-1, 2, 2))


class _DepthMap:
    """Depth map towards the eye on a grid with pixels of size `pixel` [m]."""

    def __init__(self, corners: FloatArray) -> None:
        flat = corners.reshape(-1, 3)
        across = np.ptp(flat[:, :2], axis=0)
        self.pixel = max(PIXEL, float(np.sqrt(across.prod() / MOST_PIXELS)))
        self._low = flat[:, :2].min(axis=0) - 2.0 * self.pixel
        size = np.ceil((flat[:, :2].max(axis=0) - self._low) / self.pixel).astype(int) + 3
        # Single precision resolves a thousandth of a pixel.
        self._depth = np.full((size[1], size[0]), -np.inf, dtype=np.float32)
        # Triangles that face the eye, row by row; in closed meshes the others are behind them.
        for begin in range(0, len(corners), _CHUNK):
            points = corners[begin : begin + _CHUNK].copy()
            points[:, :, :2] = (points[:, :, :2] - self._low) / self.pixel
            edge_1, edge_2 = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
            front = edge_1[:, 0] * edge_2[:, 1] - edge_1[:, 1] * edge_2[:, 0] > 1e-9
            _, rows, columns, depth = covered_pixels(points[front], 0.0)
            np.maximum.at(self._depth, (rows, columns), depth)
        # Farthest depth around each pixel, so that a face does not hide its own edges.
        self._farthest = minimum_filter(self._depth, 3, mode="wrap")

    def sees(self, points: FloatArray) -> FloatArray:
        """Whether each point is unobstructed, shape (n,)."""
        columns, rows = np.rint((points[:, :2] - self._low) / self.pixel).astype(int).T
        return np.asarray(points[:, 2] + 0.5 * self.pixel >= self._farthest[rows, columns])


def _visible_parts(mesh: Mesh, depth: _DepthMap) -> list[FloatArray]:
    """Visible parts of creases and outlines, each given by its two ends, shape (2, 2)."""
    corners = mesh.corners
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    ends = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    faces = np.repeat(np.arange(len(corners)), 3)
    order = np.lexsort(ends.T)
    ends, faces = ends[order], faces[order]
    pairs = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    one, other = normals[faces[pairs]], normals[faces[pairs + 1]]
    front = (one[:, 2] > 0.0).astype(int) + (other[:, 2] > 0.0)
    crease = np.einsum("ij,ij->i", one, other) < _CREASE
    is_drawn = (front == 1) | (crease & (front == 2))
    # Creases and outlines with a face towards the eye, by their ends, shape (n, 2, 3).
    edges = np.asarray(mesh.vertices[ends[pairs[is_drawn]]])
    if not len(edges):
        return []
    lengths = np.linalg.norm(edges[:, 1, :2] - edges[:, 0, :2], axis=1)
    counts = np.maximum(np.ceil(lengths / depth.pixel).astype(int), 1)
    owner = np.repeat(np.arange(len(edges)), counts)
    share = (ranges(np.zeros(len(edges), dtype=int), counts) + 0.5) / counts[owner]
    start, along = edges[owner, 0], edges[owner, 1] - edges[owner, 0]
    is_visible = depth.sees(start + share[:, None] * along)
    parts, position = [], 0
    for edge, count in zip(edges[:, :, :2], counts, strict=True):
        flags = np.concatenate([[False], is_visible[position : position + count], [False]])
        position += count
        turns = np.flatnonzero(flags[1:] != flags[:-1])
        for begin, end in zip(turns[::2], turns[1::2], strict=True):
            # Single visible points are noise of the depth map.
            if end - begin > 1 or count <= 2:
                shares = np.array([begin, end])[:, None] / count
                parts.append(edge[0] + shares * (edge[1] - edge[0]))
    return parts


def _chains(segments: Iterable[FloatArray]) -> tuple[FloatArray, ...]:
    """Segments with common ends joined to chains of points."""
    pieces = [segment for segment in segments if _key(segment[0]) != _key(segment[1])]
    by_end: dict[tuple[int, int], list[int]] = {}
    keys = [[_key(point) for point in piece] for piece in pieces]
    for number, (start, end) in enumerate(keys):
        by_end.setdefault(start, []).append(number)
        by_end.setdefault(end, []).append(number)
    remaining, chains = set(range(len(pieces))), []
    for number in range(len(pieces)):
        if number not in remaining:
            continue
        remaining.discard(number)
        chain = list(pieces[number])
        # Extend it at its end, then, reversed, at its start.
        for end in reversed(keys[number]):
            last = end
            while candidates := [neighbour for neighbour in by_end[last] if neighbour in remaining]:
                following = candidates[0]
                remaining.discard(following)
                far_end = int(keys[following][0] == last)
                chain.append(pieces[following][far_end])
                last = keys[following][far_end]
            chain.reverse()
        chains.append(np.array(chain))
    return tuple(chains)


def _key(point: FloatArray) -> tuple[int, int]:
    """Point rounded to a hundredth of a micrometre."""
    x, y = np.rint(1e8 * point).astype(int).tolist()
    return x, y
