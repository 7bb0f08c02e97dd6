"""Materials of flywheels, each with where its figures come from."""

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

import msgspec

from ocs_design.catalogue.names import entry
from ocs_design.exceptions import OcsError

DEFAULT_MATERIAL = "stainless-304"
"""Dense, cheap, does not rust, sold as tube."""


@dataclass(frozen=True)
class Material:
    """An isotropic material.

    Attributes:
        name: in the catalogue.
        density: [kg/m^3].
        yield_strength, ultimate_strength: [Pa]; None if the source gives none.
        poisson_ratio: None if the source gives none.
        source: of the figures.
    """

    name: str
    density: float
    yield_strength: float | None
    ultimate_strength: float | None
    poisson_ratio: float | None
    source: str

    def __post_init__(self) -> None:
        defect = self._defect()
        if defect:
            raise OcsError(f"material {self.name!r}: {defect}")

    def _defect(self) -> str:
        """Why these figures cannot be right; empty if they can."""
        figures = (self.density, self.yield_strength, self.ultimate_strength)
        if not all(figure is None or 0.0 < figure < math.inf for figure in figures):
            return "density and strengths must be positive and finite"
        if self.poisson_ratio is not None and not -1.0 < self.poisson_ratio < 0.5:
            return "Poisson's ratio must lie between -1 and 0.5"
        if (self.yield_strength or 0.0) > (self.ultimate_strength or math.inf):
            return "it cannot yield above its ultimate strength"
        return "" if self.source else "it has no source"


@cache
def materials() -> Mapping[str, Material]:
    """Every material of the catalogue by name, sorted; read and checked on the first call."""
    text = files("ocs_design.catalogue").joinpath("materials.csv").read_text(encoding="utf-8")
    rows = sorted(csv.DictReader(text.splitlines()), key=lambda row: row["name"])
    found = {row["name"]: _material(row) for row in rows}
    if len(found) < len(rows):
        raise OcsError("materials.csv names a material twice")
    return MappingProxyType(found)


def material(name: str) -> Material:
    """The material called `name`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(materials(), name, "material")


def _material(row: Mapping[str, str]) -> Material:
    def figure(column: str) -> float | None:
        """None where the source gives none."""
        return float(row[column]) if row[column] else None

    return Material(
        name=row["name"],
        density=float(row["density_kg_m3"]),
        yield_strength=figure("yield_strength_pa"),
        ultimate_strength=figure("ultimate_strength_pa"),
        poisson_ratio=figure("poisson_ratio"),
        source=row["source"],
    )


def materials_to_json() -> bytes:
    """The catalogue as indented UTF-8 JSON, SI."""
    document = {"schema_version": 1, "materials": list(materials().values())}
    return msgspec.json.format(msgspec.json.encode(document), indent=2) + b"\n"
