"""One candidate as a smooth nonlinear programme without a fixed point, and the prices of limits.

Over the logarithms of outer radius, height and wall, and the incidence, the mass is the smallest
for which every part of the requirement is met on the robot with the device; SciPy's SLSQP solves it
(docs/theory.md, The selection: Refinement and Prices of the limits).
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from threadpoolctl import ThreadpoolController

from ocs_design.actuation.tilt_inertia import OUT_OF_REACH
from ocs_design.common.arrays import FloatArray
from ocs_design.device.records.selection import PriceRecord
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import cylinder_spin_inertia
from ocs_design.sizing.bound.rim_problem import BORE_SHARE
from ocs_design.sizing.lightest_module import ModuleShape
from ocs_design.sizing.limits import STRESS, TIME, TOP_SPEED
from ocs_design.sizing.selection.candidates import Candidates, drives_of, web_inertia
from ocs_design.sizing.selection.composite_inertia import CompositeInertia
from ocs_design.sizing.selection.demand import margins_of
from ocs_design.sizing.selection.fixed_point import FINE, Design, FixedPoint, fixed_point
from ocs_design.sizing.selection.problem import (
    Candidate,
    SelectionProblem,
    limits_of,
    of_parts,
    with_limit,
)

_FEASIBLE = 1e-10
"""Relative violation of a limit that counts as rounding."""

_RATIO_MIN, _RATIO_MAX = 1e-6, 1e6
"""Range to which the limits' ratios are clipped."""

_DIFFERENCE = 1e-6
"""Step of the central differences."""

_DIGITS = 1e-11
"""Change of the logarithm of the mass at which SLSQP stops."""

_ITERATIONS_MAX = 40
_PATIENCE = 12
"""Evaluations without progress after which SLSQP is stopped; at a jump it may try a hundred."""

_PENALTY = 10.0
"""Logarithm of the mass per unit of violation, to measure progress: prices are about one."""

_LARGEST_CHANGE = 0.7
"""Largest change of the logarithms of radius, height and wall."""


class Optimum(NamedTuple):
    """The best point that SLSQP has seen.

    Attributes:
        point: see `coordinates`. value: logarithm of the mass of a module [log kg].
        violation: largest violation of a limit; 0: all hold.
    """

    point: FloatArray
    value: float
    violation: float


def refine(candidates: Candidates, point: FixedPoint) -> FixedPoint:
    """The lightest device of one candidate near a point; infeasible where none is found."""
    programme = Programme(candidates)
    shape = point.shapes.take(0)
    outer, height, inner = map(float, (shape.outer_radius, shape.height, shape.inner_radius))
    optimum = lightest(programme, coordinates(outer, height, inner, float(point.angle[0])))
    if optimum.violation <= _FEASIBLE:
        return programme.fixed_point(optimum.point)
    # SLSQP gets no closer where a slope jumps: the fixed point at the same radius is used.
    radius, angle = np.exp(optimum.point[:1]), optimum.point[3:]
    return fixed_point(candidates, np.zeros(1), Design(radius, angle, np.zeros(1)), FINE)


def lightest(programme: "Programme", start: FloatArray) -> Optimum:
    """The lightest device near a start, feasible or not; see `coordinates`."""
    # The import takes longer than a selection.
    from scipy.optimize import Bounds, NonlinearConstraint, minimize  # noqa: PLC0415

    fixed_incidence, angle = programme.holds_incidence(start), float(start[-1])
    angle_range = (angle, angle) if fixed_incidence else (0.0, np.pi / 2.0)
    low: FloatArray = np.append(start[:3] - _LARGEST_CHANGE, angle_range[0])
    high: FloatArray = np.append(start[:3] + _LARGEST_CHANGE, angle_range[1])

    best, best_merit, idle = Optimum(start, np.inf, np.inf), np.inf, 0

    # The last point is cached: SLSQP requests its value, slope and limits separately.
    @lru_cache(maxsize=1)
    def evaluation(point: bytes) -> _Evaluation:
        nonlocal best, best_merit, idle
        evaluated = programme.evaluation(np.frombuffer(point), low, high)
        violations = np.append(-evaluated.limits, evaluated.limits[equal])
        current = Optimum(np.frombuffer(point), evaluated.value, max(float(violations.max()), 0.0))
        best = min(best, current, key=lambda seen: (max(seen.violation, _FEASIBLE), seen.value))
        merit = current.value + _PENALTY * current.violation
        best_merit, idle = (merit, 0) if merit < best_merit - _DIGITS else (best_merit, idle + 1)
        if idle > _PATIENCE:
            raise _StalledError
        return evaluated

    def at(point: FloatArray) -> _Evaluation:
        return evaluation(point.tobytes())

    def value(point: FloatArray) -> float:
        return at(point).value

    def slope(point: FloatArray) -> FloatArray:
        return at(point).slope

    def constraint(rows: slice, upper: float) -> NonlinearConstraint:
        return NonlinearConstraint(
            lambda point: at(point).limits[rows],
            0.0,
            upper,
            jac=lambda point: at(point).slopes[rows],
        )

    specified = programme.candidates.problem.requirement.spin_inertia is not None
    equal, unequal = slice(int(specified)), slice(int(specified), None)
    with _libraries().limit(limits=1, user_api="blas"), suppress(_StalledError):
        minimize(
            value,
            np.clip(start, low, high),
            jac=slope,
            method="SLSQP",
            bounds=Bounds(low, high),
            constraints=[constraint(unequal, np.inf), constraint(equal, 0.0)][: 1 + specified],
            options={"maxiter": _ITERATIONS_MAX, "ftol": _DIGITS},
        )
    return best


