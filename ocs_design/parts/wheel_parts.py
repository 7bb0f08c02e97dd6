"""The pieces that a wheel is made of."""

from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, Revolution, revolved
from ocs_design.parts.wheel import Hub, Rim, Wheel


def wheel_parts(wheel: Wheel) -> tuple[Part, ...]:
    """One part for each piece: the wheel, or its rim and its hub."""
    rim, hub = wheel.rim, wheel.hub
    if hub is None:
        return (Part("rim", rim.density, (_revolved_rim(rim),), _balancing(rim)),)
    if wheel.one_piece:
        cuts = _balancing(rim) + _hub_holes(hub)
        return (Part("wheel", rim.density, (_revolved_wheel(rim, hub),), cuts),)
    return (
        Part("rim", rim.density, (_revolved_rim(rim),), _balancing(rim)),
        Part("hub", hub.density, (_revolved_hub(rim, hub),), _hub_holes(hub)),
    )


def _revolved_rim(rim: Rim) -> Revolution:
    return revolved([*_outer_edge(rim), *_upper_bore(rim), *_lower_bore(rim)])


def _revolved_hub(rim: Rim, hub: Hub) -> Revolution:
    half = hub.web_thickness / 2.0
    seat = [(rim.inner_radius, -half), (rim.inner_radius, half)]
    return revolved([*seat, *_around_hub(hub)])


def _revolved_wheel(rim: Rim, hub: Hub) -> Revolution:
    half = hub.web_thickness / 2.0
    upper, lower = (rim.inner_radius, half), (rim.inner_radius, -half)
    corners = [*_outer_edge(rim), *_upper_bore(rim), upper, *_around_hub(hub), lower]
    return revolved([*corners, *_lower_bore(rim)])


def _outer_edge(rim: Rim) -> list[tuple[float, float]]:
    """From the lower face to the upper one."""
    outer, half, edge = rim.outer_radius, rim.height / 2.0, rim.made_chamfer
    lower = [(outer - edge, -half), (outer, edge - half)]
    return [*lower, *_mirrored(lower)]


def _upper_bore(rim: Rim) -> list[tuple[float, float]]:
    """From the upper face downwards."""
    inner, half, edge = rim.inner_radius, rim.height / 2.0, rim.made_chamfer
    return [(inner + edge, half), (inner, half - edge)]


def _lower_bore(rim: Rim) -> list[tuple[float, float]]:
    """From the bore to the lower face."""
    return _mirrored(_upper_bore(rim))


def _around_hub(hub: Hub) -> list[tuple[float, float]]:
    """From the web's upper face around the hub to its lower one."""
    web, half, edge = hub.web_thickness / 2.0, hub.height / 2.0, hub.chamfer
    outside = [(hub.radius, web), (hub.radius, half - edge), (hub.radius - edge, half)]
    bore = [(hub.bore_radius + edge, half), (hub.bore_radius, half - edge)]
    return [*outside, *bore, *_mirrored([*outside, *bore])]


def _mirrored(corners: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """At z = 0, and walked the other way."""
    return [(radius, -height) for radius, height in reversed(corners)]


def _balancing(rim: Rim) -> tuple[Prism, ...]:
    ring = rim.balancing
    if ring is None:
        return ()
    half = rim.height / 2.0
    return (*ring.prisms(half - ring.depth, half), *ring.prisms(-half, ring.depth - half))


def _hub_holes(hub: Hub) -> tuple[Prism, ...]:
    bolts = () if hub.bolts is None else hub.bolts.prisms(-hub.height / 2.0, hub.height / 2.0)
    half = hub.web_thickness / 2.0
    lightening = () if hub.lightening is None else hub.lightening.prisms(-half, half)
    return (*bolts, *lightening)
