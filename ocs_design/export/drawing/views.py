"""Views of a wheel in first-angle projection: the section, and the front view to its right."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Circle, Item, Lettering, Line, Point, Scale
from ocs_design.export.drawing.wheel import (
    WEB_GRADE,
    diameters,
    fitted_bore_label,
    hole_label,
    in_mm,
    toleranced,
)
from ocs_design.parts.joints import Grade
from ocs_design.parts.rim import HoleRing
from ocs_design.parts.wheel import Rim, Wheel

AXIS_Y = 82.0
"""y of the wheel's axis in both views [mm]."""

MAX_VIEW_HEIGHT = 98.0
"""Largest height of a view, between its name and dimensions and the title block [mm]."""

DIAMETER_SPACE, WIDTH_SPACE, LEADER_SPACE = 33.0, 36.0, 51.0
"""Space for the diameters, for the widths, and for the leaders [mm]."""

_ROOM = sheet.WIDTH - sheet.MARGIN_LEFT - sheet.MARGIN - DIAMETER_SPACE - WIDTH_SPACE - LEADER_SPACE

FIRST_COLUMN, COLUMN = 9.0, 8.0
"""Distance of the first diameter from the section's outline, and between diameters [mm]."""

RIM_WIDTH_DISTANCE = 9.0
"""Distance of the rim's width from the outline below it [mm]."""

CHAMFER_ASIDE, CHAMFER_BELOW = 5.0, 7.0
"""Distance of the chamfer's leader from its edge, and from the outline above it [mm]."""

MIN_AXIS_DISTANCE = 4.0
"""Smallest distance of a width's dimension line from the axis [mm]."""

TEXT_ASIDE, PAST_ARROWS = 4.0, 7.0
"""Distance of a width's text from the outline, and from its dimension line [mm]."""

LEADER_SHELF, LEADER_ROW = 9.0, 7.0
"""Distance of the front view's leaders from its outline, and between them [mm]."""

BORE_LEADERS = tuple(math.radians(angle) for angle in range(8, 42, 2))
"""Directions that the bore's leader may come from [rad]."""

HOLE_ROWS = (14.0, 25.0, 36.0)
"""Distance below the axis of the leaders to bolt, lightening and balancing holes [mm]."""

HOLE_LEADERS = (math.radians(-25.0), math.radians(-40.0), math.radians(-50.0))
"""Direction of the hole that each of these leaders points to [rad]."""

MIN_LINE_DISTANCE = 1.0
"""Smallest line distance in the front view [mm]: narrower chamfers are not drawn there."""

_CENTRE_LINE_OVERHANG = 3.0
"""Length of centre lines beyond the front view's outline [mm]."""

_ABOVE, _BELOW = -1.0, 1.0

Profile: TypeAlias = list[Point]
"""Polygon of z and radius [m] in one half of the section."""


@dataclass(frozen=True)
class SheetLayout:
    """Scale of both views, and their centres [mm]: `section` is seen from the right of `front`."""

    scale: Scale
    section: Point
    front: Point


def lay_out(wheel: Wheel) -> SheetLayout:
    """Place both views side by side, centred in the available space."""
    diameter, width = 2.0 * wheel.rim.outer_radius, wheel.width
    scale = sheet.largest_scale((diameter, MAX_VIEW_HEIGHT), (diameter + width, _ROOM))
    diameter_on_paper, width_on_paper = scale(diameter), scale(width)
    spare = max(0.0, _ROOM - diameter_on_paper - width_on_paper)
    start = sheet.MARGIN_LEFT + DIAMETER_SPACE + spare / 2.0
    section = start + width_on_paper / 2.0
    front = start + width_on_paper + WIDTH_SPACE + diameter_on_paper / 2.0
    return SheetLayout(scale, (section, AXIS_Y), (front, AXIS_Y))


