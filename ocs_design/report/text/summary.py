"""The story of a design on one screen; `-v` has all of it."""

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from rich.console import Console
from rich.text import Text

from ocs_design.common.units import format_quantity
from ocs_design.device.records.design import DESIGN_FILE, OcsDesign
from ocs_design.export.folder import REPORT_FILE
from ocs_design.report.device import FIRST_FACTS, device_facts, device_title, share_of_robot
from ocs_design.report.flights import (
    flights_title,
    run_sentence,
    short_verdict,
    survival_cost,
    survival_sentence,
)
from ocs_design.report.limits import (
    assumed,
    heat,
    holding_up,
    lighter,
    lighter_table,
    owed_to,
    tightest,
)
from ocs_design.report.quantities import degrees_number, grams
from ocs_design.report.table import Cell, Table, columns, listed
from ocs_design.report.text.console import breaks_lines
from ocs_design.report.text.layout import facts, heading, items, note, show
from ocs_design.report.text.plots import tilt_plots
from ocs_design.report.text.validation import print_headline
from ocs_design.report.verdict import headline
from ocs_design.report.warnings import all_warnings
from ocs_design.simulation.run import Run

MOST_MARGINS, MOST_MINDED, MOST_CHANGES = 4, 3, 3

NARROWEST_PLOT, WIDEST_PLOT = 8, 20
BESIDE_PLOTS = 64
"""Columns of the flights' table without its plots."""


def print_summary(console: Console, design: OcsDesign, runs: Sequence[Run], folder: Path) -> None:
    """The verdict first, and last once more, where the eye is when a command ends."""
    line = headline(design)
    print_headline(console, line)
    if design.reliability is not None:
        items(console, design.reliability.rounds)
    mass = f"{grams(design.ocs.mass_total)}, {share_of_robot(design)}"
    heading(console, f"{device_title(design)}, {mass}")
    facts(console, _device(design))
    if runs:
        _print_flights(console, design, runs)
    # The verdict names flights already.
    flown = (run for run in design.validation if run.ocs and run.scenario in line.matter)
    told = {line.matter, *(run_sentence(run, with_note=False) for run in flown)}
    minded = [each for each in all_warnings(design) if each not in told]
    if minded:
        more = f"; {len(minded) - MOST_MINDED} more with -v" if len(minded) > MOST_MINDED else ""
        heading(console, f"To mind{more}")
        items(console, minded[:MOST_MINDED], style="yellow")
    changes = lighter(design)[:MOST_CHANGES]
    if changes:
        heading(console, "What one change would save")
        facts(console, changes)
    print_lighter(console, design)
    print_assumed(console, design.requirement.assumptions)
    console.print()
    # The report, the artefact, the other files beside them, and the folders.
    paths = [PurePosixPath(name) for name in design.files]
    beside = sorted(str(path) for path in paths if len(path.parts) == 1)
    folders = sorted({f"{path.parts[0]}/" for path in paths if len(path.parts) > 1})
    written = ", ".join([REPORT_FILE, DESIGN_FILE, *beside, *folders])
    console.print(Text(f"{folder}/: {written}"))
    print_headline(console, line, Text("(-v: all figures)", "dim"))


def _device(design: OcsDesign) -> Iterator[tuple[str, str]]:
    """The robot that it is for, what is to be built, and what sets its mass."""
    robot = design.robot
    yield "robot", f"{robot.name}, {robot.mass:.4g} kg, posture {robot.posture_name}"
    found = dict(device_facts(design))
    yield from ((short, found[name]) for name, short in FIRST_FACTS.items() if name in found)
    owed = owed_to(design)
    why = [listed(holding_up(design)), f"owed to {owed}" if owed else ""]
    if any(why):
        yield "set by", "; ".join(filter(None, why))
    for index, (share, names) in enumerate(tightest(design)[:MOST_MARGINS]):
        yield "" if index else "used", f"{share} {names}"
    if heat(design):
        yield "heat", heat(design)
    if design.survival is not None:
        told = (survival_sentence(design.survival), survival_cost(design))
        yield "survives", "; ".join(filter(None, told))


def _print_flights(console: Console, design: OcsDesign, runs: Sequence[Run]) -> None:
    """Each scenario with the device and without, and a curve of its tilt where there is room."""
    width = min((console.width - BESIDE_PLOTS) // 2, WIDEST_PLOT)
    plotted = (
        width >= NARROWEST_PLOT and console.encoding.startswith("utf") and breaks_lines(console)
    )
    kinds = {item.name: item.kind for item in design.requirement.maneuvers}
    pairs = zip(runs[::2], runs[1::2], strict=True)
    records = zip(design.validation[::2], design.validation[1::2], strict=True)
    rows: list[tuple[Cell, ...]] = []
    for pair, recorded in zip(pairs, records, strict=True):
        verdicts = (short_verdict(run, kind=kinds.get(run.scenario, "")) for run in recorded)
        rows.append((recorded[0].scenario, *verdicts))
        if plotted:
            plots, top = tilt_plots([run.series for run in pair], width)
            rows[-1] += (*plots, degrees_number(top, 0))
    names = ("<flight", "<with the device", "<without it", "<tilt with", "<without", "full")
    heading(console, f"Flights in MuJoCo: {flights_title(design.validation)}")
    show(console, Table(columns(*names[: 6 if plotted else 3]), tuple(rows)))
    if plotted:
        times = listed([f"{run.series.time[-1]:.1f}" for run in runs[::2]])
        note(console, f"tilt: off level from start to end, {times} s; full: deg of a full bar")


def print_lighter(console: Console, design: OcsDesign) -> None:
    """What would have to give for a lighter device; nothing where that was not asked."""
    if design.lighter is not None:
        asked = format_quantity(design.lighter.by, "g", 3)
        heading(console, f"What must give for {asked} less")
        if design.lighter.changes:
            show(console, lighter_table(design), fewest=2)
        else:
            note(console, "No change that was looked for makes it so much lighter.")


def print_assumed(console: Console, assumptions: Sequence[str]) -> None:
    """What was taken where nothing was stated, as a short list."""
    rows = assumed(assumptions)
    if rows:
        heading(console, "Assumed; `--help` has the option for each")
        facts(console, rows)
