"""Facts about the flights: verdicts, attitudes, wheel speeds and torques, and further remarks."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import rpm, rpm_number
from ocs_design.common.wording import degrees, degrees_number, grams, listed
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import SurvivalRecord, ValidationRecord
from ocs_design.report.table import Cell, CellTable, Tone, Toned, columns
from ocs_design.requirement.bound import SpinDemand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.run import UPRIGHT_TILT
from ocs_design.simulation.verdict import attitude_errors, ends_at_any_attitude, landing_attitude

SWING_INCREASE_NOTED = np.radians(1.0)
"""Increase of the swing on the ground by the device above which it is reported [rad]."""

CLOSE = 0.5
"""Share of the allowed error at touchdown above which a flight as designed is reported."""

ANGLE_TOLERANCE = 1e-9
"""Difference below which incidences count as equal [rad]."""

HEIGHT_ERROR_NOTED = 0.05
"""Relative error of a jump's height above which it is reported."""

NEARLY_SATURATED = 0.95
"""Share of its top speed above which a wheel can absorb hardly any more momentum."""

_COLUMNS = (
    "\nroll [deg]", "end\npitch [deg]", "\nroll [deg]", "turned [deg]", "wheel\nspeed [rpm]",
    "motor\ntorque [N m]",
)  # fmt: skip
"""Columns after the verdict and the pitch at touchdown."""

# A robot is expected to fail without the device, so that is no alarm.
_VERDICTS = {
    True: Toned("pass", Tone.PASS),
    False: Toned("FAIL", Tone.FAIL),
    None: Toned("not judged", Tone.OPEN),
}
_VERDICTS_WITHOUT_DEVICE = {**_VERDICTS, False: Toned("fails", Tone.PLAIN)}


def off_level(roll: ArrayLike, pitch: ArrayLike) -> FloatArray:
    """Angle between the trunk's vertical and the world's [rad]; 0..pi."""
    return np.asarray(np.arccos(np.clip(np.cos(roll) * np.cos(pitch), -1.0, 1.0)))


def flight_table(runs: Sequence[ValidationRecord], *, one_scenario: bool = False) -> CellTable:
    """Verdict, attitude at touchdown and at the end, and peak wheel figures of each run.

    With `one_scenario`, all rows are of one scenario and are named "with" and "without".
    """
    first, without = ("<device", "without") if one_scenario else ("<scenario", "  without")
    names = ((("with" if one_scenario else run.scenario) if run.ocs else without) for run in runs)
    rows: list[tuple[Cell, ...]] = []
    for name, run in zip(names, runs, strict=True):
        metrics = run.metrics
        is_known = {
            "touchdown_pitch": run.was_airborne,
            "touchdown_roll": run.was_airborne,
            "final_pitch": True,
            "final_roll": True,
            "turned_angle": run.was_airborne and not run.was_on_pivot,
        }
        angles = (metrics.get(angle) if known else None for angle, known in is_known.items())
        speed, torque = (
            metrics.get(peak) if run.ocs else None
            for peak in ("peak_wheel_speed", "peak_wheel_torque")
        )
        rows.append(
            (
                name,
                (_VERDICTS if run.ocs else _VERDICTS_WITHOUT_DEVICE)[run.passed],
                *("-" if angle is None else degrees_number(angle) for angle in angles),
                "-" if speed is None else rpm_number(speed),
                "-" if torque is None else f"{torque:.3g}",
            )
        )
    judged_at = {"when due" if run.was_on_pivot else "touchdown" for run in runs}
    when = " or ".join(sorted(judged_at, reverse=True)) or "touchdown"
    return CellTable(columns(first, "<verdict", f"{when}\npitch [deg]", *_COLUMNS), tuple(rows))


def flights_title(runs: Iterable[ValidationRecord]) -> str:
    """Meaning of the angles of `short_verdict`, as title of a table of these flights."""
    pivots = [run.was_on_pivot for run in runs]
    if all(pivots):
        return "degrees off balance when due upright"
    balance = ", or off balance" if any(pivots) else ""
    return f"degrees off level at touchdown{balance}, or turned"