def section_view(wheel: Wheel, layout: SheetLayout) -> list[Item]:
    """Wheel cut along its axis: cut faces, edges behind them, axes, diameters and widths."""
    (x, y), scale, rim = layout.section, layout.scale, wheel.rim
    half, edge = scale(wheel.width) / 2.0, scale(rim.outer_radius)
    items: list[Item] = []

    def across(label: str, width: float, y: float, start: float | None = None) -> Iterator[Item]:
        """One width, with extension lines from `start` if the outline does not reach it."""
        ends = x - scale(width) / 2.0, x + scale(width) / 2.0
        text_x = ends[1] + PAST_ARROWS
        if start is not None:
            yield from (sheet.extension_line(end, start, y) for end in ends)
        if start is None or width < wheel.width:
            # Clear of the outline.
            text_x = max(text_x, x + half + TEXT_ASIDE)
        yield from sheet.horizontal_dimension(
            label, left=ends[0], right=ends[1], y=y, text_x=text_x
        )

    for side in (_ABOVE, _BELOW):
        for profile, mirrored in cut_faces(wheel, above=side == _ABOVE):
            corners = _on_sheet(profile, layout, side)
            items += [*sheet.outline(corners), *sheet.hatching(corners, mirrored=mirrored)]
    items += _edges_behind(wheel, layout)
    items.append(Line((x - half - 4.0, y), (x + half + 4.0, y), sheet.CENTRE))
    for ring, width, side in _cut_rings(wheel):
        half_length = width + scale.length(2.0)
        along = [(z, ring.circle_radius) for z in (-half_length, half_length)]
        start, end = _on_sheet(along, layout, side)
        items.append(Line(start, end, sheet.CENTRE))
    # Diameters that have space for their text, side by side, the smallest next to the outline.
    column = x - half - FIRST_COLUMN
    for label, radius, width in diameters(wheel):
        long, outline_x = scale(radius), x - scale(width) / 2.0
        if sheet.fits_inside(label, 2.0 * long):
            items += sheet.vertical_dimension(
                label, x=column, middle=y, half=long, outline_x=outline_x
            )
            column -= COLUMN
    # Width of the rim above the view; widths of web and hub on either side of the axis, where the
    # web is uncut: in the wider of its parts inside and outside its holes.
    label, top = toleranced(rim.height, Grade.IT11), y - edge
    items += across(label, rim.height, top - RIM_WIDTH_DISTANCE, top)
    web = wheel.web
    if web is not None:
        hub, holes = web.hub, web.holes
        inside, outside = hub.radius, rim.inner_radius
        if holes is not None and 2.0 * holes.circle_radius > inside + outside:
            outside = holes.inside
        elif holes is not None:
            inside = holes.reach
        distance = max(MIN_AXIS_DISTANCE, scale(inside + outside) / 2.0)
        items += across(toleranced(web.thickness, WEB_GRADE), web.thickness, y - distance)
        items += across(in_mm(hub.height), hub.height, y + distance, y + scale(hub.radius))
    # The size of the rim's chamfers, below the view, if it is large enough to be written.
    chamfer = in_mm(rim.chamfer)
    if float(chamfer) > 0.0:
        aside = rim.chamfer / 2.0
        middle = (rim.height / 2.0 - aside, rim.outer_radius - aside)
        (corner,) = _on_sheet([middle], layout, _BELOW)
        shelf = (corner[0] + CHAMFER_ASIDE, y + edge + CHAMFER_BELOW)
        items += sheet.leader([f"{chamfer} × 45°"], corner, 0.0, shelf)
    return [*items, Lettering((x, y - edge - RIM_WIDTH_DISTANCE - 7.0), "A–A", 5.0, Anchor.MIDDLE)]


def _on_sheet(profile: Profile, layout: SheetLayout, side: float) -> list[Point]:
    (x, y), scale = layout.section, layout.scale
    return [(x + scale(z), y + side * scale(radius)) for z, radius in profile]


def _edges_behind(wheel: Wheel, layout: SheetLayout) -> Iterator[Item]:
    """Edges of circles behind the cutting plane: bores, holes and the rim's inside."""
    rim, web = wheel.rim, wheel.web
    r, half = rim.inner_radius + rim.chamfer, rim.height / 2.0
    # Distance from the wheel's middle, and ends across the axis [m].
    spans = [(half, -r, r)]
    if web is not None:
        hub = web.hub
        if hub.height > rim.height:
            spans = [(half, -r, -hub.radius), (half, hub.radius, r)]
        mouth = hub.bore_radius + hub.chamfer
        spans.append((hub.height / 2.0, -mouth, mouth))
    for ring, width, side in _cut_rings(wheel):
        center = side * ring.circle_radius
        spans.append((width, center - ring.hole_radius, center + ring.hole_radius))
    for distance, low, high in spans:
        for z in (-distance, distance):
            start, end = _on_sheet([(z, low), (z, high)], layout, _BELOW)
            yield Line(start, end, sheet.OUTLINE)


