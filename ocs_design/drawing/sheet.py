"""What a drawing is made of. Millimetres on paper from the sheet's upper left corner, y down."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from ocs_design.drawing.helvetica import ASCENT, CAP_HEIGHT, DESCENT, printable, text_width

WIDTH, HEIGHT = 297.0, 210.0
"""A4, landscape."""

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


class Anchor(StrEnum):
    """Which end of a text its place is; the values are SVG's."""

    START = "start"
    MIDDLE = "middle"
    END = "end"


_ANCHOR_PART = {Anchor.START: 0.0, Anchor.MIDDLE: 0.5, Anchor.END: 1.0}


@dataclass(frozen=True)
class Line:
    """A straight line."""

    start: Point
    end: Point
    pen: Pen = THIN


@dataclass(frozen=True)
class Circle:
    """A whole circle."""

    center: Point
    radius: float
    pen: Pen = OUTLINE


@dataclass(frozen=True)
class Area:
    """A black polygon without an outline, such as the head of an arrow."""

    corners: tuple[Point, ...]


@dataclass(frozen=True)
class Text:
    """One line of lettering.

    Attributes:
        place: on the baseline, at the anchor.
        text: characters that Helvetica lacks have become question marks.
        height: of its capitals [mm] (ISO 3098: 1.8, 2.5, 3.5, 5).
        anchor: which end `place` is.
        upright: whether it is read from the sheet's right side, turned by a quarter to the left.
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
        """Of the font [mm]."""
        return self.height / CAP_HEIGHT

    @property
    def width(self) -> float:
        """Along the baseline [mm]."""
        return text_width(self.text, self.size)

    @property
    def start(self) -> Point:
        """Where its first letter begins on the baseline."""
        x, y = self.place
        back = _ANCHOR_PART[self.anchor] * self.width
        return (x, y + back) if self.upright else (x - back, y)

    @property
    def box(self) -> Box:
        """What it covers."""
        (x, y), above, below = self.start, ASCENT * self.size, DESCENT * self.size
        if self.upright:
            return (x - above, y - self.width, x + below, y)
        return (x, y - above, x + self.width, y + below)


Item: TypeAlias = Line | Circle | Area | Text


def outline(corners: Sequence[Point], pen: Pen = OUTLINE) -> list[Item]:
    """A closed polygon, line by line."""
    following = [*corners[1:], corners[0]]
    return [Line(a, b, pen) for a, b in zip(corners, following, strict=True)]


def rectangle(left: float, top: float, right: float, bottom: float) -> tuple[Point, ...]:
    """Its corners, clockwise as seen."""
    return (left, top), (right, top), (right, bottom), (left, bottom)


def fitted(text: str, width: float, height: float) -> str:
    """As much of a text as fits [mm], with an ellipsis for what does not."""
    text = printable(text)
    if Text((0.0, 0.0), text, height).width <= width:
        return text
    while text and Text((0.0, 0.0), text + "…", height).width > width:
        text = text[:-1]
    return text + "…"


def wrapped(text: str, width: float, height: float) -> list[str]:
    """The words of a text in lines of at most that width [mm]; a longer word is cut."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and Text((0.0, 0.0), longer, height).width <= width:
            lines[-1] = longer
        else:
            lines.append(fitted(word, width, height))
    return lines
