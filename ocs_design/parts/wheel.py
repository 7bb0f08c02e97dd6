"""The wheel as made: a rim on a thin web with a hub, whether it can be made, and its parts."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, pi, sin

from ocs_design.common.errors import PartError
from ocs_design.parts.rim import CHAMFER_SHARE, LIGAMENT
from ocs_design.parts.shapes import Disc
from ocs_design.parts.solids import Part, Prism, Revolution, revolved

ROUNDING = 1e-9
"""Rounding allowed for lengths at their lower limits [m]: a thousandth of a micrometre."""


@dataclass(frozen=True)
class HoleRing:
    """Equal holes around the axis, the first of them straight up, at -y.

    Attributes:
        radius: of the circle of their centres [m].
        count: of holes, evenly spaced.
        hole_radius: of each [m].
        depth: of each [m]; inf: through.
    """

    radius: float
    count: int
    hole_radius: float
    depth: float = inf

    def prisms(self, low: float, high: float) -> Prism[float]:
        """The holes between two heights [m]."""
        return Prism(Disc(self.hole_radius, (0.0, -self.radius)), low, high, count=self.count)

    @property
    def spacing(self) -> float:
        """Material between neighbours [m]."""
        if self.count == 1:
            return inf
        return 2.0 * (self.radius * sin(pi / self.count) - self.hole_radius)


@dataclass(frozen=True)
class Rim:
    """A hollow cylinder around z, with its middle at z = 0.

    Attributes:
        inner_radius, outer_radius, height: [m].
        material: name. density: [kg/m^3].
        chamfer: of its four edges at 45 degrees, as specified [m]; see `made_chamfer`.
        balancing: blind holes, the same in both faces; None: none.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: str
    density: float
    chamfer: float
    balancing: HoleRing | None = None

    @property
    def made_chamfer(self) -> float:
        """Chamfer as made, at most a share of wall and height [m]."""
        wall = self.outer_radius - self.inner_radius
        return min(self.chamfer, CHAMFER_SHARE * wall, CHAMFER_SHARE * self.height)


@dataclass(frozen=True)
class WheelCentre:
    """The wheel within its rim: a thin web with a hub in its middle, both centred at z = 0.

    Attributes:
        web_thickness: [m].
        radius, height: of the hub [m].
        bore_radius: of the hole for the shaft [m]; 0: none.
        material: name. density: [kg/m^3].
        bolts: through holes in the hub; None if the motor's are not known.
        lightening: through holes in the web; None: none.
        chamfer: of the edges of hub and bore, at 45 degrees [m].
    """

    web_thickness: float
    radius: float
    height: float
    bore_radius: float
    material: str
    density: float
    bolts: HoleRing | None = None
    lightening: HoleRing | None = None
    chamfer: float = 0.0


@dataclass(frozen=True)
class Wheel:
    """A rim on its centre, or only a rim if `hub` is None.

    Raises:
        PartError: it cannot be made; see `wheel_faults`.
    """

    rim: Rim
    hub: WheelCentre | None = None

    def __post_init__(self) -> None:
        faults = list(wheel_faults(self))
        if faults:
            raise PartError(
                "the wheel cannot be made: " + "; ".join(faults),
                hint=f"leave {1e3 * LIGAMENT:g} mm between holes and edges, "
                "or design the rim alone, without a web",
            )

    @property
    def one_piece(self) -> bool:
        """True if it is turned from one material."""
        return self.hub is None or self.hub.material == self.rim.material


