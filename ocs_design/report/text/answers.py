"""Answers of the smaller commands in the terminal: bound, init and export."""

import numpy as np
from rich.console import Console

from ocs_design.common.units import rpm
from ocs_design.device.answers import BoundAnswer, Exported, Initialized, LayoutsAnswer
from ocs_design.report.quantities import BOUND_NOTE, degrees, inertia
from ocs_design.report.table import Table, columns
from ocs_design.report.text.layout import facts, files_written, heading, note, show


def print_bound(console: Console, answer: BoundAnswer) -> None:
    """Bound as printed in the paper and as it should be, for each wheel, and its curve."""
    heading(console, f"Lower bound on the device's inertia about {answer.axis}")
    facts(
        console,
        [
            ("robot", inertia(answer.inertia)),
            ("rate change d", f"{answer.rate_change:.4g} rad/s"),
            ("wheel speed gamma", rpm(answer.wheel_speed_max)),
            ("one wheel, required", inertia(answer.required, 6)),
            ("one wheel, as the paper prints it", inertia(answer.paper, 6)),
            (f"each of two at {degrees(answer.incidence)}", inertia(answer.spin_inertia, 6)),
        ],
    )
    note(console, BOUND_NOTE)
    heading(console, "Required over robot's inertia in percent: wheel speed against rate change")
    rates = columns("<", *(f"{rate:.3g} [rad/s]" for rate in answer.rate_changes))
    rows = tuple(
        (rpm(speed), *(f"{100.0 * share:.3g}" if np.isfinite(share) else "-" for share in row))
        for speed, row in zip(answer.wheel_speeds, answer.curve, strict=True)
    )
    show(console, Table(rates, rows))


def print_layouts(console: Console, answer: LayoutsAnswer) -> None:
    """A row for each layout, then why there is none, or what keeps it from being built."""
    heading(console, f"Layouts for {answer.robot}: mass, and momentum that they can give")
    axes = (f"{axis} [N m s]" for axis in ("roll", "pitch", "yaw"))
    lost = (f"{axis}, one lost [N m s]" for axis in ("roll", "pitch", "yaw"))
    rows = tuple(
        (
            each.layout,
            "-" if each.mass is None else f"{1e3 * each.mass:.0f}",
            each.motor or "-",
            ", ".join(each.survives) or "-",
            *(f"{value:.3g}" for value in (*each.momentum, *each.momentum_without_one)),
        )
        for each in answer.layouts
    )
    names = ("<", "mass [g]", "<motor", "<survives one lost in", *axes, *lost)
    show(console, Table(columns(*names), rows))
    for each in answer.layouts:
        for text in (*each.open, *([each.without] if each.without else [])):
            note(console, f"{each.layout}: {text}")


def print_initialized(console: Console, initialized: Initialized) -> None:
    """File that was written, and the command that designs by it."""
    facts(console, [("written", initialized.file), ("next", initialized.next)])


def print_export(console: Console, exported: Exported) -> None:
    """Files by their folders, and notes on them."""
    files_written(console, exported.folder, exported.files, "the design as it was")
    for each in exported.notes:
        note(console, each)
