"""Curves in a terminal: bars of blocks, or cells that hold two by four dots of Braille each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.report.flights import off_level
from ocs_design.simulation.run import Series

BARS = " ▁▂▃▄▅▆▇█"
"""Eighths of a character's height, and none."""

LEAST_SPAN = np.radians(5.0)
"""Smallest angle of a full bar [rad]: what counts as level is drawn as level."""

_FLAT = 1e-6
"""Spread of values, relative to them, below which they are equal: rounding is not drawn."""

_BLANK = 0x2800
_DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bit of each dot of a cell by its row and column (Unicode, Braille Patterns)."""


@dataclass(frozen=True)
class Scale:
    """Values along one axis.

    Attributes:
        low, high: ends, low < high.
    """

    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float], room: float = 0.0) -> "Scale":
        """Scale of values, with `room` times their spread at either end; never empty."""
        low, high = min(values), max(values)
        if high - low <= _FLAT * max(abs(low), abs(high)):
            half = 0.1 * abs(high) or 1.0
            return cls(low - half, high + half)
        return cls(low - room * (high - low), high + room * (high - low))

    def part(self, value: float) -> float:
        """0 at the low end, 1 at the high one."""
        return (value - self.low) / (self.high - self.low)


class Canvas:
    """A grid of dots, its origin at the lower left.

    Attributes:
        width, height: in characters.
    """

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._cells = np.zeros((height, width), dtype=np.int64)

    def column(self, x: float) -> int:
        """The character that holds the dots at a part of the width."""
        return round(x * (2 * self.width - 1)) // 2

    def dot(self, x: float, y: float) -> None:
        """Set the dot at a part of the width and of the height, 0..1."""
        column = round(x * (2 * self.width - 1))
        row = round((1.0 - y) * (4 * self.height - 1))
        self._cells[row // 4, column // 2] |= _DOTS[row % 4, column % 2]

    def line(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Draw a straight line without gaps."""
        for part in np.linspace(0.0, 1.0, 4 * (self.width + self.height)):
            x, y = ((1.0 - part) * a + part * b for a, b in zip(start, end, strict=True))
            self.dot(x, y)

    def rows(self) -> list[str]:
        """Lines of characters from the top."""
        return ["".join(chr(_BLANK + cell) for cell in row) for row in self._cells.tolist()]


def frame(
    canvas: Canvas, *, x_ends: tuple[str, str], y_ends: tuple[str, str], marks: dict[int, str]
) -> list[str]:
    """The canvas with its axes.

    Args:
        canvas: of one curve.
        x_ends: below the left and the right end. y_ends: beside the bottom and the top.
        marks: one character on the x axis by its column.
    """
    bottom, top = y_ends
    margin = max(len(bottom), len(top))
    names = [top, *[""] * (canvas.height - 2), bottom]
    rows = [f"{name:>{margin}} ┤{row}" for name, row in zip(names, canvas.rows(), strict=True)]
    axis = "".join(marks.get(column, "─") for column in range(canvas.width))
    left, right = x_ends
    below = left + right.rjust(canvas.width - len(left))
    return [*rows, f"{'':{margin}} └{axis}", f"{'':{margin}}  {below}"]


def tilt_plots(flights: Sequence[Series], width: int) -> tuple[list[str], float]:
    """Bars of the tilt of each flight, all to one scale, and the tilt of a full bar [rad].

    A bar is the largest tilt of its part of the time; where a flight has ended there is none.
    """
    tilts = [off_level(series.roll, series.pitch) for series in flights]
    end = max(float(series.time[-1]) for series in flights)
    top = max([float(angles.max()) for angles in tilts] + [LEAST_SPAN])
    plots = []
    for series, angles in zip(flights, tilts, strict=True):
        places = np.minimum(series.time / end * width, width - 1).astype(np.int64)
        highest = np.zeros(width)
        np.maximum.at(highest, places, np.maximum(np.ceil(8.0 * angles / top - 1e-9), 1.0))
        plots.append("".join(BARS[int(height)] for height in highest))
    return plots, top
