"""A front in the terminal: table, plot, and why some points have no device."""

import shlex
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from ocs_design.answers import Front, FrontDevice, FrontPoint
from ocs_design.report.braille import Canvas, Scale, frame
from ocs_design.report.layout import INDENT, columns, facts, heading, items, note, show
from ocs_design.report.quantities import grams, tenths
from ocs_design.units import format_quantity, to_unit

PLOT_HEIGHT = 12
"""Rows of the plot's area."""

MARGIN = 14
"""Columns beside the plot's area, for indent and names."""

OWN, NONE = "┴", "×"
"""On the plot's axis: the specification's own value, and a value without a device."""


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
    _print_reasons(console, front)


def _same(front: Front) -> Mapping[str, str]:
    """Gear and material where all devices have the same."""
    found = {
        name: {getattr(point.device, name) for point in front.feasible}
        for name in ("gear", "material")
    }
    return {name: values.pop() for name, values in found.items() if len(values) == 1}


def _table(front: Front) -> Table:
    names = [name for name in ("motor", "gear", "material") if name not in _same(front)]
    numbers = ("mass\ng", "of robot\n%", "R\nmm", "r\nmm", "h\nmm", "alpha\ndeg")
    table = columns(front.unit, *numbers, ", ".join(names), left=0)
    table.columns[-1].justify = "left"
    for point in front.points:
        value = f"{to_unit(point.value, front.unit):.4g}"
        if point.device is None:
            table.add_row(value, "none", *[""] * (len(numbers) - 1), "see below", style="dim")
        else:
            chosen = ", ".join(getattr(point.device, name) for name in names)
            table.add_row(value, *_figures(point.device), Text(chosen))
    return table


def _figures(device: FrontDevice) -> tuple[str, ...]:
    return (
        f"{1e3 * device.mass:.1f}",
        f"{100.0 * device.share:.1f}",
        tenths(device.outer_radius),
        tenths(device.inner_radius),
        tenths(device.height),
        f"{np.degrees(device.incidence):.1f}",
    )


def _print_plot(console: Console, front: Front) -> None:
    """Left out where the terminal has no Braille."""
    if not console.encoding.startswith("utf"):
        return
    heading(console, f"Mass of the device against {front.label}")
    canvas = Canvas(max(console.width - MARGIN, 20), PLOT_HEIGHT)
    across = Scale.of([point.value for point in front.points])
    masses = [(point.value, point.device.mass) for point in front.points if point.device]
    up = Scale.of([mass for _, mass in masses], room=0.05)
    for one, other in pairwise(front.points):
        if one.device and other.device:
            canvas.line(
                _place(one, one.device, across, up), _place(other, other.device, across, up)
            )
    for value, mass in masses:
        canvas.dot(across.part(value), up.part(mass))
    ends = (_value(front, across.low), _value(front, across.high))
    rows = frame(
        canvas,
        x_ends=ends,
        y_ends=(grams(up.low), grams(up.high)),
        marks=_marks(front, across, canvas),
    )
    console.print(Padding(Text("\n".join(rows), no_wrap=True), INDENT))
    note(console, f"{OWN} as specified, {NONE} no device")


def _place(point: FrontPoint, device: FrontDevice, across: Scale, up: Scale) -> tuple[float, float]:
    return across.part(point.value), up.part(device.mass)


def _marks(front: Front, across: Scale, canvas: Canvas) -> dict[int, str]:
    """By the column of the plot's area."""
    marks = {
        canvas.column(across.part(point.value)): NONE
        for point in front.points
        if point.device is None
    }
    if front.spans_own_value:
        marks[canvas.column(across.part(front.own_value))] = OWN
    return marks


def _print_reasons(console: Console, front: Front) -> None:
    without = [point for point in front.points if point.device is None]
    if without:
        heading(console, "No device")
        reasons = (f"{_value(front, point.value)}: {point.reason}" for point in without)
        items(console, reasons, style="yellow")


def print_written(
    console: Console, front: Front, folder: Path | None, remarks: Sequence[str]
) -> None:
    """Where the front lies, and how a point becomes a device that is exported and flown."""
    heading(console, "Any point as a whole design")
    if folder is None:
        note(console, "-o DIR writes the specification of each point for `ocs-design size --spec`")
        return
    items(console, remarks, style="yellow")
    names = ", ".join(sorted(path.name for path in folder.glob("front.*")))
    chosen = min(front.feasible or front.points, key=lambda p: abs(p.value - front.own_value))
    command = shlex.join(["ocs-design", "size", "--spec", str(folder / chosen.file)])
    facts(
        console,
        [
            ("front", f"{folder}/: {names}"),
            (_value(front, chosen.value), command),
        ],
    )


def _value(front: Front, value: float) -> str:
    return format_quantity(value, front.unit)
