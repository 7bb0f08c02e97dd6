"""From a wheel as it was sized to the wheel as it is made."""

from ocs_design.design import Flywheel, Web
from ocs_design.parts.wheel import HoleRing, Hub, Rim, Wheel


def made_wheel(flywheel: Flywheel) -> Wheel:
    """Rim, and web with hub where there is one; edges sharp, so that it weighs what was sized.

    Raises:
        PartError: it cannot be made.
    """
    rim = Rim(
        flywheel.inner_radius,
        flywheel.outer_radius,
        flywheel.height,
        flywheel.material,
        flywheel.density,
        chamfer=0.0,
    )
    return Wheel(rim, None if flywheel.web is None else _made_hub(flywheel.web))


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
    )
