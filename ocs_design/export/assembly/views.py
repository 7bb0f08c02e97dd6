"""Exploded view and section of a module on a sheet, with piece numbers.

Both are line drawings of triangle meshes: with hidden lines removed, or cut by a plane.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import cycle

import numpy as np
from scipy.ndimage import minimum_filter

from ocs_design.actuation.fasteners import Fastening
from ocs_design.common.arrays import FloatArray
from ocs_design.export.assembly.placed import Piece
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Box, Circle, Item, Lettering, Line, Polyline
from ocs_design.export.meshes import Mesh
from ocs_design.export.raster import covered_pixels, ranges, view_of

_CAMERA, _UP = (0.80, -0.38, 0.55), (0.0, -1.0, 0.0)

_PEN = sheet.Pen(0.25)

_GAPS, _SCREW_GAP = (1.4, 1.2, 1.05, 0.9, 0.8, 0.7, 0.6, 0.52, 0.45, 0.4), 0.55
"""Gaps to try between exploded pieces, relative to the largest radius; factor before screws."""

_BOUGHT = ("motor", "gear", "gear_2")

BALLOON = 3.2
"""Radius of a number's circle [mm]."""


def pulled_apart(pieces: Sequence[Piece], between: float) -> tuple[Piece, ...]:
    """Pieces moved apart along the axis with this distance between them [m]."""
    moved, end = [], -np.inf
    lift = 0.0
    for piece in pieces:
        heights = piece.mesh.vertices[:, 2]
        low, high = float(heights.min()), float(heights.max())
        if piece.drop is not None:
            moved.append(piece)
            continue
        if piece.key == "foot":
            # Its base is below the motor; its screws must be visible in front of it.
            above = piece.mesh.vertices[piece.mesh.vertices[:, 1] < 0.0]
            low = float(above[:, 2].min())
        gap = between * (_SCREW_GAP if piece.fastening is not None else 1.0)
        shift = 0.0 if np.isneginf(end) else end + gap - low
        end = high + shift
        moved.append(piece.moved(np.array([0.0, 0.0, shift])))
        if piece.key == "foot":
            lift = shift
    # Pieces on or under the foot move with it.
    for index, piece in enumerate(moved):
        if piece.drop is not None:
            moved[index] = piece.moved(np.array([0.0, piece.drop, lift + piece.aside]))
    return tuple(moved)


def exploded_view(
    pieces: Sequence[Piece], numbers: Mapping[str | Fastening, int], box: Box
) -> tuple[list[Item], sheet.Scale]:
    """Exploded view in the middle of a box of the sheet [mm], with its scale."""
    view = view_of(_CAMERA, _UP)
    left, top, right, bottom = box
    room = np.array([right - left - 4.0, bottom - top - 4.0 * (BALLOON + 2.0)])
    tried = []
    radius = max(float(np.abs(piece.mesh.vertices[:, 0]).max()) for piece in pieces)
    for gap in _GAPS:
        apart = pulled_apart(pieces, gap * radius)
        points = np.concatenate([piece.mesh.vertices for piece in apart]) @ view[:2].T
        low, high = points.min(axis=0), points.max(axis=0)
        tried.append((_fitting(high - low, room), apart, low, high))
    # Trade-off of size against overlap: doubling the gap is worth a factor of 1.4 in scale.
    pairs = zip(tried, _GAPS, strict=True)
    scores = [scale.paper / scale.part * gap**0.5 for (scale, *_), gap in pairs]
    scale, apart, low, high = tried[scores.index(max(scores))]
    meshes = [Mesh(piece.mesh.vertices @ view.T, piece.mesh.triangles) for piece in apart]
    lines = visible_lines(meshes)
    place = _placing(scale, (low + high) / 2.0, box)
    items: list[Item] = []
    for chains in lines:
        items += [Polyline(tuple(map(place, chain)), _PEN) for chain in chains]
    heights = np.concatenate([piece.mesh.vertices[:, 2] for piece in apart])
    ends = np.array([[0.0, 0.0, heights.min() - 0.01], [0.0, 0.0, heights.max() + 0.01]])
    ends = np.asarray((ends @ view.T)[:, :2])
    items.append(Line(place(ends[0]), place(ends[1]), sheet.CENTRE))
    above, below = [], []
    for piece, mesh, chains in zip(apart, meshes, lines, strict=True):
        # Hidden pieces get a leader, too.
        flat = np.concatenate(chains) if chains else mesh.vertices[:, :2]
        name = numbers[piece.key]
        if piece.drop is not None or piece.key == "foot":
            below.append((name, place(flat[flat[:, 1].argmin()])))
        else:
            above.append((name, place(flat[flat[:, 1].argmax()])))
    items += _balloons(above, 0, top + BALLOON, (left, right))
    items += _balloons(below, 0, bottom - BALLOON, (left, right))
    return items, scale


