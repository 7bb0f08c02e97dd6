"""Materials of flywheels, each with the source of its figures."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ocs_design.catalogue.rows import catalogue, entry, load_entries
from ocs_design.common.files import to_json
from ocs_design.common.ranges import Unit

DEFAULT_MATERIAL = "stainless-304"
"""Dense, cheap, rust-free, and sold as tube."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """An isotropic material; each field is a column of the catalogue, with its unit as suffix.

    Attributes:
        name: in the catalogue.
        density: [kg/m^3].
        yield_strength, ultimate_strength: [Pa]; None if the source gives none.
        poisson_ratio: None if the source gives none.
        source: of the figures.
        elastic_modulus: [Pa]; None if the source gives none.
        thermal_expansion: per temperature, linear [1/K]; None if the source gives none.
        order: designation, condition and standard to order it by, whose least strengths those
            above are, for bars as thick as a wheel is wide; empty: no figure is guaranteed.
    """

    name: str
    density: Annotated[float, Unit("kg_m3")]
    yield_strength: Annotated[float | None, Unit("pa")] = None
    ultimate_strength: Annotated[float | None, Unit("pa")] = None
    poisson_ratio: float | None = None
    source: str
    elastic_modulus: Annotated[float | None, Unit("pa")] = None
    thermal_expansion: Annotated[float | None, Unit("per_k")] = None
    order: str = ""


def _faults(material: Material) -> Iterator[str]:
    """Figures of a row that contradict each other, one line each."""
    if (material.poisson_ratio or 0.0) >= 0.5:
        yield "poisson_ratio must be below 0.5"
    if (material.yield_strength or 0.0) > (material.ultimate_strength or math.inf):
        yield "yield_strength_pa is above ultimate_strength_pa"


def materials() -> Mapping[str, Material]:
    """Every material of the catalogue by name, sorted."""
    return catalogue("materials.csv", load_materials)


def load_materials(path: Path) -> Mapping[str, Material]:
    """Every material of a CSV or TOML file by name, sorted.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return load_entries(path, "material", Material, _faults)


_FORMER_NAMES = {
    "steel-1045-cold-worked": "steel-1045-normalized",
    "steel-4140-normalized": "steel-4140-qt",
}
"""Names in earlier files of conditions whose strength no standard guarantees in a wheel's size, and
the names of the conditions that are ordered in their place."""


def material(name: str) -> Material:
    """The material called `name`, now or formerly.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(materials(), _FORMER_NAMES.get(name, name), "material")


def recorded_material(name: str) -> Material | None:
    """The material that a design names, now or formerly; None: it is not in the catalogue."""
    return materials().get(_FORMER_NAMES.get(name, name))


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
