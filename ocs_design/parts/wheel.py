"""The wheel as made: a rim on a thin web with a hub, whether it can be made, and its parts."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf
from typing import TypeAlias

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.catalogue.materials import Material
from ocs_design.common.errors import PartError
from ocs_design.common.ranges import Length, LengthIfAny, NotNegative, Positive, Signed
from ocs_design.parts.rim import (
    CHAMFER_SHARE,
    NO_CUTS,
    HoleRing,
    Hub,
    RimCuts,
    hoop_stress,
    stored_energy,
    wheel_body,
)
from ocs_design.parts.solids import Part, Prism, Revolution, revolved

Point: TypeAlias = tuple[float, float]
"""Radius and height above the wheel's middle [m]."""

ROUNDING = 1e-9
"""Rounding allowed for lengths at their lower limits [m]: a thousandth of a micrometre."""


@dataclass(frozen=True)
class Rim:
    """A hollow cylinder around z, with its middle at z = 0.

    Attributes:
        inner_radius, outer_radius, height: [m].
        material: name. density: [kg/m^3].
        cuts: chamfers and balancing holes, as specified; see `chamfer`.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: str
    density: float
    cuts: RimCuts = NO_CUTS

    @property
    def chamfer(self) -> float:
        """Chamfer as made, at most a share of wall and height [m]."""
        wall = self.outer_radius - self.inner_radius
        return min(self.cuts.chamfer, CHAMFER_SHARE * wall, CHAMFER_SHARE * self.height)

    @property
    def balancing(self) -> HoleRing | None:
        """Balancing holes, the same in both faces; None: none."""
        return self.cuts.ring(self.inner_radius, self.outer_radius)

    @property
    def corners(self) -> list[Point]:
        """Corners of the upper half of its cross-section, from the outside to the bore."""
        inner, outer = self.inner_radius, self.outer_radius
        edge, top = self.chamfer, self.height / 2.0
        return [(outer, top - edge), (outer - edge, top), (inner + edge, top), (inner, top - edge)]


@dataclass(frozen=True)
class Web:
    """Connection of a rim to its motor, in one piece: a disc in the rim's middle plane and a hub.

    Attributes:
        material: name in the catalogue. density: [kg/m^3].
        thickness: of the disc, which fills the rim's bore [m].
        mass: including the hub, less the holes [kg].
        hub: at its centre.
        holes: lightening holes; None: none.
    """

    material: str
    density: Positive
    thickness: Length
    mass: Positive
    hub: Hub
    holes: HoleRing | None = None

    @property
    def rings(self) -> tuple[HoleRing, ...]:
        """Through holes, from the inside out: for bolts in the hub, and to lighten the disc."""
        return tuple(ring for ring in (self.hub.bolt_ring, self.holes) if ring is not None)

    def height(self, radius: float) -> float:
        """Extent of hub or disc along the axis at a radius [m]."""
        return self.hub.height if radius < self.hub.radius else self.thickness

    def corners(self, bore: float) -> list[Point]:
        """Corners of the upper half of its cross-section, from a rim's bore [m] inwards."""
        hub, level, edge = self.hub, self.thickness / 2.0, self.hub.chamfer
        top = hub.height / 2.0
        outside = (hub.radius, level), (hub.radius, top - edge), (hub.radius - edge, top)
        inside = (hub.bore_radius + edge, top), (hub.bore_radius, top - edge)
        return [(bore, level), *outside, *inside]


@dataclass(frozen=True)
class Wheel:
    """A rim on its web, or only a rim if `web` is None.

    Raises:
        PartError: it cannot be made; see `wheel_faults`.
    """

    rim: Rim
    web: Web | None = None

    def __post_init__(self) -> None:
        if faults := "; ".join(wheel_faults(self)):
            left = f"leave {1e3 * LIGAMENT:g} mm between holes and edges"
            hint = f"{left}, or design the rim alone, without a web"
            raise PartError(f"the wheel cannot be made: {faults}", hint=hint)

    @property
    def shrunk_on(self) -> bool:
        """Whether the rim is shrunk on a web of another material."""
        return self.web is not None and self.web.material != self.rim.material

    @property
    def width(self) -> float:
        """Largest extent along the axis [m]."""
        return max(self.rim.height, 0.0 if self.web is None else self.web.hub.height)


