"""The whole report of `size` in the terminal: what was read, asked, found, proved and written."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.requirement import ManeuverRecord
from ocs_design.device.records.selection import SelectionRecord
from ocs_design.report import limits, selection, warnings
from ocs_design.report.device import criterion_table, device_facts, device_title, drawn_facts
from ocs_design.report.flights import landing_remarks
from ocs_design.report.text.layout import (
    facts,
    files_written,
    heading,
    items,
    note,
    show,
    warn,
)
from ocs_design.report.text.robot import print_joints, print_robot
from ocs_design.report.text.summary import print_lighter
from ocs_design.report.text.validation import print_headline, print_runs
from ocs_design.report.verdict import headline

_FEWEST = 2
"""Columns of the ranking that the narrowest terminal shows: drive and mass."""


def print_design(console: Console, design: OcsDesign) -> None:
    """Everything about a design and its flights, the verdict first."""
    print_headline(console, headline(design))
    items(console, (f"{each.what}; {each.cure}" for each in design.buildable.open[1:]))
    print_robot(console, design.robot)
    heading(console, limits.requirement_title(design))
    show(console, limits.demand_table(design))
    note(console, limits.demand_note(design))
    items(console, warnings.shortfalls(design), style="yellow")
    items(console, warnings.coupling_notes(design))
    if design.requirement.assumptions:
        heading(console, "Assumed, because nothing else was specified")
        items(console, design.requirement.assumptions)
    if design.reality:
        heading(console, "What `validate --samples` draws")
        facts(console, drawn_facts(design.reality))
    if design.selection is not None:
        print_selection(console, design.selection, design.requirement.maneuvers)
    heading(console, device_title(design))
    facts(console, (*device_facts(design), ("motor's source", design.ocs.motor.source)))
    warn(console, design.ocs.warnings)
    items(console, warnings.device_warnings(design), style="yellow")
    if design.ocs.incidence_by_criterion:
        show(console, criterion_table(design.ocs))
    names, meaning = limits.active_limits(design)
    heading(console, f"Active limits: {names}")
    if meaning:
        note(console, meaning)
    owed = limits.owed_to(design)
    if owed:
        note(console, f"The mass is owed to {owed}.")
    show(console, limits.saving_table(design))
    note(console, limits.saving_notes(design))
    if design.selection is not None and design.selection.kept is not None:
        heading(console, "What is uncertain, and what it costs")
        show(console, limits.reserve_table(design.selection.kept))
        note(console, limits.reserve_note(design.selection.kept, design.ocs.mass_total))
    print_alternatives(console, design)
    margins = limits.recorded_margins(design)
    heading(console, "Margins")
    show(console, limits.margin_table(margins))
    note(console, limits.MARGIN_NOTE)
    items(console, limits.margin_notes(margins))
    if design.ocs.flywheel.stress_margin is None:
        items(console, [warnings.unchecked_stress(design.ocs)], style="yellow")
    if design.validation:
        print_runs(console, design.validation, design.survival)
    items(console, landing_remarks(design), style="yellow")


def print_alternatives(console: Console, design: OcsDesign) -> None:
    """What one change of the question would give each; nothing where none was looked for."""
    if design.alternatives:
        heading(console, "What would be lighter otherwise")
        found = limits.alternatives_table(design)
        if found.rows:
            show(console, found)
        vain = limits.alternatives_note(design)
        if vain:
            note(console, vain)
    print_lighter(console, design)


def print_solution(console: Console, design: OcsDesign) -> None:
    """Posture joint by joint, and how the optimum was found."""
    if design.robot.posture:
        print_joints(console, design.robot)
    sizing, chosen = design.sizing, design.selection is not None
    heading(console, "Solution")
    facts(
        console,
        [
            ("status", sizing.status),
            ("method", sizing.method),
            ("objective", f"{sizing.objective:.6g} kg, {'the device' if chosen else 'one rim'}"),
            *(() if chosen else (("relative duality gap", f"{sizing.gap:.1e}"),)),
            ("fixed point", f"residual {sizing.residual:.1e} after {sizing.iterations} iterations"),
            *((f"price of {name}", f"{price!r}") for name, price in sizing.shadow_prices.items()),
        ],
    )


def print_selection(
    console: Console,
    chosen: SelectionRecord,
    maneuvers: Sequence[ManeuverRecord] = (),
    *,
    verbose: bool = False,
) -> None:
    """What the drive is asked for, the lightest ones, and how many were ruled out."""
    heading(console, f"Choice: {selection.choice_title(chosen)}")
    show(console, selection.task_table(chosen))
    note(console, selection.task_note(chosen, maneuvers))
    drives = selection.best_drives if verbose else selection.shown_drives
    show(console, selection.drive_table(drives(chosen.ranking)), fewest=_FEWEST)
    ruled_out = selection.ruled_out(chosen)
    if ruled_out:
        note(console, ruled_out)
    if verbose:
        items(console, selection.rejection_details(chosen))
    co_design = selection.co_design_facts(chosen)
    if co_design:
        heading(console, "Co-design: all dimensions together with the maneuvers, in 3-D")
        facts(console, co_design)


def print_outcome(console: Console, design: OcsDesign, folder: Path) -> None:
    """What was written, and the verdict in one line."""
    files_written(console, str(folder), design.files, "everything in this report")
    console.print()
    print_headline(console, headline(design))
