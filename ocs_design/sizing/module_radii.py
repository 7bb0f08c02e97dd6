"""Which outer radii leave room for a rim of a given spin inertia, in closed form but for two roots.

With a = R^2, b = r^2, k = 2 I / (pi rho) and a web that counts like t of the rim's material the
height is h = (k - t b^2) / (a^2 - b^2), and the limits bound b at each R, from above and below:

    h_max: b^2 <= a^2 - (k - t a^2) / (h_max - t)    h_min: b^2 >= a^2 - (k - t a^2) / (h_min - t)
    wall:  b <= (R - w)^2                            bore:  b >= r_min^2, b >= (R / 100)^2
    hoop stress: b <= (S - (3 + nu) a) / (1 - nu)    mass:  k - t b^2 <= m_max / (pi rho) (a + b)

Each pair of an upper and a lower bound leaves all radii on one side of where the two meet. So the
radii that leave room are one interval, between the largest of those crossings that bound R from
below and the smallest of those that bound it from above.
"""

from collections.abc import Callable

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_closed_form import BORE_SHARE, flat_wall_radius
from ocs_design.sizing.rim_problem import RimLimits

# From above each step of Newton's method halves the error at least; then it doubles the digits.
_NEWTON_STEPS = 12


def smallest_radius(inertia: FloatArray, limits: RimLimits) -> FloatArray:
    """Below it a wheel of this spin inertia [kg m^2] is too tall, too thick or too heavy [m]."""
    wall, bore, web = np.asarray(limits.wall_min), np.asarray(limits.inner_radius_min), limits.web
    full, tall = 2.0 * inertia / (np.pi * limits.density), np.asarray(limits.height_max)
    share = BORE_SHARE**4
    # Positive also where the web alone has more than is asked for: nothing small is too tall then.
    by_bore = np.maximum(full - web * bore**4, 0.0) / tall + bore**4
    by_share = full / tall / (1.0 - (1.0 - web / tall) * share)
    square = np.sqrt(np.maximum(by_bore, by_share))
    by_wall = np.maximum(bore + wall, wall / (1.0 - BORE_SHARE))
    radius: FloatArray = np.maximum(
        np.maximum(np.sqrt(square), by_wall), np.asarray(limits.outer_radius_min)
    )
    if np.all(np.isinf(limits.mass_max)):
        return radius
    return np.maximum(radius, _smallest_by_mass(full, limits))


def _smallest_by_mass(full: FloatArray, limits: RimLimits) -> FloatArray:
    """R where the largest mass meets the largest height, or the least wall [m].

    At the largest height a rim of the largest mass has a - b = m / (pi rho h) = c, so that
    h c (2 a - c) + t (a - c)^2 = k. Where that leaves no bore, every radius is light enough.
    """
    mass, web = limits.mass_max / (np.pi * limits.density), limits.web
    tall, wall = np.asarray(limits.height_max), np.asarray(limits.wall_min)
    apart = mass / tall
    # In b = a - c: t b^2 + 2 h c b = k - h c^2.
    left, linear = full - tall * apart**2, tall * apart
    bore = left / (linear + np.sqrt(np.maximum(linear**2 + web * left, 0.0)))
    by_height = np.where(left > 0.0, np.sqrt(np.maximum(bore + apart, 0.0)), 0.0)
    light = full / mass
    start = (wall + np.sqrt(np.maximum(2.0 * light - wall**2, 0.0))) / 2.0

    def excess(radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of what the largest mass has with the least wall, and its slope."""
        inner = radius - wall
        value = mass * (radius**2 + inner**2) + web * inner**4 - full
        return value, 2.0 * mass * (radius + inner) + 4.0 * web * inner**3

    return np.maximum(by_height, _root_from_above(excess, start, web))


def largest_radius(inertia: FloatArray, limits: RimLimits) -> FloatArray:
    """Above it a wheel of this spin inertia [kg m^2] breaks, is too flat, or has no room [m]."""
    full, flat = 2.0 * inertia / (np.pi * limits.density), np.asarray(limits.height_min)
    square = _largest_square_by_stress(inertia, full, limits)
    radius = np.minimum(limits.outer_radius_max, np.sqrt(np.maximum(square, 0.0)))
    wall, web = np.asarray(limits.wall_min), np.asarray(limits.web)

    def excess(radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of what the flattest rim with the least wall has, and its slope."""
        inner = radius - wall
        value = flat * radius**4 - (flat - web) * inner**4 - full
        return value, 4.0 * (flat * radius**3 - (flat - web) * inner**3)

    with np.errstate(divide="ignore"):
        # Without any rim the web alone would have as much.
        start = np.minimum(flat_wall_radius(full / flat, wall), (full / web) ** 0.25)
    return np.minimum(radius, _root_from_above(excess, start, web))


def _largest_square_by_stress(
    inertia: FloatArray, full: FloatArray, limits: RimLimits
) -> FloatArray:
    """R^2 where the hoop stress meets the bore, the least height or the largest mass [m^2].

    With p = 3 + nu and n = 1 - nu the stress leaves b = (S - p a) / n. The least height meets it
    where (h - t) (S - p a)^2 = n^2 (h a^2 - k), the largest mass where t b^2 + m (a + b) = k.
    """
    nu, stretch = limits.poisson_ratio, np.asarray(limits.stretch_max)
    bore, web = np.asarray(limits.inner_radius_min), limits.web
    outer, inner = 3.0 + nu, 1.0 - nu
    by_bore = (stretch - inner * bore**2) / outer
    by_share = stretch / (outer + inner * BORE_SHARE**2)
    light = 2.0 * inertia / limits.mass_max
    # An unlimited hoop stress leaves any radius light enough.
    over = light - np.where(np.isinf(stretch), 0.0, stretch) / outer
    slope = 1.0 - inner / outer
    curved = web * np.pi * limits.density / limits.mass_max
    root = np.sqrt(np.maximum(slope**2 + 4.0 * curved * over, 0.0))
    by_mass = (stretch - inner * 2.0 * over / (slope + root)) / outer
    tall = np.asarray(limits.height_min) - web
    more = np.where(web > np.zeros_like(tall), 1.0 + web / tall, 1.0)
    flat = full / tall
    root = np.sqrt(np.maximum(more - flat * (outer**2 - inner**2 * more) / stretch**2, 0.0))
    by_height = (stretch + inner**2 * flat / stretch) / (outer + inner * root)
    # Where R^4 is less than that already, the least height leaves any bore.
    by_height = np.where(stretch > outer * np.sqrt(flat / more), by_height, np.inf)
    return np.minimum(np.minimum(by_bore, by_share), np.minimum(by_mass, by_height))


def _root_from_above(
    excess: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    start: FloatArray,
    web: float | FloatArray,
) -> FloatArray:
    """Of a convex, rising function, by Newton's method; without a web it is the start itself.

    Args:
        excess: the function and its slope.
        start: not below the root.
        web: see `RimLimits`.
    """
    root = np.asarray(start, dtype=np.float64)
    if np.all(np.asarray(web) == 0.0):
        return root
    for _ in range(_NEWTON_STEPS):
        value, slope = excess(root)
        root = root - value / slope
    return root
