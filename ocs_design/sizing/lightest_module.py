"""The lightest rim with its web and housing, in closed form but for one root, for many at once.

The lightest rim of a spin inertia I is as large as it may be (`rim_closed_form`), but its housing
grows with it. The web is a disc that fills the bore, of a thickness that counts like t of the rim's
material. With a = R^2, b = r^2 and k = 2 I / (pi rho),

    k = h (a^2 - b^2) + t b^2,    m = pi rho (h (a - b) + t b) + m_housing(R, h),

in which h (a - b) + t b = (k + t a b) / (a + b). At a given R, with C = dm_housing/dh,

    dm/db = pi rho (k - t a^2) / (a + b)^2 (2 q b / (a - b)^2 - 1),  q = C / (pi rho).

The rim is taller than t, so that k > t a^2, and the mass is at its best where

    (a - b)^2 = 2 q b,  so that  b = a + q - sqrt(q (2 a + q)),

whatever I and the web are, or at the bound of b next to it (`module_radii`). Over R the mass of rim
and housing has a single valley: with
u = a - b and v = a + b everything but the least wall is a posynomial of (R, h, u, v), and the
smallest of a geometric program is a convex function of log R (Boyd, Kim, Vandenberghe, Hassibi, A
tutorial on geometric programming, Optim. Eng. 8, 2007). The least wall and the web bend it a
little; the tests compare with a grid. So the best R is where the slope changes sign, or an end of
the interval.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.housing import (
    housing_mass,
    housing_mass_per_height,
    housing_mass_per_radius,
)
from ocs_design.sizing.module_radii import largest_radius, smallest_radius
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.rim_problem import RimLimits

# Together twelve digits of the interval of radii.
_PARTS = 8
_ROUNDS = 13
# Limits that meet in one point stay compatible when their figures are rounded.
_ROUNDING = 1e-12


class ModuleShape(NamedTuple):
    """Hollow cylinders in their housings; NaN where no rim meets the limits.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m], all of one shape.
        rim_mass, web_mass, housing_mass: [kg].
    """

    inner_radius: FloatArray
    outer_radius: FloatArray
    height: FloatArray
    rim_mass: FloatArray
    web_mass: FloatArray
    housing_mass: FloatArray

    @property
    def mass(self) -> FloatArray:
        """Of rim, web and housing [kg]."""
        return self.rim_mass + self.web_mass + self.housing_mass


def lightest_module(spin_inertia: ArrayLike, limits: RimLimits) -> ModuleShape:
    """The lightest wheel of each spin inertia [kg m^2] with its housing; see the module's text."""
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high, fits = _radii(inertia, limits)
        return _shape(inertia, _valley(inertia, low, high, limits), limits, fits)


def lightest_module_at(
    spin_inertia: ArrayLike,
    outer_radius: ArrayLike,
    limits: RimLimits,
    flatness: float | FloatArray = 1.0,
) -> ModuleShape:
    """The lightest of each spin inertia [kg m^2] with an outer radius [m] or the nearest possible.

    Args:
        spin_inertia, outer_radius, limits: of the rims.
        flatness: how much more a housing's height counts than it weighs, at least 1: flatter
            modules weigh more, but stand nearer to the robot.
    """
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high, fits = _radii(inertia, limits)
        return _shape(inertia, np.clip(outer_radius, low, high), limits, fits, flatness)


def _radii(
    inertia: FloatArray, limits: RimLimits
) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
    """From and to which outer radius there are rims [m], and whether there are any at all."""
    low, high = smallest_radius(inertia, limits), largest_radius(inertia, limits)
    flat = np.asarray(limits.height_min) <= np.asarray(limits.height_max) * (1.0 + _ROUNDING)
    fits = (low <= high * (1.0 + _ROUNDING)) & (inertia > 0.0) & flat
    return np.minimum(low, high), high, fits


def _shape(
    inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    fits: NDArray[np.bool_],
    flatness: float | FloatArray = 1.0,
) -> ModuleShape:
    """Of modules of given outer radii."""
    square, per_height = outer_radius**2, np.pi * limits.density
    bore, _ = _best_bore(inertia, outer_radius, limits, flatness)
    of_rim = 2.0 * inertia / per_height - limits.web * bore**2
    height = of_rim / (square**2 - bore**2)
    values = (
        np.sqrt(bore),
        outer_radius,
        height,
        per_height * of_rim / (square + bore),
        per_height * limits.web * bore,
        housing_mass(outer_radius, height),
    )
    return ModuleShape(*(np.where(fits, value, np.nan) for value in values))


