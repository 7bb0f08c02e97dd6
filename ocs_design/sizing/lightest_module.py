"""The lightest rim with its web and the shell around it, for many at once.

The lightest rim of a spin inertia I is as large as it may be (`rim_closed_form`), but its housing
and foot grow with it. The web is a disc that fills the bore, of a thickness that counts like t of
the rim's material. With a = R^2, b = r^2 and k = 2 I / (pi rho),

    k = h (a^2 - b^2) + t b^2,    m = pi rho (h (a - b) + t b) + m_shell(R, h),

in which h (a - b) + t b = (k + t a b) / (a + b). At a given R, with C = dm_shell/dh,

    dm/db = pi rho (k - t a^2) / (a + b)^2 (2 q b / (a - b)^2 - 1),  q = C / (pi rho).

The rim is taller than t, so that k > t a^2, and the mass is at its best where

    (a - b)^2 = 2 q b,  so that  b = a + q - sqrt(q (2 a + q)),

or at the bound of b next to it (`module_radii`). C grows a little with h, by the foot's base, and
each round of settling it gains a digit or more. Over R the mass of rim and shell has a single
valley: with u = a - b and v = a + b everything but the least wall and some holes is a generalised
posynomial of (R, h, u, v), made of sums, products, powers and the larger of two, and the smallest
of a geometric program is a convex function of log R (Boyd, Kim, Vandenberghe, Hassibi, A tutorial
on geometric programming, Optim. Eng. 8, 2007). The least wall, the holes and the web bend it a
little; the tests compare with a grid. So the lightest of some radii has the best between its
neighbours.

Chamfers and holes (`rim_cuts`) take L(R, r) off k and M(R, r) off the mass over pi rho: the rim is
a plain one of k + L, and its best bore where, with e from the derivatives of L and M by b,

    (a - b)^2 (1 - e) = 2 q b,
    e (k + L - t a^2) / (a + b)^2 = L' (1 + q / (a - b)) / (a + b) - M'.

They are a few per cent at most and settle along with C.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.module_radii import largest_radius, smallest_radius
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.rim_problem import RimLimits
from ocs_design.sizing.shell import Shell

# Together nine digits of the interval of radii: the mass tells no more of them.
_PARTS = 12
_ROUNDS = 12
# Of C, which moves by less than a fifth of what the height does.
_SETTLING = 5
# Of what is cut off a rim besides: nine digits also where that is a lot.
_CUT_SETTLING = 9
# Of e, which is small where there is a bore to speak of.
_MOST_BENT = 0.5
# Limits that meet in one point stay compatible when their figures are rounded.
_ROUNDING = 1e-12
# Of R^2 - r^2 over R^2.
_NO_WALL = 1e-9
# Of the largest bore over the least one, beyond what either is known to.
_ROOMY = 1e-6


def lightest_module(spin_inertia: ArrayLike, limits: RimLimits, shell: Shell) -> ModuleShape:
    """The lightest wheel of each spin inertia [kg m^2] with its shell; see the module's text."""
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high, fits = _radii(inertia, limits)
        radius = _valley(inertia, low, high, limits, shell)
        return _where(fits, _shape(inertia, radius, limits, shell))


def lightest_module_at(
    spin_inertia: ArrayLike,
    outer_radius: ArrayLike,
    limits: RimLimits,
    shell: Shell,
    flatness: float | FloatArray = 1.0,
) -> ModuleShape:
    """The lightest of each spin inertia [kg m^2] with an outer radius [m] or the nearest possible.

    Args:
        spin_inertia, outer_radius, limits: of the rims.
        shell: around each.
        flatness: how much more a shell's height counts than it weighs, at least 1: flatter
            modules weigh more, but stand nearer to the robot.
    """
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high, fits = _radii(inertia, limits)
        radius = np.clip(outer_radius, low, high)
        return _where(fits, _shape(inertia, radius, limits, shell, flatness))