class _StalledError(Exception):
    """SLSQP makes no progress."""


@cache
def _libraries() -> ThreadpoolController:
    """The linear algebra libraries that are loaded, SciPy's among them.

    SLSQP multiplies by packed triangular matrices (DTPMV), which OpenBLAS splits among its threads
    however small they are: a different number of threads rounds differently, so the result differs.
    """
    return ThreadpoolController()


class _Evaluation(NamedTuple):
    """Logarithm of the mass and limits at a point, and their slopes by central differences."""

    value: float
    limits: FloatArray
    slope: FloatArray
    slopes: FloatArray


@dataclass(frozen=True, eq=False)
class Programme:
    """Mass and limits of one candidate on its robot as functions of `coordinates`."""

    candidates: Candidates

    def __call__(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Logarithm of a module's mass, shape (k,), and constraints c >= 0, shape (k, m).

        Where a spin inertia is specified, the first constraint is an equality.
        """
        candidates, shapes = self._copies(len(points)), self._shapes(points)
        spin, composite = self._on_robot(candidates, shapes)
        requirement = candidates.problem.requirement
        at_design, at_own = margins_of(
            requirement, candidates.drives, composite, spin, points[:, 3:]
        )
        margins = [part.margin[:, 0] for part in (*at_design, *at_own)]
        # Ratios of the rims' limits to their values.
        rim = self.candidates.limits
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        weight, bore_weight = rim.hoop_weights
        pairs = (
            (outer, rim.outer_radius_max),
            (height, rim.height_max),
            (shapes.rim_mass, rim.mass_max),
            (weight * outer**2 + bore_weight * inner**2, rim.stretch_max),
            (rim.outer_radius_min, outer),
            (rim.height_min, height),
            (rim.wall_min, outer - inner),
            (np.maximum(rim.inner_radius_min, BORE_SHARE * outer), inner),
        )
        with np.errstate(divide="ignore"):
            rim_margins = [np.broadcast_to(most / value, outer.shape) for value, most in pairs]
        limits = np.log(np.clip([*margins, *rim_margins], _RATIO_MIN, _RATIO_MAX))
        if requirement.spin_inertia is not None:
            limits = np.concatenate([np.log(spin / requirement.spin_inertia)[None], limits])
        return np.log(candidates.drives.mass + shapes.mass), limits.T

    @cached_property
    def _copies(self) -> Callable[[int], Candidates]:
        """Makes copies of the candidate, whose drives and limits are then computed only once."""
        return cache(self.candidates.repeat)

    def evaluation(self, point: FloatArray, low: FloatArray, high: FloatArray) -> _Evaluation:
        """The programme at a point, with all points of the central differences in one call.

        They stay within the bounds, as there may be nothing to evaluate beyond.
        """
        n, width = point.size, _DIFFERENCE * np.eye(point.size)
        ahead, behind = np.minimum(point + width, high), np.maximum(point - width, low)
        values, limits = self(np.concatenate([point[None], ahead, behind]))
        steps = np.diag(ahead - behind)
        # A fixed variable has no slope.
        divisors = np.where(steps > 0.0, steps, np.inf)
        slope = (values[1 : n + 1] - values[n + 1 :]) / divisors
        slopes = ((limits[1 : n + 1] - limits[n + 1 :]) / divisors[:, None]).T
        return _Evaluation(float(values[0]), limits[0], slope, slopes)

    def holds_incidence(self, point: FloatArray) -> bool:
        """Whether the incidence is specified, or isolated from its neighbours.

        At an isolated incidence an axis is out of reach and ignored; beside it, the wheels would
        have to meet the demand of the coupling about that axis with hardly any leverage.
        """
        axes, angle = self.candidates.problem.layout.axes(point[3]), point[None, 3:]
        _, composite = self._on_robot(self.candidates, self._shapes(point[None]))
        uncontrolled = np.abs(axes[:2]).max(axis=1) <= OUT_OF_REACH
        isolated = bool(uncontrolled.any() and composite.at(angle)[0].product.any())
        return self.candidates.problem.incidence is not None or isolated

    def fixed_point(self, point: FloatArray) -> FixedPoint:
        """A single point at which all limits hold, as a fixed point."""
        shapes, angle = self._shapes(point[None]), point[3:]
        spin, composite = self._on_robot(self.candidates, shapes)
        requirement = self.candidates.problem.requirement
        at_design, at_own = margins_of(
            requirement, self.candidates.drives, composite, spin, angle[:, None]
        )
        parts = [*at_design, *at_own]
        margin = np.min([part.margin[:, 0] for part in parts], axis=0, initial=np.inf)
        demand = np.max(
            [self.candidates.least_spin_inertia, *(part.improved[:, 0] for part in parts)], axis=0
        )
        # Where no larger wheel would do either, a margin slightly below one due to rounding
        # requests an infinite wheel.
        residual = np.where(np.isfinite(demand), np.abs(demand / spin - 1.0), np.abs(margin - 1.0))
        return FixedPoint(
            spin_inertia=spin,
            radius=shapes.outer_radius,
            angle=angle,
            shapes=shapes,
            feasible=np.ones(1, dtype=np.bool_),
            margin=margin,
            residual=np.zeros(1) if requirement.spin_inertia is not None else residual,
            iterations=np.zeros(1, dtype=np.intp),
        )

    def _on_robot(
        self, candidates: Candidates, shapes: ModuleShape
    ) -> tuple[FloatArray, CompositeInertia]:
        """Spin inertias of the wheels [kg m^2], and the composite inertia that they turn."""
        limits = candidates.limits
        dimensions = (shapes.inner_radius, shapes.outer_radius, shapes.height)
        cut = limits.cuts.axial_inertia(shapes.inner_radius, shapes.outer_radius, 1.0)
        rim = (cylinder_spin_inertia(*dimensions, 1.0) - cut) * np.asarray(limits.density)
        web = web_inertia(limits, shapes.inner_radius)
        spin = rim + web + candidates.drives.inertia_beside_rim
        return spin, candidates.on_robot(spin, shapes)

    def _shapes(self, points: FloatArray) -> ModuleShape:
        outer, height, wall = np.exp(points[:, :3]).T
        # A wall is at most the radius; a thicker one fails as too small a bore.
        inner = np.maximum(outer - wall, BORE_SHARE * outer / 2.0)
        limits = self.candidates.limits
        # The bore of a ring around a bell is given, whatever the wall.
        bell = np.asarray(limits.inner_radius_max)
        inner = np.where(np.isfinite(bell), bell, inner)
        density = np.asarray(limits.density)
        cut = limits.cuts.mass(inner, outer, 1.0)
        mass = (cylinder_mass(inner, outer, height, 1.0) - cut) * density
        web = np.pi * density * limits.heavy_web * inner**2
        shell = self.candidates.shell.mass(outer, height)
        return ModuleShape(inner, outer, height, mass, web, shell)


def coordinates(outer: float, height: float, inner: float, angle: float) -> FloatArray:
    """Logarithms of a rim's outer radius, height and wall [m], and the incidence [rad]."""
    return np.append(np.log([outer, height, outer - inner]), angle)


_UNITS = {STRESS: 0.1, TIME: 0.01, TOP_SPEED: 100.0}
"""Realistic changes in the limit's own unit; all other limits change by one."""

_LEAST_FRACTION = 0.5
"""Least fraction of a limit that is left where it is loosened downwards."""

_FEASIBLE_TO_PRICE = 1e-6
"""Relative violation of a limit that is tolerated in a price."""

_ACTIVE, _MOVED = 1e-6, 1e-9
"""Slack of an active limit, and change of it that counts as moved; logarithms of ratios."""


def mass_prices(problem: SelectionProblem, chosen: Candidate) -> Iterator[PriceRecord]:
    """Prices of all specified limits, with the same motor, gear and material."""
    same_parts = of_parts(problem, chosen)
    sizes = chosen.outer_radius, chosen.height, chosen.inner_radius
    start = coordinates(*sizes, chosen.incidence)
    (before,), (slack,) = _programme(same_parts)(start[None])
    for limit, value in limits_of(problem).items():
        if not (np.isfinite(value) and value > 0.0):
            continue
        step = _UNITS.get(limit, 1.0) / limit.per_si
        changed = (
            value + step if limit.loosens_upwards else max(value - step, _LEAST_FRACTION * value)
        )
        loosened = _programme(with_limit(same_parts, limit, changed))
        _, (changed_slack,) = loosened(start[None])
        change = 0.0
        if np.any((slack < _ACTIVE) & (np.abs(changed_slack - slack) > _MOVED)):
            optimum = lightest(loosened, start)
            if optimum.violation <= _FEASIBLE_TO_PRICE:
                change = min(float(np.expm1(optimum.value - before)), 0.0)
        yield PriceRecord(
            limit=limit.name,
            value=value,
            changed=changed,
            mass_change=float(change * chosen.modules_mass),
        )


def _programme(problem: SelectionProblem) -> Programme:
    """Programme of a problem with a single motor, gear and material."""
    first = np.zeros(1, dtype=np.intp)
    return Programme(Candidates(problem, drives_of(problem, first.repeat(2)[None]), first))
