"""Sheet of paper with lines, circles, texts and dimensions [mm].

x is measured from its left edge, y down from its top. Dimensions and leaders follow ISO 129-1 and
do not overlap.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from reportlab.pdfbase.pdfmetrics import stringWidth

WIDTH, HEIGHT = 297.0, 210.0
"""Size of A4, landscape [mm]."""

MARGIN_LEFT, MARGIN = 20.0, 10.0
"""Distance of the frame from the sheet's edges (ISO 5457), wider on the left for filing [mm]."""

FRAME_BOX = (MARGIN_LEFT, MARGIN, WIDTH - MARGIN, HEIGHT - MARGIN)
"""Left, top, right and bottom of the frame [mm]."""

FONT = "Helvetica"
"""Typeface of all texts, available in every PDF reader."""

SPACING = 2.0
"""Distance between hatching lines [mm]."""

_DIAGONAL = math.sqrt(0.5)

ENCODING = "cp1252"
"""WinAnsiEncoding of PDF, which has the characters of drawings, as in `Ø8 H7 ±0.05`."""

CAP_HEIGHT = 0.718
"""Height of Helvetica's capitals per font size."""

Point: TypeAlias = tuple[float, float]
Box: TypeAlias = tuple[float, float, float, float]
"""Left, top, right, bottom."""


@dataclass(frozen=True)
class Pen:
    """A kind of line (ISO 128-2).

    Attributes:
        width: [mm].
        dashes: lengths of dashes and gaps in turn [mm]; empty: continuous.
    """

    width: float
    dashes: tuple[float, ...] = ()


FRAME = Pen(0.7)
OUTLINE = Pen(0.5)
THIN = Pen(0.25)
CENTRE = Pen(0.25, (6.0, 1.0, 0.6, 1.0))


class Anchor(Enum):
    """Part of a text that is at its position, as a share of its length."""

    START = 0.0
    MIDDLE = 0.5
    END = 1.0


@dataclass(frozen=True)
class Line:
    """A straight line."""

    start: Point
    end: Point
    pen: Pen = THIN


@dataclass(frozen=True)
class Polyline:
    """Straight lines from point to point, at least two points."""

    points: tuple[Point, ...]
    pen: Pen = THIN


@dataclass(frozen=True)
class Circle:
    """A whole circle."""

    center: Point
    radius: float
    pen: Pen = OUTLINE


@dataclass(frozen=True)
class Area:
    """A black polygon without an outline, such as an arrowhead; a white one hides what is below."""

    corners: tuple[Point, ...]
    white: bool = False


@dataclass(frozen=True)
class Lettering:
    """One line of lettering.

    Attributes:
        place: position of the anchor on the baseline.
        text: text printable in Helvetica, see `printable`.
        height: height of its capitals [mm] (ISO 3098: 1.8, 2.5, 3.5, 5).
        anchor: part of the text that is at `place`.
        upright: whether it is read from the sheet's right side, turned a quarter turn to the left.
    """

    place: Point
    text: str
    height: float = 2.5
    anchor: Anchor = Anchor.START
    upright: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "text", printable(self.text))

    @property
    def size(self) -> float:
        """Font size [mm]."""
        return self.height / CAP_HEIGHT

    @property
    def width(self) -> float:
        """Length along the baseline [mm]."""
        return float(stringWidth(self.text, FONT, self.size))

    @property
    def start(self) -> Point:
        """Start of its first letter on the baseline."""
        x, y = self.place
        back = self.anchor.value * self.width
        return (x, y + back) if self.upright else (x - back, y)


Item: TypeAlias = Line | Polyline | Circle | Area | Lettering


@dataclass(frozen=True)
class Scale:
    """Scale `paper:part` of a drawing (ISO 5455), or of a picture, which needs no standard scale.

    One of the two numbers is 1.
    """

    paper: float
    part: float

    def __str__(self) -> str:
        return f"{self.paper:g}:{self.part:g}"

    def __call__(self, length: float) -> float:
        """Length on paper [mm] of a length of the part [m]."""
        return 1e3 * length * self.paper / self.part

    def length(self, on_paper: float) -> float:
        """Length of the part [m] of a length on paper [mm]."""
        return 1e-3 * on_paper * self.part / self.paper


