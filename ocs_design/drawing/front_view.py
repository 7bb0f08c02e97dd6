"""The wheel along its axis, with what is said of its circles."""

import math
from collections.abc import Iterator

from ocs_design.drawing.dimensioning import Callout, fits_inside, leader, viewing_arrow
from ocs_design.drawing.labels import diameter, diameters, holes
from ocs_design.drawing.layout import Layout
from ocs_design.drawing.sheet import CENTRE, OUTLINE, Circle, Item, Line, Point
from ocs_design.parts.wheel import HoleRing, Wheel

SHELF, ROW = 9.0, 7.0
"""Of the leaders: off the outline, and apart [mm]."""

BORE_LEADERS = tuple(math.radians(angle) for angle in range(8, 42, 2))
"""Directions that the bore's leader may come from [rad]."""

HOLE_ROWS = (14.0, 25.0, 36.0)
"""Of the leaders to holes below the axis: bolts, lightening, balancing [mm]."""

_BEYOND = 3.0
"""Of centre lines past an outline [mm]."""

HOLE_LEADERS = (math.radians(-25.0), math.radians(-40.0), math.radians(-50.0))
"""Where the hole should be that each of them points to [rad]."""

NARROWEST = 1.0
"""Between lines of an outline [mm]: chamfers that are narrower are not drawn from the front."""


def front_view(wheel: Wheel, layout: Layout) -> list[Item]:
    """Circles, centre lines, the plane of the section, and leaders to the right."""
    (x, y), edge = layout.front, layout.scale(wheel.rim.outer_radius)
    return [
        *_circles(wheel, layout),
        Line((x - edge - _BEYOND, y), (x + edge + _BEYOND, y), CENTRE),
        Line((x, y - edge - _BEYOND), (x, y + edge + _BEYOND), CENTRE),
        *viewing_arrow("A", x=x, edge=y - edge, down=False),
        *viewing_arrow("A", x=x, edge=y + edge, down=True),
        *_leaders(wheel, layout),
    ]


def _circles(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    radii = [*_rim_radii(wheel, layout)]
    if wheel.hub is not None:
        radii += [wheel.hub.radius, wheel.hub.bore_radius]
    yield from (Circle(layout.front, layout.scale(radius)) for radius in radii if radius > 0.0)
    for ring in _rings(wheel):
        if ring is not None:
            yield from _holes(ring, layout)


def _rim_radii(wheel: Wheel, layout: Layout) -> Iterator[float]:
    rim, edge = wheel.rim, wheel.rim.made_chamfer
    yield from (rim.outer_radius, rim.inner_radius)
    if layout.scale(edge) >= NARROWEST:
        yield from (rim.outer_radius - edge, rim.inner_radius + edge)


def _rings(wheel: Wheel) -> tuple[HoleRing | None, ...]:
    """Bolts, lightening, balancing."""
    hub = wheel.hub
    in_hub = (None, None) if hub is None else (hub.bolts, hub.lightening)
    return (*in_hub, wheel.rim.balancing)


def _holes(ring: HoleRing, layout: Layout) -> Iterator[Item]:
    """Each with its centre marked across the circle that they are on."""
    (x, y), radius = layout.front, layout.scale(ring.radius)
    yield Circle((x, y), radius, CENTRE)
    reach = layout.scale(ring.hole_radius) + 1.0
    for angle in hole_angles(ring):
        u, v = math.cos(angle), -math.sin(angle)
        yield Circle(_hole(ring, angle, layout), layout.scale(ring.hole_radius), OUTLINE)
        yield Line(
            (x + (radius - reach) * u, y + (radius - reach) * v),
            (x + (radius + reach) * u, y + (radius + reach) * v),
        )


def hole_angles(ring: HoleRing) -> list[float]:
    """From the right, counter-clockwise as seen; the first is straight up [rad]."""
    return [math.pi / 2.0 + 2.0 * math.pi * i / ring.count for i in range(ring.count)]


def _hole(ring: HoleRing, angle: float, layout: Layout) -> Point:
    (x, y), radius = layout.front, layout.scale(ring.radius)
    return x + radius * math.cos(angle), y - radius * math.sin(angle)


def _leaders(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    (x, y), edge = layout.front, layout.scale(wheel.rim.outer_radius)
    shelf = x + edge + SHELF
    bolts = None if wheel.hub is None else wheel.hub.bolts
    first = (edge + SHELF) * math.tan(_bore_leader(bolts))
    for row, callout in enumerate(_callouts(wheel, layout)):
        yield from leader(callout, (shelf, y - first - ROW * row))
    for ring, below, aim in zip(_rings(wheel), HOLE_ROWS, HOLE_LEADERS, strict=True):
        if ring is not None:
            yield from leader(_hole_callout(ring, aim, layout), (shelf, y + below))


def _bore_leader(bolts: HoleRing | None) -> float:
    """The direction farthest from all holes, so that the leader crosses none [rad]."""
    if bolts is None:
        return BORE_LEADERS[0]
    angles = hole_angles(bolts)
    return min(BORE_LEADERS, key=lambda angle: max(math.cos(angle - hole) for hole in angles))


def _callouts(wheel: Wheel, layout: Layout) -> Iterator[Callout]:
    """Circles whose dimensions the section has no room for, and the bore, from the inside out."""
    if wheel.hub is not None and wheel.hub.bore_radius > 0.0:
        bore = f"{diameter(wheel.hub.bore_radius)} H7"
        yield Callout((bore,), layout.front, layout.scale(wheel.hub.bore_radius))
    for label, radius, _ in diameters(wheel):
        on_paper = layout.scale(radius)
        if not fits_inside(label, 2.0 * on_paper):
            yield Callout((label,), layout.front, on_paper)


def _hole_callout(ring: HoleRing, aim: float, layout: Layout) -> Callout:
    """For the hole nearest to a direction [rad]."""
    angle = max(hole_angles(ring), key=lambda each: math.cos(each - aim))
    return Callout(holes(ring), _hole(ring, angle, layout), layout.scale(ring.hole_radius))
