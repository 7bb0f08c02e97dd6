"""What the verdict on a flight does not say: poor landings, and what is left in the wheels."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from ocs_design.design import Motor
from ocs_design.design_file import OcsDesign, ValidationRecord
from ocs_design.report.flights import run_story
from ocs_design.report.quantities import degrees, rpm
from ocs_design.simulation.metrics import UPRIGHT_TILT
from ocs_design.simulation.verdict import LANDING_TOLERANCE

WORSE = np.radians(1.0)
"""By which a landing with the device must swing further to be told [rad]."""

SWING = ("roll_swing", "pitch_swing")
END = ("final_roll", "final_pitch")
"""Metrics."""

SPENT = 0.95
"""Share of its top speed at which a wheel takes up next to nothing more."""


def flight_remarks(design: OcsDesign) -> Iterator[str]:
    """Flights that do not pass or end unjudged, poor landings, and what was changed about them."""
    carrying = [run for run in design.validation if run.ocs]
    for run in carrying:
        if run.passed is not True or run.can_stand is False:
            yield run_story(run, with_note=False)
    yield from landing_remarks(design)
    yield from shared_notes(carrying)


def landing_remarks(design: OcsDesign) -> Iterator[str]:
    """What no verdict says: landings that the device does not mend, and wheels left at speed."""
    carrying = [run for run in design.validation if run.ocs]
    bare = {run.scenario: run for run in design.validation if not run.ocs}
    yield from _worse(carrying, bare)
    yield from _leaning(carrying)
    yield from _spent(carrying, design.ocs.motor)


def shared_notes(runs: Iterable[ValidationRecord]) -> Iterator[str]:
    """Each note once, with the flights that it is about."""
    about: dict[str, list[str]] = {}
    for run in runs:
        if run.note:
            about.setdefault(run.note, []).append(run.scenario)
    yield from (f"{', '.join(names)}: {note}" for note, names in about.items())


def _worse(runs: Sequence[ValidationRecord], bare: Mapping[str, ValidationRecord]) -> Iterator[str]:
    """Where the trunk swings further on the ground than that of the robot alone."""
    found = []
    for run in runs:
        swing = _off_level(run, SWING)
        alone = _off_level(bare[run.scenario], SWING) if run.scenario in bare else None
        if swing is not None and alone is not None and swing > alone + WORSE:
            found.append(f"{run.scenario} {degrees(swing)}, {degrees(alone)} without")
    if found:
        yield f"on the ground the trunk swings further with the device: {'; '.join(found)}"


def _leaning(runs: Sequence[ValidationRecord]) -> Iterator[str]:
    """Where the legs give way without letting the robot fall."""
    stood = [run for run in runs if run.passed and run.can_stand]
    ends = {run.scenario: _off_level(run, END) or 0.0 for run in stood}
    told = [f"{name} {degrees(end)}" for name, end in ends.items() if end > LANDING_TOLERANCE]
    if told:
        yield (
            f"stands, for that is less than {degrees(float(UPRIGHT_TILT), 0)}, but ends off level: "
            f"{', '.join(told)}"
        )


def _spent(runs: Sequence[ValidationRecord], motor: Motor) -> Iterator[str]:
    """Wheels that have nothing left for what comes next."""
    top = min(motor.no_load_speed, motor.speed_max or np.inf)
    speeds = {run.scenario: _figure(run, "final_wheel_speed") or 0.0 for run in runs}
    names = [name for name, speed in speeds.items() if speed >= SPENT * top]
    if names:
        yield (
            f"{', '.join(names)}: a wheel ends at {rpm(max(speeds.values()))}, near its top speed, "
            "and helps no more before it is braked: see --desaturate"
        )


def _off_level(run: ValidationRecord, names: tuple[str, str]) -> float | None:
    """Roll and pitch of these names together [rad]; None where they are not known."""
    roll, pitch = (_figure(run, name) for name in names)
    return None if roll is None or pitch is None else float(np.hypot(roll, pitch))


def _figure(run: ValidationRecord, name: str) -> float | None:
    return run.metrics.get(name)
