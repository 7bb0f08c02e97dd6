"""Holes for metric screws."""

from dataclasses import dataclass

from ocs_design.exceptions import PartError


@dataclass(frozen=True)
class Screw:
    """A socket head cap screw (ISO 4762) with coarse thread.

    Attributes:
        name: such as "M3".
        diameter: of the thread [m].
        clearance_hole: diameter that it passes through, medium fit of ISO 273 [m].
        tapping_drill: diameter of the hole that its thread is cut into, ISO 2306 [m].
        head_diameter, head_height: largest [m].
    """

    name: str
    diameter: float
    clearance_hole: float
    tapping_drill: float
    head_diameter: float
    head_height: float


SCREWS = (
    Screw("M2", 2.0e-3, 2.4e-3, 1.6e-3, 3.8e-3, 2.0e-3),
    Screw("M2.5", 2.5e-3, 2.9e-3, 2.05e-3, 4.5e-3, 2.5e-3),
    Screw("M3", 3.0e-3, 3.4e-3, 2.5e-3, 5.5e-3, 3.0e-3),
    Screw("M4", 4.0e-3, 4.5e-3, 3.3e-3, 7.0e-3, 4.0e-3),
    Screw("M5", 5.0e-3, 5.5e-3, 4.2e-3, 8.5e-3, 5.0e-3),
)
"""Clearance holes: ISO 273:1979, medium; drills: ISO 2306:1972; heads: ISO 4762:2004."""


def screw(name: str) -> Screw:
    """The screw of a name such as "M3"."""
    for found in SCREWS:
        if found.name == name:
            return found
    raise PartError(
        f"no screw is called {name!r}",
        hint="there are " + ", ".join(known.name for known in SCREWS),
    )
