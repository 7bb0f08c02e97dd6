"""Outer radii feasible for a rim of a given spin inertia, in closed form except for two roots.

With a = R^2, b = r^2, k = 2 I / (pi rho) and a web that counts like t of the rim's material, the
height is h = (k - t b^2) / (a^2 - b^2), and the limits bound b at each R, from above and below:

    h_max: b^2 <= a^2 - (k - t a^2) / (h_max - t)    h_min: b^2 >= a^2 - (k - t a^2) / (h_min - t)
    wall:  b <= (R - w)^2                            bore:  b >= r_min^2, b >= (R / 100)^2
    bell:  b <= r_max^2, where the bore is that of a ring around one
    hoop stress: b <= (S - (3 + nu) a) / (1 - nu)    mass:  k - t b^2 <= m_max / (pi rho) (a + b)

Each pair of an upper and a lower bound admits all radii on one side of the point where the two
meet. So the feasible radii are one interval, between the largest of the crossings that bound R from
below and the smallest of those that bound it from above.

A rim with chamfered edges and holes is a plain one with k and mass increased by what they remove
(`RimCuts`). That depends only weakly on (R, r), so each iteration for it at a crossing gains about
two digits.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.sizing.bound.rim_problem import BORE_SHARE, RimLimits, flat_wall_radius

# From above, each Newton step at least halves the error; near the root it doubles the digits.
_NEWTON_STEPS = 12
# Relative step below which iteration stops: the next would be rounding.
_LAST_STEP = 1e-9
# Relative difference of radii that count as equal, so that limits meeting in a point admit a rim.
_EQUAL = 1e-13
# Last step, relative to the distance from a radius, after which iteration stays on its side of it.
_SURELY = 0.5
# Iterations for the cuts; each gains a digit, as cuts are at most an eighth of the section.
_CUT_ROUNDS = 7


class _Crossing(NamedTuple):
    """Rim at which two limits meet: r and R [m]."""

    inner: FloatArray
    outer: FloatArray


class _RequiredRim(NamedTuple):
    """A required plain rim, before chamfers and holes are cut, and its limits.

    Each method returns the rim at which two limits meet.

    Attributes:
        full: k [m^5]. mass: largest, over pi rho [m^3].
        limits: of the rim.
    """

    full: FloatArray
    mass: FloatArray
    limits: RimLimits

    def tall_and_narrow(self) -> _Crossing:
        """The largest height and the least bore."""
        bore, tall = np.asarray(self.limits.inner_radius_min), np.asarray(self.limits.height_max)
        # Non-negative even where the web alone has more inertia than required: then no small rim is
        # too tall.
        fourth = np.maximum(self.full - self.limits.web * bore**4, 0.0) / tall + bore**4
        return _Crossing(bore, np.sqrt(np.sqrt(fourth)))

    def tall_and_closed(self) -> _Crossing:
        """The largest height and the least ratio of bore to outer radius."""
        tall = np.asarray(self.limits.height_max)
        fourth = self.full / tall / (1.0 - (1.0 - self.limits.web / tall) * BORE_SHARE**4)
        outer = np.sqrt(np.sqrt(fourth))
        return _Crossing(BORE_SHARE * outer, outer)

    def tall_and_heavy(self) -> _Crossing:
        """The largest height and the largest mass.

        A rim at both has a - b = m / (pi rho h) = c, so that h c (2 a - c) + t (a - c)^2 = k. Where
        that leaves no bore, every radius is light enough.
        """
        tall, web = np.asarray(self.limits.height_max), self.limits.web
        apart = self.mass / tall
        # In b = a - c: t b^2 + 2 h c b = k - h c^2.
        left, linear = self.full - tall * apart**2, tall * apart
        bore = left / (linear + np.sqrt(np.maximum(linear**2 + web * left, 0.0)))
        outer = np.where(left > 0.0, np.sqrt(np.maximum(bore + apart, 0.0)), 0.0)
        return _Crossing(np.sqrt(np.maximum(bore, 0.0)), outer)

    def thin_and_heavy(self) -> _Crossing:
        """The least wall and the largest mass."""
        wall, web = np.asarray(self.limits.wall_min), self.limits.web
        light = self.full / self.mass
        start = (wall + np.sqrt(np.maximum(2.0 * light - wall**2, 0.0))) / 2.0

        def excess(radius: FloatArray) -> tuple[FloatArray, FloatArray]:
            inner = radius - wall
            value = self.mass * (radius**2 + inner**2) + web * inner**4 - self.full
            return value, 2.0 * self.mass * (radius + inner) + 4.0 * web * inner**3

        outer = _root_from_above(excess, start, web)
        return _Crossing(outer - wall, outer)

    def thin_and_flat(self) -> _Crossing:
        """The least wall and the least height."""
        wall, web = np.asarray(self.limits.wall_min), np.asarray(self.limits.web)
        flat = np.asarray(self.limits.height_min)

        def excess(radius: FloatArray) -> tuple[FloatArray, FloatArray]:
            inner = radius - wall
            value = flat * radius**4 - (flat - web) * inner**4 - self.full
            return value, 4.0 * (flat * radius**3 - (flat - web) * inner**3)

        with np.errstate(divide="ignore"):
            # At this radius the web alone, without any rim, would have the inertia.
            start = np.minimum(flat_wall_radius(self.full / flat, wall), (self.full / web) ** 0.25)
        outer = _root_from_above(excess, start, web)
        return _Crossing(outer - wall, outer)

    def wide_and_heavy(self) -> _Crossing:
        """The largest bore and the largest mass: m (a + b) = k."""
        bore = np.asarray(self.limits.inner_radius_max)
        return _Crossing(bore, np.sqrt(np.maximum(self.full / self.mass - bore**2, 0.0)))

    def wide_and_flat(self) -> _Crossing:
        """The largest bore and the least height: h (a^2 - b^2) = k."""
        bore, flat = (np.asarray(x) for x in (self.limits.inner_radius_max, self.limits.height_min))
        return _Crossing(bore, np.sqrt(np.sqrt(self.full / flat + bore**4)))

    def stretched_and_heavy(self) -> _Crossing:
        """The hoop stress and the largest mass: t b^2 + m (a + b) = k with b = (S - p a) / n.

        With p = 3 + nu, n = 1 - nu and S the largest stretch.
        """
        outer, inner = self.limits.hoop_weights
        stretch = np.asarray(self.limits.stretch_max)
        # An unlimited hoop stress leaves any radius light enough.
        over = self.full / self.mass - np.where(np.isinf(stretch), 0.0, stretch) / outer
        slope = 1.0 - inner / outer
        root = np.sqrt(np.maximum(slope**2 + 4.0 * self.limits.web / self.mass * over, 0.0))
        return self._stretched((stretch - inner * 2.0 * over / (slope + root)) / outer)

    def stretched_and_flat(self) -> _Crossing:
        """The hoop stress and the least height: (h - t) (S - p a)^2 = n^2 (h a^2 - k)."""
        outer, inner = self.limits.hoop_weights
        stretch, web = np.asarray(self.limits.stretch_max), self.limits.web
        tall = np.asarray(self.limits.height_min) - web
        more = np.where(web > np.zeros_like(tall), 1.0 + web / tall, 1.0)
        flat = self.full / tall
        root = np.sqrt(np.maximum(more - flat * (outer**2 - inner**2 * more) / stretch**2, 0.0))
        square = (stretch + inner**2 * flat / stretch) / (outer + inner * root)
        # Where R^4 is already smaller, the least height allows any bore.
        return self._stretched(np.where(stretch > outer * np.sqrt(flat / more), square, np.inf))

    def _stretched(self, square: FloatArray) -> _Crossing:
        """Rim with that R^2 [m^2] and the bore at which it reaches the hoop stress limit."""
        outer, inner = self.limits.hoop_weights
        square = np.maximum(square, 0.0)
        bore = (self.limits.stretch_max - outer * square) / inner
        return _Crossing(np.sqrt(np.maximum(bore, 0.0)), np.sqrt(square))


def smallest_radius(
    inertia: FloatArray, limits: RimLimits, near: FloatArray | None = None
) -> FloatArray:
    """Radius below which a wheel of a spin inertia is too tall, too thick or too heavy [m].

    It is rough where it is below `near`, if given.
    """
    wall, bore = np.asarray(limits.wall_min), np.asarray(limits.inner_radius_min)
    by_wall = np.maximum(bore + wall, wall / (1.0 - BORE_SHARE))
    crossings = [_RequiredRim.tall_and_narrow, _RequiredRim.tall_and_closed]
    if not np.all(np.isinf(limits.mass_max)):
        crossings += [_RequiredRim.tall_and_heavy, _RequiredRim.thin_and_heavy]
        crossings += [_RequiredRim.wide_and_heavy] if _has_bore_limit(limits) else []
    radius: FloatArray = np.maximum(by_wall, np.asarray(limits.outer_radius_min))
    for crossing in crossings:
        radius = np.maximum(radius, _crossing_radius(crossing, inertia, limits, near, 1.0))
    return radius


def largest_radius(
    inertia: FloatArray, limits: RimLimits, near: FloatArray | None = None
) -> FloatArray:
    """Radius above which a wheel of a spin inertia breaks, is too flat, or has no room [m].

    It is rough where it is above `near`, if given.
    """
    stretch, (outer, inner) = np.asarray(limits.stretch_max), limits.hoop_weights
    by_bore = (stretch - inner * np.asarray(limits.inner_radius_min) ** 2) / outer
    by_share = stretch / (outer + inner * BORE_SHARE**2)
    square = np.minimum(by_bore, by_share)
    crossings = [_RequiredRim.stretched_and_flat, _RequiredRim.thin_and_flat]
    if not np.all(np.isinf(limits.mass_max)):
        crossings.append(_RequiredRim.stretched_and_heavy)
    if _has_bore_limit(limits):
        crossings.append(_RequiredRim.wide_and_flat)
    radius: FloatArray = np.minimum(
        np.asarray(limits.outer_radius_max), np.sqrt(np.maximum(square, 0.0))
    )
    for crossing in crossings:
        radius = np.minimum(radius, _crossing_radius(crossing, inertia, limits, near, -1.0))
    return radius


def _crossing_radius(
    crossing: Callable[[_RequiredRim], _Crossing],
    inertia: FloatArray,
    limits: RimLimits,
    near: FloatArray | None,
    sense: float,
) -> FloatArray:
    """R at which two limits meet for a rim with cuts [m].

    It is rough where `sense` times the distance from it up to `near` is positive: each iteration
    gains a digit, so that it stays on that side.
    """
    cuts, per_volume = limits.cuts, np.pi * limits.density
    full, mass = 2.0 * inertia / per_volume, np.asarray(limits.mass_max) / per_volume
    rim = crossing(_RequiredRim(full, mass, limits))
    for _ in range(_CUT_ROUNDS if cuts.any else 0):
        # Where the limits do not meet, there are no cuts.
        both = cuts.spread(*rim), cuts.area(*rim)
        spread, area = (np.where(np.isfinite(cut), cut, 0.0) for cut in both)
        last, rim = rim, crossing(_RequiredRim(full + spread, mass + area, limits))
        tolerance = _EQUAL * rim.outer
        if near is not None:
            tolerance = np.maximum(tolerance, _SURELY * sense * (near - rim.outer))
        if not np.any(np.abs(rim.outer - last.outer) > tolerance):
            break
    return rim.outer


def _has_bore_limit(limits: RimLimits) -> bool:
    """Whether bores have an upper limit; such rims have no webs."""
    return not np.all(np.isinf(limits.inner_radius_max))


def _root_from_above(
    excess: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    start: FloatArray,
    web: float | FloatArray,
) -> FloatArray:
    """Root of a convex, increasing function by Newton's method; without a web, the start itself.

    `excess`: the function and its slope; `start`: not below the root.
    """
    root = np.asarray(start, dtype=np.float64)
    if np.all(np.asarray(web) == 0.0):
        return root
    for _ in range(_NEWTON_STEPS):
        value, slope = excess(root)
        step = value / slope
        root = root - step
        if not np.any(np.abs(step) > _LAST_STEP * root):
            break
    return root
