"""The mast: welded square tube on the trunk's back that carries plates one above the other."""

from dataclasses import dataclass
from math import sqrt

MAST_YIELD = 115e6 / 1.25
"""Of 6061-T6 beside a weld, over the partial factor of joints [Pa]: f_o,haz of EN 1999-1-1, table
3.2b, and table 8.1."""

TUBES = (
    (0.025, 2.0e-3),
    (0.03, 2.0e-3),
    (0.04, 2.0e-3),
    (0.04, 3.0e-3),
    (0.05, 3.0e-3),
    (0.05, 4.0e-3),
    (0.06, 4.0e-3),
    (0.08, 4.0e-3),
    (0.1, 5.0e-3),
)
"""Sides and walls of square tube that is kept in stock [m]; tolerances: EN 755-8."""


@dataclass(frozen=True)
class Mast:
    """Square tube upright on the trunk's back, with an arm of it backwards under each plate.

    Attributes:
        side: of the tube, outside [m]. wall: of the tube [m].
        face: x of the upright's side on the trunk, in the plate's frame [m].
        below, high: how far its ends are below and above the origin, likewise [m].
        overhang: farthest that an arm is above or below the trunk's screws [m].
        spacer: thickness of the block between the upright and the trunk, around the screws [m].
    """

    side: float
    wall: float
    face: float
    below: float
    high: float
    overhang: float
    spacer: float = 0.0

    @property
    def low(self) -> float:
        """Coordinate z of its lower end [m]."""
        return -self.below

    @property
    def bore(self) -> float:
        """Width of the tube inside [m]."""
        return self.side - 2.0 * self.wall

    @property
    def back(self) -> float:
        """Coordinate x of the upright's other side, where the arms begin [m]."""
        return self.face - self.side

    @property
    def second_moment(self) -> float:
        """Second moment of the tube's area, (a^4 - b^4) / 12 [m^4]."""
        return (self.side**4 - self.bore**4) / 12.0

    def stress(self, bending: float, twisting: float) -> float:
        """Stress of the tube under two moments [N m], of von Mises [Pa].

        M a / (2 I), and Bredt's T / (2 t (a - t)^2): Roark's Formulas for Stress and Strain, 7th
        edition, table A.1 and section 10.3.
        """
        bent = bending * self.side / (2.0 * self.second_moment)
        twisted = twisting / (2.0 * self.wall * (self.side - self.wall) ** 2)
        return sqrt(bent**2 + 3.0 * twisted**2)
