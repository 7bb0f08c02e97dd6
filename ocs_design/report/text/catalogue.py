"""Catalogues in the terminal: tables of motors, gears and materials, with their sources."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from rich.console import Console

from ocs_design.actuation.drive import speed_limit
from ocs_design.actuation.motor import Motor, Mounting, build_gaps
from ocs_design.catalogue.gears import GearSheet, gears, gears_to_json
from ocs_design.catalogue.materials import Material, materials, materials_to_json
from ocs_design.catalogue.motors import implausible_values, motors, motors_to_json
from ocs_design.common.errors import UsageError
from ocs_design.common.units import format_quantity, to_unit
from ocs_design.report.table import CellTable, columns
from ocs_design.report.text.layout import heading, items, note, show

BASIS_MARK = {"peak current": "+", "stall torque": "*"}
"""Mark after a short-term torque that is not the maker's rating, by its basis."""

KINDS = ("motors", "gears", "materials")
"""Names of the catalogues."""

MOST_NAMES = 8
"""Number of entries with a common source above which they are counted and not named."""


TORQUE_CLASSES = (0.0, 0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0, math.inf)
"""Limits of the torque classes in which motors are counted [N m]."""


@dataclass(frozen=True)
class Listing:
    """One catalogue ready for output: its entries, the JSON document and the printed table.

    `warnings` are about a user's file, one sentence each.
    """

    rows: Sequence[Motor | GearSheet | Material]
    json: bytes
    print_table: Callable[[Console, Any], None]
    warnings: tuple[str, ...] = ()

    def show(self, console: Console, *, verbose: bool) -> None:
        """Print the table and the sources; with `verbose`, the source of each row."""
        self.print_table(console, self.rows)
        heading(console, "Sources")
        by_source: dict[str, list[str]] = {}
        for row in self.rows:
            mounting = motor_mounting(row.mounting) if isinstance(row, Motor) else ""
            order = row.order if isinstance(row, Material) else ""
            # Materials have no remarks.
            remarks = (order, row.source, mounting, str(getattr(row, "remark", "")))
            source = f"{row.name}: {'; '.join(filter(None, remarks))}" if verbose else row.source
            by_source.setdefault(source, []).append(row.name)
        named = (f"{_names_of(names)}: {source}" for source, names in by_source.items())
        items(console, by_source if verbose else named)


def listing(what: str, files: Mapping[str, str | None]) -> Listing:
    """The catalogue `what`, with the user's file of its kind, if there is one.

    Raises:
        UsageError: there is no such catalogue, or a file of another kind is given.
        SpecificationError: the file cannot be read or has faults.
    """
    what = what.casefold()
    if what not in KINDS:
        commands = ", ".join(f"catalogue {name}" for name in KINDS)
        raise UsageError(f"there is no catalogue of {what}", hint=f"try: {commands}")
    for kind, file in files.items():
        if file is not None and kind != what:
            raise UsageError(f"--{kind} has no effect on {what}", hint=f"try: catalogue {kind}")
    file = files.get(what)
    path = None if file is None else Path(file)
    if what == "motors":
        known = tuple(motors(path).values())
        doubts = () if path is None else implausible_values(path)
        return Listing(known, motors_to_json(known, doubts), print_motors, doubts)
    if what == "gears":
        sheets = tuple(gears(path).values())
        return Listing(sheets, gears_to_json(sheets), print_gears)
    return Listing(tuple(materials().values()), materials_to_json(), print_materials)


def motor_mounting(mounting: Mounting | None) -> str:
    """Shaft and threads of a motor, as in `shaft 4 mm, rotor 3 x M3 on 17 mm`; empty: unknown."""
    if mounting is None:
        return ""
    clauses = []
    if mounting.shaft_diameter is not None:
        length = mounting.shaft_length
        by = "" if length is None else f" x {format_quantity(length, 'mm')}"
        clauses.append(f"shaft {format_quantity(mounting.shaft_diameter, 'mm')}{by}")
    if mounting.rotor is not None:
        clauses.append(f"rotor {mounting.rotor}")
    if mounting.stator is not None:
        clauses.append(f"stator {mounting.stator} ({mounting.stator_face})")
    return ", ".join(clauses)


