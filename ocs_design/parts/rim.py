"""Closed forms of a flywheel: its rim with chamfers and holes, its web and its hub.

The rim is a hollow cylinder that spins about its axis (docs/theory.md, The rim). Radii and heights
are in metres, densities in kg/m^3; scalars, arrays that broadcast, or CasADi symbols, since all
formulas use operators only. Masses and inertias are integrals, as in any handbook; stresses are
those of Budynas and Nisbett, Shigley's Mechanical Engineering Design, "Stresses in Rotating Rings".

A rim's four edges are chamfered, and balancing holes are drilled into its faces. Its cross-section
with 45 degree chamfers stays symmetric about the middle radius s = (R + r) / 2, so that by Pappus
its volume is 2 pi s times its area, and its third moment about the axis is s^3 times its area plus
3 s times its second moment about that radius. With the wall w = R - r and a chamfer c the chamfers
remove, over pi rho,

    mass           2 c^2 (R + r)
    spin inertia   c^2 (R + r) (R^2 + r^2 + (w - c)^2).

Holes of radius q and depth p, n in each face on the radius s, remove n q^2 p twice, at
s^2 + q^2 / 2.

A thin web and a hub join the rim to its motor. All three are turned from one piece of the rim's
material; or web and hub are of aluminium, and the rim is shrunk on. The web is a disc in the
wheel's middle plane that fills the rim's bore, the hub a cylinder around the axis with a bore and
bolt holes, both symmetric about that plane.

Lightening holes remove a fixed share s of the web between hub, x, and bore, r, whatever its size: n
of radius q with n q^2 = s (r^2 - x^2), on a circle c with c^2 + q^2 / 2 = g (r^2 + x^2). So they
remove

    mass           pi rho t s (r^2 - x^2)
    spin inertia   pi rho t s g (r^4 - x^4),

and the web is a plain disc with the effective thickness (1 - s) t for mass and (1 - 2 s g) t for
spin inertia; the material that this disc lacks within the hub is counted with the hub.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import inf, pi, sin, sqrt
from typing import Annotated

import numpy as np

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.common.ranges import Count, Length, LengthIfAny, OneOf
from ocs_design.parts.moments import Real, cylinder_mass
from ocs_design.parts.shapes import Disc
from ocs_design.parts.solids import Carrier, Part, Prism

CHAMFER_SHARE = 0.25
"""Largest chamfer over wall and height: half of each face remains."""

WEB_THICKNESS = 1.0e-3
"""Thickness of a web in one piece with its rim [m]: metal can be turned to 0.8 mm without special
care. In steel a rim of 45 g on a web of 38 mm radius rocks at 820 Hz, more than four times its spin
frequency."""

SHRUNK_WEB_THICKNESS = 1.5e-3
"""Thickness of an aluminium web with a shrunk-on rim [m]: Solo12's would buckle at 1 mm."""

WEB_MATERIAL = "aluminium-6061-t6"
"""Material of a web with a shrunk-on rim, by its name in the catalogue of materials."""

SHOULDER = 0.5e-3
"""Least height of a rim in excess of the web that it is shrunk on [m]."""

STEP = 0.1e-3
"""Least length of a rim's bore between its chamfers, in excess of its web's thickness [m]."""


LIGHTENED: Mapping[int, float] = {0: 0.0, 5: 0.35, 6: 0.4, 7: 0.4, 8: 0.35}
"""Share of the web between hub and bore removed, by number of holes. Webs of 26 to 50 mm have room
for these with spokes between, and for few more."""

LIGHTENED_STRESS: Mapping[int, float] = {0: 0.0, 5: 6.5, 6: 6.5, 7: 8.0, 8: 8.0}
"""Upper bound on the stress at holes over the hoop stress at the rim's bore, by number of holes
(`turning_rings.holed_peaks` of webs and rims of all sizes)."""

LIGHTENING_PLACE = 0.42
"""g of the module docstring: about midway between a hub and a bore of four times its radius."""

SPOKE = 3.0e-3
"""Least material between lightening holes, and from them to hub and rim [m]."""

SMALLEST_LIGHTENING = 3.0e-3
"""Least radius of a lightening hole [m]: smaller ones are not worth drilling."""


_BORES = 400
"""Number of bores at which holes are tried, from wide to narrow; 1 to 2 % apart."""