def roomy_module_at(
    spin_inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    shell: Shell,
    flatness: FloatArray,
) -> ModuleShape:
    """`lightest_module_at` of exactly those radii; NaN where no rim of one fits, or only just.

    Takes a third of the time: which radii fit at all is not asked.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        shape = _shape(spin_inertia, outer_radius, limits, shell, flatness)
        bore = shape.inner_radius**2
        lower, upper = _bounds(
            spin_inertia, outer_radius, limits, bore if limits.cuts.any else None
        )
        roomy = (
            (lower <= upper * (1.0 - _ROOMY))
            & (outer_radius > limits.wall_min)
            & (outer_radius >= limits.outer_radius_min)
            & (outer_radius <= limits.outer_radius_max)
            & (np.asarray(limits.height_min) <= limits.height_max)
            & (spin_inertia > 0.0)
        )
        return _where(roomy, shape)


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
    shell: Shell,
    flatness: float | FloatArray = 1.0,
) -> ModuleShape:
    """Of modules of given outer radii."""
    square, per_height = outer_radius**2, np.pi * limits.density
    bore = _best_bore(inertia, outer_radius, limits, shell, flatness)
    of_rim, height = _rim_height(inertia, outer_radius, bore, limits)
    inner_radius = np.sqrt(bore)
    return ModuleShape(
        inner_radius,
        outer_radius,
        height,
        per_height * (of_rim / (square + bore) - limits.cuts.area(inner_radius, outer_radius)),
        per_height * limits.web * bore,
        shell.mass(outer_radius, height),
    )


def _where(fits: NDArray[np.bool_], shape: ModuleShape) -> ModuleShape:
    return ModuleShape(*(np.where(fits, value, np.nan) for value in shape))


def _valley(
    inertia: FloatArray, low: FloatArray, high: FloatArray, limits: RimLimits, shell: Shell
) -> FloatArray:
    """The radius between `low` and `high` at which the mass is least [m].

    Looks at several radii at once, as a call of numpy costs more than its work on few modules.
    """
    low, high = np.broadcast_arrays(low, high)
    parts = np.linspace(0.0, 1.0, _PARTS + 1).reshape(-1, *(1,) * low.ndim)
    for _ in range(_ROUNDS):
        radii = low + parts * (high - low)
        mass = _shape(inertia, radii, limits, shell).mass
        # On an edge of the interval rounding may leave no rim.
        best = np.where(mass > 0.0, mass, np.inf).argmin(axis=0)[None]
        low, high = (
            np.take_along_axis(radii, np.clip(best + step, 0, _PARTS), axis=0)[0]
            for step in (-1, 1)
        )
    found: FloatArray = np.take_along_axis(radii, best, axis=0)[0]
    return found


def _rim_height(
    inertia: FloatArray, outer: FloatArray, bore: FloatArray, limits: RimLimits
) -> tuple[FloatArray, FloatArray]:
    """k of the rim alone before it is cut [m^5], and its height [m], by R and r^2."""
    cut = limits.cuts.spread(np.sqrt(bore), outer)
    of_rim = 2.0 * inertia / (np.pi * limits.density) + cut - limits.web * bore**2
    square = outer**2
    height = of_rim / (square**2 - bore**2)
    # A rim without any wall is none: of it, this is nothing over nothing, or what rounding left.
    return of_rim, np.where(square - bore > _NO_WALL * square, height, np.nan)


def _best_bore(
    inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    shell: Shell,
    flatness: float | FloatArray,
) -> FloatArray:
    """b = r^2 of the lightest module at R [m^2]."""
    square = outer_radius**2
    height = np.asarray(limits.height_min) + np.zeros_like(outer_radius)
    lower, upper = _bounds(inertia, outer_radius, limits, None)
    bent: float | FloatArray = 0.0
    for _ in range(_CUT_SETTLING if limits.cuts.any else _SETTLING):
        per_height = flatness * shell.mass_per_height(outer_radius, height)
        ratio = per_height / (np.pi * limits.density)
        pull = ratio / (1.0 - bent)
        free = square + pull - np.sqrt(pull * (2.0 * square + pull))
        bore = np.clip(free, lower, upper)
        of_rim, height = _rim_height(inertia, outer_radius, bore, limits)
        if limits.cuts.any:
            bent = _bent(outer_radius, bore, of_rim, ratio, limits)
            lower, upper = _bounds(inertia, outer_radius, limits, bore)
    return bore


def _bent(
    outer: FloatArray, bore: FloatArray, of_rim: FloatArray, ratio: FloatArray, limits: RimLimits
) -> FloatArray:
    """e of the module's text, by R, r^2 and q [m]."""
    square, inner = outer**2, np.sqrt(bore)
    both = square + bore
    # Derivatives by r^2 = those by r over 2 r.
    spread = limits.cuts.spread_slope(inner, outer) * (1.0 + ratio / (square - bore)) / both
    more = (spread - limits.cuts.area_slope()) / (2.0 * inner)
    beyond = of_rim + limits.web * (bore**2 - square**2)
    bent: FloatArray = np.clip(more * both**2 / beyond, -_MOST_BENT, _MOST_BENT)
    return bent


def _bounds(
    inertia: FloatArray, outer: FloatArray, limits: RimLimits, bore: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    """Of r^2 at R [m^2], with what is cut off a rim of about that r^2; None: nothing."""
    full, mass = (
        2.0 * inertia / (np.pi * limits.density),
        limits.mass_max / (np.pi * limits.density),
    )
    if bore is not None:
        inner = np.sqrt(bore)
        full = full + limits.cuts.spread(inner, outer)
        mass = mass + limits.cuts.area(inner, outer)
    nu = limits.poisson_ratio
    lower = (
        _bore_at_height(full, outer, limits, limits.height_min),
        np.asarray(limits.inner_radius_min) ** 2,
        (BORE_SHARE * outer) ** 2,
        _bore_at_mass(full, outer, limits, mass),
    )
    upper = (
        _bore_at_height(full, outer, limits, limits.height_max),
        (outer - limits.wall_min) ** 2,
        (limits.stretch_max - (3.0 + nu) * outer**2) / (1.0 - nu),
    )
    return (
        np.maximum.reduce(np.broadcast_arrays(*lower)),
        np.minimum.reduce(np.broadcast_arrays(*upper)),
    )


def _bore_at_height(
    full: FloatArray, outer: FloatArray, limits: RimLimits, height: float | FloatArray
) -> FloatArray:
    """b at which a rim of radius R has that height; zero where even a full one is taller."""
    square, over = outer * outer, np.asarray(height) - limits.web
    beyond = full - limits.web * square**2
    bore: FloatArray = np.sqrt(np.maximum(square**2 - beyond / over, 0.0))
    return bore


def _bore_at_mass(
    full: FloatArray, outer: FloatArray, limits: RimLimits, mass: float | FloatArray
) -> FloatArray:
    """b at which a rim of radius R has the largest mass: t b^2 + m b = k - m a, m per pi rho."""
    over, web = full / mass - outer**2, limits.web / mass
    bore: FloatArray = 2.0 * over / (1.0 + np.sqrt(np.maximum(1.0 + 4.0 * web * over, 1e-300)))
    return bore
