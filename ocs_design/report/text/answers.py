"""Terminal output of the smaller commands: bound, layouts, init, export and doctor."""

from collections.abc import Iterable

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.common.errors import extra_command
from ocs_design.common.units import rpm
from ocs_design.common.wording import degrees, inertia, listed
from ocs_design.device.answers import BoundAnswer, Exported, Initialized, LayoutsAnswer
from ocs_design.device.findings import Examination, Finding, State
from ocs_design.report.limits import BOUND_NOTE
from ocs_design.report.table import CellTable, Tone, Toned, columns
from ocs_design.report.text.layout import facts, files_written, heading, items, note, show


def print_bound(console: Console, answer: BoundAnswer) -> None:
    """Print the bound as in the paper and corrected, for each wheel, and its curve."""
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
    heading(
        console,
        "Required inertia over the robot's in percent, by wheel speed (rows) and rate change",
    )
    rates = columns("<", *(f"{rate:.3g} [rad/s]" for rate in answer.rate_changes))
    rows = tuple(
        (rpm(speed), *(f"{100.0 * share:.3g}" if np.isfinite(share) else "-" for share in row))
        for speed, row in zip(answer.wheel_speeds, answer.curve, strict=True)
    )
    show(console, CellTable(rates, rows))


def print_layouts(console: Console, answer: LayoutsAnswer) -> None:
    """Print a row for each layout, then reasons why one is missing or cannot be built."""
    heading(console, f"Layouts for {answer.robot}: mass and available momentum")
    axes = (f"{axis} [N m s]" for axis in ("roll", "pitch", "yaw"))
    lost = (f"{axis}, one lost [N m s]" for axis in ("roll", "pitch", "yaw"))
    rows = tuple(
        (
            option.layout,
            "-" if option.mass is None else f"{1e3 * option.mass:.0f}",
            option.motor or "-",
            ", ".join(option.survives) or "-",
            *(f"{value:.3g}" for value in (*option.momentum, *option.momentum_without_one)),
        )
        for option in answer.layouts
    )
    names = ("<", "mass [g]", "<motor", "<survives one lost in", *axes, *lost)
    show(console, CellTable(columns(*names), rows))
    for option in answer.layouts:
        for text in (*option.open, *([option.without] if option.without else [])):
            note(console, f"{option.layout}: {text}")


def print_initialized(console: Console, initialized: Initialized) -> None:
    """Print the file that was written, and the command that uses it."""
    facts(console, [("written", initialized.file), ("next", initialized.next)])


def print_export(console: Console, exported: Exported) -> None:
    """Print the files by folder, and notes on them."""
    files_written(console, exported.folder, exported.files, "the design, unchanged")
    for remark in exported.notes:
        note(console, remark)


_TONES = {
    State.WORKS: Tone.PASS,
    State.MISSING: Tone.OPEN,
    State.UNFIT: Tone.OPEN,
    State.BROKEN: Tone.FAIL,
}


def print_examination(console: Console, examination: Examination) -> None:
    """Print all findings, remedies for what does not work, and the verdict last."""
    _print_findings(console, "Machine", examination.machine)
    for title, required in (("Packages", True), ("Extras", False)):
        _print_findings(
            console,
            title,
            (finding for finding in examination.packages if finding.required is required),
        )
    not_working = [finding for finding in examination.findings if finding.state is not State.WORKS]
    optional = [
        finding
        for finding in not_working
        if not finding.required and finding.state is State.MISSING
    ]
    _print_cures(console, "To fix", (finding for finding in not_working if finding not in optional))
    _print_cures(console, "To add, if you need the feature", optional)
    extras = dict.fromkeys(finding.extra for finding in optional if finding.extra)
    if len(extras) > 1:
        items(console, [f"all of these: {extra_command(*extras)}"], style="")
    console.print()
    blocking = [finding.name for finding in examination.findings if finding.is_blocking]
    verdict = f"does not work without {listed(blocking)}" if blocking else "works here"
    console.print(Text(f"ocs-design {examination.version} {verdict}", style="bold"))


def _print_findings(console: Console, title: str, findings: Iterable[Finding]) -> None:
    table = CellTable.of(
        findings,
        {
            f"<{title}": lambda finding: finding.name,
            "<state": lambda finding: Toned(finding.state.value, _TONES[finding.state]),
            "<found": lambda finding: finding.found,
            "<wanted": lambda finding: finding.wanted,
            "<for": lambda finding: finding.purpose,
        },
    )
    console.print()
    show(console, table)


def _print_cures(console: Console, title: str, findings: Iterable[Finding]) -> None:
    names_by_cure: dict[str, list[str]] = {}
    for finding in findings:
        if finding.cure:
            reason = f" ({finding.reason})" if finding.reason else ""
            names_by_cure.setdefault(finding.cure, []).append(finding.name + reason)
    cures = [f"{', '.join(names)}: {cure}" for cure, names in names_by_cure.items()]
    if cures:
        heading(console, title)
        items(console, cures, style="")