def cylinder_spin_inertia(
    inner_radius: Real | float, outer_radius: Real, height: Real | float, density: Real | float
) -> Real:
    """Inertia about the axis: m (R^2 + r^2) / 2 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (outer_radius**2 + inner_radius**2) / 2.0


def cylinder_transverse_inertia(
    inner_radius: Real | float, outer_radius: Real, height: Real | float, density: Real | float
) -> Real:
    """Inertia across the axis through the centre of mass: m (3 (R^2 + r^2) + h^2) / 12 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (3.0 * (outer_radius**2 + inner_radius**2) + height**2) / 12.0


def hoop_weights(poisson_ratio: Real) -> tuple[Real, Real]:
    """Weights p = 3 + nu of R^2 and n = 1 - nu of r^2 in the hoop stress at the bore.

    This is the only place that defines the rule for hoop stress: another rule of the same form,
    `rho w^2 / 4 (p R^2 + n r^2)`, needs no change elsewhere.
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
    """Largest tangential stress, which occurs at the bore [Pa].

    rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2). As r -> 0 it tends to that of a disc with a pinhole,
    twice that of a solid disc.
    """
    outer, inner = hoop_weights(poisson_ratio)
    return density * wheel_speed**2 / 4.0 * (outer * outer_radius**2 + inner * inner_radius**2)


def stored_energy(spin_inertia: Real, wheel_speed: float) -> Real:
    """Energy I_w w^2 / 2 [J]."""
    return spin_inertia * wheel_speed**2 / 2.0


@dataclass(frozen=True)
class HoleRing:
    """Equal holes around the wheel's axis, evenly spaced, the first of them straight up, at -y.

    Attributes:
        count: number of holes.
        circle_radius: of the circle of their middles [m].
        hole_radius: of each [m].
    """

    count: Count
    circle_radius: LengthIfAny
    hole_radius: LengthIfAny

    @classmethod
    def lightening(cls, count: int, hub_radius: float, bore: float) -> "HoleRing":
        """Holes that remove their share of the web between a hub and a rim's bore, radii [m]."""
        square = LIGHTENED[count] * (bore**2 - hub_radius**2) / count
        circle = LIGHTENING_PLACE * (bore**2 + hub_radius**2) - square / 2.0
        return cls(count, sqrt(circle), sqrt(square))

    @property
    def inside(self) -> float:
        """Radius to the inner edge of the holes [m]."""
        return self.circle_radius - self.hole_radius

    @property
    def reach(self) -> float:
        """Radius to the outer edge of the holes [m]."""
        return self.circle_radius + self.hole_radius

    @property
    def spacing(self) -> float:
        """Material between neighbours [m]; inf: there is one hole."""
        if self.count == 1:
            return inf
        return 2.0 * (self.circle_radius * sin(pi / self.count) - self.hole_radius)

    def spoke(self, inner: float, outer: float) -> float:
        """Least material between two of them, or to the edges at these radii [m]."""
        return min(self.inside - inner, outer - self.reach, self.spacing)

    def prism(self, low: float, high: float) -> Prism[float]:
        """The holes between two heights [m]."""
        return Prism(
            Disc(self.hole_radius, (0.0, -self.circle_radius)), low, high, count=self.count
        )