@dataclass(frozen=True)
class Flywheel:
    """A hollow cylinder on a web that spins about its z axis.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim, name in the catalogue. density: [kg/m^3].
        mass: of the whole wheel [kg].
        spin_inertia: angular momentum about the spin axis per speed relative to the trunk,
            including the motor's rotor [kg m^2].
        transverse_inertia: of the wheel about any transverse axis through its centre of mass,
            without the rotor [kg m^2].
        hoop_stress: largest, at the bore, at the highest wheel speed [Pa].
        stress_margin: yield strength over hoop stress; None if the strength is unknown.
        stored_energy: at the highest wheel speed [J].
        web: web and hub; None: massless spokes, or a ring around the motor's bell.
        cuts: chamfers and balancing holes of the rim.
    """

    inner_radius: LengthIfAny
    outer_radius: Length
    height: Length
    material: str
    density: Positive
    mass: Positive
    spin_inertia: Positive
    transverse_inertia: NotNegative
    hoop_stress: NotNegative | None
    stress_margin: Signed | None
    stored_energy: NotNegative
    web: Web | None = None
    cuts: RimCuts = NO_CUTS

    @classmethod
    def of(
        cls,
        cylinder: tuple[float, float, float],
        material: Material,
        wheel_speed: float,
        rotor_share: float,
        hub: Hub | None = None,
        *,
        cuts: RimCuts = NO_CUTS,
        web_material: Material | None = None,
    ) -> "Flywheel":
        """Wheel from a rim's inner and outer radius and height [m], and a rotor's share [kg m^2].

        Args:
            wheel_speed: highest [rad/s].
            web_material: of web and hub; None: of one piece with the rim.
        """
        inner, outer, height = cylinder
        strength, stress, web = material.yield_strength, None, None
        if material.poisson_ratio is not None:
            stress = float(
                hoop_stress(
                    inner,
                    outer,
                    density=material.density,
                    poisson_ratio=material.poisson_ratio,
                    wheel_speed=wheel_speed,
                )
            )
        of_web = material if web_material is None else web_material
        if hub is not None:
            mass = hub.mass_with_web(inner, of_web.density)
            holes = hub.holes(inner)
            web = Web(of_web.name, of_web.density, hub.web_thickness, mass, hub, holes)
        body = wheel_body(*cylinder, material.density, hub, cuts=cuts, web_density=of_web.density)
        spin_inertia = body.axial_inertia + rotor_share
        return cls(
            inner_radius=inner,
            outer_radius=outer,
            height=height,
            material=material.name,
            density=material.density,
            mass=body.mass,
            spin_inertia=spin_inertia,
            transverse_inertia=body.transverse_inertia,
            hoop_stress=stress,
            stress_margin=None if strength is None or stress is None else strength / stress,
            stored_energy=float(stored_energy(spin_inertia, wheel_speed)),
            web=web,
            cuts=cuts,
        )

    @property
    def shape(self) -> Wheel:
        """The wheel as made.

        Raises:
            PartError: it cannot be made.
        """
        size = self.inner_radius, self.outer_radius, self.height
        return Wheel(Rim(*size, self.material, self.density, self.cuts), self.web)

    @property
    def rim_mass(self) -> float:
        """Mass of the rim alone [kg]."""
        return self.mass - (0.0 if self.web is None else self.web.mass)


def wheel_faults(wheel: Wheel) -> Iterator[str]:
    """Reasons why a wheel cannot be made, each as a clause."""
    rim, web = wheel.rim, wheel.web
    if not 0.0 <= rim.inner_radius < rim.outer_radius:
        yield "its rim's inner radius is not less than its outer radius"
    if rim.height <= 0.0 or rim.chamfer < 0.0:
        yield "its rim has no height, or a negative chamfer"
    edge = rim.chamfer
    if rim.balancing is not None:
        edges, depth = (rim.inner_radius + edge, rim.outer_radius - edge), rim.cuts.hole_depth
        yield from _ring_faults(rim.balancing, *edges, "balancing", depth)
        if 2.0 * depth + LIGAMENT > rim.height + ROUNDING:
            yield "its balancing holes meet in the middle"
    if web is None:
        return
    hub = web.hub
    if not 0.0 <= hub.bore_radius < hub.radius:
        yield "its bore is not narrower than its hub"
    if not hub.radius + LIGAMENT <= rim.inner_radius + ROUNDING:
        wide, bore = 1e3 * hub.radius, 1e3 * rim.inner_radius
        yield f"its hub of {wide:.4g} mm radius leaves no web in the rim's {bore:.4g} mm"
    if not 0.0 < web.thickness <= rim.height - 2.0 * rim.chamfer:
        yield f"its web of {1e3 * web.thickness:.3g} mm is thicker than the rim is high"
    if hub.height < web.thickness + 2.0 * hub.chamfer:
        yield "its hub is lower than the web is thick"
    if not 0.0 <= 2.0 * hub.chamfer < hub.radius - hub.bore_radius:
        yield "its hub's chamfers leave no face between them"
    if hub.bolt_ring is not None:
        yield from _ring_faults(hub.bolt_ring, hub.bore_radius, hub.radius, "bolt")
    if web.holes is not None:
        yield from _ring_faults(web.holes, hub.radius, rim.inner_radius, "lightening")


def _ring_faults(
    ring: HoleRing, inner: float, outer: float, name: str, depth: float = inf
) -> Iterator[str]:
    """Faults of holes of this depth between two edges [m]."""
    if ring.count < 1 or ring.hole_radius <= 0.0 or depth <= 0.0:
        yield f"its {name} holes have no count, size or depth"
    elif ring.inside < inner + LIGAMENT - ROUNDING:
        yield f"its {name} holes are too close to the inner edge"
    elif ring.reach > outer - LIGAMENT + ROUNDING:
        yield f"its {name} holes are too close to the outer edge"
    elif ring.spacing < LIGAMENT - ROUNDING:
        yield f"its {name} holes are too close to each other"


def wheel_parts(wheel: Wheel) -> tuple[Part[float], ...]:
    """One part for each piece: the whole wheel, or its rim and its hub."""
    rim, web = wheel.rim, wheel.web
    holes: tuple[Prism[float], ...] = ()
    if rim.balancing is not None:
        half = rim.height / 2.0
        bottom = half - rim.cuts.hole_depth
        holes = (rim.balancing.prism(bottom, half), rim.balancing.prism(-half, -bottom))
    alone = Part("rim", rim.density, (_mirrored(rim.corners),), holes)
    if web is None:
        return (alone,)
    disc, ends = web.corners(rim.inner_radius), [web.height(r.circle_radius) for r in web.rings]
    both = zip(web.rings, ends, strict=True)
    drilled = tuple(ring.prism(-end / 2.0, end / 2.0) for ring, end in both)
    if not wheel.shrunk_on:
        return (Part("wheel", rim.density, (_mirrored([*rim.corners, *disc]),), holes + drilled),)
    return alone, Part("hub", web.density, (_mirrored(disc),), drilled)


def _mirrored(upper: list[Point]) -> Revolution:
    """A body of revolution from its upper half and the mirror image below z = 0."""
    return revolved([*upper, *((radius, -height) for radius, height in reversed(upper))])
