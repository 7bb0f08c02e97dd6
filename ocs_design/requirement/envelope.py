"""The room that a flywheel may take."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Envelope:
    """Limits of one flywheel rim, all SI.

    Attributes:
        outer_radius_max: [m]. inner_radius_min: the bore that the motor needs [m].
        height_max, height_min: along the spin axis [m].
        wall_min: of outer minus inner radius [m].
        mass_max: of one rim [kg].
        stress_safety: yield strength over the hoop stress allowed at the highest wheel speed.
    """

    outer_radius_max: float
    inner_radius_min: float
    height_max: float
    height_min: float
    wall_min: float
    mass_max: float
    stress_safety: float


LIMIT_OF_KEY: Mapping[str, str] = MappingProxyType(
    {
        "r_max": "outer_radius_max",
        "r_min": "inner_radius_min",
        "h_max": "height_max",
        "h_min": "height_min",
        "wall_min": "wall_min",
        "wheel_mass_max": "mass_max",
        "stress_safety": "stress_safety",
    }
)
"""Field of `Envelope` that each key of `[flywheel]` sets."""
