"""Materials of flywheels, each with the source of its figures."""

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any

from ocs_design.catalogue.rows import entry
from ocs_design.common.errors import OcsError
from ocs_design.common.files import to_json

DEFAULT_MATERIAL = "stainless-304"
"""Dense, cheap, rust-free, and sold as tube."""


@dataclass(frozen=True)
class Material:
    """An isotropic material.

    Attributes:
        name: in the catalogue.
        density: [kg/m^3].
        yield_strength, ultimate_strength: [Pa]; None if the source gives none.
        poisson_ratio: None if the source gives none.
        source: of the figures.
        elastic_modulus: [Pa]; None if the source gives none.
        thermal_expansion: per temperature, linear [1/K]; None if the source gives none.
    """

    name: str
    density: float
    yield_strength: float | None
    ultimate_strength: float | None
    poisson_ratio: float | None
    source: str
    elastic_modulus: float | None = None
    thermal_expansion: float | None = None

    def __post_init__(self) -> None:
        figures = (
            self.density,
            self.yield_strength,
            self.ultimate_strength,
            self.elastic_modulus,
            self.thermal_expansion,
        )
        defect = ""
        if not all(figure is None or 0.0 < figure < math.inf for figure in figures):
            defect = "density, strengths, modulus and expansion must be positive and finite"
        elif self.poisson_ratio is not None and not -1.0 < self.poisson_ratio < 0.5:
            defect = "Poisson's ratio must lie between -1 and 0.5"
        elif (self.yield_strength or 0.0) > (self.ultimate_strength or math.inf):
            defect = "it cannot yield above its ultimate strength"
        elif not self.source:
            defect = "it has no source"
        if defect:
            raise OcsError(f"material {self.name!r}: {defect}")


_COLUMNS = {
    "density": "density_kg_m3",
    "yield_strength": "yield_strength_pa",
    "ultimate_strength": "ultimate_strength_pa",
    "poisson_ratio": "poisson_ratio",
    "elastic_modulus": "elastic_modulus_pa",
    "thermal_expansion": "thermal_expansion_per_k",
}
"""Column of each figure; its cell is empty where the source gives none."""


@cache
def materials() -> Mapping[str, Material]:
    """Every material of the catalogue by name, sorted; read and checked on the first call."""
    text = files("ocs_design.catalogue").joinpath("materials.csv").read_text(encoding="utf-8")
    rows = sorted(csv.DictReader(text.splitlines()), key=lambda row: row["name"])
    by_name = {}
    for row in rows:
        figures: dict[str, Any] = {
            name: float(row[column]) if row[column] else None for name, column in _COLUMNS.items()
        }
        by_name[row["name"]] = Material(name=row["name"], source=row["source"], **figures)
    if len(by_name) < len(rows):
        raise OcsError("materials.csv names a material twice")
    return MappingProxyType(by_name)


def material(name: str) -> Material:
    """The material called `name`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(materials(), name, "material")


_STEELS = ("stainless-", "steel-")
"""Prefixes of the names of the catalogue's steels."""


def strong_materials(*, steel: bool = False) -> tuple[Material, ...]:
    """Materials whose stress can be checked, all of them or only steels."""
    return tuple(
        material
        for material in materials().values()
        if material.yield_strength is not None
        and material.poisson_ratio is not None
        and (not steel or material.name.startswith(_STEELS))
    )


def materials_to_json() -> bytes:
    """The catalogue as indented UTF-8 JSON, SI."""
    return to_json({"schema_version": 1, "materials": list(materials().values())})
