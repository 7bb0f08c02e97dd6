"""Which limits hold the mass of a module up."""

from dataclasses import fields

import numpy as np

from ocs_design.requirement.envelope import Envelope
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.rim_problem import RimLimits

HOUSING = "housing"
"""Stands for the radius where no limit holds it: a larger rim is lighter, but its housing and its
foot are heavier."""

HUB, WEB = "hub", "web"
"""Stand for the bore and the height where the hub and the web ask for more than was specified."""

CUT_WALL, CUT_HEIGHT = "wall for edges and holes", "height for edges and holes"
"""Stand for wall and height where chamfers or balancing holes ask for more than was specified."""

MOUNT = "mount"
"""Stands for the radius where the motor's mount asks for a larger housing."""

# Relative; a hundredth of what can be turned.
_TOUCHING = 1e-5


def binding_limits(
    shapes: ModuleShape, limits: RimLimits, room: Envelope, row: int
) -> tuple[str, ...]:
    """Names of the limits that one module touches, as in the specification.

    Args:
        shapes: of the modules. limits: of their rims.
        room: as specified, without what web and hub take.
        row: which module.
    """
    inner, outer, height = (float(value[row]) for value in shapes[:3])
    at = {
        field.name: float(np.broadcast_to(getattr(limits, field.name), shapes.mass.shape)[row])
        for field in fields(limits)
        if field.name != "cuts"
    }
    nu = at["poisson_ratio"]
    stretched = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
    bore = HUB if at["inner_radius_min"] > room.inner_radius_min else "r_min"
    seat = CUT_HEIGHT if limits.cuts.height_min >= at["height_min"] else WEB
    flat = seat if at["height_min"] > room.height_min else "h_min"
    wall = CUT_WALL if at["wall_min"] > room.wall_min else "wall_min"
    touched = {
        "r_max": (outer, at["outer_radius_max"]),
        "h_max": (height, at["height_max"]),
        "hoop_stress": (stretched, at["stretch_max"]),
        "wheel_mass_max": (float(shapes.rim_mass[row]), at["mass_max"]),
        bore: (inner, at["inner_radius_min"]),
        flat: (height, at["height_min"]),
        wall: (outer - inner, at["wall_min"]),
        MOUNT: (outer, at["outer_radius_min"]),
    }
    names = tuple(
        name for name, (value, limit) in touched.items() if abs(value - limit) <= _TOUCHING * value
    )
    radius_is_held = {"r_max", "hoop_stress", MOUNT} & set(names) or {flat, wall} <= set(names)
    return names if radius_is_held else (*names, HOUSING)