def wheel_faults(wheel: Wheel) -> Iterator[str]:
    """Reasons why a wheel cannot be made, each as a clause."""
    rim, hub = wheel.rim, wheel.hub
    if not 0.0 <= rim.inner_radius < rim.outer_radius:
        yield "its rim's inner radius is not less than its outer radius"
    if rim.height <= 0.0 or rim.chamfer < 0.0:
        yield "its rim has no height, or a negative chamfer"
    edge = rim.made_chamfer
    if rim.balancing is not None:
        yield from _ring_faults(
            rim.balancing, rim.inner_radius + edge, rim.outer_radius - edge, "balancing"
        )
        if 2.0 * rim.balancing.depth + LIGAMENT > rim.height + ROUNDING:
            yield "its balancing holes meet in the middle"
    if hub is None:
        return
    if not 0.0 <= hub.bore_radius < hub.radius:
        yield "its bore is not narrower than its hub"
    if not hub.radius + LIGAMENT <= rim.inner_radius + ROUNDING:
        yield (
            f"its hub of {1e3 * hub.radius:.4g} mm radius leaves no web in the rim's "
            f"{1e3 * rim.inner_radius:.4g} mm"
        )
    if not 0.0 < hub.web_thickness <= rim.height - 2.0 * rim.made_chamfer:
        yield f"its web of {1e3 * hub.web_thickness:.3g} mm is thicker than the rim is high"
    if hub.height < hub.web_thickness + 2.0 * hub.chamfer:
        yield "its hub is lower than the web is thick"
    if not 0.0 <= 2.0 * hub.chamfer < hub.radius - hub.bore_radius:
        yield "its hub's chamfers leave no face between them"
    if hub.bolts is not None:
        yield from _ring_faults(hub.bolts, hub.bore_radius, hub.radius, "bolt")
    if hub.lightening is not None:
        yield from _ring_faults(hub.lightening, hub.radius, rim.inner_radius, "lightening")


def _ring_faults(ring: HoleRing, inner: float, outer: float, name: str) -> Iterator[str]:
    """Faults of holes between two edges."""
    if ring.count < 1 or ring.hole_radius <= 0.0 or ring.depth <= 0.0:
        yield f"its {name} holes have no count, size or depth"
    elif ring.radius - ring.hole_radius < inner + LIGAMENT - ROUNDING:
        yield f"its {name} holes are too close to the inner edge"
    elif ring.radius + ring.hole_radius > outer - LIGAMENT + ROUNDING:
        yield f"its {name} holes are too close to the outer edge"
    elif ring.spacing < LIGAMENT - ROUNDING:
        yield f"its {name} holes are too close to each other"


def wheel_parts(wheel: Wheel) -> tuple[Part[float], ...]:
    """One part for each piece: the whole wheel, or its rim and its hub."""
    rim, hub = wheel.rim, wheel.hub
    inner, outer = rim.inner_radius, rim.outer_radius
    half, edge = rim.height / 2.0, rim.made_chamfer
    # Corners of the upper half, from the outside to the bore.
    upper = [(outer, half - edge), (outer - edge, half), (inner + edge, half), (inner, half - edge)]
    holes: tuple[Prism[float], ...] = ()
    if rim.balancing is not None:
        bottom = half - rim.balancing.depth
        holes = (rim.balancing.prisms(bottom, half), rim.balancing.prisms(-half, -bottom))
    if hub is None:
        return (Part("rim", rim.density, (_mirrored(upper),), holes),)

    web, top, edge = hub.web_thickness / 2.0, hub.height / 2.0, hub.chamfer
    disc = [
        (rim.inner_radius, web),
        (hub.radius, web),
        (hub.radius, top - edge),
        (hub.radius - edge, top),
        (hub.bore_radius + edge, top),
        (hub.bore_radius, top - edge),
    ]
    drilled: tuple[Prism[float], ...] = ()
    if hub.bolts is not None:
        drilled += (hub.bolts.prisms(-top, top),)
    if hub.lightening is not None:
        drilled += (hub.lightening.prisms(-web, web),)
    if wheel.one_piece:
        return (Part("wheel", rim.density, (_mirrored([*upper, *disc]),), holes + drilled),)
    return (
        Part("rim", rim.density, (_mirrored(upper),), holes),
        Part("hub", hub.density, (_mirrored(disc),), drilled),
    )


def _mirrored(upper: list[tuple[float, float]]) -> Revolution:
    """A body of revolution from its upper half and the mirror image below z = 0."""
    return revolved([*upper, *((radius, -height) for radius, height in reversed(upper))])
