"""The story of a design on one screen; `-v` has all of it."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path, PurePosixPath

from rich.console import Console
from rich.text import Text

from ocs_design.device.records import OcsDesign
from ocs_design.export.folder import DESIGN_FILE, REPORT_FILE
from ocs_design.report.device import device_facts, device_title, has_motor, robot_facts
from ocs_design.report.flights import short_verdict
from ocs_design.report.limits import first_margins, used_up, what_saves
from ocs_design.report.table import Cell, Table, columns
from ocs_design.report.text.layout import facts, heading, items, note, show
from ocs_design.report.text.plots import tilt_plots
from ocs_design.report.text.size import print_alternatives
from ocs_design.report.text.validation import print_headline
from ocs_design.report.verdict import headline
from ocs_design.report.warnings import all_warnings
from ocs_design.simulation.scenario import Run

ROBOT_FACTS = ("mass", "posture", "locked inertia")
DEVICE_FACTS = (
    "total mass",
    "mass of a module",
    "carrier plate",
    "incidence alpha*",
    "rim",
    "spin inertia",
    "motor",
    "gear",
    "drive at the wheel",
    "wheels at",
)

NARROWEST_PLOT, WIDEST_PLOT = 8, 20
BESIDE_PLOTS = 63
"""Columns of the flights' table without its plots."""


def print_summary(console: Console, design: OcsDesign, runs: Sequence[Run], folder: Path) -> None:
    """The verdict first, and last once more, where the eye is when a command ends."""
    line = headline(design)
    print_headline(console, line)
    if design.requirement.assumptions:
        heading(console, "Assumed, because nothing else was specified")
        note(console, " ".join(design.requirement.assumptions))
    heading(console, f"Robot: {design.robot.name}")
    facts(console, _chosen(robot_facts(design.robot), ROBOT_FACTS))
    heading(console, device_title(design))
    rows = dict(_chosen(device_facts(design), DEVICE_FACTS))
    if has_motor(design):
        # The source of a motor's figures is left to the whole report.
        rows["motor"] = design.ocs.motor.name
    used = first_margins(design)
    if used:
        rows["used at most"] = used
    rows["limits"] = used_up(design)
    saves = "" if design.selection is None else what_saves(design.selection)
    if saves:
        rows["looser limits"] = saves
    facts(console, rows.items())
    print_alternatives(console, design)
    if runs:
        heading(console, "Flights in MuJoCo, with the device and without")
        show(console, _flights(console, design, runs))
    warnings = list(all_warnings(design))
    if warnings:
        heading(console, "Warnings")
        items(console, warnings, style="yellow")
    console.print()
    # The artefact, the report, the other files beside them, and the folders.
    paths = [PurePosixPath(name) for name in design.files]
    beside = sorted(str(path) for path in paths if len(path.parts) == 1)
    folders = sorted({f"{path.parts[0]}/" for path in paths if len(path.parts) > 1})
    written = ", ".join([DESIGN_FILE, REPORT_FILE, *beside, *folders])
    console.print(Text(f"{folder}/: {written}"))
    print_headline(console, line, Text("(-v: all figures)", "dim"))


def _chosen(rows: Iterable[tuple[str, str]], names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Rows of these names, in the order of the names."""
    found = dict(rows)
    return ((name, found[name]) for name in names if name in found)


def _flights(console: Console, design: OcsDesign, runs: Sequence[Run]) -> Table:
    """Each scenario with the device and without, and a curve of its tilt where there is room."""
    width = min((console.width - BESIDE_PLOTS) // 2, WIDEST_PLOT)
    plotted = width >= NARROWEST_PLOT and console.encoding.startswith("utf")
    flips = {item.name for item in design.requirement.maneuvers if item.kind == "flip"}
    pairs = zip(runs[::2], runs[1::2], strict=True)
    records = zip(design.validation[::2], design.validation[1::2], strict=True)
    rows: list[tuple[Cell, ...]] = []
    for pair, recorded in zip(pairs, records, strict=True):
        verdicts = (short_verdict(run, turns=run.scenario in flips) for run in recorded)
        curves = tilt_plots([run.series for run in pair], width)[0] if plotted else ()
        rows.append((recorded[0].scenario, *verdicts, *curves))
    names = (
        "<scenario",
        "<with\ndeg off level",
        "<without\ndeg off level",
        "<tilt with",
        "<without",
    )
    return Table(columns(*names[: 5 if plotted else 3]), tuple(rows))
