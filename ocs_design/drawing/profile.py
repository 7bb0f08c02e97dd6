"""The cut faces of a wheel: polygons of z and radius [m], one half of the section."""

from collections.abc import Iterator

from ocs_design.drawing.sheet import Point
from ocs_design.parts.wheel import HoleRing, Hub, Rim, Wheel

Profile = list[Point]


def cut_faces(wheel: Wheel, *, above: bool) -> Iterator[tuple[Profile, bool]]:
    """Each face, and whether it belongs to a part beside the first and is hatched the other way.

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
        outermost = _joined(outermost, rim)
    else:
        yield rim, True
    for profile in (*inner, outermost):
        yield profile, False


def is_cut(ring: HoleRing, *, above: bool) -> bool:
    """The first hole is straight up; straight down is one if their number is even."""
    return above or ring.count % 2 == 0


def half_width(hub: Hub, radius: float) -> float:
    """Of web or hub, at a radius [m]."""
    return (hub.height if radius < hub.radius else hub.web_thickness) / 2.0


def rim_profile(rim: Rim, *, above: bool) -> Profile:
    """Round the rim from the left end of its bore, around its blind holes."""
    r, R, half, c = rim.inner_radius, rim.outer_radius, rim.height / 2.0, rim.made_chamfer
    right = [(half - c, r), (half, r + c), *_notch(rim, above=above), (half, R - c), (half - c, R)]
    left = [(-z, radius) for z, radius in reversed(right)]
    return _distinct([left[-1], *right, *left[:-1]])


def _notch(rim: Rim, *, above: bool) -> Profile:
    """A blind hole in the right face, from the inside out."""
    ring = rim.balancing
    if ring is None or not is_cut(ring, above=above):
        return []
    face, bottom = rim.height / 2.0, rim.height / 2.0 - ring.depth
    inside, outside = ring.radius - ring.hole_radius, ring.radius + ring.hole_radius
    return [(face, inside), (bottom, inside), (bottom, outside), (face, outside)]


def _hub_profiles(hub: Hub, seat_radius: float, *, above: bool) -> list[Profile]:
    """Web and hub up to the rim's bore, in pieces where holes are cut."""
    rings = [ring for ring in (hub.bolts, hub.lightening) if ring is not None]
    cuts = [ring for ring in rings if is_cut(ring, above=above)]
    starts = [hub.bore_radius, *(ring.radius + ring.hole_radius for ring in cuts)]
    ends = [*(ring.radius - ring.hole_radius for ring in cuts), seat_radius]
    return [_between(hub, start, end) for start, end in zip(starts, ends, strict=True)]


def _between(hub: Hub, inner: float, outer: float) -> Profile:
    """What of web and hub lies between two radii, from the left of the inner one."""
    low, high, edge = half_width(hub, inner), half_width(hub, outer), hub.chamfer
    at_bore = [(low - edge, inner), (low, inner + edge)]
    start = at_bore if inner == hub.bore_radius else [(low, inner)]
    step = [(low, hub.radius - edge), (low - edge, hub.radius), (high, hub.radius)]
    right = [*start, *(step if inner < hub.radius < outer else []), (high, outer)]
    return _distinct([*right, *[(-z, radius) for z, radius in reversed(right)]])


def _joined(web: Profile, rim: Profile) -> Profile:
    """One polygon of both: the rim goes where the web's outer end was."""
    end = max(range(len(web)), key=lambda i: (web[i][1], web[i][0]))
    return [*web[: end + 1], *rim[1:], rim[0], *web[end + 1 :]]


def _distinct(profile: Profile) -> Profile:
    """Without corners that repeat the one before them, as where there is no chamfer."""
    return [b for a, b in zip([profile[-1], *profile], profile, strict=False) if a != b]