@dataclass(frozen=True)
class RimCuts:
    """Chamfers and blind holes, the same on both faces.

    Attributes:
        chamfer: of all four edges, at 45 degrees [m].
        holes: number of balancing holes in each face, evenly spaced on the middle radius; 0: none.
        hole_radius, hole_depth: of each [m].
    """

    chamfer: LengthIfAny = 0.0
    holes: Count = 0
    hole_radius: LengthIfAny = 0.0
    hole_depth: LengthIfAny = 0.0

    @property
    def wall_min(self) -> float:
        """Least wall that leaves half of each face between chamfers, and ligaments at holes [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        if self.holes == 0:
            return plain
        return max(plain, 2.0 * (self.hole_radius + self.chamfer + LIGAMENT))

    @property
    def height_min(self) -> float:
        """Least height that leaves half the band between chamfers, and ligaments at holes [m]."""
        plain = self.chamfer / CHAMFER_SHARE
        return max(plain, 2.0 * self.hole_depth + LIGAMENT) if self.holes else plain

    @property
    def inner_radius_min(self) -> float:
        """Smallest bore radius at whose edge holes would still be a ligament apart [m]."""
        if self.holes == 0:
            return 0.0
        return (self.hole_radius + LIGAMENT / 2.0) / sin(pi / self.holes)

    def ring(self, inner: float, outer: float) -> HoleRing | None:
        """The balancing holes of a rim with these radii [m]; None: none."""
        if self.holes == 0:
            return None
        return HoleRing(self.holes, (inner + outer) / 2.0, self.hole_radius)

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
        """Spin inertia over pi rho / 2, like (R^4 - r^4) times the height [m^5]."""
        both, face = outer + inner, outer - inner - self.chamfer
        edges = 2.0 * self.chamfer**2 * both * (outer**2 + inner**2 + face**2)
        return edges + self._drilled * (both**2 / 2.0 + self.hole_radius**2)

    def area_slope(self) -> float:
        """Derivative of `area` with respect to the inner radius [m^2]."""
        return 2.0 * self.chamfer**2

    def spread_slope(self, inner: Real, outer: Real) -> Real:
        """Derivative of `spread` with respect to the inner radius [m^4]."""
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
        """Inertia of the cuts about any transverse axis through the middle [kg m^2].

        Half of that about the spin axis, plus the second moment about the middle plane: each
        triangle c^2 / 2 is at h / 2 - c / 3 and adds its own c^4 / 36, each hole its own p^2 / 12.
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
        bolts: number of bolts; 0: the motor's are not in the catalogue.
        bolt_circle_radius, bolt_hole_radius: [m]; 0 without bolts.
        chamfer: of the cylinder's edges and of its bore's, at 45 degrees [m].
        bolt_head: height of the bolts' heads [m].
        web_thickness: of the web around it [m].
        lightening: number of holes in that web (`LIGHTENED`); 0: none.
    """

    radius: Length
    height: Length
    bore_radius: LengthIfAny
    bolts: Count = 0
    bolt_circle_radius: LengthIfAny = 0.0
    bolt_hole_radius: LengthIfAny = 0.0
    chamfer: LengthIfAny = 0.0
    bolt_head: LengthIfAny = 0.0
    web_thickness: LengthIfAny = WEB_THICKNESS
    lightening: Annotated[int, OneOf(tuple(LIGHTENED))] = 0

    @property
    def lightened(self) -> float:
        """Share of the web that its holes remove."""
        return LIGHTENED[self.lightening]

    @property
    def lightened_stress(self) -> float:
        """Largest stress of its web over the hoop stress at the rim's bore; 0: without holes."""
        return LIGHTENED_STRESS[self.lightening]

    @property
    def bore_min(self) -> float:
        """Least bore radius of a rim whose web has room for its holes [m]; 0: no holes."""
        return _lightened_bore(self.lightening, self.radius) if self.lightening else 0.0

    @property
    def bolt_ring(self) -> HoleRing | None:
        """Its bolt holes; None: none."""
        if self.bolts == 0:
            return None
        return HoleRing(self.bolts, self.bolt_circle_radius, self.bolt_hole_radius)

    def holes(self, bore: float) -> HoleRing | None:
        """Lightening holes of the web in a rim of this bore radius [m]; None: none."""
        return HoleRing.lightening(self.lightening, self.radius, bore) if self.lightening else None

    def web(self, bore: float, density: float) -> Carrier:
        """The web in a rim of this bore radius [m], without hub, as a disc up to the axis.

        The hub accounts for the material that this disc lacks within it.
        """
        disc = (0.0, bore, self.web_thickness, density)
        mass = cylinder_mass(*disc) * (1.0 - self.lightened)
        axial = cylinder_spin_inertia(*disc) * spread_left(self.lightened)
        return Carrier(mass, axial, axial / 2.0 + mass * self.web_thickness**2 / 12.0)

    def mass_with_web(self, bore: float, density: float) -> float:
        """Mass of hub and web in a rim of this bore radius, minus all holes [kg]."""
        return self.web(bore, density).mass + self.beyond_web(density).mass

    def beyond_web(self, density: float) -> Carrier:
        """The hub in addition to its `web`, with the material which that lacks, as one body."""
        unit = _beyond_web(self)
        inertias = unit.axial_inertia, unit.transverse_inertia
        return Carrier(density * unit.mass, *(density * inertia for inertia in inertias))