def _cut_rings(wheel: Wheel) -> Iterator[tuple[HoleRing, float, float]]:
    """Hole rings cut by the section, half the width at the hole [m], and the side."""
    rings = [] if wheel.rim.balancing is None else [(wheel.rim.balancing, wheel.rim.height / 2.0)]
    if wheel.web is not None:
        web = wheel.web
        rings += [(ring, web.height(ring.circle_radius) / 2.0) for ring in web.rings]
    for ring, width in rings:
        for side in (_ABOVE, _BELOW):
            if is_cut(ring, above=side == _ABOVE):
                yield ring, width, side


def cut_faces(wheel: Wheel, *, above: bool) -> Iterator[tuple[Profile, bool]]:
    """Faces of one half of the section, each with a flag for mirrored hatching.

    It is the upper half, or the lower half if not `above`.
    """
    rim, web = rim_profile(wheel.rim, above=above), wheel.web
    if web is None:
        yield rim, False
        return
    # Web and hub up to the rim's bore, in pieces where holes are cut.
    hub = web.hub
    cut_rings = [ring for ring in web.rings if is_cut(ring, above=above)]
    starts = [hub.bore_radius, *(ring.reach for ring in cut_rings)]
    ends = [*(ring.inside for ring in cut_rings), wheel.rim.inner_radius]
    corners = [(z, radius) for radius, z in reversed(web.corners(wheel.rim.inner_radius))]
    profiles = []
    for inside, outside in zip(starts, ends, strict=True):
        right = [corner for corner in corners if inside <= corner[1] <= outside]
        if inside > hub.bore_radius:
            right.insert(0, (web.height(inside) / 2.0, inside))
        right.append((web.height(outside) / 2.0, outside))
        profiles.append(_distinct([*right, *[(-z, radius) for z, radius in reversed(right)]]))
    *inner, outermost = profiles
    if not wheel.shrunk_on:
        # One polygon for both: the rim replaces the web's outer end.
        end = max(range(len(outermost)), key=lambda i: (outermost[i][1], outermost[i][0]))
        outermost = [*outermost[: end + 1], *rim[1:], rim[0], *outermost[end + 1 :]]
    else:
        yield rim, True
    for profile in (*inner, outermost):
        yield profile, False


def is_cut(ring: HoleRing, *, above: bool) -> bool:
    """Whether the section cuts a hole; the first one is straight up."""
    return above or ring.count % 2 == 0


def rim_profile(rim: Rim, *, above: bool) -> Profile:
    """Outline of the rim from the left end of its bore, around its blind holes."""
    right = [(z, radius) for radius, z in reversed(rim.corners)]
    ring = rim.balancing
    if ring is not None and is_cut(ring, above=above):
        half = rim.height / 2.0
        bottom = half - rim.cuts.hole_depth
        # In the middle of its face.
        right[2:2] = [
            (half, ring.inside),
            (bottom, ring.inside),
            (bottom, ring.reach),
            (half, ring.reach),
        ]
    left = [(-z, radius) for z, radius in reversed(right)]
    return _distinct([left[-1], *right, *left[:-1]])


def _distinct(profile: Profile) -> Profile:
    """Profile without repeated corners, which occur if there is no chamfer."""
    return [b for a, b in zip([profile[-1], *profile], profile, strict=False) if a != b]


