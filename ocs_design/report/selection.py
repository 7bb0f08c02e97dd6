"""How the motor was chosen, for people."""

from collections import Counter

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.drive.gear import DIRECT
from ocs_design.report.layout import columns, facts, fits, heading, items, note, show
from ocs_design.report.quantities import grams, rpm
from ocs_design.selection_record import RankedRecord, RejectionRecord, SelectionRecord
from ocs_design.sizing.selection.result import TaskDemand

TASKS = ("asked by", "alpha\ndeg", "spin inertia\nkg m2", "needed\ns", "given\ns", "peak\nrpm")
"""Columns of what is asked of the drive."""

RANKED = ("lightest drives", "mass\ng", "rim", "R\nmm", "h\nmm", "alpha\ndeg")
"""Columns of the ranking; the last ones are left out where the terminal is too narrow."""
SHOWN = 5
"""Drives that the report shows; -v shows those of the whole ranking."""


def print_selection(console: Console, selection: SelectionRecord, *, verbose: bool = False) -> None:
    """The winner's tasks, the next lightest, and why the others fell out."""
    heading(
        console,
        f"Choice: {selection.candidates:,} combinations of motor, gear, material and incidence "
        f"at {selection.bus_voltage:g} V",
    )
    _print_tasks(console, selection.tasks)
    note(
        console,
        f"Needed: the least time at {selection.reserve:.0%} of voltage and current; "
        f"{selection.binding_maneuver} asks for the most.",
    )
    ranking = selection.ranking
    _print_ranking(console, best_drives(ranking) if verbose else shown_drives(ranking))
    _print_rejections(console, selection.rejections, verbose=verbose)
    _print_co_design(console, selection)


def _print_tasks(console: Console, tasks: tuple[TaskDemand, ...]) -> None:
    table = columns(*TASKS)
    for task in tasks:
        table.add_row(*map(Text, task_cells(task)))
    show(console, table)


def task_cells(task: TaskDemand) -> tuple[str, ...]:
    """In the columns of `TASKS`."""
    return (
        task.source,
        f"{np.degrees(task.incidence):.1f}",
        f"{task.spin_inertia:.3e}",
        "-" if task.time_needed is None else f"{task.time_needed:.3f}",
        "-" if task.time_given is None else f"{task.time_given:.3f}",
        rpm(task.peak_speed).removesuffix(" rpm"),
    )


def _print_ranking(console: Console, ranking: tuple[RankedRecord, ...]) -> None:
    """With as many columns as the terminal has room for."""
    for count in range(len(RANKED), 1, -1):
        table = columns(*RANKED[:count])
        for column in table.columns[2:3]:
            column.justify = "left"
        for entry in ranking:
            table.add_row(*map(Text, ranked_cells(entry)[:count]))
        if fits(console, table):
            break
    show(console, table)


def ranked_cells(entry: RankedRecord) -> tuple[str, ...]:
    """In the columns of `RANKED`."""
    return (
        drive_name(entry),
        f"{1e3 * entry.mass:.1f}",
        entry.material,
        f"{1e3 * entry.outer_radius:.1f}",
        f"{1e3 * entry.height:.1f}",
        f"{np.degrees(entry.incidence):.1f}",
    )


def drive_name(entry: RankedRecord) -> str:
    """Motor, and gear where there is one."""
    return entry.motor if entry.gear == DIRECT.name else f"{entry.motor}, {entry.gear}"


def best_drives(ranking: tuple[RankedRecord, ...]) -> tuple[RankedRecord, ...]:
    """The lightest of each motor and gear: what other materials make of them is nothing new."""
    best: dict[tuple[str, str], RankedRecord] = {}
    for entry in ranking:
        best.setdefault((entry.motor, entry.gear), entry)
    return tuple(best.values())


def shown_drives(ranking: tuple[RankedRecord, ...]) -> tuple[RankedRecord, ...]:
    """The lightest of each motor, as not every one can be bought; then other gears of the same."""
    drives = best_drives(ranking)
    motors: dict[str, RankedRecord] = {}
    for entry in drives:
        motors.setdefault(entry.motor, entry)
    first = tuple(motors.values())
    others = tuple(entry for entry in drives if entry not in first)
    shown = (*first, *others)[:SHOWN]
    return tuple(entry for entry in drives if entry in shown)


def _print_rejections(
    console: Console, rejections: tuple[RejectionRecord, ...], *, verbose: bool
) -> None:
    if not rejections:
        return
    counted = Counter(rejection.reason for rejection in rejections)
    reasons = ", ".join(f"{count} for {reason}" for reason, count in counted.most_common())
    note(console, f"{len(rejections)} motors fell out: {reasons}.")
    if verbose:
        items(console, (f"{rejection.motor}: {rejection.detail}" for rejection in rejections))


def _print_co_design(console: Console, selection: SelectionRecord) -> None:
    found = selection.co_design
    if found is None:
        return
    heading(console, "Co-design: all dimensions together with the maneuvers, in 3-D")
    rows = [("solver", f"{found.status}, {found.iterations} iterations")]
    if found.mass is not None:
        change = found.mass / found.selected_mass - 1.0
        rows.append(
            ("device", f"{grams(found.mass)} against {grams(found.selected_mass)} ({change:+.2%})")
        )
    if found.violation is not None:
        rows.append(("violation", f"{found.violation:.1e} on a ten times finer grid, relative"))
    facts(console, [*rows, ("outcome", found.remark)])
