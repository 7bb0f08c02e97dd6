"""What is said of a motor's shaft and threads."""

from collections.abc import Iterator

from ocs_design.drive.mounting import Mounting
from ocs_design.units import format_quantity


def mounting_text(mounting: Mounting | None) -> str:
    """As `shaft 4 mm, rotor 3 x M3 on 17 mm, stator 4 x M3 on 25 mm (back)`; empty without."""
    return "" if mounting is None else ", ".join(_clauses(mounting))


def _clauses(mounting: Mounting) -> Iterator[str]:
    if mounting.shaft_diameter is not None:
        length = mounting.shaft_length
        by = "" if length is None else f" x {format_quantity(length, 'mm')}"
        yield f"shaft {format_quantity(mounting.shaft_diameter, 'mm')}{by}"
    if mounting.rotor is not None:
        yield f"rotor {mounting.rotor}"
    if mounting.stator is not None:
        yield f"stator {mounting.stator} ({mounting.stator_face})"