def _valley(
    inertia: FloatArray, low: FloatArray, high: FloatArray, limits: RimLimits
) -> FloatArray:
    """The radius between `low` and `high` up to which the mass falls [m].

    Looks at several radii at once, as a call of numpy costs more than its work on few modules.
    """
    low, high = np.broadcast_arrays(low, high)
    largest = high
    parts = np.arange(1.0, _PARTS).reshape(-1, *(1,) * low.ndim)
    for _ in range(_ROUNDS):
        step = (high - low) / _PARTS
        falls = _slope(inertia, low + parts * step, limits) < 0.0
        low = low + falls.sum(axis=0) * step
        high = low + step
    return np.minimum(high, largest)


def _slope(inertia: FloatArray, outer_radius: FloatArray, limits: RimLimits) -> FloatArray:
    """dm/dR along the best bore [kg/m]."""
    square = outer_radius**2
    bore, along = _best_bore(inertia, outer_radius, limits)
    per_height, density = housing_mass_per_height(outer_radius), np.pi * limits.density
    full = 2.0 * inertia / density
    # Of the rim alone, and of what it has beyond a disc of the web's thickness.
    of_rim, beyond = full - limits.web * bore**2, full - limits.web * square**2
    apart, across = square**2 - bore**2, (square + bore) ** 2
    height = of_rim / apart
    by_square = -density * of_rim / across - 2.0 * per_height * height * square / apart
    by_bore = beyond * (2.0 * per_height * bore / apart**2 - density / across)
    shell = housing_mass_per_radius(outer_radius, height)
    slope: FloatArray = by_square * 2.0 * outer_radius + by_bore * along + shell
    return slope


def _best_bore(
    inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    flatness: float | FloatArray = 1.0,
) -> tuple[FloatArray, FloatArray]:
    """b = r^2 of the lightest module at R [m^2], and how it moves along R, db/dR [m].

    Where no bound holds it, the mass does not depend on how it moves, and zero stands in for that.
    """
    square = outer_radius**2
    ratio = flatness * housing_mass_per_height(outer_radius) / (np.pi * limits.density)
    free = square + ratio - np.sqrt(ratio * (2.0 * square + ratio))
    upper, upper_along = _most(_upper_bounds(inertia, outer_radius, limits), sign=-1.0)
    lower, lower_along = _most(_lower_bounds(inertia, outer_radius, limits), sign=1.0)
    bore = np.clip(free, lower, upper)
    along = np.where(free >= upper, upper_along, np.where(free <= lower, lower_along, 0.0))
    return bore, along


Bound = tuple[FloatArray, FloatArray]
"""Of b [m^2], and how it moves along R [m]."""


def _upper_bounds(inertia: FloatArray, outer: FloatArray, limits: RimLimits) -> list[Bound]:
    nu, wall = limits.poisson_ratio, outer - limits.wall_min
    stretch = (limits.stretch_max - (3.0 + nu) * outer**2) / (1.0 - nu)
    return [
        _bore_at_height(inertia, outer, limits, limits.height_max),
        (wall**2, 2.0 * wall),
        (stretch, -2.0 * (3.0 + nu) / (1.0 - nu) * outer),
    ]


def _lower_bounds(inertia: FloatArray, outer: FloatArray, limits: RimLimits) -> list[Bound]:
    zero = np.zeros_like(outer)
    return [
        _bore_at_height(inertia, outer, limits, limits.height_min),
        (limits.inner_radius_min**2 + zero, zero),
        ((BORE_SHARE * outer) ** 2, 2.0 * BORE_SHARE**2 * outer),
        _bore_at_mass(inertia, outer, limits),
    ]


def _bore_at_height(
    inertia: FloatArray, outer: FloatArray, limits: RimLimits, height: float | FloatArray
) -> Bound:
    """b at which a rim of radius R has that height; zero where even a full one is taller."""
    square, over = outer * outer, np.asarray(height) - limits.web
    beyond = 2.0 * inertia / (np.pi * limits.density) - limits.web * square**2
    bore = np.sqrt(np.maximum(square**2 - beyond / over, 0.0))
    along = 2.0 * square * outer * (1.0 + limits.web / over)
    return bore, np.where(bore > 0.0, along / bore, 0.0)


def _bore_at_mass(inertia: FloatArray, outer: FloatArray, limits: RimLimits) -> Bound:
    """b at which a rim of radius R has the largest mass: t b^2 + m b = k - m a, m per pi rho."""
    over = 2.0 * inertia / limits.mass_max - outer**2
    web = limits.web * np.pi * limits.density / limits.mass_max
    root = np.sqrt(np.maximum(1.0 + 4.0 * web * over, 1e-300))
    return 2.0 * over / (1.0 + root), -2.0 * outer / root


def _most(bounds: list[Bound], sign: float) -> Bound:
    """The largest of the bounds, or the smallest if `sign` is negative."""
    value, along = bounds[0]
    for other, its_along in bounds[1:]:
        further = sign * other > sign * value
        value, along = np.where(further, other, value), np.where(further, its_along, along)
    return value, along
