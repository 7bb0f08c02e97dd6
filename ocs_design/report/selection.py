"""Facts about the choice of the drive: its demands, the lightest drives, those ruled out."""

from collections import Counter
from collections.abc import Iterable

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.units import rpm_number
from ocs_design.common.wording import counted, degrees_number, grams, inertia_number, listed
from ocs_design.device.records.requirement import ManeuverRecord
from ocs_design.device.records.selection import RankedRecord, SelectionRecord
from ocs_design.report.table import CellTable, Rows

DRIVES_SHOWN = 5
"""Drives that the terminal shows; with -v it shows the whole ranking."""


def choice_title(selection: SelectionRecord) -> str:
    """Number of combinations compared, and the voltage."""
    return (
        f"{selection.candidates:,} combinations of motor, gear, material and incidence at "
        f"{selection.bus_voltage:g} V"
    )


def task_table(selection: SelectionRecord) -> CellTable:
    """Demands of each maneuver on the chosen drive."""
    return CellTable.of(
        selection.tasks,
        {
            "<required by": lambda task: task.source,
            "alpha [deg]": lambda task: degrees_number(task.incidence),
            "spin inertia [kg mm2]": lambda task: inertia_number(task.spin_inertia),
            "needed [s]": lambda task: _seconds(task.time_needed),
            "given [s]": lambda task: _seconds(task.time_given),
            "peak [rpm]": lambda task: rpm_number(task.peak_speed),
        },
    )


def _seconds(time: float | None) -> str:
    return "-" if time is None else f"{time:.3f}"


_INERTIA_RESOLUTION = 5e-4
"""Relative difference of spin inertias that is invisible in four digits."""


def task_note(selection: SelectionRecord, maneuvers: Iterable[ManeuverRecord]) -> str:
    """Meaning of the needed times, and the maneuver that decides."""
    needed = (
        f"Needed: the shortest time at {selection.reserve:.0%} of the voltage, current and speed "
        "limits."
    )
    if any("pivot" in maneuver.parameters for maneuver in maneuvers):
        needed += (
            " On a pivot both times are of a turn without gravity that needs the same torque and "
            "momentum."
        )
    largest = max((task.spin_inertia for task in selection.tasks), default=0.0)
    deciding = [
        task.source
        for task in selection.tasks
        if task.spin_inertia > largest * (1.0 - _INERTIA_RESOLUTION)
    ]
    if not selection.binding_maneuver or not deciding:
        return needed
    if len(deciding) == len(selection.tasks) > 1:
        return f"{needed} All need the same spin inertia."
    return f"{needed} The largest spin inertia is for {listed(deciding)}."


def drive_table(drives: tuple[RankedRecord, ...]) -> CellTable:
    """Lightest drives, each with the mass of the whole device, its rim and incidence."""
    return CellTable.of(
        drives,
        {
            "<lightest drives": drive_name,
            "device [g]": lambda drive: f"{1e3 * drive.mass:.1f}",
            "<rim": lambda drive: drive.material,
            "R [mm]": lambda drive: f"{1e3 * drive.outer_radius:.1f}",
            "h [mm]": lambda drive: f"{1e3 * drive.height:.1f}",
            "alpha [deg]": lambda drive: degrees_number(drive.incidence),
        },
    )


def drive_name(entry: RankedRecord) -> str:
    """Name of the motor, and of the gear if there is one."""
    return entry.motor if entry.gear == DIRECT.name else f"{entry.motor}, {entry.gear}"


def best_drives(ranking: tuple[RankedRecord, ...]) -> tuple[RankedRecord, ...]:
    """Lightest device of each motor and gear; the same drive with other materials is left out."""
    best: dict[tuple[str, str], RankedRecord] = {}
    for drive in ranking:
        best.setdefault((drive.motor, drive.gear), drive)
    return tuple(best.values())


def shown_drives(ranking: tuple[RankedRecord, ...]) -> tuple[RankedRecord, ...]:
    """Lightest drive of each motor, since not all can be bought; then more gears.

    At most `DRIVES_SHOWN` in all.
    """
    drives = best_drives(ranking)
    motors: dict[str, RankedRecord] = {}
    for drive in drives:
        motors.setdefault(drive.motor, drive)
    lightest = tuple(motors.values())
    shown = (*lightest, *(drive for drive in drives if drive not in lightest))[:DRIVES_SHOWN]
    return tuple(drive for drive in drives if drive in shown)


def ruled_out(selection: SelectionRecord) -> str:
    """Number of motors ruled out, by reason; empty if none was."""
    counts = Counter(rejection.reason for rejection in selection.rejections).most_common()
    if not counts:
        return ""
    reasons = ", ".join(f"{reason} ({count})" for reason, count in counts)
    return f"{counted(len(selection.rejections), 'motor')} ruled out: {reasons}."


def rejection_details(selection: SelectionRecord) -> tuple[str, ...]:
    """Why each motor was ruled out, with figures."""
    return tuple(f"{rejection.motor}: {rejection.detail}" for rejection in selection.rejections)


def co_design_facts(selection: SelectionRecord) -> Rows:
    """Result of the co-design by optimal control; empty if it was not requested."""
    co_design = selection.co_design
    if co_design is None:
        return ()
    rows = [("solver", f"{co_design.status}, {co_design.iterations} iterations")]
    if co_design.mass is not None:
        selected = co_design.selected_mass
        change = f"({co_design.mass / selected - 1.0:+.2%})"
        rows.append(("device", f"{grams(co_design.mass)} against {grams(selected)} {change}"))
    if co_design.violation is not None:
        violation = f"{co_design.violation:.1e} (relative), on a grid ten times finer"
        rows.append(("violation", violation))
    return (*rows, ("outcome", co_design.remark))
