"""Which outer radii leave room for a rim of a given spin inertia, in closed form.

With a = R^2, b = r^2, k = 2 I / (pi rho) the height is h = k / (a^2 - b^2), and the limits bound b
at each R, from above and from below:

    h_max: b <= sqrt(a^2 - k / h_max)                h_min: b >= sqrt(a^2 - k / h_min)
    wall:  b <= (R - t)^2                            bore:  b >= r_min^2, b >= (R / 100)^2
    hoop stress: b <= (S - (3 + nu) a) / (1 - nu)    mass:  b >= 2 I / m_max - a

Each pair of an upper and a lower bound leaves all radii on one side of where the two meet. So the
radii that leave room are one interval, between the largest of those crossings that bound R from
below and the smallest of those that bound it from above.
"""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_closed_form import BORE_SHARE, flat_wall_radius
from ocs_design.sizing.rim_problem import RimLimits


def smallest_radius(inertia: FloatArray, limits: RimLimits) -> FloatArray:
    """Below it a rim of this spin inertia [kg m^2] is too tall, too thick or too heavy [m]."""
    tall = 2.0 * inertia / (np.pi * limits.density * limits.height_max)
    wall, bore = np.asarray(limits.wall_min), np.asarray(limits.inner_radius_min)
    # R^2 + r^2 of the heaviest rim; none below it is light enough.
    light = 2.0 * inertia / limits.mass_max
    square = np.sqrt(np.maximum(tall + bore**4, tall / (1.0 - BORE_SHARE**4)))
    # Where a disc of the largest height is light enough, so is everything wider.
    slim = tall < light**2
    by_light = (light + tall / np.where(slim, light, 1.0)) / 2.0
    square = np.where(slim, np.maximum(square, by_light), square)
    by_wall = np.maximum(bore + wall, wall / (1.0 - BORE_SHARE))
    by_mass = (wall + np.sqrt(np.maximum(2.0 * light - wall**2, 0.0))) / 2.0
    radius: FloatArray = np.maximum(np.sqrt(square), np.maximum(by_wall, by_mass))
    return radius


def largest_radius(inertia: FloatArray, limits: RimLimits) -> FloatArray:
    """Above it a rim of this spin inertia [kg m^2] breaks, is too flat, or has no room [m]."""
    flat = 2.0 * inertia / (np.pi * limits.density * np.asarray(limits.height_min))
    square = _largest_square_by_stress(inertia, flat, limits)
    radius = np.minimum(limits.outer_radius_max, np.sqrt(np.maximum(square, 0.0)))
    return np.minimum(radius, flat_wall_radius(flat, limits.wall_min))


def _largest_square_by_stress(
    inertia: FloatArray, flat: FloatArray, limits: RimLimits
) -> FloatArray:
    """R^2 where the hoop stress meets the bore, the least height or the largest mass [m^2]."""
    nu, stretch = limits.poisson_ratio, np.asarray(limits.stretch_max)
    bore, light = np.asarray(limits.inner_radius_min), 2.0 * inertia / limits.mass_max
    by_bore = (stretch - (1.0 - nu) * bore**2) / (3.0 + nu)
    by_share = stretch / (3.0 + nu + (1.0 - nu) * BORE_SHARE**2)
    by_mass = (stretch - (1.0 - nu) * light) / (2.0 + 2.0 * nu)
    root = np.sqrt(np.maximum(1.0 - 8.0 * (1.0 + nu) * flat / stretch**2, 0.0))
    by_height = (stretch + (1.0 - nu) ** 2 * flat / stretch) / (3.0 + nu + (1.0 - nu) * root)
    # Where R^4 is less than `flat` already, the least height leaves any bore.
    by_height = np.where(stretch > (3.0 + nu) * np.sqrt(flat), by_height, np.inf)
    return np.minimum(np.minimum(by_bore, by_share), np.minimum(by_mass, by_height))
