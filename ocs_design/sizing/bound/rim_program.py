"""The lightest rim as a convex program in CVXPY, solved by Clarabel (docs/theory.md, The rim).

Variables are a = (R / s)^2 and b = (r / s)^2 with a scale s, so that both are of the order of one,
and limits that may be far away are divided by their own size; otherwise the solver loses digits. By
Lagrange, the sensitivity of the optimal mass to a limit is that of the constraint
g(a, b; limit) <= 0 times its multiplier. All limits are convex except wall and least height, which
are replaced by
tangents at the last solution (the convex-concave procedure): where the solutions converge, the
multipliers of the last convex program are those of the rim itself (Yuille and Rangarajan, Neural
Computation 15, 2003; Lipp and Boyd, Optim. Eng. 17, 2016).
"""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia, hoop_weights
from ocs_design.sizing.bound.infeasible import infeasible_rim
from ocs_design.sizing.bound.rim_problem import RimProblem, lightest_rim

if TYPE_CHECKING:
    from types import ModuleType

    from cvxpy import Constraint, Expression, Problem, Variable


class RimConstraint(NamedTuple):
    """One limit, g(a, b; limit) <= 0.

    Attributes:
        convex: the CVXPY constraint.
        derivative: of g with respect to the limit where it is active, at (a, b) [1 / SI unit of the
            limit].
    """

    convex: "Constraint"
    derivative: Callable[[float, float], float]


class RimConstraints:
    """All limits of one rim problem.

    Attributes:
        a, b: CVXPY variables.
        by_name: the limits that are set, by the specification's names; the derivative of the hoop
            stress is with respect to the allowed stress [1 / Pa].
    """

    def __init__(self, problem: RimProblem, scale: float) -> None:
        # Importing CVXPY takes a second, so it is imported only to solve.
        cvxpy = import_module("cvxpy")
        self.a: Variable
        self.b: Variable
        self.a, self.b = cvxpy.Variable(), cvxpy.Variable()
        self._moves: list[Callable[[], None]] = []
        room, inertia, density = problem.envelope, problem.spin_inertia, problem.material.density
        radius, bore = room.outer_radius_max / scale, room.inner_radius_min / scale
        wall, per_height = room.wall_min / scale, 2.0 * inertia / (np.pi * density * scale**4)
        # Differences a^2 - b^2 of the tallest rim and of the flattest one.
        tall = per_height / room.height_max
        flat = per_height / room.height_min if room.height_min > 0.0 else np.inf
        # The height limit is a second-order cone. The geometric mean of a - b and a + b would
        # express the same cone, but costs Clarabel four digits of the multipliers.
        norm = cvxpy.norm(cvxpy.hstack([self.b, np.sqrt(tall)]))
        self.by_name = {
            "r_max": RimConstraint(
                self.a / radius**2 <= 1.0, lambda _a, _b: -2.0 / room.outer_radius_max
            ),
            "r_min": RimConstraint(self.b >= bore**2, lambda _a, _b: 2.0 * bore / scale),
            "h_max": RimConstraint(
                norm <= self.a,
                lambda _a, b: -tall / (2.0 * room.height_max * np.hypot(b, np.sqrt(tall))),
            ),
        }
        if room.wall_min > 0.0:

            def widest_bore(a: float) -> tuple[float, float]:
                """(sqrt(a) - t)^2 and its slope."""
                widest = np.sqrt(a) - wall
                return widest**2, widest / np.sqrt(a)

            self.by_name["wall_min"] = RimConstraint(
                self.b <= self._tangent(self.a, widest_bore),
                lambda a, _b: 2.0 * (np.sqrt(a) - wall) / scale,
            )
        if room.height_min > 0.0:

            def widest_rim(b: float) -> tuple[float, float]:
                """sqrt(Q + b^2) and its slope."""
                widest = np.hypot(b, np.sqrt(flat))
                return widest, b / widest

            self.by_name["h_min"] = RimConstraint(
                self.a <= self._tangent(self.b, widest_rim),
                lambda _a, b: flat / (2.0 * room.height_min * widest_rim(b)[0]),
            )
        if np.isfinite(room.mass_max):
            least = 2.0 * inertia / (room.mass_max * scale**2)
            self.by_name["wheel_mass_max"] = RimConstraint(
                (self.a + self.b) / least >= 1.0, lambda _a, _b: -1.0 / room.mass_max
            )
        if np.isfinite(problem.stretch_max):
            stretch = problem.stretch_max / scale**2
            outer, inner = hoop_weights(problem.material.poisson_ratio or 0.0)
            self.by_name["hoop_stress"] = RimConstraint(
                self.a * (outer / stretch) + self.b * (inner / stretch) <= 1.0,
                lambda _a, _b: -1.0 / problem.hoop_stress_max,
            )

    def touch(self, a: float, b: float) -> None:
        """Move the tangents to this point."""
        self.a.value, self.b.value = a, b
        for move in self._moves:
            move()

    def point(self) -> FloatArray:
        """The values of a and b, shape (2,); clipped at zero against a solver's rounding."""
        return np.maximum([np.asarray(x.value).item() for x in (self.a, self.b)], 0.0)

    def _tangent(
        self, x: "Variable", function: Callable[[float], tuple[float, float]]
    ) -> "Expression":
        """The tangent, at `touch`, of a convex function that returns its value and slope."""
        cvxpy = import_module("cvxpy")
        slope, offset = cvxpy.Parameter(), cvxpy.Parameter()

        def move() -> None:
            contact = np.asarray(x.value).item()
            height, steepness = function(contact)
            slope.value, offset.value = steepness, height - steepness * contact

        self._moves.append(move)
        line: Expression = slope * x + offset
        return line


