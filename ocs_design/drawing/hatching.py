"""Hatching of cut faces (ISO 128-3): thin lines at 45 degrees."""

import math
from collections.abc import Sequence

from ocs_design.drawing.sheet import THIN, Item, Line, Point

SPACING = 2.0
"""Between the lines [mm]."""

_DIAGONAL = math.sqrt(0.5)


def hatching(corners: Sequence[Point], *, mirrored: bool = False) -> list[Item]:
    """Lines inside a polygon.

    All polygons of a sheet share one grid, so that faces of one part are hatched as one.

    Args:
        corners: of a simple polygon.
        mirrored: leaning to the left, for the part beside the first.
    """
    side = -_DIAGONAL if mirrored else _DIAGONAL
    turned = [(_DIAGONAL * x - side * y, side * x + _DIAGONAL * y) for x, y in corners]
    across = [v for _, v in turned]
    first, last = math.ceil(min(across) / SPACING), math.floor(max(across) / SPACING)
    return [
        Line(_back(start, side), _back(end, side), THIN)
        for row in range(first, last + 1)
        for start, end in _inside(turned, SPACING * row)
    ]


def _inside(corners: Sequence[Point], v: float) -> list[tuple[Point, Point]]:
    """Parts of a level line inside a polygon, by the even-odd rule."""
    crossings = []
    for (u0, v0), (u1, v1) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if (v0 <= v) != (v1 <= v):
            crossings.append(u0 + (u1 - u0) * (v - v0) / (v1 - v0))
    crossings.sort()
    return [((a, v), (b, v)) for a, b in zip(crossings[::2], crossings[1::2], strict=True)]


def _back(turned: Point, side: float) -> Point:
    u, v = turned
    return _DIAGONAL * u + side * v, -side * u + _DIAGONAL * v