def print_motors(console: Console, motors: Sequence[Motor]) -> None:
    """Print every motor with its key figures, the lightest first; then the missing data."""
    heading(console, "Motors")
    table = CellTable.of(
        sorted(motors, key=lambda motor: (motor.mass or math.inf, motor.name)),
        {
            "<name": lambda motor: motor.name,
            "mass [g]": lambda motor: _figure(motor.mass, "g", ".0f"),
            "rated [V]": lambda motor: _figure(motor.rated_voltage, "V", ".4g"),
            "max [rpm]": lambda motor: _figure(speed_limit(motor), "rpm", ",.0f"),
            "peak  [N m ]": lambda motor: (
                _figure(motor.peak_torque, "N m", ".3g") + BASIS_MARK.get(motor.peak_basis, " ")
            ),
            "k_t [mN m/A]": lambda motor: _figure(motor.torque_constant, "mN m", ".3g"),
            "<lacks": lambda motor: _first_gap(build_gaps(motor)),
        },
    )
    show(console, table)
    note(console, "+ k_t times the peak current   * stall torque, because no rating is given")
    heading(console, "Complete, by short-term torque")
    classes = []
    for low, high in pairwise(TORQUE_CLASSES):
        of_class = [motor for motor in motors if low <= (motor.peak_torque or -1.0) < high]
        complete = sum(not build_gaps(motor) for motor in of_class)
        if of_class:
            limits = f"{low:g} to {high:g}" if high < math.inf else f"{low:g} and more"
            classes.append((limits, str(complete), str(len(of_class))))
    show(console, CellTable(columns("<peak [N m]", "complete", "motors"), tuple(classes)))
    note(console, "size chooses among complete motors; with --motors-any among all")
    # Data that motors lack for building: one line for each set of gaps.
    by_gaps: dict[tuple[str, ...], list[str]] = {}
    for motor in motors:
        by_gaps.setdefault(build_gaps(motor), []).append(motor.name)
    by_gaps.pop((), None)
    if by_gaps:
        heading(console, "Cannot be built with")
        items(
            console,
            (f"{_names_of(names)}: no {'; no '.join(gaps)}" for gaps, names in by_gaps.items()),
        )


def _first_gap(gaps: Sequence[str]) -> str:
    """The first gap in a word or two, and the number of further gaps; a dash if there is none.

    These words are the start of the gap, up to a bracket or an `or`, without `of the`.
    """
    if not gaps:
        return "-"
    label = re.split(r" \(| or ", gaps[0])[0].replace(" of the", "").replace("bolt circle ", "")
    return label if len(gaps) == 1 else f"{label} +{len(gaps) - 1}"


def _names_of(names: Sequence[str]) -> str:
    """Names, or their number if there are more than `MOST_NAMES`."""
    return f"{len(names)} of the above" if len(names) > MOST_NAMES else ", ".join(names)


def print_gears(console: Console, sheets: Sequence[GearSheet]) -> None:
    """Print every stage of the gears; then the gears without one, and the data they lack."""
    heading(console, "Gears")
    table = CellTable.of(
        [gear for sheet in sheets for gear in sheet.stages()],
        {
            "<name": lambda gear: gear.name,
            "ratio": lambda gear: f"{gear.ratio:.3f}",
            "mass [g]": lambda gear: _figure(gear.mass, "g", ".0f"),
            "at wheel [g cm2]": lambda gear: _figure(gear.inertia, "g cm2", ".4g"),
            "peak [N m]": lambda gear: _figure(gear.torque_max, "N m", ".3g"),
            "motor [rpm]": lambda gear: _figure(gear.motor_speed_max, "rpm", ",.0f"),
            "wheel [rpm]": lambda gear: _figure(gear.wheel_speed_max, "rpm", ",.0f"),
        },
    )
    show(console, table)
    note(console, "ratio: motor speed over wheel speed. Without a gear it is 1: direct.")
    lacking = [f"{sheet.name}: no {', '.join(sheet.missing)}" for sheet in sheets if sheet.missing]
    if lacking:
        heading(console, "Cannot be chosen")
        items(console, lacking)


def print_materials(console: Console, entries: Sequence[Material]) -> None:
    """Print every material with its figures."""
    heading(console, "Materials")
    table = CellTable.of(
        entries,
        {
            "<name": lambda material: material.name,
            "density [kg/m3]": lambda material: f"{material.density:.0f}",
            "yield [MPa]": lambda material: _figure(material.yield_strength, "MPa", ".0f"),
            "ultimate [MPa]": lambda material: _figure(material.ultimate_strength, "MPa", ".0f"),
            "Poisson": lambda material: _figure(material.poisson_ratio, "", ".2f"),
        },
    )
    show(console, table)


def _figure(value: float | None, unit: str, number_format: str) -> str:
    """SI value in `unit`, if any; a dash if it is unknown or unlimited."""
    if value is None or math.isinf(value):
        return "-"
    return f"{to_unit(value, unit) if unit else value:{number_format}}"
