"""A front in the terminal: table, plot of dots of Braille, and why some points have no device."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from ocs_design.common.units import format_quantity, to_unit
from ocs_design.device.answers import Front
from ocs_design.report.quantities import grams, tenths
from ocs_design.report.table import Cell, Table, Tone, Toned, columns
from ocs_design.report.text.console import breaks_lines
from ocs_design.report.text.layout import INDENT, facts, heading, items, note, show

PLOT_HEIGHT = 12
"""Rows of the plot's area."""

MARGIN = 14
"""Columns beside the plot's area, for indent and names."""

OWN, NONE = "┴", "×"
"""Marks on the plot's axis: the specification's own value, and a value without a device."""


def print_front(console: Console, front: Front) -> None:
    """Everything that the terminal shows of a front."""
    heading(console, f"Lightest device against {front.label}: {front.robot}")
    same = [f"{name} {value}" for name, value in _same(front).items()]
    facts(
        console,
        [
            ("as specified", _value(front, front.own_value)),
            *([("in every device", ", ".join(same))] if same else []),
        ],
    )
    items(console, front.remarks)
    if front.feasible:
        show(console, _table(front))
        _print_plot(console, front)
    without = [point for point in front.points if point.device is None]
    if without:
        heading(console, "No device")
        reasons = (f"{_value(front, point.value)}: {point.reason}" for point in without)
        items(console, reasons, style="yellow")


def _same(front: Front) -> Mapping[str, str]:
    """Gear and material where all devices have the same."""
    found = {
        name: {getattr(point.device, name) for point in front.feasible}
        for name in ("gear", "material")
    }
    return {name: values.pop() for name, values in found.items() if len(values) == 1}


def _table(front: Front) -> Table:
    """Mass, rim, incidence and drive at each value; a value without a device says so."""
    names = [name for name in ("motor", "gear", "material") if name not in _same(front)]
    heads = columns(
        f" [{front.unit}]", "mass [g]", f"<{', '.join(names)}", "of robot [%]", "R [mm]", "r [mm]",
        "h [mm]", "alpha [deg]",
    )  # fmt: skip
    rows: list[tuple[Cell, ...]] = []
    for point in front.points:
        value, device = f"{to_unit(point.value, front.unit):.4g}", point.device
        if device is None:
            texts = (value, "none", "see below", *[""] * (len(heads) - 3))
            rows.append(tuple(Toned(text, Tone.PLAIN) for text in texts))
            continue
        lengths = (device.outer_radius, device.inner_radius, device.height)
        rows.append(
            (
                value,
                f"{1e3 * device.mass:.1f}",
                ", ".join(getattr(device, name) for name in names),
                f"{100.0 * device.share:.1f}",
                *map(tenths, lengths),
                f"{np.degrees(device.incidence):.1f}",
            )
        )
    return Table(heads, tuple(rows))


def _print_plot(console: Console, front: Front) -> None:
    """Mass against the value, where there is a terminal that has Braille."""
    if not console.encoding.startswith("utf") or not breaks_lines(console):
        return
    heading(console, f"Mass of the device against {front.label}")
    canvas = Canvas(max(console.width - MARGIN, 20), PLOT_HEIGHT)
    across = Scale.of([point.value for point in front.points])
    up = Scale.of([point.device.mass for point in front.points if point.device], room=0.05)
    places = [
        (across.part(point.value), up.part(point.device.mass)) if point.device else None
        for point in front.points
    ]
    for one, other in pairwise(places):
        if one and other:
            canvas.line(one, other)
    for place in filter(None, places):
        canvas.dot(*place)
    marks = {
        canvas.column(across.part(point.value)): NONE
        for point in front.points
        if point.device is None
    }
    if front.spans_own_value:
        marks[canvas.column(across.part(front.own_value))] = OWN
    ends = (_value(front, across.low), _value(front, across.high))
    rows = frame(canvas, x_ends=ends, y_ends=(grams(up.low), grams(up.high)), marks=marks)
    console.print(Padding(Text("\n".join(rows), no_wrap=True), INDENT))
    note(console, f"{OWN} as specified, {NONE} no device")


def print_written(console: Console, front: Front, folder: Path | None) -> None:
    """Files of the front, and the command that makes a whole device of a point."""
    heading(console, "Any point as a whole design")
    if folder is None:
        note(console, "-o DIR writes the specification of each point for `ocs-design size --spec`")
        return
    names = ", ".join(sorted(path.name for path in folder.glob("front.*")))
    chosen = min(front.feasible or front.points, key=lambda p: abs(p.value - front.own_value))
    command = shlex.join(["ocs-design", "size", "--spec", str(folder / chosen.file)])
    facts(console, [("front", f"{folder}/: {names}"), (_value(front, chosen.value), command)])


def _value(front: Front, value: float) -> str:
    return format_quantity(value, front.unit)


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
    """The canvas of a curve with its axes: words at their ends, and marks on x by their columns."""
    bottom, top = y_ends
    margin = max(len(bottom), len(top))
    names = [top, *[""] * (canvas.height - 2), bottom]
    rows = [f"{name:>{margin}} ┤{row}" for name, row in zip(names, canvas.rows(), strict=True)]
    axis = "".join(marks.get(column, "─") for column in range(canvas.width))
    left, right = x_ends
    below = left + right.rjust(canvas.width - len(left))
    return [*rows, f"{'':{margin}} └{axis}", f"{'':{margin}}  {below}"]
