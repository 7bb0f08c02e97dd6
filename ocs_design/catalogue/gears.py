"""Gears that can stand between a motor and its wheel, each with where its figures come from."""

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

import msgspec

from ocs_design.catalogue.cells import read_cells
from ocs_design.catalogue.entries import extended, load_entries, packaged
from ocs_design.catalogue.gear_sheet import GEAR_COLUMNS, GearSheet
from ocs_design.catalogue.names import entry
from ocs_design.catalogue.table import Row
from ocs_design.drive.gear import Gear

REQUIRED_COLUMNS = frozenset({"name", "maker", "kind", "source"})


@cache
def gears() -> Mapping[str, GearSheet]:
    """Every gear of the catalogue by name, sorted; read and checked on the first call."""
    return packaged("gears.csv", load_gears)


def known_gears(file: Path | None = None) -> Mapping[str, GearSheet]:
    """The catalogue and the gears of a user's file, which replace those of the same name.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return extended(gears(), file, load_gears)


def gear(name: str, known: Mapping[str, GearSheet] | None = None) -> GearSheet:
    """The gear called `name`, of the catalogue or of `known`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(gears() if known is None else known, name, "gear")


def named_stages(name: str, known: Mapping[str, GearSheet] | None = None) -> tuple[Gear, ...]:
    """Every stage of the gear called `name`, or the one stage that is: a gear's with its ratio.

    Raises:
        SpecificationError: see `gear`.
    """
    sheets = gears() if known is None else known
    one = tuple(stage for stage in stages(sheets.values()) if stage.name == name)
    return one if one and name not in sheets else stages([gear(name, sheets)])


def load_gears(path: Path) -> Mapping[str, GearSheet]:
    """Every gear of a CSV or TOML file by name, sorted.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return load_entries(path, "gear", _sheet)


def stages(sheets: Iterable[GearSheet]) -> tuple[Gear, ...]:
    """Every stage that these gears offer; direct drive (`drive.gear.DIRECT`) is none of them."""
    return tuple(stage for sheet in sheets for stage in sheet.stages())


def _sheet(row: Row, faults: list[str]) -> GearSheet | None:
    values = read_cells(row, GEAR_COLUMNS, REQUIRED_COLUMNS, faults)
    return None if values is None else GearSheet(**values)


def gears_to_json(found: Iterable[GearSheet]) -> bytes:
    """Gears as indented UTF-8 JSON: each row as stated, and its stages in SI; null: not limited."""
    rows = [
        {**msgspec.to_builtins(sheet), "missing": sheet.missing, "stages": sheet.stages()}
        for sheet in found
    ]
    document = {"schema_version": 1, "gears": rows}
    return msgspec.json.format(msgspec.json.encode(document), indent=2) + b"\n"
