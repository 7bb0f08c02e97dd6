"""Metric screws, and the holes that they need."""

from dataclasses import dataclass
from math import ceil

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

    def through(self, thickness: float) -> str:
        """Its designation, long enough for parts of that thickness [m] and a thread behind them.

        The thread is as deep as the screw is thick at least, which holds in aluminium and steel.
        """
        least = 1e3 * (thickness + self.diameter)
        long_enough = (length for length in SHORT_LENGTHS if length >= least - 1e-9)
        return f"ISO 4762 {self.name} x {next(long_enough, 5 * ceil(least / 5.0 - 1e-9))}"


SHORT_LENGTHS = (4, 5, 6, 8, 10, 12, 16, 20)
"""[mm], ISO 4762:2004, table 1, which goes on in steps of 5 mm."""

SCREWS = (
    Screw("M2", 2.0e-3, 2.4e-3, 1.6e-3, 3.8e-3, 2.0e-3),
    Screw("M2.5", 2.5e-3, 2.9e-3, 2.05e-3, 4.5e-3, 2.5e-3),
    Screw("M3", 3.0e-3, 3.4e-3, 2.5e-3, 5.5e-3, 3.0e-3),
    Screw("M4", 4.0e-3, 4.5e-3, 3.3e-3, 7.0e-3, 4.0e-3),
    Screw("M5", 5.0e-3, 5.5e-3, 4.2e-3, 8.5e-3, 5.0e-3),
    Screw("M6", 6.0e-3, 6.6e-3, 5.0e-3, 10.0e-3, 6.0e-3),
)
"""Clearance holes: ISO 273:1979, medium; drills: ISO 2306:1972; heads: ISO 4762:2004."""

SCREW_NAMES = tuple(known.name for known in SCREWS)


def screw(name: str) -> Screw:
    """The screw of a name such as "M3"."""
    for found in SCREWS:
        if found.name == name:
            return found
    raise PartError(f"no screw is called {name!r}", hint="there are " + ", ".join(SCREW_NAMES))