_STANDARD, _FINE = (1, 2, 5), (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8)


def largest_scale(*lengths: tuple[float, float], standard: bool = True) -> Scale:
    """Largest scale, of ISO 5455 or of finer steps, at which all lengths fit; else the smallest.

    Each entry is a length of the part [m] and the space for it on paper [mm].
    """
    steps = _STANDARD if standard else _FINE
    scales = [Scale(step * 10**power, 1) for power in (2, 1, 0) for step in reversed(steps)]
    scales += [Scale(1, step * 10**power) for power in range(7) for step in steps][1:]
    fitting = (scale for scale in scales if all(scale(length) <= room for length, room in lengths))
    return next(fitting, scales[-1])


def outline(corners: Sequence[Point], pen: Pen = OUTLINE) -> list[Item]:
    """Lines of a closed polygon."""
    following = [*corners[1:], corners[0]]
    return [Line(a, b, pen) for a, b in zip(corners, following, strict=True)]


def rectangle(left: float, top: float, right: float, bottom: float) -> tuple[Point, ...]:
    """Corners of a rectangle, clockwise as seen."""
    return (left, top), (right, top), (right, bottom), (left, bottom)


def centre_lines(at: Point, half: float) -> list[Item]:
    """Centre lines of a hole with this half length [mm], which cross in dashes (ISO 128-2)."""
    x, y = at
    ends = (x + half, y), (x - half, y), (x, y + half), (x, y - half)
    return [Line(at, end, CENTRE) for end in ends]


def hatching(
    corners: Sequence[Point], *others: Sequence[Point], mirrored: bool = False
) -> list[Item]:
    """Thin lines at 45 degrees inside a simple polygon [mm] (ISO 128-3); `others` are holes in it.

    All polygons of a sheet share one grid, so that faces of one part are hatched consistently;
    `mirrored` lines, for an adjacent part, lean to the left.
    """
    side = -_DIAGONAL if mirrored else _DIAGONAL
    rings = [
        [(_DIAGONAL * x - side * y, side * x + _DIAGONAL * y) for x, y in ring]
        for ring in (corners, *others)
    ]
    levels = [v for ring in rings for _, v in ring]
    first, last = math.ceil(min(levels) / SPACING), math.floor(max(levels) / SPACING)
    lines: list[Item] = []
    for v in (SPACING * row for row in range(first, last + 1)):
        # Segments of a horizontal line inside the polygons, by the even-odd rule.
        crossings = sorted(
            u0 + (u1 - u0) * (v - v0) / (v1 - v0)
            for ring in rings
            for (u0, v0), (u1, v1) in zip(ring, [*ring[1:], ring[0]], strict=True)
            if (v0 <= v) != (v1 <= v)
        )
        ends = [(_DIAGONAL * u + side * v, -side * u + _DIAGONAL * v) for u in crossings]
        lines += [Line(a, b, THIN) for a, b in zip(ends[::2], ends[1::2], strict=True)]
    return lines


def printable(text: str) -> str:
    """Text with a question mark for each character that Helvetica lacks."""
    return re.sub(r"[\x00-\x1f\x7f]", "?", text).encode(ENCODING, "replace").decode(ENCODING)


def truncated(text: str, width: float, height: float) -> str:
    """Text truncated to a width [mm], with an ellipsis if it does not fit."""
    text = printable(text)
    if Lettering((0.0, 0.0), text, height).width <= width:
        return text
    while text and Lettering((0.0, 0.0), text + "…", height).width > width:
        text = text[:-1]
    return text + "…"


