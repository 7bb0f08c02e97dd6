"""From a wheel as it was sized to the wheel as it is made."""

from ocs_design.design import Flywheel, Web
from ocs_design.parts.wheel import HoleRing, Hub, Rim, Wheel


def made_wheel(flywheel: Flywheel) -> Wheel:
    """Rim, and web with hub where there is one, to the mass and inertia that were sized.

    Raises:
        PartError: it cannot be made.
    """
    rim = Rim(
        flywheel.inner_radius,
        flywheel.outer_radius,
        flywheel.height,
        flywheel.material,
        flywheel.density,
        chamfer=flywheel.cuts.chamfer,
        balancing=_balancing(flywheel),
    )
    return Wheel(rim, None if flywheel.web is None else _made_hub(flywheel.web))


def _balancing(flywheel: Flywheel) -> HoleRing | None:
    cuts = flywheel.cuts
    if cuts.holes == 0:
        return None
    middle = (flywheel.inner_radius + flywheel.outer_radius) / 2.0
    return HoleRing(middle, cuts.holes, cuts.hole_radius, cuts.hole_depth)


def _made_hub(web: Web) -> Hub:
    hub = web.hub
    return Hub(
        web_thickness=web.thickness,
        radius=hub.radius,
        height=hub.height,
        bore_radius=hub.bore_radius,
        material=web.material,
        density=web.density,
        bolts=HoleRing(hub.bolt_circle_radius, hub.bolts, hub.bolt_hole_radius)
        if hub.bolts
        else None,
        chamfer=hub.chamfer,
    )