@lru_cache(maxsize=4096)
def _beyond_web(hub: Hub) -> Carrier:
    """A hub in addition to its web, of unit density.

    A ring of three or more holes has equal moments about every transverse axis.
    """
    half, web = hub.height / 2.0, hub.web_thickness / 2.0
    holes = [Prism(Disc(hub.radius), -web, web), Prism(Disc(hub.bore_radius), -half, half)]
    if hub.bolt_ring is not None:
        holes.append(hub.bolt_ring.prism(-half, half))
    body = Part("hub", 1.0, (Prism(Disc(hub.radius), -half, half),), tuple(holes)).moments()
    # With its bore it is a hollow cylinder like a rim, with the same chamfers.
    edges, size = RimCuts(hub.chamfer), (hub.bore_radius, hub.radius)
    disc, left = (0.0, hub.radius, hub.web_thickness, 1.0), hub.web(hub.radius, 1.0)
    return Carrier(
        body.mass - edges.mass(*size, 1.0) + cylinder_mass(*disc) - left.mass,
        body.xx + body.yy - edges.axial_inertia(*size, 1.0)
        + cylinder_spin_inertia(*disc) - left.axial_inertia,
        (body.xx + body.yy) / 2.0 + body.zz - edges.transverse_inertia(*size, hub.height, 1.0)
        + cylinder_transverse_inertia(*disc) - left.transverse_inertia,
    )  # fmt: skip


@lru_cache(maxsize=4096)
def _lightened_bore(count: int, hub_radius: float) -> float:
    """Least bore radius from which on webs have room for their spokes [m], to rounding."""

    def has_room(bore: float) -> bool:
        """Whether spokes and holes are wide enough to be made."""
        holes = HoleRing.lightening(count, hub_radius, bore)
        spoke = holes.spoke(hub_radius, bore)
        return spoke >= SPOKE and holes.hole_radius >= SMALLEST_LIGHTENING

    # Spokes grow slowly with the bore: in the widest webs they are at least a fiftieth of it.
    low, high = hub_radius, 100.0 * (hub_radius + SPOKE)
    steps = np.geomspace(high, low, _BORES)
    short = next(row for row, bore in enumerate(steps.tolist()) if not has_room(bore))
    low, high = float(steps[short]), float(steps[short - 1]) if short else inf
    while high - low > 1e-12 * high < inf:
        middle = (low + high) / 2.0
        low, high = (low, middle) if has_room(middle) else (middle, high)
    return high


NO_HUB = Hub(radius=0.0, height=0.0, bore_radius=0.0)
"""Hub of massless spokes."""


def wheel_body(
    inner_radius: float,
    outer_radius: float,
    height: float,
    density: float,
    hub: Hub | None,
    *,
    cuts: RimCuts = NO_CUTS,
    web_density: float | None = None,
) -> Carrier:
    """A rim with its web and hub, without the motor's rotor.

    Args:
        inner_radius, outer_radius, height, density: of the rim [m, kg/m^3].
        hub: in the middle of its web; None: massless spokes.
        cuts: in the rim.
        web_density: of web and hub [kg/m^3]; None: in one piece with the rim.
    """
    rim = (inner_radius, outer_radius, height, density)
    mass = cylinder_mass(*rim) - cuts.mass(inner_radius, outer_radius, density)
    axial = cylinder_spin_inertia(*rim) - cuts.axial_inertia(inner_radius, outer_radius, density)
    transverse = cylinder_transverse_inertia(*rim) - cuts.transverse_inertia(*rim)
    if hub is None:
        return Carrier(mass, axial, transverse)
    own = density if web_density is None else web_density
    web, beyond = hub.web(inner_radius, own), hub.beyond_web(own)
    return Carrier(
        mass=mass + web.mass + beyond.mass,
        axial_inertia=axial + web.axial_inertia + beyond.axial_inertia,
        transverse_inertia=transverse + web.transverse_inertia + beyond.transverse_inertia,
    )


def spread_left(lightened: Real) -> Real:
    """Share of a disc's spin inertia that remains after holes remove this share of its mass."""
    return 1.0 - 2.0 * LIGHTENING_PLACE * lightened
