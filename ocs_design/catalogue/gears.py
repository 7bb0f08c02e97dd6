"""Gears that can stand between a motor and its wheel, each with where its figures come from."""

from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path
from types import MappingProxyType

import msgspec

from ocs_design.catalogue.cells import read_cells
from ocs_design.catalogue.gear_sheet import GEAR_COLUMNS, GearSheet
from ocs_design.catalogue.names import entry, merged, named_twice
from ocs_design.catalogue.table import Row, read_rows, refuse
from ocs_design.drive.gear import Gear

REQUIRED_COLUMNS = frozenset({"name", "maker", "kind", "source"})


@cache
def gears() -> Mapping[str, GearSheet]:
    """Every gear of the catalogue by name, sorted; read and checked on the first call."""
    with as_file(files("ocs_design.catalogue").joinpath("gears.csv")) as path:
        return load_gears(path)


def known_gears(file: Path | None = None) -> Mapping[str, GearSheet]:
    """The catalogue and the gears of a user's file, which replace those of the same name.

    Raises:
        SpecificationError: see `load_gears`.
    """
    return gears() if file is None else MappingProxyType(merged(gears(), load_gears(file)))


def gear(name: str, known: Mapping[str, GearSheet] | None = None) -> GearSheet:
    """The gear called `name`, of the catalogue or of `known`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(gears() if known is None else known, name, "gear")


def load_gears(path: Path) -> Mapping[str, GearSheet]:
    """Every gear of a CSV or TOML file by name, sorted (docs/catalogue.md has the columns).

    Raises:
        SpecificationError: it cannot be read, or has faults, all of which are listed.
    """
    faults: list[str] = []
    rows = read_rows(path, "gear", faults)
    sheets = [sheet for row in rows if (sheet := _sheet(row, faults)) is not None]
    faults.extend(named_twice(rows))
    refuse(path, faults)
    return MappingProxyType({sheet.name: sheet for sheet in sorted(sheets, key=lambda s: s.name)})


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