def short_verdict(run: ValidationRecord, maneuver: Maneuver | None) -> Toned:
    """Verdict with its decisive angle: the angle turned for a flip, the heading for a turn.

    Without the maneuver the flight is assumed to end level.
    """
    verdict = (_VERDICTS if run.ocs else _VERDICTS_WITHOUT_DEVICE)[run.passed]
    metrics = run.metrics
    if run.passed is None or not metrics:
        return verdict
    roll, pitch = _angles(metrics, "touchdown_{}")
    # As in `judge`.
    angle, suffix = max(abs(roll), abs(pitch)), ""
    if maneuver is not None and maneuver.counts_turns:
        angle, suffix = abs(metrics["turned_angle"] or 0.0), " turned"
    elif metrics["touchdown_time"] == metrics["lift_off_time"]:
        # A push on a standing robot.
        angle, suffix = float(np.hypot(*_angles(metrics, "{}_swing"))), " swing"
    elif maneuver is not None and maneuver.heading_matters:
        if ends_at_any_attitude(maneuver):
            angle, suffix = metrics.get("touchdown_rate") or 0.0, " deg/s"
        elif any(landing_attitude(maneuver)[:2]):
            angle = float(attitude_errors(np.array([roll]), np.array([pitch]), maneuver)[0])
            suffix = " off target"
        suffix += f", heading {degrees_number(metrics['heading_drift'] or 0.0)}"
    return Toned(f"{verdict.text:<5} {degrees_number(angle):>5}{suffix}", verdict.tone)


def verdict_table(design: OcsDesign) -> CellTable:
    """Verdicts on each maneuver with the device and without, with their decisive angles."""
    maneuvers = {record.name: record.maneuver() for record in design.requirement.maneuvers}
    without_device = {run.scenario: run for run in design.validation if not run.ocs}

    def verdict(run: ValidationRecord | None) -> Cell:
        return "-" if run is None else short_verdict(run, maneuvers.get(run.scenario))

    return CellTable.of(
        (run for run in design.validation if run.ocs),
        {
            "<flight": lambda run: run.scenario,
            "<with the device": verdict,
            "<without it": lambda run: verdict(without_device.get(run.scenario)),
        },
    )


def run_sentence(run: ValidationRecord, *, with_note: bool = True) -> str:
    """Reason why a run passes or fails; with its note, also what was changed about the turn."""
    device = "with" if run.ocs else "without"
    reasons = (run.reason, run.note if with_note else "")
    return f"{run.scenario}, {device}: {'; '.join(filter(None, reasons))}"


def flight_remarks(design: OcsDesign) -> Iterator[str]:
    """Remarks on flights that fail or are not judged, on poor landings, and on changed turns."""
    with_device = [run for run in design.validation if run.ocs]
    for run in with_device:
        if run.passed is not True or (run.can_stand is False and run.stands is not False):
            yield run_sentence(run, with_note=False)
    yield from filter(None, [fall_remark(with_device)])
    yield from landing_remarks(design)
    scenarios_by_note: dict[str, list[str]] = {}
    for run in with_device:
        if run.note:
            scenarios_by_note.setdefault(run.note, []).append(run.scenario)
    yield from (f"{', '.join(names)}: {note}" for note, names in scenarios_by_note.items())


def hand_turn_remarks(design: OcsDesign) -> tuple[str, ...]:
    """Sentences on the maneuvers for which the modules must be turned by hand first."""
    demands = design.requirement.demands
    return tuple(filter(None, (hand_turn_remark(demand, design) for demand in demands)))


def hand_turn_remark(demand: SpinDemand, design: OcsDesign) -> str:
    """Sentence on how the modules are turned for a maneuver; empty if they are not."""
    incidence = design.ocs.incidence
    if abs(demand.incidence - incidence) <= ANGLE_TOLERANCE:
        return ""
    return (
        f"{demand.source}: sized and flown with the modules turned by hand to "
        f"{degrees(demand.incidence)}; the files have them at {degrees(incidence)}"
    )


