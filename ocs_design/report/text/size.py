"""A design in the terminal: a summary on one screen, and with `-v` all of it."""

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.common.units import format_quantity, rpm
from ocs_design.common.wording import degrees_number, grams, listed
from ocs_design.device.records.design import DESIGN_FILE, OcsDesign
from ocs_design.device.records.requirement import ManeuverRecord
from ocs_design.device.records.selection import SelectionRecord
from ocs_design.export.folder import REPORT_FILE
from ocs_design.report import flights, limits, selection, warnings
from ocs_design.report.device import (
    criterion_table,
    device_facts,
    device_title,
    distribution_facts,
    first_facts,
    share_of_robot,
)
from ocs_design.report.monte_carlo import BARS
from ocs_design.report.table import CellTable, columns
from ocs_design.report.text.console import breaks_lines
from ocs_design.report.text.layout import facts, files_written, heading, items, note, show
from ocs_design.report.text.robot import print_joints, print_robot
from ocs_design.report.text.validation import print_headline, print_runs
from ocs_design.report.verdict import headline
from ocs_design.simulation.run import Run, Series

LEAST_SPAN = np.radians(5.0)
"""Smallest angle of a full bar [rad], so that a level flight looks level."""

_FEWEST_COLUMNS = 2
"""Columns of the ranking that even the narrowest terminal shows: drive and mass."""


def print_design(console: Console, design: OcsDesign) -> None:
    """Print everything about a design and its flights, the verdict first."""
    print_headline(console, headline(design))
    items(console, (f"{point.what}; {point.cure}" for point in design.buildable.open[1:]))
    # Warnings about the robot's file follow with the robot.
    of_robot = design.robot.warnings
    device_warnings = [text for text in warnings.all_warnings(design) if text not in of_robot]
    if device_warnings:
        heading(console, "Warnings")
        items(console, (*device_warnings, *warnings.reach_notes(design.ocs)), style="yellow")
    print_robot(console, design.robot)
    heading(console, f"Requirement: wheels of at most {rpm(design.requirement.wheel_speed_max)}")
    show(console, limits.demand_table(design))
    note(console, limits.NOTE_WITHOUT_MOTORS if design.selection is None else limits.NOTE_ON_DRIVE)
    items(console, warnings.coupling_notes(design))
    if design.requirement.assumptions:
        heading(console, "Assumed, because nothing else was specified")
        items(console, design.requirement.assumptions)
    if design.reality:
        heading(console, "Distributions that `validate --samples` draws from")
        facts(console, distribution_facts(design.reality))
    if design.selection is not None:
        print_selection(console, design.selection, design.requirement.maneuvers)
    heading(console, device_title(design))
    facts(console, (*device_facts(design), ("motor's source", design.ocs.motor.source)))
    if design.ocs.incidence_by_criterion:
        show(console, criterion_table(design.ocs))
    names, meaning = limits.active_limits(design)
    heading(console, f"Active limits: {names}")
    if meaning:
        note(console, meaning)
    driving = limits.driving_maneuver_text(design)
    if driving:
        note(console, f"The mass is driven by {driving}.")
    show(console, limits.saving_table(design))
    note(console, limits.saving_notes(design))
    if design.selection is not None and design.selection.kept is not None:
        heading(console, "What is uncertain, and what it costs")
        show(console, limits.reserve_table(design.selection.kept))
        note(console, limits.reserve_note(design.selection.kept, design.ocs.mass_total))
    print_alternatives(console, design)
    margins = design.margins
    heading(console, "Margins")
    show(console, limits.margin_table(margins))
    note(console, limits.MARGIN_NOTE)
    items(console, limits.margin_notes(margins))
    if design.validation:
        print_runs(console, design.validation, design.survival)
    if design.reliability is not None:
        items(console, design.reliability.rounds)