def section_view(
    pieces: Sequence[Piece],
    numbers: Mapping[str | Fastening, int],
    box: Box,
    *,
    standing: bool = False,
) -> tuple[list[Item], sheet.Scale]:
    """Section along the axis, upright, in the middle of a box of the sheet [mm], with its scale.

    The axis of the pieces is z and points right; if they are `standing`, it is y and vertical.
    """
    # Up is at the top of the sheet.
    sections = ((piece, section_lines(piece.mesh)) for piece in pieces if piece.drop is None)
    flip = [1.0, -1.0]
    cut = [
        (piece, [chain[:, ::-1] * flip for chain in lines]) for piece, lines in sections if lines
    ]
    points = np.concatenate([chain for _, chains in cut for chain in chains])
    low, high = points.min(axis=0), points.max(axis=0)
    left, top, right, bottom = box
    margin = 2.0 * BALLOON + 8.0
    room = np.array([right - left - 2.0 * margin, bottom - top - 8.0])
    scale, middle = _fitting(high - low, room), (low + high) / 2.0
    place = _placing(scale, middle, box)
    items: list[Item] = []
    by_side: dict[bool, list[tuple[int, tuple[float, float]]]] = {True: [], False: []}
    leaning = cycle((False, True))
    for piece, chains in cut:
        lines = [tuple(map(place, chain)) for chain in chains]
        if piece.fastening is None and piece.key not in _BOUGHT:
            # Adjacent parts are hatched in opposite directions; bought parts are not hatched.
            items += sheet.hatching(*lines, mirrored=next(leaning))
        pen = sheet.THIN if piece.fastening is not None else sheet.OUTLINE
        items += [Polyline(line, pen) for line in lines]
        corners = np.concatenate(chains)
        behind = float(corners[:, 0].mean()) < middle[0]
        ends = corners[:, 0] if behind else -corners[:, 0]
        # The highest of the outermost corners.
        outer = corners[np.lexsort((-corners[:, 1], np.rint(1e6 * ends)))[0]]
        by_side[behind].append((numbers[piece.key], place(outer)))
    along = np.array([0.0, 1.0] if standing else [1.0, 0.0])
    items.append(Line(place(along * (low - 0.004)), place(along * (high + 0.004)), sheet.CENTRE))
    for behind, marks in by_side.items():
        x = left + BALLOON if behind else right - BALLOON
        items += _balloons(marks, 1, x, (top, bottom))
    return items, scale


def _placing(
    scale: sheet.Scale, middle: FloatArray, box: Box
) -> Callable[[FloatArray], tuple[float, float]]:
    """Map from the picture, up positive [m], to the sheet: `middle` goes to the box's centre."""
    left, top, right, bottom = box
    centre = np.array([(left + right) / 2.0, (top + bottom) / 2.0])

    def place(at: FloatArray) -> tuple[float, float]:
        """Point of the sheet [mm], down positive."""
        right, down = (at - middle) * [1.0, -1.0]
        return float(centre[0] + scale(float(right))), float(centre[1] + scale(float(down)))

    return place


def _fitting(size: FloatArray, room: FloatArray) -> sheet.Scale:
    """Largest scale at which a size [m] fits a space on the sheet [mm]."""
    return sheet.largest_scale(*zip(size.tolist(), room.tolist(), strict=True), standard=False)


def _balloons(
    marks: Sequence[tuple[int, tuple[float, float]]],
    axis: int,
    level: float,
    room: tuple[float, float],
) -> list[Item]:
    """Balloons with leaders to points, in a row (`axis` 0) or a column (1), in the points' order.

    All are at `level` across it, between the ends of `room` along it [mm].
    """
    ordered = sorted(marks, key=lambda mark: mark[1][axis])
    places = spread([at[axis] for _, at in ordered], 2.0 * BALLOON + 1.5, room)
    items: list[Item] = []
    for (number, to), along in zip(ordered, places, strict=True):
        at = (level, along) if axis else (along, level)
        # A number in a circle, with a leader to its piece.
        away = np.subtract(to, at)
        start = np.add(at, away * BALLOON / max(float(np.linalg.norm(away)), BALLOON))
        items += [
            Circle(at, BALLOON, sheet.THIN),
            Line((float(start[0]), float(start[1])), to, sheet.THIN),
            Circle(to, 0.4, sheet.THIN),
            Lettering((at[0], at[1] + 1.25), str(number), 2.5, Anchor.MIDDLE),
        ]
    return items


def spread(targets: Sequence[float], spacing: float, room: tuple[float, float]) -> list[float]:
    """Ascending positions near the wanted ones, at least `spacing` apart, in `room` if they fit."""
    places: list[float] = []
    least, most = room[0] + spacing / 2.0, room[1] - spacing / 2.0
    for target in targets:
        places.append(max(target, least))
        least = places[-1] + spacing
    for index in reversed(range(len(places))):
        places[index] = min(places[index], most)
        most = places[index] - spacing
    return places


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
    parts = []
    for edge, seen in zip(edges[:, :, :2], np.split(is_visible, np.cumsum(counts)), strict=False):
        count, flags = len(seen), np.concatenate([[False], seen, [False]])
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