SURVIVAL_TITLE = "Failure of a drive: final error in degrees, by the time of failure"


def survival_sentence(survival: SurvivalRecord) -> str:
    """Whether the robot lands despite a failed drive, the worst case, and when it does not."""
    count, lost, worst = len(survival.flights), survival.lost, survival.worst
    tilt = "not judged" if worst.tilt is None else f"{degrees(worst.tilt)} off at the end"
    case = f"worst: drive {worst.module} fails {worst.instant:.2f} s into {worst.scenario}, {tilt}"
    if not lost:
        return f"any one drive may fail ({count} flights); {case}"
    by_scenario: dict[str, dict[str, None]] = {}
    for flight in lost:
        by_scenario.setdefault(flight.scenario, {})[f"{flight.instant:.2f}"] = None
    failures = (f"{name} {listed(list(instants))} s" for name, instants in by_scenario.items())
    return (
        f"{len(lost)} of {count} flights with a failed drive end out of tolerance, for failures "
        f"at: {'; '.join(failures)}; {case}"
    )


def survival_sentences(design: OcsDesign) -> Iterator[str]:
    """Sentences on the failure of a drive, and on the mass added to survive it if known."""
    survival = design.survival
    if survival is not None:
        yield survival_sentence(survival)
        if survival.mass_without is not None:
            added_mass = design.ocs.mass_total - survival.mass_without
            yield (
                f"{grams(added_mass)} heavier than a device that need not survive it "
                f"({grams(survival.mass_without)})"
            )


def survival_table(survival: SurvivalRecord) -> CellTable:
    """Final error angle by the drive that fails and the share of the flight before the failure."""
    rows: dict[tuple[str, str], list[Cell]] = {}
    for flight in survival.flights:
        text = "-" if flight.tilt is None else degrees_number(flight.tilt)
        tone = Tone.PLAIN if flight.lands else Tone.FAIL
        rows.setdefault((flight.scenario, flight.module), []).append(Toned(text, tone))
    count = max(map(len, rows.values()))
    shares = (f"{index / count:.0%}" for index in range(count))
    return CellTable(
        columns("<scenario", "<drive", *shares),
        tuple((*names, *cells) for names, cells in rows.items()),
    )


def fall_remark(runs: Sequence[ValidationRecord]) -> str:
    """Sentence on level landings that the legs cannot take; empty if there are none."""
    fallen = [run.scenario for run in runs if run.passed and run.stands is False]
    if not fallen:
        return ""
    return (
        f"{', '.join(fallen)}: the robot lands level and then falls; its legs cannot take such a "
        "landing, however level it is"
    )


def leaning_tilts(runs: Iterable[ValidationRecord]) -> Mapping[str, float]:
    """Final tilt [rad] of each robot that stays on its feet but not level, by scenario."""
    standing = (run for run in runs if run.passed and run.can_stand)
    tilts = {run.scenario: float(off_level(*_angles(run.metrics, "final_{}"))) for run in standing}
    return {name: tilt for name, tilt in tilts.items() if tilt > LANDING_TOLERANCE}


def lean_remark(runs: Iterable[ValidationRecord]) -> str:
    """Sentence on the robots that end leaning; empty if there are none."""
    tilts = [f"{name} {degrees(tilt)}" for name, tilt in leaning_tilts(runs).items()]
    if not tilts:
        return ""
    return (
        f"the robot stays on its feet and ends leaning: {', '.join(tilts)} (more than "
        f"{degrees(float(UPRIGHT_TILT), 0)} would be a fall)"
    )


