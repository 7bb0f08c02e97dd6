"""The lightest rim in closed form, for many rims at once.

With the spin inertia I met with equality, write P = 2 I / (pi rho h_max), Q = 2 I / (pi rho h_min).
The mass is m = 2 I / (R^2 + r^2), the height follows from R^4 - r^4 = 2 I / (pi rho h), and the
limits are

    R <= R_max                                       r >= r_min
    r <= (R^4 - P)^(1/4)            (h_max)          R^4 - r^4 <= Q        (h_min)
    r <= R - t                      (wall)           R^2 + r^2 >= 2 I / m_max
    (3 + nu) R^2 + (1 - nu) r^2 <= S                 (hoop stress, S = 4 sigma / (rho w^2))

The best bore at a given R is the largest, r(R), the smallest of the three upper limits on r. Two of
them rise with R (h_max and wall), so that R^2 + r^2 rises with R as long as one of these is the
smallest. Once the hoop stress is, R^2 + r^2 = S / (1 - nu) - 2 (1 + nu) / (1 - nu) R^2 falls. R is
therefore best where the hoop stress meets the larger of the two crossings

    h_max: (3 + nu) a + (1 - nu) sqrt(a^2 - P) = S,  a = R^2
    wall:  (3 + nu) R^2 + (1 - nu) (R - t)^2 = S,

unless one of two limits stops it earlier: R_max, or h_min. The latter forbids only walls so thick
that even h_min gives too much inertia: along r = R - t the difference R^4 - r^4 rises with R and
meets Q at 4 t c^3 + t^3 c = Q, c = R - t / 2 (a cubic with one real root). So

    R = min(R_max, max(crossings), h_min on the wall),   r = min(h_max, wall at R),

a vertex where two limits meet: r_max or hoop_stress with h_max or wall_min, or h_min with wall_min.
If this r is below r_min, or below 1 % of R and thus no bore, no other R mends it: a smaller one
lowers r(R), a larger one is forbidden or lowers it too. If the mass is above m_max, no rim is
lighter. The vertex decides feasibility.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_problem import RimLimits

# Limits that meet in one point stay compatible when their figures are rounded.
_ROUNDING = 1e-12

BORE_SHARE = 0.01
"""A rim is no disc: its bore is at least this share of its outer radius. As a bore closes, the
shadow prices grow without limit, and no solver can tell them."""


class RimShape(NamedTuple):
    """Hollow cylinders; NaN where no rim meets the limits.

    Attributes:
        inner_radius, outer_radius, height: [m], all of one shape.
        mass: [kg].
    """

    inner_radius: FloatArray
    outer_radius: FloatArray
    height: FloatArray
    mass: FloatArray


def lightest_rim(spin_inertia: ArrayLike, limits: RimLimits) -> RimShape:
    """The lightest rim of each spin inertia [kg m^2] within its limits; see the module's text."""
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        tall = 2.0 * inertia / (np.pi * limits.density * limits.height_max)
        flat = np.divide(2.0 * inertia, np.pi * limits.density * np.asarray(limits.height_min))
        outer = np.minimum(
            np.minimum(limits.outer_radius_max, _hoop_radius(tall, limits)),
            flat_wall_radius(flat, limits.wall_min),
        )
        bore_by_height = np.maximum(outer**4 - tall, 0.0) ** 0.25
        bore_by_wall = outer - limits.wall_min
        inner = np.minimum(bore_by_height, bore_by_wall)
        spread = np.where(
            bore_by_height < bore_by_wall, tall, (outer**2 - inner**2) * (outer**2 + inner**2)
        )
        height = 2.0 * inertia / (np.pi * limits.density * spread)
        mass = 2.0 * inertia / (outer**2 + inner**2)
        fits = (tall <= flat * (1.0 + _ROUNDING)) & _fits(inner, outer, mass, limits)
    values = np.broadcast_arrays(inner, outer, height, mass)
    return RimShape(*(np.where(fits, value, np.nan) for value in values))


