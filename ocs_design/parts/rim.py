"""Closed forms of a flywheel: its rim, what is cut off that, its web and its hub.

The rim is a hollow cylinder that spins about its axis (docs/theory.md, The rim). Radii and heights
are in metres, densities in kg/m^3; scalars, arrays that broadcast, or CasADi's symbols, as all is
built of operators alone. Masses and inertias are integrals, as in any handbook; stresses are those
of Budynas and Nisbett, Shigley's Mechanical Engineering Design, "Stresses in Rotating Rings".

A rim's four edges are broken and balancing holes drilled into its faces. Its cross-section with the
edges broken at 45 degrees stays symmetric to its middle radius s = (R + r) / 2, so that by Pappus
its volume is 2 pi s times its area, and its third moment about the axis s^3 times its area and 3 s
times its second moment about that radius. With the wall w = R - r and a chamfer c the edges take,
over pi rho,

    mass           2 c^2 (R + r)
    spin inertia   c^2 (R + r) (R^2 + r^2 + (w - c)^2).

Holes of radius q and depth p, n in each face on the radius s, take n q^2 p twice, at s^2 + q^2 / 2.

A thin web and a hub, turned from one piece of aluminium, join the rim to its motor. The web is a
disc in the wheel's middle plane that fills the rim's bore, the hub a cylinder around the axis with
a bore and bolt holes, both symmetric to that plane.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi, sin

import numpy as np

from ocs_design.actuation.motor import Motor, Mounting
from ocs_design.parts.moments import Carrier, MassMoments, Real
from ocs_design.parts.part import Part
from ocs_design.parts.shapes import Disc
from ocs_design.parts.solids import Prism

CHAMFER_SHARE = 0.25
"""Largest share of a chamfer in wall and height: half of each face stays."""

LIGAMENT = 1.0e-3
"""Material between holes, to their edges and between their bottoms, at least [m]."""

WEB_THICKNESS = 1.5e-3
"""[m]: thinner ones sing on the lathe, and weigh little less."""

WEB_MATERIAL = "aluminium-6061-t6"
"""Name in the catalogue of materials."""

WEB_DENSITY = 2710.0
"""Its density [kg/m^3]: Hibbeler, Mechanics of Materials, Appendix C."""

SHOULDER = 0.5e-3
"""Least height of a rim over its web [m]: it is seated on its edge."""

SEAT = 0.1e-3
"""Least length of a rim's bore between its chamfers, over its web's thickness [m]."""

HUB_HEIGHT = 5.0e-3
"""[m]: a grub screw of M2 with its thread on either side, or the heads of bolts below flush."""

HUB_WALL = 2.0e-3
"""Least wall around bore and bolts [m]: room for the thread of a grub screw of M2."""

PILOT_BORE = 3.0e-3
"""Diameter where the motor's shaft is not in the catalogue, at most [m]: to be opened to fit."""


def cylinder_mass(inner_radius: Real, outer_radius: Real, height: Real, density: float) -> Real:
    """Mass m = pi rho h (R^2 - r^2) [kg]."""
    return np.pi * density * height * (outer_radius**2 - inner_radius**2)


def cylinder_spin_inertia(
    inner_radius: Real, outer_radius: Real, height: Real, density: float
) -> Real:
    """Inertia about the axis: m (R^2 + r^2) / 2 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (outer_radius**2 + inner_radius**2) / 2.0


def cylinder_transverse_inertia(
    inner_radius: Real, outer_radius: Real, height: Real, density: float
) -> Real:
    """Inertia across the axis through the centre of mass: m (3 (R^2 + r^2) + h^2) / 12 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (3.0 * (outer_radius**2 + inner_radius**2) + height**2) / 12.0


def hoop_weights(poisson_ratio: Real) -> tuple[Real, Real]:
    """Weights p = 3 + nu of R^2 and n = 1 - nu of r^2 in the hoop stress at the bore.

    The rule of the hoop stress stands here alone: another one of the same form,
    `rho w^2 / 4 (p R^2 + n r^2)`, needs no other change.
    """
    return 3.0 + poisson_ratio, 1.0 - poisson_ratio


