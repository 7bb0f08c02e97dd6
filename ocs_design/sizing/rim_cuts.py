"""What is cut off a rim that was a plain hollow cylinder: its four edges, and balancing holes.

The cross-section of a rim with its edges broken at 45 degrees stays symmetric to its middle radius
s = (R + r) / 2, so that by Pappus its volume is 2 pi s times its area, and its third moment about
the axis s^3 times its area and 3 s times its second moment about that radius. With the wall w = R -
r and a chamfer c the edges take, over pi rho,

    mass           2 c^2 (R + r)
    spin inertia   c^2 (R + r) (R^2 + r^2 + (w - c)^2).

Holes of radius q and depth p, n in each face on the radius s, take n q^2 p twice, at s^2 + q^2 / 2.
All is built of operators alone, for arrays and CasADi's symbols too.
"""

from dataclasses import dataclass
from math import pi, sin
from typing import TypeVar

from ocs_design.arrays import FloatArray

Real = TypeVar("Real", float, FloatArray)

CHAMFER_SHARE = 0.25
"""Of a chamfer in wall and height, at most: so half of each face stays."""

LIGAMENT = 1.0e-3
"""Of material between holes, to their edges and between their bottoms, at least [m]."""


@dataclass(frozen=True)
class RimCuts:
    """Chamfers and blind holes, the same on both faces.

    Attributes:
        chamfer: of all four edges, at 45 degrees [m].
        holes: for balancing, in each face, evenly spaced on the middle radius; 0: none.
        hole_radius, hole_depth: of each [m].
    """

    chamfer: float = 0.0
    holes: int = 0
    hole_radius: float = 0.0
    hole_depth: float = 0.0

    @property
    def wall_min(self) -> float:
        """That leaves half of each face between chamfers, and a ligament beside the holes [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        if self.holes == 0:
            return plain
        return max(plain, 2.0 * (self.hole_radius + self.chamfer + LIGAMENT))

    @property
    def height_min(self) -> float:
        """Likewise, and a ligament between the holes of both faces [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        return max(plain, 2.0 * self.hole_depth + LIGAMENT) if self.holes else plain

    @property
    def inner_radius_min(self) -> float:
        """That keeps holes a ligament apart, were they at the bore [m]."""
        if self.holes == 0:
            return 0.0
        return (self.hole_radius + LIGAMENT / 2.0) / sin(pi / self.holes)

    @property
    def any(self) -> bool:
        """Whether anything is cut."""
        return self.chamfer > 0.0 or self.holes > 0

    @property
    def _drilled(self) -> float:
        """Volume of all holes over pi [m^3]."""
        return 2.0 * self.holes * self.hole_radius**2 * self.hole_depth

    def area(self, inner: Real, outer: Real) -> Real:
        """Mass over pi rho [m^3]."""
        return 2.0 * self.chamfer**2 * (outer + inner) + self._drilled

    def spread(self, inner: Real, outer: Real) -> Real:
        """Spin inertia over pi rho / 2, as R^4 - r^4 times the height is [m^5]."""
        both, face = outer + inner, outer - inner - self.chamfer
        edges = 2.0 * self.chamfer**2 * both * (outer**2 + inner**2 + face**2)
        return edges + self._drilled * (both**2 / 2.0 + self.hole_radius**2)

    def area_slope(self) -> float:
        """By the inner radius [m^2]."""
        return 2.0 * self.chamfer**2

    def spread_slope(self, inner: Real, outer: Real) -> Real:
        """By the inner radius [m^4]."""
        both, face = outer + inner, outer - inner - self.chamfer
        of_edges = outer**2 + inner**2 + face**2 + 2.0 * both * (inner - face)
        return 2.0 * self.chamfer**2 * of_edges + self._drilled * both

    def mass(self, inner: Real, outer: Real, density: float) -> Real:
        """[kg]."""
        return pi * density * self.area(inner, outer)

    def axial_inertia(self, inner: Real, outer: Real, density: float) -> Real:
        """About the axis [kg m^2]."""
        return pi * density / 2.0 * self.spread(inner, outer)

    def transverse_inertia(self, inner: Real, outer: Real, height: Real, density: float) -> Real:
        """About any axis across it through the middle [kg m^2].

        Half of what it is about the axis, and the second moment off the middle plane: of each
        triangle c^2 / 2 at h / 2 - c / 3 and its own c^4 / 36, of each hole p^2 / 12 likewise.
        """
        c, depth = self.chamfer, self.hole_depth
        triangles = 2.0 * c**2 * (height / 2.0 - c / 3.0) ** 2 + c**4 / 9.0
        holes = self._drilled * ((height - depth) ** 2 / 4.0 + depth**2 / 12.0)
        off_plane = pi * density * ((outer + inner) * triangles + holes)
        return self.axial_inertia(inner, outer, density) / 2.0 + off_plane


NO_CUTS = RimCuts()
"""Of a plain hollow cylinder."""
