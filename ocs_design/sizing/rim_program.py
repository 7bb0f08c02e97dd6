"""The lightest rim as a convex program in CVXPY, solved by Clarabel (docs/theory.md, The rim).

In a = R^2 and b = r^2, with the spin inertia I met with equality, the mass is 2 I / (a + b). All
limits are convex but two, wall and least height, whose feasible side lies under a convex function:

    wall:   b <= (sqrt(a) - t)^2          h_min:   a <= sqrt(Q + b^2)

The convex-concave procedure puts the tangent at the last solution in place of that function. A
tangent lies below it, so each solution is feasible, and none is heavier than the one before. Where
the solutions stop moving, the multipliers of the last convex program are those of the rim itself
(Yuille and Rangarajan, Neural Computation 15, 2003; Lipp and Boyd, Optim. Eng. 17, 2016).
"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_constraints import Constraint, RimConstraints
from ocs_design.sizing.rim_problem import RimProblem

if TYPE_CHECKING:
    from cvxpy import Problem

_SOLVER_OPTIONS = {"tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10, "tol_feas": 1e-10}
_STEP_TOLERANCE = 1e-8
_ITERATIONS_MAX = 50
# A multiplier below this belongs to a limit that does not bind; those that do are of order one.
_IDLE = 1e-6
_NEWTON_STEPS = 3
# Newton goes to a vertex that Clarabel may mean, or nowhere.
_POLISH_MAX = 1e-5
_ROUNDING = 1e-11


@dataclass(frozen=True)
class RimOptimum:
    """What the convex program found.

    Attributes:
        outer_radius, inner_radius: [m].
        mass: [kg].
        prices: change of the mass per change of each limit that is set [kg per SI unit].
        gap: primal less dual objective, over the primal one.
        iterations: of the convex-concave procedure.
        status: CVXPY's.
    """

    outer_radius: float
    inner_radius: float
    mass: float
    prices: Mapping[str, float]
    gap: float
    iterations: int
    status: str


def optimise_rim(problem: RimProblem, outer_radius: float, inner_radius: float) -> RimOptimum:
    """Improve on a feasible rim until nothing moves any more.

    Args:
        problem: of the rim.
        outer_radius, inner_radius: of any rim within the limits [m].
    """
    scale = outer_radius
    constraints = RimConstraints(problem, scale)
    program = _program(constraints)
    point = np.array([1.0, (inner_radius / scale) ** 2])
    step, iterations = np.inf, 0
    while step > _STEP_TOLERANCE and iterations < _ITERATIONS_MAX:
        last = point
        constraints.touch(*last)
        gap = _solve(program)
        point = constraints.point()
        step, iterations = np.abs(point - last).max(), iterations + 1
    point, multipliers = _polished(constraints)
    outer, inner = scale * np.sqrt(point)
    mass_scale = 2.0 * problem.spin_inertia / scale**2
    return RimOptimum(
        outer_radius=float(outer),
        inner_radius=float(inner),
        mass=float(mass_scale / point.sum()),
        prices={
            # Plus zero: an idle limit has the price 0, not -0.
            name: mass_scale * multiplier * float(constraints.by_name[name].derivative(*point))
            + 0.0
            for name, multiplier in multipliers.items()
        },
        gap=gap,
        iterations=iterations,
        status=str(program.status),
    )


def _polished(constraints: RimConstraints) -> tuple[FloatArray, dict[str, float]]:
    """The point and the multipliers with full digits, where Clarabel leaves about nine.

    Two limits that bind are two equations for the vertex (Newton), and the Lagrange condition two
    linear ones for their multipliers. Where more limits meet, the multipliers are not unique and
    Clarabel's stand. Idle limits have none.
    """
    found = {
        name: np.asarray(limit.convex.dual_value).item()
        for name, limit in constraints.by_name.items()
    }
    binding = [name for name, multiplier in found.items() if multiplier > _IDLE]
    limits = [constraints.by_name[name] for name in binding]
    point = _best_vertex(constraints, limits)
    if len(binding) == 2:
        exact = np.linalg.solve(_gradients(limits, point).T, np.full(2, point.sum() ** -2.0))
        found.update(zip(binding, map(float, exact), strict=True))
    return point, {name: found[name] if name in binding else 0.0 for name in found}


def _best_vertex(constraints: RimConstraints, binding: Sequence[Constraint]) -> FloatArray:
    """The lightest point next to Clarabel's that lies on two binding limits and within all."""
    point = constraints.point()
    vertices = [_vertex(pair, point) for pair in combinations(binding, 2)]
    feasible = [
        vertex
        for vertex in vertices
        if np.abs(vertex - point).max() < _POLISH_MAX
        and all(limit.value(*vertex) < _ROUNDING for limit in constraints.by_name.values())
    ]
    return max(feasible, key=np.sum, default=point)


def _vertex(limits: Sequence[Constraint], point: FloatArray) -> FloatArray:
    """The point next to this one where both limits bind."""
    for _ in range(_NEWTON_STEPS):
        values = np.array([limit.value(*point) for limit in limits])
        # Not `solve`: equal h_min and h_max are one equation twice.
        point = point - np.linalg.lstsq(_gradients(limits, point), values, rcond=None)[0]
    return point


def _gradients(limits: Sequence[Constraint], point: FloatArray) -> FloatArray:
    return np.array([limit.gradient(*point) for limit in limits])


def load_solver() -> None:
    """Import CVXPY, which takes a second, at a time of the caller's choice."""
    import_module("cvxpy")


def _program(constraints: RimConstraints) -> "Problem":
    cvxpy = import_module("cvxpy")
    mass = cvxpy.inv_pos(constraints.a + constraints.b)
    program: Problem = cvxpy.Problem(
        cvxpy.Minimize(mass), [limit.convex for limit in constraints.by_name.values()]
    )
    return program


def _solve(program: "Problem") -> float:
    """Solve in place; returns the relative gap between the primal and the dual objective."""
    # Not `program.solve()`, which throws the dual objective away.
    data, chain, inverse = program.get_problem_data("CLARABEL", solver_opts=_SOLVER_OPTIONS)
    raw = chain.solve_via_data(program, data, solver_opts=_SOLVER_OPTIONS)
    with warnings.catch_warnings():
        # An inaccurate solution shows in the gap and in the status.
        warnings.filterwarnings("ignore", message="Solution may be inaccurate")
        program.unpack_results(raw, chain, inverse)
    if program.status not in ("optimal", "optimal_inaccurate"):
        raise RuntimeError(
            f"Clarabel calls a rim {program.status} that has been built: {raw.status}"
        )
    return float(abs(raw.obj_val - raw.obj_val_dual) / abs(raw.obj_val))
