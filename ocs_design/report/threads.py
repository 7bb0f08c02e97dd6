"""What is said of a motor's shaft and threads."""

from collections.abc import Iterator

from ocs_design.drive.mounting import BoltCircle, Mounting
from ocs_design.units import format_quantity


def mounting_text(mounting: Mounting | None) -> str:
    """As `shaft 4 mm, rotor 3 x M3 on 17 mm, stator 4 x M3 on 25 mm (back)`; empty without."""
    return "" if mounting is None else ", ".join(_clauses(mounting))


def _clauses(mounting: Mounting) -> Iterator[str]:
    if mounting.shaft_diameter is not None:
        yield f"shaft {format_quantity(mounting.shaft_diameter, 'mm')}"
    if mounting.rotor is not None:
        yield f"rotor {_circle(mounting.rotor)}"
    if mounting.stator is not None:
        yield f"stator {_circle(mounting.stator)} ({mounting.stator_face})"


def _circle(circle: BoltCircle) -> str:
    return f"{circle.bolts} x {circle.thread} on {format_quantity(circle.diameter, 'mm')}"
