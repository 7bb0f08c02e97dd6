"""Which limits hold the mass of a module up."""

import numpy as np

from ocs_design.sizing.cylinder import cylinder_mass
from ocs_design.sizing.lightest_module import ModuleShape
from ocs_design.sizing.rim_problem import RimLimits

HOUSING = "housing"
"""Stands for the radius where no limit holds it: a larger rim is lighter, its housing heavier."""

_TOUCHING = 1e-6


def binding_limits(shapes: ModuleShape, limits: RimLimits, row: int) -> tuple[str, ...]:
    """Names of the limits that one module touches, as in the specification.

    Args:
        shapes: of the modules. limits: of their rims.
        row: which module.
    """
    inner, outer, height = (float(value[row]) for value in shapes[:3])
    density, stretch, nu = (
        float(np.broadcast_to(value, shapes.mass.shape)[row])
        for value in (limits.density, limits.stretch_max, limits.poisson_ratio)
    )
    stretched = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
    touched = {
        "r_max": (outer, limits.outer_radius_max),
        "h_max": (height, limits.height_max),
        "hoop_stress": (stretched, stretch),
        "wheel_mass_max": (cylinder_mass(inner, outer, height, density), limits.mass_max),
        "r_min": (inner, limits.inner_radius_min),
        "h_min": (height, limits.height_min),
        "wall_min": (outer - inner, limits.wall_min),
    }
    names = tuple(
        name
        for name, (value, limit) in touched.items()
        if abs(value - float(np.asarray(limit))) <= _TOUCHING * value
    )
    radius_is_held = {"r_max", "hoop_stress"} & set(names) or {"h_min", "wall_min"} <= set(names)
    return names if radius_is_held else (*names, HOUSING)