def landing_remarks(design: OcsDesign) -> Iterator[str]:
    """Remarks on landings that the device does not improve, and on wheels left at high speed."""
    with_device = [run for run in design.validation if run.ocs]
    without_device = {run.scenario: run for run in design.validation if not run.ocs}
    maneuvers = [record.maneuver() for record in design.requirement.maneuvers]
    # A landing in a specified tilt swings by it, and the robot without its device lands level.
    tilted = {
        maneuver.name
        for maneuver in maneuvers
        if any(landing_attitude(maneuver)[:2]) or ends_at_any_attitude(maneuver)
    }
    swings = []
    for run in with_device:
        bare = without_device.get(run.scenario)
        swing, swing_without = _swing(run), None if bare is None else _swing(bare)
        if swing is None or swing_without is None or run.scenario in tilted:
            continue
        if swing > swing_without + SWING_INCREASE_NOTED:
            swings.append(f"{run.scenario} {degrees(swing)}, {degrees(swing_without)} without")
    if swings:
        yield f"on the ground the trunk swings further with the device: {'; '.join(swings)}"
    yield from filter(None, [close_remark(with_device, maneuvers), lean_remark(with_device)])
    top = design.ocs.motor.top_speed
    speeds = {run.scenario: run.metrics.get("final_wheel_speed") or 0.0 for run in with_device}
    saturated = [name for name, speed in speeds.items() if speed >= NEARLY_SATURATED * top]
    if saturated:
        yield (
            f"{', '.join(saturated)}: a wheel ends at {rpm(max(speeds.values()))}, near its top "
            "speed, and cannot help again until it is braked (try `validate --desaturate`)"
        )


def close_remark(runs: Iterable[ValidationRecord], maneuvers: Iterable[Maneuver]) -> str:
    """Sentence on flights that pass with an error near the one allowed; empty if there are none."""
    flown = {maneuver.name: maneuver for maneuver in maneuvers}
    errors = []
    for run in runs:
        maneuver = flown.get(run.scenario)
        if not run.passed or maneuver is None or ends_at_any_attitude(maneuver):
            continue
        roll, pitch = (np.array([angle]) for angle in _angles(run.metrics, "touchdown_{}"))
        error = float(attitude_errors(roll, pitch, maneuver)[0])
        if error > CLOSE * LANDING_TOLERANCE:
            errors.append(f"{run.scenario} by {degrees(error)}")
    if not errors:
        return ""
    return (
        f"already as designed, flights miss the attitude asked for: {', '.join(errors)}, of "
        f"{degrees(LANDING_TOLERANCE, 0)} allowed. The reserve for build errors does not count "
        "this: `validate --samples 100` tells how many robots stay within"
    )


def jump_remark(design: OcsDesign) -> str:
    """Sentence on jumps that are higher or lower than specified; empty if there are none."""
    maneuvers = {record.name: record.maneuver() for record in design.requirement.maneuvers}
    deviations = []
    for run in design.validation:
        maneuver, rise = maneuvers.get(run.scenario), run.metrics.get("rise")
        height = 0.0 if maneuver is None else maneuver.rise
        if not run.ocs or not rise or not height:
            continue
        if abs(rise / height - 1.0) > HEIGHT_ERROR_NOTED:
            error = f"{rise / height - 1.0:+.1%}"
            deviations.append(f"{run.scenario} {rise:.3f} m instead of {height:.3f} m ({error})")
    if not deviations:
        return ""
    return (
        f"jumps rise higher or lower than asked: {', '.join(deviations)}, because the legs track "
        "the push-off with an error; --ballistic starts at the exact lift-off speed"
    )


def _angles(metrics: Mapping[str, float | bool | None], name: str) -> tuple[float, float]:
    """Roll and pitch metrics of that name [rad]; 0 where unknown."""
    roll, pitch = (metrics.get(name.format(axis)) for axis in ("roll", "pitch"))
    return roll or 0.0, pitch or 0.0


def _swing(run: ValidationRecord) -> float | None:
    """Combined swing of roll and pitch [rad]; None where it is not known.

    A swing is a range of angles, above a full turn where a robot rolls over, not an attitude.
    """
    roll, pitch = (run.metrics.get(f"{axis}_swing") for axis in ("roll", "pitch"))
    return None if roll is None or pitch is None else float(np.hypot(roll, pitch))
