"""The lightest rim: the answer to a `RimProblem`, with its proof."""

from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia
from ocs_design.sizing.bound.rim_problem import RimProblem, lightest_rim
from ocs_design.sizing.bound.rim_program import optimise_rim
from ocs_design.sizing.relaxation import infeasible_rim

AGREEMENT = 1e-7
"""Largest relative difference in mass between the convex program and the closed form."""

_METHOD = "convex program (CVXPY, Clarabel), vertex in closed form"


@dataclass(frozen=True)
class RimSolution:
    """The lightest hollow cylinder within the limits.

    Attributes:
        inner_radius, outer_radius, height: of the vertex in closed form, to full digits [m].
        mass: [kg]. spin_inertia, transverse_inertia: [kg m^2].
        binding: names of the limits that hold the mass up.
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
    """The lightest rim of the spin inertia asked for.

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
