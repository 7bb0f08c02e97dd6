"""Whether a wheel and a housing can be drilled for what a motor's row says of its mounting."""

from collections.abc import Iterator
from math import inf

from ocs_design.catalogue.motor_sheet import MotorSheet
from ocs_design.drive.mounting import BoltCircle
from ocs_design.fasteners import SCREW_NAMES

LEAST_BOLTS = {"rotor": 3, "stator": 2}
"""With two holes a wheel's inertia is not the same about every axis across it."""

LIGAMENT = 1.0e-3
"""Of material between the screws' holes and the shaft, and between each other, at least [m]."""


def mounting_faults(sheet: MotorSheet) -> Iterator[str]:
    """What cannot be right, or cannot be made; no remark helps."""
    shaft, body = sheet.shaft_diameter_m, sheet.diameter_m
    if shaft is not None and body is not None and shaft >= body:
        yield f"shaft_diameter_m is {shaft:g}, but the motor is only {body:g} m wide"
    yield from _side(sheet, "rotor", sheet.rotor)
    yield from _side(sheet, "stator", sheet.stator)
    if (sheet.stator is None) != (sheet.stator_face is None):
        yield "stator_face and the stator's bolt circle say nothing without each other"


def _side(sheet: MotorSheet, side: str, circle: BoltCircle | None) -> Iterator[str]:
    columns = [f"{side}_{end}" for end in ("bolt_circle_m", "bolts", "thread")]
    missing = [column for column in columns if getattr(sheet, column) is None]
    if circle is None:
        if len(missing) < len(columns):
            yield f"{', '.join(columns)} belong together: no {', '.join(missing)}"
    elif circle.bolts < LEAST_BOLTS[side]:
        yield f"{columns[1]} is {circle.bolts}; it must be {LEAST_BOLTS[side]} or more"
    elif circle.thread not in SCREW_NAMES:
        yield f"{columns[2]} is {circle.thread!r}, which is none of {', '.join(SCREW_NAMES)}"
    else:
        yield from _drilled(circle, columns[0], sheet)


def _drilled(circle: BoltCircle, column: str, sheet: MotorSheet) -> Iterator[str]:
    """Of a circle with a known thread."""
    where = f"{column} is {circle.diameter:g}"
    if circle.diameter >= (sheet.diameter_m or inf):
        yield f"{where}, but the motor is only {sheet.diameter_m:g} m wide"
    elif circle.inside < (sheet.shaft_diameter_m or 0.0) / 2.0 + LIGAMENT:
        yield f"{where}: holes for {circle.thread} leave less than 1 mm to the shaft"
    elif circle.spacing < LIGAMENT:
        yield f"{where}: {circle.bolts} holes for {circle.thread} leave less than 1 mm between them"
