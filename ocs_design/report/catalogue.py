"""What `catalogue` prints."""

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from ocs_design.catalogue.materials import Material
from ocs_design.report.layout import columns, heading, items, show


def print_materials(console: Console, found: Sequence[Material]) -> None:
    """Every material with its figures and where they come from."""
    heading(console, "Materials")
    table = columns("name", "kg/m3", "yield\nMPa", "ultimate\nMPa", "Poisson")
    for material in found:
        table.add_row(
            Text(material.name),
            f"{material.density:.0f}",
            _megapascals(material.yield_strength),
            _megapascals(material.ultimate_strength),
            "-" if material.poisson_ratio is None else f"{material.poisson_ratio:.2f}",
        )
    show(console, table)
    heading(console, "Sources")
    items(console, (f"{material.name}: {material.source}" for material in found))


def _megapascals(stress: float | None) -> str:
    return "-" if stress is None else f"{stress / 1e6:.0f}"
