"""Cut faces of a wheel: polygons of z and radius [m], one half of the section, and hatching."""

import math
from collections.abc import Iterator, Sequence

from ocs_design.export.drawing.sheet import THIN, Item, Line, Point
from ocs_design.parts.wheel import HoleRing, Hub, Rim, Wheel

SPACING = 2.0
"""Distance of the hatching's lines [mm]."""

_DIAGONAL = math.sqrt(0.5)

Profile = list[Point]


def cut_faces(wheel: Wheel, *, above: bool) -> Iterator[tuple[Profile, bool]]:
    """Faces of one half of the section, each with whether it is hatched the other way.

    Args:
        wheel: to cut.
        above: the half that points straight up; else the one straight down.
    """
    rim, hub = rim_profile(wheel.rim, above=above), wheel.hub
    if hub is None:
        yield rim, False
        return
    *inner, outermost = _hub_profiles(hub, wheel.rim.inner_radius, above=above)
    if wheel.one_piece:
        # One polygon of both: the rim goes where the web's outer end was.
        end = max(range(len(outermost)), key=lambda i: (outermost[i][1], outermost[i][0]))
        outermost = [*outermost[: end + 1], *rim[1:], rim[0], *outermost[end + 1 :]]
    else:
        yield rim, True
    for profile in (*inner, outermost):
        yield profile, False


def is_cut(ring: HoleRing, *, above: bool) -> bool:
    """Whether the section cuts a hole; the first one is straight up."""
    return above or ring.count % 2 == 0


def half_width(hub: Hub, radius: float) -> float:
    """Half the thickness of web or hub at a radius [m]."""
    return (hub.height if radius < hub.radius else hub.web_thickness) / 2.0


def rim_profile(rim: Rim, *, above: bool) -> Profile:
    """Outline of the rim from the left end of its bore, around its blind holes."""
    r, R, half, c = rim.inner_radius, rim.outer_radius, rim.height / 2.0, rim.made_chamfer
    notch: Profile = []
    ring = rim.balancing
    if ring is not None and is_cut(ring, above=above):
        bottom = half - ring.depth
        inside, outside = ring.radius - ring.hole_radius, ring.radius + ring.hole_radius
        notch = [(half, inside), (bottom, inside), (bottom, outside), (half, outside)]
    right = [(half - c, r), (half, r + c), *notch, (half, R - c), (half - c, R)]
    left = [(-z, radius) for z, radius in reversed(right)]
    return _distinct([left[-1], *right, *left[:-1]])


def _hub_profiles(hub: Hub, seat_radius: float, *, above: bool) -> list[Profile]:
    """Web and hub up to the rim's bore, in pieces where holes are cut."""
    rings = [ring for ring in (hub.bolts, hub.lightening) if ring is not None]
    cuts = [ring for ring in rings if is_cut(ring, above=above)]
    starts = [hub.bore_radius, *(ring.radius + ring.hole_radius for ring in cuts)]
    ends = [*(ring.radius - ring.hole_radius for ring in cuts), seat_radius]
    profiles, edge = [], hub.chamfer
    for inner, outer in zip(starts, ends, strict=True):
        low, high = half_width(hub, inner), half_width(hub, outer)
        at_bore = [(low - edge, inner), (low, inner + edge)]
        start = at_bore if inner == hub.bore_radius else [(low, inner)]
        step = [(low, hub.radius - edge), (low - edge, hub.radius), (high, hub.radius)]
        right = [*start, *(step if inner < hub.radius < outer else []), (high, outer)]
        profiles.append(_distinct([*right, *[(-z, radius) for z, radius in reversed(right)]]))
    return profiles


def _distinct(profile: Profile) -> Profile:
    """Profile without corners that repeat the one before them, as where there is no chamfer."""
    return [b for a, b in zip([profile[-1], *profile], profile, strict=False) if a != b]


def hatching(
    corners: Sequence[Point], *others: Sequence[Point], mirrored: bool = False
) -> list[Item]:
    """Thin lines at 45 degrees inside a polygon (ISO 128-3).

    All polygons of a sheet share one grid, so that faces of one part are hatched as one.

    Args:
        corners: of a simple polygon [mm]. others: further ones of the part, or holes in it.
        mirrored: leaning to the left, for the part beside the first.
    """
    side = -_DIAGONAL if mirrored else _DIAGONAL
    rings = [
        [(_DIAGONAL * x - side * y, side * x + _DIAGONAL * y) for x, y in ring]
        for ring in (corners, *others)
    ]
    across = [v for ring in rings for _, v in ring]
    first, last = math.ceil(min(across) / SPACING), math.floor(max(across) / SPACING)
    lines: list[Item] = []
    for v in (SPACING * row for row in range(first, last + 1)):
        # Parts of a level line inside the polygons, by the even-odd rule.
        crossings = sorted(
            u0 + (u1 - u0) * (v - v0) / (v1 - v0)
            for ring in rings
            for (u0, v0), (u1, v1) in zip(ring, [*ring[1:], ring[0]], strict=True)
            if (v0 <= v) != (v1 <= v)
        )
        lines += [
            Line(
                (_DIAGONAL * a + side * v, -side * a + _DIAGONAL * v),
                (_DIAGONAL * b + side * v, -side * b + _DIAGONAL * v),
                THIN,
            )
            for a, b in zip(crossings[::2], crossings[1::2], strict=True)
        ]
    return lines
