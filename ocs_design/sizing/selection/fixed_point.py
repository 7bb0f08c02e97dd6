"""Wheel, incidence and robot at their fixed point, for many candidates at once.

A heavier module needs a larger wheel. The demand is iterated to its fixed point, from a lower bound
upwards (docs/theory.md, The selection). Each iteration tries some incidences around the best so far
and takes one Newton step towards the demand at the best of them, narrowing the range of incidences
as it goes.

The mass of a module of given spin inertia has one minimum over its radius (`lightest_module`), but
a smaller module is closer to the robot and may need less, and where the torque barely suffices it
may be the only feasible one. So masses are compared at their fixed points.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, Table
from ocs_design.sizing.bound.rim_problem import smallest_rim_inertia
from ocs_design.sizing.lightest_module import ModuleShape
from ocs_design.sizing.module_radii import smallest_radius
from ocs_design.sizing.selection.candidates import Candidates, Guess
from ocs_design.sizing.selection.demand import margins_of, worst_case

_ITERATIONS_MAX = 40
_POINTS = np.linspace(-1.0, 1.0, 5)
"""Incidences that one iteration tries, relative to the width around the best so far."""

_NARROWING = 0.55
"""Factor on the width per iteration: the next incidences reach slightly beyond the best one's
neighbours."""

_STEEPEST, _STEEPEST_NEAR = 0.9, 0.9995
"""Slope of the demand over the spin inertia up to which a secant is trusted, far from and near the
last iteration."""

_NEAR = 0.02
"""Relative difference of two iterations that count as near."""

_SPANS = (1.0, 0.2)
"""Fractions of the range of radii searched in turn; each reaches slightly beyond the best one's
neighbours."""

_RADII = 13
_HUGE, _TINY = 1e9, 1e-9
"""A value above any spin inertia [kg m^2] and mass [kg], and one below any margin."""


class Design(NamedTuple):
    """Radius and incidence of candidates, shape (n,) each; the spin inertia gives the rest.

    Attributes:
        radius: outer radius of the rim [m]; the nearest feasible one is used.
        angle: incidence [rad]. width: range around it to search [rad].
    """

    radius: FloatArray
    angle: FloatArray
    width: FloatArray


class Tolerance(NamedTuple):
    """When a fixed point counts as reached.

    Attributes:
        residual: of the spin inertia, relative. width: of the incidence, relative to the first one.
    """

    residual: float
    width: float


_ROUGH = Tolerance(residual=1e-5, width=0.05)
FINE = Tolerance(residual=1e-12, width=1e-3)


@dataclass(frozen=True, eq=False)
class FixedPoint(Table):
    """Candidates at their fixed points, shape (n,) each.

    Attributes:
        spin_inertia: of each wheel [kg m^2]; of an infeasible candidate, that with the largest
            margin.
        radius: outer radius requested [m]; the nearest feasible one is used.
        angle: the best incidence [rad].
        shapes: rims and housings.
        feasible: whether the candidate is feasible.
        margin: of the worst part of the requirement, see `Margins`.
        residual: relative change of the spin inertia in one more iteration.
        iterations: number of iterations.
    """

    spin_inertia: FloatArray
    radius: FloatArray
    angle: FloatArray
    shapes: ModuleShape
    feasible: NDArray[np.bool_]
    margin: FloatArray
    residual: FloatArray
    iterations: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Solved(Table):
    """Candidates near their best radius and incidence, one per row.

    Attributes:
        candidates: their parts. guess: where the search started.
        point: the result.
    """

    candidates: Candidates
    guess: Guess
    point: FixedPoint

    @property
    def mass(self) -> FloatArray:
        """Mass of all modules [kg]; inf where the candidate is not feasible."""
        mass = len(self.candidates.problem.layout) * (
            self.candidates.drives.mass + self.point.shapes.mass
        )
        return np.where(self.point.feasible, mass, np.inf)

    @property
    def score(self) -> FloatArray:
        """Mass [kg], or a penalty where it is not feasible that falls as the margin grows."""
        penalty = _HUGE / np.maximum(self.point.margin, _TINY)
        return np.where(self.point.feasible, self.mass, penalty)


def solve_stepwise(candidates: Candidates, guess: Guess) -> Iterator[Solved]:
    """Devices of the candidates that meet the requirement, where found, in steps of precision.

    Each step is at the best radius so far. All but the last are rough; the last is at most a few
    per cent heavier than necessary (`refinement`).
    """
    start = np.maximum(guess.spin_inertia, candidates.least_spin_inertia)
    # A larger wheel than the starting one may be needed, possibly of larger radius.
    rim = np.maximum(
        start - candidates.drives.inertia_beside_rim, smallest_rim_inertia(candidates.limits)
    )
    high = candidates.problem.envelope.outer_radius_max
    low = np.minimum(smallest_radius(rim, candidates.limits), high)
    radius, half, angle = np.sqrt(low * high), np.log(high / low) / 2.0, guess.angle
    copies, best = candidates.repeat(_RADII), None
    for span in _SPANS:
        steps = span * np.linspace(-1.0, 1.0, _RADII)
        radii = radius[:, None] * np.exp(np.outer(half, steps))
        angles, widths = np.repeat([angle, span * guess.width], _RADII, axis=1)
        design = Design(radii.ravel(), angles, widths)
        point = fixed_point(copies, np.repeat(start, _RADII), design, _ROUGH)
        score = Solved(copies, guess.repeat(_RADII), point).score.reshape(-1, _RADII)
        rows = np.arange(len(candidates)) * _RADII + score.argmin(axis=1)
        solved = Solved(candidates, guess, point.take(rows))
        if best is not None:
            improved = np.flatnonzero(solved.score < best.score)
            solved = best.put(improved, solved.take(improved))
        best, radius, angle = solved, solved.point.radius, solved.point.angle
        yield best
    assert best is not None, "there are spans"
    design = Design(best.point.radius, best.point.angle, np.zeros_like(start))
    near = np.where(best.point.feasible, best.point.spin_inertia, start)
    point = fixed_point(candidates, near, design, FINE)
    # The lightest radius may be the last feasible one, where the fine iteration may diverge.
    lost = np.flatnonzero(best.point.feasible & ~point.feasible)
    rough = replace(best.point.take(lost), feasible=np.zeros(lost.size, dtype=np.bool_))
    yield replace(best, point=point.put(lost, rough))


class _Step(NamedTuple):
    """Result of one iteration: the best incidence, the demand there, and the margin."""

    angle: FloatArray
    width: FloatArray
    demand: FloatArray
    margin: FloatArray


def fixed_point(
    candidates: Candidates,
    start: FloatArray,
    design: Design,
    tolerance: Tolerance,
) -> FixedPoint:
    """The smallest wheels that meet the whole requirement.

    `start`: lower bounds of their spin inertias [kg m^2], shape (n,).
    """
    specified = candidates.problem.requirement.spin_inertia
    spin = start = np.maximum(start, candidates.least_spin_inertia)
    if specified is not None:
        spin = np.full_like(spin, specified)
    radius, width_min = design.radius, tolerance.width * design.width
    last_spin = last_demand = np.zeros_like(spin)
    best_spin, best_margin = spin, np.zeros_like(spin)
    iterations = 0
    while True:
        iterations += 1
        shapes = candidates.shapes_at(spin, radius)
        step = _step(candidates, spin, shapes, design)
        design = design._replace(angle=step.angle, width=step.width)
        demand = spin if specified is not None else step.demand
        improved = step.margin > best_margin
        best_spin = np.where(improved, spin, best_spin)
        best_margin = np.where(improved, step.margin, best_margin)
        residual = np.abs(demand / spin - 1.0)
        secant_estimate, diverges = _along_secant(spin, demand, last_spin, last_demand)
        possible = (shapes.mass > 0.0) & np.isfinite(demand) & ~diverges
        converged = possible & (residual <= tolerance.residual)
        done = (design.width <= width_min) & (converged | ~possible)
        if done.all() or iterations == _ITERATIONS_MAX:
            break
        last_spin, last_demand = spin, demand
        # At a poor incidence the demand is too high: restart once the incidence is better.
        spin = np.where(done, spin, np.where(possible, secant_estimate, start))
    # The margin is uncertain by about the residual.
    solved = done & converged & (step.margin >= 1.0 - 10.0 * tolerance.residual)
    spin = np.where(solved, spin, best_spin)
    return FixedPoint(
        spin_inertia=spin,
        radius=radius,
        angle=design.angle,
        shapes=shapes if solved.all() else candidates.shapes_at(spin, radius),
        feasible=solved,
        margin=np.where(solved, step.margin, best_margin),
        residual=residual,
        iterations=np.full(spin.size, iterations),
    )


def _step(candidates: Candidates, spin: FloatArray, shapes: ModuleShape, design: Design) -> _Step:
    """Try the incidences around the best so far, and estimate the required spin inertia.

    Maneuvers at an incidence of their own do not affect the incidence of the design.
    """
    problem, composite = candidates.problem, candidates.on_robot(spin, shapes)
    offsets = design.width[:, None] * (_POINTS if design.width.any() else np.zeros(1))
    angles = np.clip(design.angle[:, None] + offsets, 0.0, np.pi / 2.0)
    at_design, at_own = margins_of(problem.requirement, candidates.drives, composite, spin, angles)
    varied, fixed = worst_case(at_design, angles.shape), worst_case(at_own, (spin.size, 1))
    # The least demand; where nothing suffices, the closest. Where there is no demand, all
    # incidences are equal, and the middle one is kept.
    penalty = _HUGE / np.maximum(varied.margin, _TINY)
    score = np.where(np.isfinite(varied.improved), varied.improved, penalty)
    # A wheel that cannot be made says nothing about the incidence.
    made = shapes.mass > 0.0
    score = np.where(made[:, None], score, _HUGE)
    score[:, score.shape[1] // 2] *= 1.0 - 1e-15
    best, row = np.argmin(score, axis=1), np.arange(spin.size)
    chosen, last = angles[row, best], offsets.shape[1] - 1
    inside = ((best > 0) & (best < last)) | (chosen == 0.0) | (chosen == np.pi / 2.0)
    demand = np.maximum(varied.improved[row, best], fixed.improved[:, 0])
    return _Step(
        angle=chosen,
        width=np.where(made & (inside | ~np.isfinite(demand)), _NARROWING, 1.0) * design.width,
        demand=np.maximum(demand, candidates.least_spin_inertia),
        margin=np.minimum(varied.margin[row, best], fixed.margin[:, 0]),
    )


def _along_secant(
    spin: FloatArray, demand: FloatArray, last_spin: FloatArray, last_demand: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Spin inertia that meets the demand, by a secant of the last two; and whether none does.

    Two close iterations give the slope of the demand, which increases: a secant from below does not
    overshoot the fixed point, and with a slope above one there is no fixed point ahead. Two distant
    iterations still show how Newton's method progressed.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = (demand - last_demand) / (spin - last_spin)
        near = np.abs(demand / last_spin - 1.0) < _NEAR
        trusted = (last_spin > 0.0) & (steepness > 0.0)
        trusted &= steepness < np.where(near, _STEEPEST_NEAR, _STEEPEST)
        estimate = spin + (demand - spin) / np.where(trusted, 1.0 - steepness, 1.0)
        diverges = near & (steepness > 1.0) & (demand > spin) & (spin > last_spin)
    return estimate, diverges
