"""The room that a flywheel may take."""

from dataclasses import dataclass


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
