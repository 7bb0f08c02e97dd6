"""Pareto front in the terminal: table, Braille plot, and why some points have no device."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import format_quantity, to_unit
from ocs_design.common.wording import grams, tenths
from ocs_design.device.answers import Front
from ocs_design.report.charts.chart import Axis
from ocs_design.report.table import Cell, CellTable, Tone, Toned, columns
from ocs_design.report.text.console import breaks_lines
from ocs_design.report.text.layout import INDENT, facts, heading, items, note, show

PLOT_HEIGHT = 12
"""Rows of the plot's area."""

MARGIN = 14
"""Columns beside the plot's area, for the indent and the labels of the axis."""

OWN_VALUE_MARK, NO_DEVICE_MARK = "┴", "×"
"""Marks on the plot's axis: the specification's own value, and a value without a device."""


def print_front(console: Console, front: Front, folder: Path | None = None) -> None:
    """Print a front, and the place of its files if they were written."""
    heading(console, f"Lightest device against {front.label}: {front.robot}")
    common = [f"{name} {value}" for name, value in _common_parts(front).items()]
    facts(
        console,
        [
            ("as specified", _value(front, front.own_value)),
            *([("same for all", ", ".join(common))] if common else []),
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
    heading(console, "To design any point in full")
    if folder is None:
        note(console, "-o DIR writes the specification of each point for `ocs-design size --spec`")
        return
    names = ", ".join(sorted(path.name for path in folder.glob("front.*")))
    nearest = min(front.feasible or front.points, key=lambda p: abs(p.value - front.own_value))
    command = shlex.join(["ocs-design", "size", "--spec", str(folder / nearest.file)])
    facts(console, [("front", f"{folder}/: {names}"), (_value(front, nearest.value), command)])


def _common_parts(front: Front) -> Mapping[str, str]:
    """Gear and material that all devices have in common."""
    parts = {
        name: {getattr(point.device, name) for point in front.feasible}
        for name in ("gear", "material")
    }
    return {name: values.pop() for name, values in parts.items() if len(values) == 1}


def _table(front: Front) -> CellTable:
    """Mass, rim, incidence and drive at each value, or a note that there is no device."""
    names = [name for name in ("motor", "gear", "material") if name not in _common_parts(front)]
    headings = columns(
        f" [{front.unit}]", "mass [g]", f"<{', '.join(names)}", "of robot [%]", "R [mm]", "r [mm]",
        "h [mm]", "alpha [deg]",
    )  # fmt: skip
    rows: list[tuple[Cell, ...]] = []
    for point in front.points:
        value, device = f"{to_unit(point.value, front.unit):.4g}", point.device
        if device is None:
            texts = (value, "none", "see below", *[""] * (len(headings) - 3))
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
    return CellTable(headings, tuple(rows))


def _print_plot(console: Console, front: Front) -> None:
    """Plot the mass against the value if the terminal can show Braille."""
    if not console.encoding.startswith("utf") or not breaks_lines(console):
        return
    heading(console, f"Mass of the device against {front.label}")
    width = max(console.width - MARGIN, 20)
    values = np.array([point.value for point in front.points])
    masses = np.array([point.device.mass if point.device else np.nan for point in front.points])
    across, up = Axis.around("", "", values, room=0.0), Axis.around("", "", masses, room=0.05)
    plot = braille(across.fractions(values), up.fractions(masses), width, PLOT_HEIGHT)
    marked = [(point.value, NO_DEVICE_MARK) for point in front.points if point.device is None]
    if front.spans_own_value:
        marked.append((front.own_value, OWN_VALUE_MARK))
    # Characters that contain the dots at these values.
    places = across.fractions(np.array([value for value, _ in marked])) * (2 * width - 1)
    columns_of = (np.rint(places).astype(np.int64) // 2).tolist()
    marks = {column: mark for column, (_, mark) in zip(columns_of, marked, strict=True)}
    ends = (_value(front, across.low), _value(front, across.high))
    rows = frame(plot, x_ends=ends, y_ends=(grams(up.low), grams(up.high)), marks=marks)
    console.print(Padding(Text("\n".join(rows), no_wrap=True), INDENT))
    note(console, f"{OWN_VALUE_MARK} as specified, {NO_DEVICE_MARK} no device")


def _value(front: Front, value: float) -> str:
    return format_quantity(value, front.unit)


_BLANK = 0x2800
_DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bit of each dot of a cell, by row and column (Unicode, Braille Patterns)."""


def braille(x: FloatArray, y: FloatArray, width: int, height: int) -> list[str]:
    """Braille plot of points joined by straight lines, as lines of text from the top.

    Coordinates are fractions of width and height, 0..1 from the lower left; NaN breaks the curve.
    """
    steps = np.linspace(0.0, 1.0, 4 * (width + height))[:, None]
    abscissas, heights = (
        np.concatenate(
            [coordinate, ((1.0 - steps) * coordinate[:-1] + steps * coordinate[1:]).ravel()]
        )
        for coordinate in (x, y)
    )
    columns, rows = (
        np.rint(part[np.isfinite(heights)] * (resolution - 1)).astype(np.int64)
        for part, resolution in ((abscissas, 2 * width), (1.0 - heights, 4 * height))
    )
    cells = np.full((height, width), _BLANK)
    np.bitwise_or.at(cells, (rows // 4, columns // 2), _DOTS[rows % 4, columns % 2])
    return ["".join(map(chr, row)) for row in cells.tolist()]


def frame(
    plot: Sequence[str], *, x_ends: tuple[str, str], y_ends: tuple[str, str], marks: dict[int, str]
) -> list[str]:
    """Plot with axes, labels at their ends, and marks on the x axis by their columns."""
    (bottom, top), (left, right), width = y_ends, x_ends, len(plot[0])
    margin = max(len(bottom), len(top))
    names = [top, *[""] * (len(plot) - 2), bottom]
    rows = [f"{name:>{margin}} ┤{row}" for name, row in zip(names, plot, strict=True)]
    axis = "".join(marks.get(column, "─") for column in range(width))
    below = left + right.rjust(width - len(left))
    return [*rows, f"{'':{margin}} └{axis}", f"{'':{margin}}  {below}"]