def print_alternatives(console: Console, design: OcsDesign) -> None:
    """Print the effect of each single change of the specification; nothing if none was tried."""
    if design.alternatives:
        heading(console, "Lighter alternatives")
        table = limits.alternatives_table(design)
        if table.rows:
            show(console, table)
        useless = limits.useless_changes_note(design)
        if useless:
            note(console, useless)
    print_lighter(console, design)


def print_solution(console: Console, design: OcsDesign) -> None:
    """Print the posture joint by joint, and how the optimum was found."""
    if design.robot.posture:
        print_joints(console, design.robot)
    sizing, chosen = design.sizing, design.selection is not None
    # The objective is the whole device's mass, a price that of one of its modules.
    of_what = ", each module" if chosen else ""
    heading(console, "Solution")
    rows = [("status", sizing.status), ("method", sizing.method)]
    rows.append(
        ("objective", f"{sizing.objective:.6g} kg, {'the device' if chosen else 'one rim'}")
    )
    if not chosen:
        rows.append(("relative duality gap", f"{sizing.gap:.1e}"))
    steps = f"residual {sizing.residual:.1e} after {sizing.iterations} iterations"
    rows.append(("fixed point", steps))
    prices = ((name, limits.rim_price(design, name)) for name in sizing.shadow_prices)
    rows += [(f"price of {name}", f"{price}{of_what}") for name, price in prices]
    facts(console, rows)


def print_selection(
    console: Console, chosen: SelectionRecord, maneuvers: Sequence[ManeuverRecord] = ()
) -> None:
    """Print the demands on the drive, the lightest drives, and how many were ruled out."""
    heading(console, f"Choice: {selection.choice_title(chosen)}")
    show(console, selection.task_table(chosen))
    note(console, selection.task_note(chosen, maneuvers))
    drives = selection.shown_drives(chosen.ranking)
    show(console, selection.drive_table(drives), fewest=_FEWEST_COLUMNS)
    ruled_out = selection.ruled_out(chosen)
    if ruled_out:
        note(console, ruled_out)
    co_design = selection.co_design_facts(chosen)
    if co_design:
        heading(console, "Co-design: all dimensions together with the maneuvers, in 3-D")
        facts(console, co_design)


def print_outcome(console: Console, design: OcsDesign, folder: Path) -> None:
    """Print the files written, and the verdict in one line."""
    files_written(console, str(folder), design.files, "everything in this report")
    console.print()
    print_headline(console, headline(design))


MOST_MARGINS, MOST_WARNINGS, MOST_CHANGES = 4, 3, 3

NARROWEST_PLOT, WIDEST_PLOT = 8, 20
BESIDE_PLOTS = 64
"""Width of the flights' table without its plots [characters]."""


def print_summary(console: Console, design: OcsDesign, runs: Sequence[Run], folder: Path) -> None:
    """Print the summary with the verdict first and again last, where the user looks."""
    line = headline(design)
    print_headline(console, line)
    if design.reliability is not None:
        items(console, design.reliability.rounds)
    mass = f"{grams(design.ocs.mass_total)}, {share_of_robot(design)}"
    heading(console, f"{device_title(design)}, {mass}")
    robot = design.robot
    rows = [("robot", f"{robot.name}, {robot.mass:.4g} kg, posture {robot.posture_name}")]
    rows += first_facts(design)
    active, driving = limits.active_limit_names(design), limits.driving_maneuver_text(design)
    causes = [f"{listed(active)} active"] if active else []
    causes += [f"mass driven by {driving}"] if driving else []
    if causes:
        rows.append(("limits", "; ".join(causes)))
    for index, (share, names) in enumerate(limits.utilizations(design)[:MOST_MARGINS]):
        rows.append(("" if index else "used", f"{share} {names}"))
    if limits.pause_remark(design):
        rows.append(("heat", limits.pause_remark(design)))
    if design.survival is not None:
        rows.append(("survives", "; ".join(flights.survival_sentences(design))))
    facts(console, rows)
    if runs:
        _print_flights(console, design, runs)
    # Already said by the verdict.
    flown = (run for run in design.validation if run.ocs and run.scenario == line.flight)
    reported = {line.main_finding, *(flights.run_sentence(run, with_note=False) for run in flown)}
    unreported = [text for text in warnings.all_warnings(design) if text not in reported]
    if unreported:
        # The number of further warnings would not help; the most important ones are here.
        heading(console, "Warnings (-v: all)" if len(unreported) > MOST_WARNINGS else "Warnings")
        items(console, unreported[:MOST_WARNINGS], style="yellow")
    changes = limits.saving_changes(design)[:MOST_CHANGES]
    if changes:
        heading(console, "What one change would save")
        facts(console, changes)
    print_lighter(console, design)
    print_assumed(console, design.requirement.assumptions)
    console.print()
    # The report, the design, the other files beside them, and the folders.
    paths = [PurePosixPath(name) for name in design.files]
    files = sorted(str(path) for path in paths if len(path.parts) == 1)
    folders = sorted({f"{path.parts[0]}/" for path in paths if len(path.parts) > 1})
    written = ", ".join([REPORT_FILE, DESIGN_FILE, *files, *folders])
    console.print(Text(f"{folder}/: {written}"))
    print_headline(console, line, Text("(-v: all figures)", "dim"))


