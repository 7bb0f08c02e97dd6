"""The wheel cut along its axis, with its diameters and widths."""

from collections.abc import Iterator

from ocs_design.drawing.dimensioning import (
    Callout,
    extension,
    fits_inside,
    leader,
    level_dimension,
    upright_dimension,
)
from ocs_design.drawing.hatching import hatching
from ocs_design.drawing.labels import diameters, plain, toleranced
from ocs_design.drawing.layout import Layout
from ocs_design.drawing.profile import Profile, cut_faces, half_width, is_cut
from ocs_design.drawing.sheet import (
    CENTRE,
    OUTLINE,
    Anchor,
    Item,
    Line,
    Point,
    Text,
    outline,
)
from ocs_design.drawing.tolerances import Grade
from ocs_design.drawing.wheel import widest
from ocs_design.parts.wheel import HoleRing, Wheel

FIRST_COLUMN, COLUMN = 9.0, 8.0
"""Of the diameters: off the outline, and apart [mm]."""

ABOVE = 9.0
"""Of the rim's width over the outline [mm]."""

CHAMFER_ASIDE, BELOW = 5.0, 7.0
"""Of the chamfer's leader from its edge and under the outline [mm]."""

NEAREST = 4.0
"""Of a width's dimension line to the axis [mm]."""

ASIDE, PAST_ARROWS = 4.0, 7.0
"""Of a width's text from the outline, and from what it measures [mm]."""

_ABOVE, _BELOW = -1.0, 1.0


def section_view(wheel: Wheel, layout: Layout) -> list[Item]:
    """Cut faces, edges behind them, axis, dimensions and the name of the section."""
    (x, y), half = layout.section, layout.scale(widest(wheel)) / 2.0
    edge = layout.scale(wheel.rim.outer_radius)
    return [
        *_faces(wheel, layout),
        *_edges_behind(wheel, layout),
        Line((x - half - 4.0, y), (x + half + 4.0, y), CENTRE),
        *_hole_axes(wheel, layout),
        *_diameters(wheel, layout),
        *_widths(wheel, layout),
        *_chamfer(wheel, layout),
        Text((x, y - edge - ABOVE - 7.0), "A–A", 5.0, Anchor.MIDDLE),
    ]


def _faces(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    for side in (_ABOVE, _BELOW):
        for profile, mirrored in cut_faces(wheel, above=side == _ABOVE):
            corners = _placed(profile, layout, side)
            yield from outline(corners)
            yield from hatching(corners, mirrored=mirrored)


def _placed(profile: Profile, layout: Layout, side: float) -> list[Point]:
    (x, y), scale = layout.section, layout.scale
    return [(x + scale(z), y + side * scale(radius)) for z, radius in profile]


def _edges_behind(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    """Circles behind the plane, edge on: of bores, holes and the rim's inside."""
    for half, low, high in _spans_behind(wheel):
        for z in (-half, half):
            start, end = _placed([(z, low), (z, high)], layout, _BELOW)
            yield Line(start, end, OUTLINE)


def _spans_behind(wheel: Wheel) -> Iterator[tuple[float, float, float]]:
    """Distance from the wheel's middle, and from where to where across the axis [m]."""
    rim, hub = wheel.rim, wheel.hub
    r, half = rim.inner_radius + rim.made_chamfer, rim.height / 2.0
    if hub is None or hub.height <= rim.height:
        yield half, -r, r
    else:
        yield half, -r, -hub.radius
        yield half, hub.radius, r
    if hub is not None:
        mouth = hub.bore_radius + hub.chamfer
        yield hub.height / 2.0, -mouth, mouth
    for ring, width, side in _cut_rings(wheel):
        center = side * ring.radius
        yield width, center - ring.hole_radius, center + ring.hole_radius


def _cut_rings(wheel: Wheel) -> Iterator[tuple[HoleRing, float, float]]:
    """Rings with a hole in the section, half the width that they go through [m], and the side."""
    rings = [] if wheel.rim.balancing is None else [(wheel.rim.balancing, wheel.rim.height / 2.0)]
    if wheel.hub is not None:
        found = (ring for ring in (wheel.hub.bolts, wheel.hub.lightening) if ring is not None)
        rings += [(ring, half_width(wheel.hub, ring.radius)) for ring in found]
    for ring, width in rings:
        for side in (_ABOVE, _BELOW):
            if is_cut(ring, above=side == _ABOVE):
                yield ring, width, side


def _hole_axes(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    for ring, width, side in _cut_rings(wheel):
        half = width + layout.scale.length(2.0)
        start, end = _placed([(-half, ring.radius), (half, ring.radius)], layout, side)
        yield Line(start, end, CENTRE)


def _diameters(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    """Those with room for their text, side by side, the smallest next to the outline."""
    (x, y), column = layout.section, 0
    left = x - layout.scale(widest(wheel)) / 2.0 - FIRST_COLUMN
    for label, radius, width in diameters(wheel):
        half = layout.scale(radius)
        if fits_inside(label, 2.0 * half):
            yield from upright_dimension(
                label,
                x=left - COLUMN * column,
                middle=y,
                half=half,
                outline_x=x - layout.scale(width) / 2.0,
            )
            column += 1


def _widths(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    """The rim's above the view; web and hub between hub and rim, on either side of the axis."""
    (_, y), edge, hub = layout.section, layout.scale(wheel.rim.outer_radius), wheel.hub
    label = toleranced(wheel.rim.height, Grade.IT11)
    yield from _width(label, wheel.rim.height, wheel, layout, y=y - edge - ABOVE, start=y - edge)
    if hub is None:
        return
    away = max(NEAREST, layout.scale(hub.radius + wheel.rim.inner_radius) / 2.0)
    yield from _width(plain(hub.web_thickness), hub.web_thickness, wheel, layout, y=y - away)
    start = y + layout.scale(hub.radius)
    yield from _width(plain(hub.height), hub.height, wheel, layout, y=y + away, start=start)


def _chamfer(wheel: Wheel, layout: Layout) -> Iterator[Item]:
    """Of the rim's edges, below the view; where it is too small to be written, nothing."""
    rim, edge = wheel.rim, wheel.rim.made_chamfer
    label = plain(edge)
    if float(label) == 0.0:
        return
    middle = (rim.height / 2.0 - edge / 2.0, rim.outer_radius - edge / 2.0)
    (corner,) = _placed([middle], layout, _BELOW)
    shelf = (corner[0] + CHAMFER_ASIDE, layout.section[1] + layout.scale(rim.outer_radius) + BELOW)
    yield from leader(Callout((f"{label} × 45°",), corner, 0.0), shelf)


def _width(
    label: str,
    width: float,
    wheel: Wheel,
    layout: Layout,
    *,
    y: float,
    start: float | None = None,
) -> Iterator[Item]:
    """One of them, with extension lines from `start` where the outline does not reach it."""
    x, half = layout.section[0], layout.scale(width) / 2.0
    if start is not None:
        yield from (extension(x + side * half, start, y) for side in (-1.0, 1.0))
    aside = (
        layout.scale(widest(wheel)) / 2.0 + ASIDE if start is None or width < widest(wheel) else 0.0
    )
    text_x = x + max(half + PAST_ARROWS, aside)
    yield from level_dimension(label, left=x - half, right=x + half, y=y, text_x=text_x)
