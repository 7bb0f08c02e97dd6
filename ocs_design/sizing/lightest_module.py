"""The lightest rim with its web and the shell around it, for many modules at once.

With a = R^2, b = r^2, k = 2 I / (pi rho), a web that counts like t of the rim's material, and
q = C / (pi rho) with C = dm_shell/dh, the mass at a given R is least where (docs/theory.md, Web
and hub)

    (a - b)^2 = 2 q b,  so that  b = a + q - sqrt(q (2 a + q)),

or at the nearest bound of b (`module_radii`). C grows a little with h, through the foot's base, and
each iteration for it gains a digit or more. The mass of rim and shell has a single minimum over R:
with u = a - b and v = a + b everything but the least wall and some holes is a generalised
posynomial of (R, h, u, v), made of sums, products, powers and maxima, and the optimum of a
geometric program is a convex function of log R (Boyd, Kim, Vandenberghe, Hassibi, A tutorial on
geometric programming, Optim. Eng. 8, 2007). The least wall, the holes and the web disturb this a
little; the tests compare with a grid. So the optimum lies between the neighbours of the lightest of
several radii.

Chamfers and holes (`RimCuts`) take L(R, r) off k and M(R, r) off the mass over pi rho: the rim is a
plain one of k + L, and its best bore is where, with e from the derivatives of L and M by b,

    (a - b)^2 (1 - e) = 2 q b,
    e (k + L - t a^2) / (a + b)^2 = L' (1 + q / (a - b)) / (a + b) - M'.

They are a few per cent at most and are found by the same iteration as C. Lightening holes, which
make the web weigh like y t, add (y - 1) t to the right-hand side of the last line.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.common.arrays import FloatArray, Table
from ocs_design.parts.module import Shell
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.bound.rim_problem import BORE_SHARE, RimLimits
from ocs_design.sizing.module_radii import largest_radius, smallest_radius

_PARTS = 12
"""Number of parts into which each round divides the interval of radii; it keeps two of them."""

_ROUNDS_PER_DIGIT = 4.0 / 3.0
"""Rounds per digit of the radius."""

_DIGITS = 9
"""Digits to which radius and bore are solved, the bore in at most as many iterations."""

_STEEPEST = 0.5
"""Largest slope of an iteration for the bore that a secant is trusted with: changing the height
changes C by under a fifth as much, and the cuts by more."""

_E_MAX = 0.5
"""Largest e (see the module's docstring); e is small unless the bore is tiny."""

# Tolerance that keeps limits which meet in one point compatible after rounding.
_ROUNDING = 1e-12
# Least (R^2 - r^2) / R^2 of a rim.
_WALL_SHARE_MIN = 1e-9


@dataclass(frozen=True, eq=False)
class ModuleShape(Table):
    """Rims with their webs and shells; NaN where no rim meets the limits.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m], all of one shape.
        rim_mass, web_mass, shell_mass: [kg].
    """

    inner_radius: FloatArray
    outer_radius: FloatArray
    height: FloatArray
    rim_mass: FloatArray
    web_mass: FloatArray
    shell_mass: FloatArray

    @property
    def mass(self) -> FloatArray:
        """Mass of rim, web and shell [kg]."""
        return self.rim_mass + self.web_mass + self.shell_mass


def lightest_module(
    spin_inertia: ArrayLike, limits: RimLimits, shell: Shell, digits: int = _DIGITS
) -> ModuleShape:
    """The lightest wheel of each spin inertia [kg m^2] with its shell; see the module's docstring.

    Its radius and bore are found to this many `digits`.
    """
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high = _radii(inertia, limits)
        low, high = np.broadcast_arrays(low, high)
        # Several radii at once: for few modules, a NumPy call costs more than its work.
        parts = np.linspace(0.0, 1.0, _PARTS + 1).reshape(-1, *(1,) * low.ndim)
        for _ in range(round(_ROUNDS_PER_DIGIT * digits)):
            radii = low + parts * (high - low)
            mass = _shape(inertia, radii, limits, shell, digits).mass
            # At an end of the interval, rounding may leave no rim.
            best = np.where(mass > 0.0, mass, np.inf).argmin(axis=0)[None]
            low, high = (
                np.take_along_axis(radii, np.clip(best + step, 0, _PARTS), axis=0)[0]
                for step in (-1, 1)
            )
        return _shape(inertia, np.take_along_axis(radii, best, axis=0)[0], limits, shell)


def lightest_module_at(
    spin_inertia: ArrayLike,
    outer_radius: ArrayLike,
    limits: RimLimits,
    shell: Shell,
) -> ModuleShape:
    """The lightest of each spin inertia [kg m^2] with an outer radius [m] near the one given."""
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        low, high = _radii(inertia, limits, np.asarray(outer_radius))
        return _shape(inertia, np.clip(outer_radius, low, high), limits, shell)


def _radii(
    inertia: FloatArray, limits: RimLimits, near: FloatArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Smallest and largest outer radius of a rim [m]; NaN where no rim is feasible.

    With a radius `near`, they are rough where it lies between them.
    """
    low, high = smallest_radius(inertia, limits, near), largest_radius(inertia, limits, near)
    flat = np.asarray(limits.height_min) <= np.asarray(limits.height_max) * (1.0 + _ROUNDING)
    fits = (low <= high * (1.0 + _ROUNDING)) & (inertia > 0.0) & flat
    return np.where(fits, np.minimum(low, high), np.nan), np.where(fits, high, np.nan)


def _shape(
    inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    shell: Shell,
    digits: int = _DIGITS,
) -> ModuleShape:
    """Lightest modules of given outer radii."""
    square, per_height = outer_radius**2, np.pi * limits.density
    bore = _best_bore(inertia, outer_radius, limits, shell, digits)
    of_rim, height = _rim_height(inertia, outer_radius, bore, limits)
    inner_radius = np.sqrt(bore)
    return ModuleShape(
        inner_radius,
        outer_radius,
        height,
        per_height * (of_rim / (square + bore) - limits.cuts.area(inner_radius, outer_radius)),
        per_height * limits.heavy_web * bore,
        shell.mass(outer_radius, height),
    )


def _rim_height(
    inertia: FloatArray, outer: FloatArray, bore: FloatArray, limits: RimLimits
) -> tuple[FloatArray, FloatArray]:
    """k of the rim alone before it is cut [m^5], and its height [m], from R and r^2."""
    cut = limits.cuts.spread(np.sqrt(bore), outer)
    of_rim = 2.0 * inertia / (np.pi * limits.density) + cut - limits.web * bore**2
    square = outer**2
    height = of_rim / (square**2 - bore**2)
    # Without a wall there is no rim: the quotient is 0 / 0, or rounding error.
    return of_rim, np.where(square - bore > _WALL_SHARE_MIN * square, height, np.nan)


def _best_bore(
    inertia: FloatArray,
    outer_radius: FloatArray,
    limits: RimLimits,
    shell: Shell,
    digits: int,
) -> FloatArray:
    """b = r^2 of the lightest module at R [m^2]."""
    square = outer_radius**2
    height = np.asarray(limits.height_min) + np.zeros_like(outer_radius)
    weight, bore_weight = limits.hoop_weights
    # These do not depend on the rim's height and mass.
    fixed_bounds = (
        np.maximum(np.asarray(limits.inner_radius_min) ** 2, (BORE_SHARE * outer_radius) ** 2),
        np.minimum(
            np.minimum(
                (outer_radius - limits.wall_min) ** 2, np.asarray(limits.inner_radius_max) ** 2
            ),
            (limits.stretch_max - weight * square) / bore_weight,
        ),
    )
    lower, upper = _bounds(inertia, outer_radius, limits, fixed_bounds, None)
    e: float | FloatArray = 0.0
    has_holes = bool(np.any(np.asarray(limits.web_weight) < 1.0))
    # Bores that were tried, and those found from them.
    tried, found = list[FloatArray](), list[FloatArray]()
    for _ in range(digits):
        per_height = shell.mass_per_height(outer_radius, height)
        ratio = per_height / (np.pi * limits.density)
        q = ratio / (1.0 - e)
        stationary = square + q - np.sqrt(q * (2.0 * square + q))
        bore = np.clip(stationary, lower, upper)
        if tried and not np.any(np.abs(bore - tried[-1]) > 10.0**-digits * bore):
            break
        found.append(bore)
        if len(tried) > 1:
            # A secant through the last two gains more than the digit of an iteration.
            slope = (found[-1] - found[-2]) / (tried[-1] - tried[-2])
            ahead = tried[-1] + (bore - tried[-1]) / (1.0 - slope)
            bore = np.where(np.abs(slope) < _STEEPEST, np.clip(ahead, lower, upper), bore)
        tried.append(bore)
        of_rim, height = _rim_height(inertia, outer_radius, bore, limits)
        squares = square + bore
        scale = squares**2 / (of_rim + limits.web * (bore**2 - square**2))
        e = 0.0
        if limits.cuts.any:
            # e of the module's docstring, from derivatives by r^2: those by r over 2 r.
            inner = np.sqrt(bore)
            spread = limits.cuts.spread_slope(inner, outer_radius)
            spread = spread * (1.0 + ratio / (square - bore)) / squares
            gain = (spread - limits.cuts.area_slope()) / (2.0 * inner)
            e = np.clip(gain * scale, -_E_MAX, _E_MAX)
            lower, upper = _bounds(inertia, outer_radius, limits, fixed_bounds, inner)
        if has_holes:
            e = e + np.minimum((limits.heavy_web - limits.web) * scale, 0.0)
    return bore


def _bounds(
    inertia: FloatArray,
    outer: FloatArray,
    limits: RimLimits,
    fixed: tuple[FloatArray, FloatArray],
    inner: FloatArray | None,
) -> tuple[FloatArray, FloatArray]:
    """Bounds of r^2 at R [m^2], with the cuts of a rim of inner radius `inner`; None: no cuts."""
    full = 2.0 * inertia / (np.pi * limits.density)
    if inner is not None:
        full = full + limits.cuts.spread(inner, outer)
    lower = np.maximum(_bore_at_height(full, outer, limits, limits.height_min), fixed[0])
    upper = np.minimum(_bore_at_height(full, outer, limits, limits.height_max), fixed[1])
    if not np.all(np.isinf(limits.mass_max)):
        mass = limits.mass_max / (np.pi * limits.density)
        if inner is not None:
            mass = mass + limits.cuts.area(inner, outer)
        # At the largest mass, t b^2 + m b = k - m a, with m over pi rho.
        over, web = full / mass - outer**2, limits.web / mass
        by_mass = 2.0 * over / (1.0 + np.sqrt(np.maximum(1.0 + 4.0 * web * over, 1e-300)))
        lower = np.maximum(lower, by_mass)
    return lower, upper


def _bore_at_height(
    full: FloatArray, outer: FloatArray, limits: RimLimits, height: float | FloatArray
) -> FloatArray:
    """b at which a rim of radius R has the given height; 0 where even a solid disc is taller."""
    square, over = outer * outer, np.asarray(height) - limits.web
    beyond = full - limits.web * square**2
    bore: FloatArray = np.sqrt(np.maximum(square**2 - beyond / over, 0.0))
    return bore


HOUSING, MOUNT, BOND = "housing", "mount", "bond on the bell"
"""Names of what sets the radius: no limit, since a larger rim is lighter but its housing and foot
are heavier; the motor's mount, which needs a larger housing; a ring's bond, which holds no larger
ring."""

BELL, HUB, LIGHTENING_HOLES = "bell", "hub", "lightening holes"
"""Names of what sets the bore: the motor's bell in a ring, which also sets its height; hub or holes
that need more than specified."""

WEB, CUT_HEIGHT, CUT_WALL = "web", "height for edges and holes", "wall for edges and holes"
"""Names of what sets height and wall where web, chamfers or balancing holes need more than
specified."""

HOLED_STRESS = "stress at lightening holes"
"""Name of the hoop stress limit where the holes are the weakest point."""

_TOUCHING = 1e-5
"""Relative distance within which a limit is active; a hundredth of what a lathe can resolve."""


def binding_limits(shape: ModuleShape, limits: RimLimits, envelope: Envelope) -> tuple[str, ...]:
    """Names of the limits that are active for one module, as in the specification.

    Shape and limits are scalars; `envelope` is as specified, without the changes for web and hub.
    """
    at, inner, outer = limits, float(shape.inner_radius), float(shape.outer_radius)
    height = float(shape.height)
    weight, bore_weight = at.hoop_weights
    stretched = weight * outer**2 + bore_weight * inner**2
    bore = HUB if at.inner_radius_min > envelope.inner_radius_min else "r_min"
    if np.isfinite(at.inner_radius_max):
        bore = BELL
    if at.lightened_bore >= at.inner_radius_min > 0.0:
        bore = LIGHTENING_HOLES
    stress = HOLED_STRESS if at.stretch_left < 1.0 else "hoop_stress"
    seat = CUT_HEIGHT if at.cuts.height_min >= at.height_min else WEB
    flat = seat if at.height_min > envelope.height_min else "h_min"
    wall = CUT_WALL if at.wall_min > envelope.wall_min else "wall_min"
    tall = BELL if bore == BELL and at.height_max < envelope.height_max else "h_max"
    largest = BOND if at.outer_radius_max < envelope.outer_radius_max else "r_max"
    active_candidates: dict[str, tuple[Any, Any]] = {
        largest: (outer, at.outer_radius_max),
        tall: (height, at.height_max),
        stress: (stretched, at.stretch_max),
        "wheel_mass_max": (float(shape.rim_mass), at.mass_max),
        bore: (inner, at.inner_radius_min),
        flat: (height, at.height_min),
        wall: (outer - inner, at.wall_min),
        MOUNT: (outer, at.outer_radius_min),
    }
    names = tuple(
        name
        for name, (value, limit) in active_candidates.items()
        if abs(value - limit) <= _TOUCHING * value
    )
    radius_is_held = {"r_max", BOND, stress, MOUNT} & set(names) or {flat, wall} <= set(names)
    return names if radius_is_held else (*names, HOUSING)