def _print_flights(console: Console, design: OcsDesign, runs: Sequence[Run]) -> None:
    """Print each scenario with the device and without, and a tilt curve if there is room."""
    width = min((console.width - BESIDE_PLOTS) // 2, WIDEST_PLOT)
    plotted = (
        width >= NARROWEST_PLOT and console.encoding.startswith("utf") and breaks_lines(console)
    )
    table = flights.verdict_table(design)
    heading(console, f"Flights in MuJoCo: {flights.flights_title(design.validation)}")
    if plotted:
        rows = []
        for row, pair in zip(table.rows, zip(runs[::2], runs[1::2], strict=True), strict=True):
            plots, top = tilt_plots([run.series for run in pair], width)
            rows.append((*row, *plots, degrees_number(top, 0)))
        headings = columns("<tilt with", "<without", "full")
        table = CellTable((*table.columns, *headings), tuple(rows))
    show(console, table)
    if plotted:
        times = listed([f"{run.series.time[-1]:.1f}" for run in runs[::2]])
        note(console, f"tilt: off level from start to end, {times} s; full: deg of a full bar")


def tilt_plots(runs: Sequence[Series], width: int) -> tuple[list[str], float]:
    """Tilt of each flight as bars to a common scale, and the tilt of a full bar [rad].

    A bar shows the largest tilt in its time interval; after the end of a flight there are none.
    """
    tilts = [flights.off_level(series.roll, series.pitch) for series in runs]
    end = max(float(series.time[-1]) for series in runs)
    top = max([float(angles.max()) for angles in tilts] + [LEAST_SPAN])
    plots = []
    for series, angles in zip(runs, tilts, strict=True):
        places = np.minimum(series.time / end * width, width - 1).astype(np.int64)
        highest = np.zeros(width)
        np.maximum.at(highest, places, np.maximum(np.ceil(8.0 * angles / top - 1e-9), 1.0))
        plots.append("".join(BARS[int(height)] for height in highest))
    return plots, top


def print_lighter(console: Console, design: OcsDesign) -> None:
    """Print the trade-offs for a lighter device; nothing if they were not requested."""
    if design.lighter is not None:
        saving = format_quantity(design.lighter.by, "g", 3)
        heading(console, f"Trade-offs to save {saving}")
        if design.lighter.changes:
            show(console, limits.lighter_table(design), fewest=2)
        else:
            note(console, "None of the changes tried saves this much.")


def print_assumed(console: Console, assumptions: Sequence[str]) -> None:
    """Print the values assumed where none was specified, as a short list."""
    rows = limits.assumption_rows(assumptions)
    if rows:
        heading(console, "Assumed; `--help` has the option for each")
        facts(console, rows)