def hoop_stress(
    inner_radius: Real,
    outer_radius: Real,
    *,
    density: float,
    poisson_ratio: float,
    wheel_speed: float,
) -> Real:
    """Largest tangential stress, which is at the bore [Pa].

    rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2). With r -> 0 it is that of a disc with a pin hole,
    twice that of a solid one.
    """
    outer, inner = hoop_weights(poisson_ratio)
    return density * wheel_speed**2 / 4.0 * (outer * outer_radius**2 + inner * inner_radius**2)


def stored_energy(spin_inertia: Real, wheel_speed: float) -> Real:
    """Energy I_w w^2 / 2 [J]."""
    return spin_inertia * wheel_speed**2 / 2.0


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
        """Thinnest wall with half of each face between chamfers and a ligament beside holes [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        if self.holes == 0:
            return plain
        return max(plain, 2.0 * (self.hole_radius + self.chamfer + LIGAMENT))

    @property
    def height_min(self) -> float:
        """Least height with half of the band between chamfers, a ligament between holes [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        return max(plain, 2.0 * self.hole_depth + LIGAMENT) if self.holes else plain

    @property
    def inner_radius_min(self) -> float:
        """Smallest bore that keeps holes a ligament apart, were they at its edge [m]."""
        if self.holes == 0:
            return 0.0
        return (self.hole_radius + LIGAMENT / 2.0) / sin(pi / self.holes)

    @property
    def any(self) -> bool:
        """True if anything is cut."""
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
        """Slope of `area` by the inner radius [m^2]."""
        return 2.0 * self.chamfer**2

    def spread_slope(self, inner: Real, outer: Real) -> Real:
        """Slope of `spread` by the inner radius [m^4]."""
        both, face = outer + inner, outer - inner - self.chamfer
        of_edges = outer**2 + inner**2 + face**2 + 2.0 * both * (inner - face)
        return 2.0 * self.chamfer**2 * of_edges + self._drilled * both

    def mass(self, inner: Real, outer: Real, density: float) -> Real:
        """Mass of the cuts [kg]."""
        return pi * density * self.area(inner, outer)

    def axial_inertia(self, inner: Real, outer: Real, density: float) -> Real:
        """Inertia of the cuts about the axis [kg m^2]."""
        return pi * density / 2.0 * self.spread(inner, outer)

    def transverse_inertia(self, inner: Real, outer: Real, height: Real, density: float) -> Real:
        """Inertia of the cuts about any axis across through the middle [kg m^2].

        Half of what it is about the axis, and the second moment off the middle plane: of each
        triangle c^2 / 2 at h / 2 - c / 3 and its own c^4 / 36, of each hole p^2 / 12 likewise.
        """
        c, depth = self.chamfer, self.hole_depth
        triangles = 2.0 * c**2 * (height / 2.0 - c / 3.0) ** 2 + c**4 / 9.0
        holes = self._drilled * ((height - depth) ** 2 / 4.0 + depth**2 / 12.0)
        off_plane = pi * density * ((outer + inner) * triangles + holes)
        return self.axial_inertia(inner, outer, density) / 2.0 + off_plane


NO_CUTS = RimCuts()
"""Cuts of a plain hollow cylinder."""


@dataclass(frozen=True)
class Hub:
    """A cylinder in the web's middle with a bore and a ring of through holes.

    Attributes:
        radius, height: [m].
        bore_radius: [m].
        bolts: how many; 0: the motor's are not in the catalogue.
        bolt_circle_radius, bolt_hole_radius: [m]; 0 without bolts.
        chamfer: of the cylinder's edges and of its bore's, at 45 degrees [m].
    """

    radius: float
    height: float
    bore_radius: float
    bolts: int = 0
    bolt_circle_radius: float = 0.0
    bolt_hole_radius: float = 0.0
    chamfer: float = 0.0

    @property
    def mass(self) -> float:
        """Mass beyond that of a web without holes [kg]."""
        return _beyond_web(self).mass - self._edges.mass(self.bore_radius, self.radius, WEB_DENSITY)

    @property
    def axial_inertia(self) -> float:
        """Inertia about the axis beyond that of a web without holes [kg m^2]."""
        body = _beyond_web(self)
        edges = self._edges.axial_inertia(self.bore_radius, self.radius, WEB_DENSITY)
        return body.xx + body.yy - edges

    @property
    def transverse_inertia(self) -> float:
        """Inertia across the axis beyond that of a web without holes [kg m^2].

        Three and more holes in a ring have the same about every axis across it.
        """
        body, size = _beyond_web(self), (self.bore_radius, self.radius, self.height)
        return (
            (body.xx + body.yy) / 2.0 + body.zz - self._edges.transverse_inertia(*size, WEB_DENSITY)
        )

    @property
    def _edges(self) -> RimCuts:
        """A hub with its bore is a hollow cylinder as a rim is."""
        return RimCuts(self.chamfer)


@lru_cache(maxsize=4096)
def _beyond_web(hub: Hub) -> MassMoments[float]:
    """Moments of a hub with sharp edges beyond the web that it stands in, its axis along z."""
    half, web = hub.height / 2.0, WEB_THICKNESS / 2.0
    holes = [Prism(Disc(hub.radius), -web, web), Prism(Disc(hub.bore_radius), -half, half)]
    if hub.bolts:
        bolt = Disc(hub.bolt_hole_radius, (0.0, -hub.bolt_circle_radius))
        holes.append(Prism(bolt, -half, half, count=hub.bolts))
    return Part("hub", WEB_DENSITY, (Prism(Disc(hub.radius), -half, half),), tuple(holes)).moments()


NO_HUB = Hub(radius=0.0, height=0.0, bore_radius=0.0)
"""Hub of massless spokes: it weighs nothing."""


def hub_of(motor: Motor, *, direct: bool = True, chamfer: float = 0.0) -> Hub:
    """Hub of a wheel on this motor, with the bore of its shaft and holes for its screws.

    Where the catalogue has no shaft it has a pilot bore; where it has no screws it is as wide as
    the bolt circles that motors of that diameter have. Behind a gear, not
    `direct`, it has neither. Its edges have that chamfer [m].
    """
    mounting = (motor.mounting if direct else None) or Mounting()
    rotor, bore = mounting.rotor, PILOT_BORE / 2.0
    if mounting.shaft_diameter is not None:
        bore = mounting.shaft_diameter / 2.0
    elif rotor is not None:
        # A pilot bore stays clear of the screws.
        bore = min(bore, rotor.inside - LIGAMENT)
    if rotor is None:
        wide = 5.5e-3 + 0.15 * (motor.diameter or 0.03)
        return Hub(max(wide, bore + HUB_WALL), HUB_HEIGHT, bore, chamfer=chamfer)
    return Hub(
        radius=rotor.reach + HUB_WALL,
        height=HUB_HEIGHT,
        bore_radius=bore,
        bolts=rotor.bolts,
        bolt_circle_radius=rotor.radius,
        bolt_hole_radius=rotor.hole_radius,
        chamfer=chamfer,
    )


def wheel_body(
    inner_radius: float,
    outer_radius: float,
    height: float,
    density: float,
    hub: Hub | None,
    *,
    cuts: RimCuts = NO_CUTS,
) -> Carrier:
    """A rim with its web and hub; None: with massless spokes. Without what turns in the motor.

    Args:
        inner_radius, outer_radius, height, density: of the rim [m, kg/m^3].
        hub: in the middle of its web.
        cuts: off the rim.
    """
    rim = (inner_radius, outer_radius, height, density)
    mass = cylinder_mass(*rim) - cuts.mass(inner_radius, outer_radius, density)
    axial = cylinder_spin_inertia(*rim) - cuts.axial_inertia(inner_radius, outer_radius, density)
    transverse = cylinder_transverse_inertia(*rim) - cuts.transverse_inertia(*rim)
    if hub is None:
        return Carrier(mass, axial, transverse)
    return Carrier(
        mass=mass + web_mass(inner_radius) + hub.mass,
        axial_inertia=axial + web_axial_inertia(inner_radius) + hub.axial_inertia,
        transverse_inertia=transverse
        + web_transverse_inertia(inner_radius)
        + hub.transverse_inertia,
    )


def web_mass(bore: Real) -> Real:
    """Mass of the disc in a rim of bore radius r, without hub and holes [kg]."""
    return pi * WEB_DENSITY * WEB_THICKNESS * bore**2


def web_axial_inertia(bore: Real) -> Real:
    """Inertia of that disc about the axis: m r^2 / 2 [kg m^2]."""
    return web_mass(bore) * bore**2 / 2.0


def web_transverse_inertia(bore: Real) -> Real:
    """Inertia of that disc across the axis: m (3 r^2 + t^2) / 12 [kg m^2]."""
    return web_mass(bore) * (3.0 * bore**2 + WEB_THICKNESS**2) / 12.0