def smallest_spin_inertia(limits: RimLimits) -> FloatArray:
    """Of the narrowest, thinnest and flattest rim that the lower limits leave [kg m^2].

    With its web, if it has one, and without what is cut off it.
    """
    bore = np.maximum(limits.inner_radius_min, limits.wall_min * BORE_SHARE / (1.0 - BORE_SHARE))
    bore = np.maximum(bore, np.asarray(limits.outer_radius_min) - limits.wall_min)
    outer = bore + limits.wall_min
    full = limits.height_min * (outer**4 - bore**4) + limits.web * bore**4
    full = full - limits.cuts.spread(bore, outer)
    return np.asarray(np.pi * limits.density * full / 2.0, dtype=np.float64)


def largest_spin_inertia(limits: RimLimits) -> FloatArray:
    """Of no rim within the limits exceeded [kg m^2]; 0 where none has room.

    With its web. As wide and tall as room and hoop stress let it be around the least bore; and with
    its mass as far out as it may be, its web to the same radius.
    """
    web, bore = np.asarray(limits.web), np.asarray(limits.inner_radius_min)
    nu, per_height = limits.poisson_ratio, np.pi * np.asarray(limits.density) / 2.0
    stretched = np.maximum(limits.stretch_max - (1.0 - nu) * bore**2, 0.0) / (3.0 + nu)
    outer = np.minimum(limits.outer_radius_max, np.sqrt(stretched))
    tall = np.asarray(limits.height_max)
    solid = per_height * (tall * (outer**4 - bore**4) + np.minimum(web, tall) * bore**4)
    heavy = np.asarray(limits.mass_max) * outer**2 + per_height * web * outer**4
    around = np.maximum(bore + limits.wall_min, limits.outer_radius_min)
    slack = 1.0 + _ROUNDING
    fits = (around <= outer * slack) & (np.asarray(limits.height_min) <= tall * slack)
    return np.asarray(np.where(fits, np.minimum(solid, heavy), 0.0), dtype=np.float64)


def flat_wall_radius(flat: FloatArray, wall: float | FloatArray) -> FloatArray:
    """Outer radius at which a rim of the least wall and the least height has the inertia [m].

    The real root of c^3 + t^2/4 c = Q / (4 t) by the hyperbolic sine.
    """
    thickness = np.asarray(wall)
    argument = np.sqrt(27.0) * flat / thickness**4
    middle = thickness / np.sqrt(3.0) * np.sinh(np.arcsinh(argument) / 3.0)
    radius: FloatArray = np.where(thickness > 0.0, middle + thickness / 2.0, np.inf)
    return radius


def _hoop_radius(tall: FloatArray, limits: RimLimits) -> FloatArray:
    """Outer radius beyond which the hoop stress costs more bore than the radius gains [m]."""
    nu, stretch, wall = limits.poisson_ratio, np.asarray(limits.stretch_max), limits.wall_min
    # Written so that an unlimited hoop stress (inf) gives inf.
    root = np.sqrt(np.maximum(1.0 - 8.0 * (1.0 + nu) * tall / stretch**2, 0.0))
    by_height = (stretch + (1.0 - nu) ** 2 * tall / stretch) / (3.0 + nu + (1.0 - nu) * root)
    discriminant = np.maximum(4.0 * stretch - (1.0 - nu) * (3.0 + nu) * wall**2, 0.0)
    by_wall = ((1.0 - nu) * wall + np.sqrt(discriminant)) / 4.0
    radius: FloatArray = np.maximum(np.sqrt(by_height), by_wall)
    return radius


def _fits(
    inner: FloatArray, outer: FloatArray, mass: FloatArray, limits: RimLimits
) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Whether the vertex meets the limits that did not shape it.

    Of the hoop stress it is enough that it leaves any bore: up to the crossing r(R) is below its
    line, and a crossing that lies beyond S = (3 + nu) R^2 is one with the negative root.
    """
    slack = 1.0 + _ROUNDING
    return np.asarray(
        (inner * slack >= limits.inner_radius_min)
        & (inner * slack >= BORE_SHARE * outer)
        & (mass <= limits.mass_max * slack)
        & ((3.0 + limits.poisson_ratio) * outer**2 <= limits.stretch_max * slack)
    )