def front_view(wheel: Wheel, layout: SheetLayout) -> list[Item]:
    """Wheel seen along its axis: circles, centre lines, the cutting plane, and leaders."""
    (x, y), scale, rim, web = layout.front, layout.scale, wheel.rim, wheel.web
    edge, chamfer = scale(rim.outer_radius), rim.chamfer
    beyond = edge + _CENTRE_LINE_OVERHANG
    radii = [rim.outer_radius, rim.inner_radius]
    if scale(chamfer) >= MIN_LINE_DISTANCE:
        radii += [rim.outer_radius - chamfer, rim.inner_radius + chamfer]
    if web is not None:
        radii += [web.hub.radius, web.hub.bore_radius]
    items: list[Item] = [Circle((x, y), scale(radius)) for radius in radii if radius > 0.0]
    for ring in filter(None, _rings(wheel)):
        # The centre of each hole is marked across the pitch circle.
        radius, hole = scale(ring.circle_radius), scale(ring.hole_radius)
        near, far = radius - (hole + 1.0), radius + (hole + 1.0)
        items.append(Circle((x, y), radius, sheet.CENTRE))
        for angle in hole_angles(ring):
            u, v = math.cos(angle), -math.sin(angle)
            items.append(Circle(_hole_position(ring, angle, layout), hole, sheet.OUTLINE))
            items.append(Line((x + near * u, y + near * v), (x + far * u, y + far * v)))
    return [
        *items,
        Line((x - beyond, y), (x + beyond, y), sheet.CENTRE),
        Line((x, y - beyond), (x, y + beyond), sheet.CENTRE),
        *sheet.viewing_arrow(x=x, edge=y - edge, down=False),
        *sheet.viewing_arrow(x=x, edge=y + edge, down=True),
        *_leaders(wheel, layout),
    ]


def _rings(wheel: Wheel) -> tuple[HoleRing | None, ...]:
    """Rings of bolt, lightening and balancing holes."""
    web = wheel.web
    in_web = (None, None) if web is None else (web.hub.bolt_ring, web.holes)
    return (*in_web, wheel.rim.balancing)


def hole_angles(ring: HoleRing) -> list[float]:
    """Angles of the holes, counter-clockwise from the right [rad]; the first is straight up."""
    return [math.pi / 2.0 + 2.0 * math.pi * i / ring.count for i in range(ring.count)]


def _hole_position(ring: HoleRing, angle: float, layout: SheetLayout) -> Point:
    (x, y), radius = layout.front, layout.scale(ring.circle_radius)
    return x + radius * math.cos(angle), y - radius * math.sin(angle)


def _leaders(wheel: Wheel, layout: SheetLayout) -> Iterator[Item]:
    """Leaders to circles whose dimensions do not fit in the section, and to the holes."""
    (x, y), edge = layout.front, layout.scale(wheel.rim.outer_radius)
    hub = None if wheel.web is None else wheel.web.hub
    shelf = x + edge + LEADER_SHELF
    callouts = []
    if hub is not None and hub.bore_radius > 0.0:
        bore = fitted_bore_label(hub.bore_radius)
        callouts.append((bore, layout.scale(hub.bore_radius)))
    for label, radius, _ in diameters(wheel):
        on_paper = layout.scale(radius)
        if not sheet.fits_inside(label, 2.0 * on_paper):
            callouts.append((label, on_paper))
    direction = BORE_LEADERS[0]
    if hub is not None and hub.bolt_ring is not None:
        # The direction farthest from all holes, so that the leader crosses none.
        bolts = hole_angles(hub.bolt_ring)
        direction = min(
            BORE_LEADERS, key=lambda angle: max(math.cos(angle - bolt) for bolt in bolts)
        )
    first = (edge + LEADER_SHELF) * math.tan(direction)
    for row, (label, radius) in enumerate(callouts):
        yield from sheet.leader(
            [label], layout.front, radius, (shelf, y - first - LEADER_ROW * row)
        )
    depths = math.inf, math.inf, wheel.rim.cuts.hole_depth
    for ring, depth, below, target in zip(
        _rings(wheel), depths, HOLE_ROWS, HOLE_LEADERS, strict=True
    ):
        if ring is not None:
            angles = hole_angles(ring)
            nearness = [math.cos(hole - target) for hole in angles]
            angle = angles[nearness.index(max(nearness))]
            center, radius = _hole_position(ring, angle, layout), layout.scale(ring.hole_radius)
            yield from sheet.leader(hole_label(ring, depth), center, radius, (shelf, y + below))
