"""Motors that can be chosen, each with where its figures come from."""

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType

import msgspec

from ocs_design.catalogue.cells import read_cells
from ocs_design.catalogue.entries import extended, load_entries, packaged
from ocs_design.catalogue.motor_checks import contradictions, incomplete
from ocs_design.catalogue.motor_sheet import MOTOR_COLUMNS, MotorSheet
from ocs_design.catalogue.mounting_checks import mounting_faults
from ocs_design.catalogue.names import entry
from ocs_design.catalogue.table import Row
from ocs_design.drive.gear import DIRECT
from ocs_design.drive.line import missing_figures
from ocs_design.drive.motor import Motor

REQUIRED_COLUMNS = frozenset({"name", "maker", "source"})


@cache
def motors() -> Mapping[str, Motor]:
    """Every motor of the catalogue by name, sorted; read and checked on the first call."""
    return packaged("motors.csv", load_motors)


def known_motors(file: Path | None = None) -> Mapping[str, Motor]:
    """The catalogue and the motors of a user's file, which replace those of the same name.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return extended(motors(), file, load_motors)


def motor(name: str, known: Mapping[str, Motor] | None = None) -> Motor:
    """The motor called `name`, of the catalogue or of `known`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(motors() if known is None else known, name, "motor")


def load_motors(path: Path) -> Mapping[str, Motor]:
    """Every motor of a CSV or TOML file by name, sorted.

    Raises:
        SpecificationError: see `load_entries`.
    """
    sheets = load_motor_sheets(path)
    return MappingProxyType({name: sheets[name].motor() for name in sheets})


def load_motor_sheets(path: Path) -> Mapping[str, MotorSheet]:
    """The same as stated, in the units and conventions of the file.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return load_entries(path, "motor", _sheet)


def _sheet(row: Row, faults: list[str]) -> MotorSheet | None:
    """The row's figures; None, with its faults kept, if they cannot be right."""
    values = read_cells(row, MOTOR_COLUMNS, REQUIRED_COLUMNS, faults)
    if values is None:
        return None
    sheet = MotorSheet(**values)
    found = [*incomplete(sheet), *mounting_faults(sheet)]
    if not sheet.remark:
        found += [f"{doubt}; explain it in `remark`" for doubt in contradictions(sheet)]
    faults.extend(f"{row.where} ({sheet.name}): {fault}" for fault in found)
    return sheet


def motors_to_json(found: Iterable[Motor]) -> bytes:
    """Motors as indented UTF-8 JSON, SI, each with what a direct drive lacks of it."""
    rows = [
        {**msgspec.to_builtins(motor), "missing": missing_figures(motor, DIRECT)} for motor in found
    ]
    document = {"schema_version": 1, "motors": rows}
    return msgspec.json.format(msgspec.json.encode(document), indent=2) + b"\n"