def wrapped(text: str, width: float, height: float) -> list[str]:
    """Lines of a text, each at most that wide [mm]; a longer word is truncated."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and Lettering((0.0, 0.0), longer, height).width <= width:
            lines[-1] = longer
        else:
            lines.append(truncated(word, width, height))
    return lines


ARROW = 3.0
"""Length of an arrowhead [mm]; its width is a third of it."""

OVERHANG = 1.5
"""Length of extension lines beyond the dimension line, twice their gap to the outline [mm]."""

TEXT_RAISE = 0.9
"""Distance of a text above its line [mm]."""

LEADING = 4.4
"""Line spacing of text [mm]."""


def arrow(tip: Point, toward: Point) -> Area:
    """Arrowhead that points in the direction `toward`, a vector of any length."""
    (x, y), (u, v) = tip, toward
    length = math.hypot(u, v)
    u, v = u / length, v / length
    back, half = (x - ARROW * u, y - ARROW * v), ARROW / 6.0
    return Area(
        (tip, (back[0] - half * v, back[1] + half * u), (back[0] + half * v, back[1] - half * u))
    )


def fits_inside(label: str, span: float) -> bool:
    """Whether a text fits between the arrows of a dimension of that length [mm]."""
    return Lettering((0.0, 0.0), label).width + 2.0 <= span and span >= 3.0 * ARROW


def vertical_dimension(
    label: str, *, x: float, middle: float, half: float, outline_x: float
) -> list[Item]:
    """Vertical dimension beside an outline, with its text turned between the arrows.

    Args:
        label: text, which must pass `fits_inside`.
        x: x of the dimension line, left of the outline.
        middle, half: y of its middle, and half its length.
        outline_x: x where the extension lines leave the outline.
    """
    top, bottom = middle - half, middle + half
    line_end, line_start = x - OVERHANG, outline_x - OVERHANG / 2.0
    text = Lettering((x - TEXT_RAISE, middle), label, anchor=Anchor.MIDDLE, upright=True)
    lines = [Line((line_start, y), (line_end, y)) for y in (top, bottom)]
    arrows = arrow((x, top), (0.0, -1.0)), arrow((x, bottom), (0.0, 1.0))
    return [*lines, Line((x, top), (x, bottom)), *arrows, text]


def horizontal_dimension(
    label: str, *, left: float, right: float, y: float, text_x: float | None = None
) -> list[Item]:
    """Horizontal dimension with its text above its middle, or to its right, starting at `text_x`.

    In the latter case the arrows are outside if there is no room between them.
    """
    start, end, side = left, right, 1.0
    text = Lettering(((left + right) / 2.0, y - TEXT_RAISE), label, anchor=Anchor.MIDDLE)
    if text_x is not None:
        text = Lettering((text_x, y - TEXT_RAISE), label)
        end = text_x + text.width
        if right - left < 3.0 * ARROW:
            start, side = left - 2.0 * ARROW, -1.0
    arrows = arrow((left, y), (-side, 0.0)), arrow((right, y), (side, 0.0))
    return [Line((start, y), (end, y)), *arrows, text]


def extension_line(x: float, start: float, end: float) -> Line:
    """Vertical extension line from an outline at the y `start` to a dimension line at `end`."""
    sign = math.copysign(1.0, end - start)
    return Line((x, start + sign * OVERHANG / 2.0), (x, end + sign * OVERHANG))


def leader(lines: Sequence[str], center: Point, radius: float, shelf: Point) -> list[Item]:
    """Leader toward the centre of a circle [mm], from a shelf under the first line of its text."""
    (x, y), (cx, cy) = shelf, center
    distance = math.hypot(x - cx, y - cy)
    u, v = (cx - x) / distance, (cy - y) / distance
    tip = (cx - radius * u, cy - radius * v)
    texts = [
        Lettering((x + 1.0, y - TEXT_RAISE + row * LEADING), line) for row, line in enumerate(lines)
    ]
    end = x + 2.0 + max(text.width for text in texts)
    return [Line(tip, shelf), Line(shelf, (end, y)), arrow(tip, (u, v)), *texts]


def viewing_arrow(*, x: float, edge: float, down: bool) -> list[Item]:
    """One end of the vertical cutting plane A of a section, seen from the right (ISO 128-3).

    It leaves the outline at the y `edge`, upward or `down`.
    """
    sign = 1.0 if down else -1.0
    y = edge + 7.0 * sign
    return [
        Line((x, edge + 3.5 * sign), (x, edge + 9.0 * sign), OUTLINE),
        Line((x, y), (x + 10.0, y), OUTLINE),
        arrow((x, y), (-1.0, 0.0)),
        # Leaders come in from the right.
        Lettering((x - 2.5, y + 1.75), "A", 3.5, Anchor.END),
    ]
