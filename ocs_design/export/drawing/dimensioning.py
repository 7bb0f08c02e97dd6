"""Dimensions and leaders of a drawing (ISO 129-1); none covers another."""

import math
from collections.abc import Sequence

from ocs_design.export.drawing.sheet import OUTLINE, Anchor, Area, Item, Line, Pen, Point, Text

ARROW = 3.0
"""Length of an arrow's head [mm]; it is a third as wide."""

OVERHANG = 1.5
"""Length of extension lines beyond the dimension line, twice their gap to the outline [mm]."""

RAISE = 0.9
"""Height of a text above its line [mm]."""

LEADING = 4.4
"""Distance of lines of text [mm]."""


def arrow(tip: Point, toward: Point) -> Area:
    """Arrow's head that points in the direction `toward`, a vector of any length."""
    (x, y), (u, v) = tip, toward
    length = math.hypot(u, v)
    u, v = u / length, v / length
    back, half = (x - ARROW * u, y - ARROW * v), ARROW / 6.0
    return Area(
        (tip, (back[0] - half * v, back[1] + half * u), (back[0] + half * v, back[1] - half * u))
    )


def fits_inside(label: str, span: float) -> bool:
    """Whether a text stands between the arrows of a dimension of that length [mm]."""
    return Text((0.0, 0.0), label).width + 2.0 <= span and span >= 3.0 * ARROW


def upright_dimension(
    label: str, *, x: float, middle: float, half: float, outline_x: float
) -> list[Item]:
    """Dimension beside an outline, its text, which `fits_inside`, turned between the arrows.

    Args:
        label: the text.
        x: of the dimension line, left of the outline.
        middle, half: the y of its middle, and half its length.
        outline_x: where the extension lines leave the outline.
    """
    top, bottom = middle - half, middle + half
    beyond, close = x - OVERHANG, outline_x - OVERHANG / 2.0
    return [
        Line((close, top), (beyond, top)),
        Line((close, bottom), (beyond, bottom)),
        Line((x, top), (x, bottom)),
        arrow((x, top), (0.0, -1.0)),
        arrow((x, bottom), (0.0, 1.0)),
        Text((x - RAISE, middle), label, anchor=Anchor.MIDDLE, upright=True),
    ]


def level_dimension(
    label: str, *, left: float, right: float, y: float, text_x: float | None = None
) -> list[Item]:
    """Dimension line with its text above its middle, or to the right of it, from `text_x` on.

    In the latter case the arrows come from outside where there is no room between them.
    """
    if text_x is None:
        outside, end = False, right
        text = Text(((left + right) / 2.0, y - RAISE), label, anchor=Anchor.MIDDLE)
    else:
        outside, text = right - left < 3.0 * ARROW, Text((text_x, y - RAISE), label)
        end = text_x + text.width
    side = -1.0 if outside else 1.0
    start = left - 2.0 * ARROW if outside else left
    return [
        Line((start, y), (end, y)),
        arrow((left, y), (-side, 0.0)),
        arrow((right, y), (side, 0.0)),
        text,
    ]


def extension(x: float, start: float, end: float) -> Line:
    """Vertical extension line from an outline at the y `start` to a dimension line at `end`."""
    way = math.copysign(1.0, end - start)
    return Line((x, start + way * OVERHANG / 2.0), (x, end + way * OVERHANG))


def leader(lines: Sequence[str], center: Point, radius: float, shelf: Point) -> list[Item]:
    """Arrow toward the centre of a circle [mm], from a shelf under the first line of its text."""
    (x, y), (cx, cy) = shelf, center
    distance = math.hypot(x - cx, y - cy)
    u, v = (cx - x) / distance, (cy - y) / distance
    tip = (cx - radius * u, cy - radius * v)
    texts = [Text((x + 1.0, y - RAISE + row * LEADING), line) for row, line in enumerate(lines)]
    end = x + 2.0 + max(text.width for text in texts)
    return [Line(tip, shelf), Line(shelf, (end, y)), arrow(tip, (u, v)), *texts]


def viewing_arrow(*, x: float, edge: float, down: bool) -> list[Item]:
    """One end of the vertical cutting plane A of a section, seen from the right (ISO 128-3).

    It leaves the outline at the y `edge`, upward or `down`.
    """
    way = 1.0 if down else -1.0
    y, thick = edge + 7.0 * way, Pen(OUTLINE.width)
    return [
        Line((x, edge + 3.5 * way), (x, edge + 9.0 * way), thick),
        Line((x, y), (x + 10.0, y), thick),
        arrow((x, y), (-1.0, 0.0)),
        # Leaders come in from the right.
        Text((x - 2.5, y + 1.75), "A", 3.5, Anchor.END),
    ]
