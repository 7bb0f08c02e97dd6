"""The lightest rim as a convex program in CVXPY, solved by Clarabel (docs/theory.md, The rim).

Variables are a = (R / s)^2 and b = (r / s)^2 with a scale s, so that both are of the order of one,
and limits that may be far away are divided by their own size; otherwise the solver loses digits. By
Lagrange, the sensitivity of the optimal mass to a limit is that of the constraint
g(a, b; limit) <= 0 times its multiplier. All limits are convex except wall and least height, which
are replaced by tangents at a given rim. At the optimum the program returns that rim, and its
multipliers are those of the rim itself (Lipp and Boyd, Optim. Eng. 17, 2016).
"""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia, hoop_weights
from ocs_design.sizing.bound.rim_problem import RimProblem, lightest_rim

if TYPE_CHECKING:
    from types import ModuleType

    from cvxpy import Constraint, Problem, Variable


class RimConstraint(NamedTuple):
    """One limit, g(a, b; limit) <= 0.

    Attributes:
        convex: the CVXPY constraint.
        derivative: of g with respect to the limit where it is active, at a given rim [1 / SI unit
            of the limit].
    """

    convex: "Constraint"
    derivative: float


def rim_constraints(
    problem: RimProblem, a: "Variable", b: "Variable", at: tuple[float, float], scale: float
) -> dict[str, RimConstraint]:
    """All limits of a rim that are set, by the specification's names.

    The derivative of the hoop stress is with respect to the allowed stress [1 / Pa].

    Args:
        problem: of the rim. a, b: variables of the program.
        at: values of a and b of the rim at which tangents are taken. scale: s [m].
    """
    cvxpy = import_module("cvxpy")
    room, inertia, density = problem.envelope, problem.spin_inertia, problem.material.density
    radius, bore = room.outer_radius_max / scale, room.inner_radius_min / scale
    wall, per_height = room.wall_min / scale, 2.0 * inertia / (np.pi * density * scale**4)
    outer_there, bore_there = np.sqrt(at[0]), at[1]
    # Difference a^2 - b^2 of the tallest rim.
    tall = per_height / room.height_max
    # The height limit is a second-order cone. The geometric mean of a - b and a + b would express
    # the same cone, but costs Clarabel four digits of the multipliers.
    norm = cvxpy.norm(cvxpy.hstack([b, np.sqrt(tall)]))
    by_height = -tall / (2.0 * room.height_max * np.hypot(bore_there, np.sqrt(tall)))
    limits = {
        "r_max": RimConstraint(a / radius**2 <= 1.0, -2.0 / room.outer_radius_max),
        "r_min": RimConstraint(b >= bore**2, 2.0 * bore / scale),
        "h_max": RimConstraint(norm <= a, by_height),
    }
    if room.wall_min > 0.0:
        # The tangent of (sqrt(a) - t)^2.
        widest = outer_there - wall
        tangent = widest**2 + widest / outer_there * (a - at[0])
        limits["wall_min"] = RimConstraint(b <= tangent, 2.0 * widest / scale)
    if room.height_min > 0.0:
        # The tangent of sqrt(Q + b^2), with the difference Q of the flattest rim.
        flat = per_height / room.height_min
        largest = np.hypot(bore_there, np.sqrt(flat))
        tangent = largest + bore_there / largest * (b - bore_there)
        limits["h_min"] = RimConstraint(a <= tangent, flat / (2.0 * room.height_min * largest))
    if np.isfinite(room.mass_max):
        least = 2.0 * inertia / (room.mass_max * scale**2)
        limits["wheel_mass_max"] = RimConstraint((a + b) / least >= 1.0, -1.0 / room.mass_max)
    if np.isfinite(problem.stretch_max):
        stretch = problem.stretch_max / scale**2
        outer, inner = hoop_weights(problem.material.poisson_ratio or 0.0)
        convex = a * (outer / stretch) + b * (inner / stretch) <= 1.0
        limits["hoop_stress"] = RimConstraint(convex, -1.0 / problem.hoop_stress_max)
    return limits


_SOLVER_OPTIONS = {"tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10, "tol_feas": 1e-10}
# A multiplier below this belongs to an inactive limit; those of active limits are of order one.
_IDLE = 1e-6


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
    """The lightest rim of the required spin inertia, which some rim within the limits must have.

    The closed form gives the numbers; the convex program must return the same rim and gives the
    multipliers.

    Raises:
        MissingToolError: CVXPY is not installed.
    """
    cvxpy = load_solver()
    inner, outer, height, mass = map(float, lightest_rim(problem.spin_inertia, problem.limits))
    scale, at = outer, (1.0, (inner / outer) ** 2)
    a, b = cvxpy.Variable(), cvxpy.Variable()
    limits = rim_constraints(problem, a, b, at, scale)
    constraints = [limit.convex for limit in limits.values()]
    program: Problem = cvxpy.Problem(cvxpy.Minimize(cvxpy.inv_pos(a + b)), constraints)
    gap = _solved_gap(program)
    mass_scale, prices = 2.0 * problem.spin_inertia / scale**2, {}
    residual = abs(mass_scale / np.sum([a.value, b.value]).item() / mass - 1.0)
    if residual > AGREEMENT:
        raise RuntimeError(
            f"closed form and convex program disagree by {residual:.1e} on {problem}"
        )
    for name, limit in limits.items():
        multiplier = np.asarray(limit.convex.dual_value).item()
        price = mass_scale * multiplier * float(limit.derivative)
        prices[name] = price if multiplier > _IDLE else 0.0
    density = problem.material.density
    return RimSolution(
        inner_radius=inner,
        outer_radius=outer,
        height=height,
        mass=mass,
        spin_inertia=cylinder_spin_inertia(inner, outer, height, density),
        transverse_inertia=cylinder_transverse_inertia(inner, outer, height, density),
        binding=tuple(name for name, price in prices.items() if price != 0.0),
        shadow_prices=prices,
        gap=gap,
        residual=residual,
        status=str(program.status),
        method=_METHOD,
    )
