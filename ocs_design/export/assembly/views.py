"""Exploded view and section of a module on a sheet, with piece numbers."""

from collections.abc import Callable, Mapping, Sequence
from itertools import cycle

import numpy as np

from ocs_design.actuation.fasteners import Fastening
from ocs_design.common.arrays import FloatArray
from ocs_design.export.assembly.line_art import section_lines, visible_lines
from ocs_design.export.assembly.placed import Piece
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Box, Circle, Item, Lettering, Line, Polyline
from ocs_design.export.meshes import Mesh
from ocs_design.export.raster import view_of

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
    return tuple(
        piece
        if piece.drop is None
        else piece.moved(np.array([0.0, piece.drop, lift + piece.aside]))
        for piece in moved
    )


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
    scores = [
        layout[0].paper / layout[0].part * gap**0.5
        for layout, gap in zip(tried, _GAPS, strict=True)
    ]
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
    cut = [
        (piece, [chain[:, ::-1] * [1.0, -1.0] for chain in section_lines(piece.mesh)])
        for piece in pieces
        if piece.drop is None
    ]
    cut = [(piece, chains) for piece, chains in cut if chains]
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
    for target in targets:
        places.append(
            max(target, places[-1] + spacing) if places else max(target, room[0] + spacing / 2.0)
        )
    end = room[1] - spacing / 2.0
    for index in range(len(places) - 1, -1, -1):
        places[index] = min(places[index], end)
        end = places[index] - spacing
    return places
