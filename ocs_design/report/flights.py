"""The proof by simulation in the terminal, and what was written."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.design_file import OcsDesign, ValidationRecord
from ocs_design.export.folder import DESIGN_FILE, REPORT_FILE
from ocs_design.report.layout import columns, facts, heading, items, show
from ocs_design.report.quantities import degrees

WITH_DEVICE = {True: ("pass", "green"), False: ("FAIL", "bold red"), None: ("not judged", "yellow")}
# Without the device a failure is what one expects, and no alarm.
WITHOUT_DEVICE = {True: ("pass", ""), False: ("fails", "dim"), None: ("not judged", "dim")}


MOST_LISTED = 6
"""Files of one folder that are named; more are counted."""


def print_flights(console: Console, design: OcsDesign) -> None:
    """See `print_runs`; nothing if none was flown."""
    if design.validation:
        print_runs(console, design.validation)


def print_runs(console: Console, runs: Sequence[ValidationRecord]) -> None:
    """Verdicts, attitude at touchdown, what the wheels did, and why."""
    heading(console, "Proof in MuJoCo: the same flights with and without the device")
    table = columns(
        "scenario", "verdict", "touchdown\npitch  roll\ndeg", "end\npitch  roll\ndeg",
        "turned\n\ndeg", "wheel\nspeed\nrpm", "motor\ntorque\nN m", left=2,
    )  # fmt: skip
    for run in runs:
        table.add_row(*_run_row(run))
    show(console, table)
    items(console, (run_story(run) for run in runs))


def _run_row(run: ValidationRecord) -> list[Text | str]:
    word, style = (WITH_DEVICE if run.ocs else WITHOUT_DEVICE)[run.passed]
    metrics = run.metrics
    speed, torque = metrics.get("peak_wheel_speed"), metrics.get("peak_wheel_torque")
    return [
        Text(run.scenario if run.ocs else "  without"),
        Text(word, style=style),
        _tilt(metrics, "touchdown") if flies(metrics) else "-",
        _tilt(metrics, "final"),
        _deg(metrics, "turned_angle") if flies(metrics) else "-",
        "-" if not run.ocs or speed is None else f"{speed * 30 / np.pi:,.0f}",
        "-" if not run.ocs or torque is None else f"{torque:.3g}",
    ]


def run_story(run: ValidationRecord, *, with_note: bool = True) -> str:
    """The verdict in words, with what was changed about the turn unless that is told elsewhere."""
    device = "with" if run.ocs else "without"
    told = (run.reason, run.note if with_note else "")
    return f"{run.scenario}, {device}: " + "; ".join(filter(None, told))


def flies(metrics: Mapping[str, float | bool | None]) -> bool:
    """Whether the robot was in the air; who is shoved as they stand touch down at once.

    A jump whose feet never left the ground has no lift-off.
    """
    # Records of older versions say nothing of it, and all of theirs start in the air.
    lift_off, touchdown = metrics.get("lift_off_time", 0.0), metrics.get("touchdown_time")
    return lift_off is not None and (touchdown is None or touchdown > lift_off)


def _tilt(metrics: Mapping[str, float | bool | None], when: str) -> str:
    """Pitch and roll [deg], side by side."""
    return f"{_deg(metrics, f'{when}_pitch')} {_deg(metrics, f'{when}_roll'):>5}"


def _deg(metrics: Mapping[str, float | bool | None], name: str) -> str:
    value = metrics.get(name)
    return "-" if value is None else degrees(value).removesuffix(" deg")


def print_outcome(console: Console, design: OcsDesign, folder: Path) -> None:
    """What was written, and the verdict in one line."""
    print_files(console, str(folder), design.files, "everything in this report")
    console.print()
    print_verdicts(console, design.validation)


def print_verdicts(console: Console, runs: Sequence[ValidationRecord]) -> None:
    """The flights with the device in one line."""
    console.print(summary([run.passed for run in runs if run.ocs]))


def print_files(console: Console, folder: str, files: Iterable[str], held: str = "") -> None:
    """What a folder got, by the folders in it.

    Args:
        console: to print on.
        folder: that it was written to.
        files: paths in that folder, without a design.json.
        held: what its design.json holds; empty: it has none.
    """
    heading(console, f"Written to {folder}/")
    rows = [(DESIGN_FILE, f"{held}, and the hashes of the other files")] if held else []
    if (Path(folder) / REPORT_FILE).is_file():
        rows.append(
            (REPORT_FILE, "all of it to look at, to mail and to sign: open it in a browser")
        )
    folders: dict[str, list[str]] = {}
    for name in (name for name in files if name != REPORT_FILE):
        folder_name, _, file = name.rpartition("/")
        folders.setdefault(folder_name, []).append(file)
    rows += [(f"{name or '.'}/", _listed(names)) for name, names in sorted(folders.items())]
    facts(console, rows)


def _listed(files: Sequence[str]) -> str:
    """All of a few files, the number of many."""
    return "  ".join(files) if len(files) <= MOST_LISTED else f"{len(files)} files"


def summary(verdicts: Sequence[bool | None]) -> Text:
    """The flights with the device in one line."""
    if not verdicts:
        return Text("No flight was simulated: the design is not proved.", style="bold yellow")
    passed, failed = verdicts.count(True), verdicts.count(False)
    line = f"{passed} of {len(verdicts)} scenarios pass with the device"
    if unknown := len(verdicts) - passed - failed:
        line += f", {unknown} could not be judged"
    return Text(line, style="bold green" if passed == len(verdicts) else "bold red")
