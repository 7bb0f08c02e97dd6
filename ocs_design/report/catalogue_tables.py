"""Tables of motors, gears and materials."""

import math
from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ocs_design.catalogue.gear_sheet import GearSheet
from ocs_design.catalogue.materials import Material
from ocs_design.drive.gear import DIRECT, Gear
from ocs_design.drive.line import missing_figures, speed_limit
from ocs_design.drive.motor import Motor
from ocs_design.report.layout import columns, heading, items, note, show
from ocs_design.units import to_unit

BASIS_MARK = {"peak current": "+", "stall torque": "*"}
"""Behind a short-term torque that is not the maker's own."""


def print_motors(console: Console, found: Sequence[Motor]) -> None:
    """Every motor with what a choice goes by, the lightest first; then what some lack."""
    heading(console, "Motors")
    table = columns(
        "name", "mass\ng", "rated\nV", "max\nrpm", "peak \nN m ", "k_t\nmN m/A", "R\nohm"
    )
    for motor in sorted(found, key=lambda motor: (motor.mass or math.inf, motor.name)):
        mark = BASIS_MARK.get(motor.peak_basis, " ")
        table.add_row(
            Text(motor.name),
            _figure(motor.mass, "g", ".0f"),
            _figure(motor.rated_voltage, "V", ".4g"),
            _figure(speed_limit(motor), "rpm", ".0f"),
            _figure(motor.peak_torque, "N m", ".3g") + mark,
            _figure(motor.torque_constant, "mN m", ".3g"),
            "-" if motor.resistance is None else f"{motor.resistance:.3f}",
        )
    show(console, table)
    note(console, "+ k_t times the peak current   * stall torque, for want of a rating")
    lacking = {motor.name: missing_figures(motor, DIRECT) for motor in found}
    _print_lacking(console, {name: lacks for name, lacks in lacking.items() if lacks})


def print_gears(console: Console, found: Sequence[GearSheet]) -> None:
    """Every stage that the gears offer; then the gears that offer none, with what they lack."""
    heading(console, "Gears")
    table = columns(
        "name", "ratio", "mass\ng", "at wheel\ng cm2", "peak\nN m", "motor\nrpm", "wheel\nrpm"
    )
    for sheet in found:
        for gear in sheet.stages():
            _add_gear(table, gear)
    show(console, table)
    note(console, "ratio: motor speed over wheel speed. Without a gear it is 1: direct.")
    _print_lacking(console, {sheet.name: sheet.missing for sheet in found if sheet.missing})


def _add_gear(table: Table, gear: Gear) -> None:
    table.add_row(
        Text(gear.name),
        f"{gear.ratio:.3f}",
        _figure(gear.mass, "g", ".0f"),
        _figure(gear.inertia, "g cm2", ".4g"),
        _figure(gear.torque_max, "N m", ".3g"),
        _figure(gear.motor_speed_max, "rpm", ".0f"),
        _figure(gear.wheel_speed_max, "rpm", ".0f"),
    )


def print_materials(console: Console, found: Sequence[Material]) -> None:
    """Every material with its figures."""
    heading(console, "Materials")
    table = columns("name", "density\nkg/m3", "yield\nMPa", "ultimate\nMPa", "Poisson")
    for material in found:
        table.add_row(
            Text(material.name),
            f"{material.density:.0f}",
            _figure(material.yield_strength, "MPa", ".0f"),
            _figure(material.ultimate_strength, "MPa", ".0f"),
            "-" if material.poisson_ratio is None else f"{material.poisson_ratio:.2f}",
        )
    show(console, table)


def _print_lacking(console: Console, lacking: Mapping[str, Sequence[str]]) -> None:
    """What cannot be chosen, and why."""
    if not lacking:
        return
    heading(console, "Cannot be chosen")
    items(console, (f"{name}: no {', '.join(lacks)}" for name, lacks in lacking.items()))


def _figure(value: float | None, unit: str, form: str) -> str:
    """In `unit`; a dash for what is not stated or not limited."""
    return "-" if value is None or math.isinf(value) else f"{to_unit(value, unit):{form}}"