_SOLVER_OPTIONS = {"tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10, "tol_feas": 1e-10}
_STEP_TOLERANCE = 1e-8
_ITERATIONS_MAX = 50
# A multiplier below this belongs to an inactive limit; those of active limits are of order one.
_IDLE = 1e-6


@dataclass(frozen=True)
class RimOptimum:
    """Solution of the convex program.

    Attributes:
        outer_radius: [m].
        mass: [kg].
        prices: change of the mass per change of each limit that is set [kg per SI unit].
        gap: duality gap relative to the primal objective. status: CVXPY's.
    """

    outer_radius: float
    mass: float
    prices: Mapping[str, float]
    gap: float
    status: str


def optimise_rim(problem: RimProblem, outer_radius: float, inner_radius: float) -> RimOptimum:
    """Improve a feasible rim until the iteration converges.

    Args:
        problem: of the rim.
        outer_radius, inner_radius: of any rim within the limits [m].

    Raises:
        MissingToolError: CVXPY is not installed.
    """
    cvxpy = load_solver()
    scale = outer_radius
    constraints = RimConstraints(problem, scale)
    mass = cvxpy.inv_pos(constraints.a + constraints.b)
    limits = [limit.convex for limit in constraints.by_name.values()]
    program: Problem = cvxpy.Problem(cvxpy.Minimize(mass), limits)
    point = np.array([1.0, (inner_radius / scale) ** 2])
    step, iterations = np.inf, 0
    while step > _STEP_TOLERANCE and iterations < _ITERATIONS_MAX:
        last = point
        constraints.touch(*last)
        gap = _solved_gap(program)
        point = constraints.point()
        step, iterations = np.abs(point - last).max(), iterations + 1
    mass_scale, prices = 2.0 * problem.spin_inertia / scale**2, {}
    for name, limit in constraints.by_name.items():
        multiplier = np.asarray(limit.convex.dual_value).item()
        price = mass_scale * multiplier * float(limit.derivative(*point))
        prices[name] = price if multiplier > _IDLE else 0.0
    return RimOptimum(
        outer_radius=float(scale * np.sqrt(point[0])),
        mass=float(mass_scale / point.sum()),
        prices=prices,
        gap=gap,
        status=str(program.status),
    )


def load_solver() -> "ModuleType":
    """The module CVXPY, imported when called, as that takes seconds.

    Raises:
        MissingToolError: it is not installed.
    """
    try:
        return import_module("cvxpy")
    except ImportError as error:
        raise MissingToolError(
            "no wheel can be sized by the bound alone: CVXPY is not installed",
            hint=f"{extra_command('bound')}, or leave out --motor none",
        ) from error


def _solved_gap(program: "Problem") -> float:
    """Solve in place; returns the relative gap between the primal and the dual objective."""
    # Not `program.solve()`, which discards the dual objective.
    data, chain, inverse = program.get_problem_data("CLARABEL", solver_opts=_SOLVER_OPTIONS)
    raw = chain.solve_via_data(program, data, solver_opts=_SOLVER_OPTIONS)
    with warnings.catch_warnings():
        # An inaccurate solution is visible in the gap and in the status.
        warnings.filterwarnings("ignore", message="Solution may be inaccurate")
        program.unpack_results(raw, chain, inverse)
    if program.status not in ("optimal", "optimal_inaccurate"):
        raise RuntimeError(
            f"Clarabel calls a rim that is known to exist {program.status}: {raw.status}"
        )
    return float(abs(raw.obj_val - raw.obj_val_dual) / abs(raw.obj_val))


AGREEMENT = 1e-7
"""Largest relative difference in mass between the convex program and the closed form."""

_METHOD = "convex program (CVXPY, Clarabel), vertex in closed form"


@dataclass(frozen=True)
class RimSolution:
    """The lightest hollow cylinder within the limits.

    Attributes:
        inner_radius, outer_radius, height: of the vertex in closed form, to full digits [m].
        mass: [kg]. spin_inertia, transverse_inertia: [kg m^2].
        binding: names of the active limits.
        shadow_prices: change of the mass per change of each limit [kg per SI unit of the limit];
            negative where a larger limit saves mass; per allowed stress for `hoop_stress`.
        gap: relative duality gap of the convex program.
        residual: relative difference in mass between the convex program and the closed form.
        status: of the convex program.
        method: how it was solved.
    """

    inner_radius: float
    outer_radius: float
    height: float
    mass: float
    spin_inertia: float
    transverse_inertia: float
    binding: tuple[str, ...]
    shadow_prices: Mapping[str, float]
    gap: float
    residual: float
    status: str
    method: str


def solve_rim(problem: RimProblem) -> RimSolution:
    """The lightest rim of the required spin inertia.

    The closed form gives the numbers; the convex program, started there, must agree and gives the
    multipliers.

    Raises:
        Infeasible: no rim has this spin inertia within the limits.
    """
    shape = lightest_rim(problem.spin_inertia, problem.limits)
    if not shape.mass > 0.0:
        raise infeasible_rim(problem, solve_rim)
    optimum = optimise_rim(problem, float(shape.outer_radius), float(shape.inner_radius))
    residual = abs(optimum.mass / float(shape.mass) - 1.0)
    if residual > AGREEMENT:
        raise RuntimeError(
            f"closed form and convex program disagree by {residual:.1e} on {problem}"
        )
    inner, outer, height = (float(value) for value in shape[:3])
    density = problem.material.density
    return RimSolution(
        inner_radius=inner,
        outer_radius=outer,
        height=height,
        mass=float(shape.mass),
        spin_inertia=cylinder_spin_inertia(inner, outer, height, density),
        transverse_inertia=cylinder_transverse_inertia(inner, outer, height, density),
        binding=tuple(name for name, price in optimum.prices.items() if price != 0.0),
        shadow_prices=optimum.prices,
        gap=optimum.gap,
        residual=residual,
        status=optimum.status,
        method=_METHOD,
    )
