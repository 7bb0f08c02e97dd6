"""The convex program: against the closed form, and its shadow prices."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from rims import (
    PAPER_STEEL,
    envelope_with,
    paper_problem,
    random_problem,
    rim_problems,
    utilization,
)

from ocs_design.common.errors import UsageError
from ocs_design.sizing.bound.rim_problem import RimProblem, check_limits, lightest_rim
from ocs_design.sizing.bound.rim_program import load_solver, rim_constraints, solve_rim
from ocs_design.sizing.limits import RIM_LIMITS

STEP = 1e-6
few_examples = settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))


def mass_of(problem):
    return float(lightest_rim(problem.spin_inertia, problem.limits).mass)


def test_theory_case():
    solution = solve_rim(paper_problem(7.11e-5, 0.03, 0.01))
    assert solution.inner_radius == pytest.approx(0.021997, abs=5e-7)
    assert solution.mass == pytest.approx(0.10276, abs=5e-6)
    assert solution.transverse_inertia == pytest.approx(3.640e-5, abs=1e-8)
    assert solution.binding == ("r_max", "h_max")
    assert solution.shadow_prices["r_max"] == pytest.approx(-12.74, abs=5e-3)
    assert solution.shadow_prices["r_min"] == 0.0
    assert solution.status == "optimal"
    assert solution.gap < 1e-9
    assert solution.residual < 1e-9


def test_random_problems_agree_with_the_closed_form():
    rng = np.random.default_rng(3)
    solved = 0
    while solved < 30:
        problem = random_problem(rng)
        if np.isnan(mass_of(problem)):
            continue
        solution = solve_rim(problem)
        assert solution.residual < 1e-8, problem
        assert solution.gap < 1e-8, problem
        assert solution.spin_inertia == pytest.approx(problem.spin_inertia, rel=1e-10)
        assert set(solution.binding) <= set(solution.shadow_prices)
        solved += 1


@few_examples
@given(rim_problems())
def test_shadow_prices_are_finite_differences(problem):
    mass = mass_of(problem)
    assume(not np.isnan(mass))
    prices = solve_rim(problem).shadow_prices
    for limit in RIM_LIMITS:
        value = limit.value(problem.envelope)
        if limit.name not in prices or value == 0.0:
            continue
        below, above = (
            mass_of(replace(problem, envelope=limit.replaced(problem.envelope, value * factor)))
            for factor in (1.0 - STEP, 1.0 + STEP)
        )
        # At a kink, where a third limit meets the vertex, there is no derivative.
        assume(abs((above - mass) - (mass - below)) < 1e-3 * abs(above - below) + 1e-13 * mass)
        difference = (above - below) / (2.0 * STEP)
        if limit.name == "hoop_stress":  # d(stress) / stress = -d(safety) / safety
            value = -problem.hoop_stress_max
        assert prices[limit.name] * value == pytest.approx(difference, rel=1e-4, abs=1e-7 * mass)


@few_examples
@given(rim_problems())
def test_loosening_a_limit_saves_mass_only_if_it_is_active(problem):
    mass = mass_of(problem)
    assume(not np.isnan(mass))
    binding = solve_rim(problem).binding
    assume(len(binding) == 2)
    for limit in RIM_LIMITS:
        value = limit.value(problem.envelope)
        loose = limit.replaced(problem.envelope, limit.loosened(value, 1.01))
        saved = mass - mass_of(replace(problem, envelope=loose))
        if limit.name in binding:
            assert saved > 1e-7 * mass
        else:
            assert saved < 1e-5 * mass


@pytest.mark.parametrize(
    "problem",
    [
        replace(
            paper_problem(7.11e-5, 0.03, 0.01), envelope=envelope_with(0.03, 0.01, height_min=0.01)
        ),
        replace(
            paper_problem(7e-5, 0.03, 0.01),
            envelope=envelope_with(
                0.03, 0.01, inner_radius_min=0.02, wall_min=0.01, height_min=0.002
            ),
        ),
        paper_problem(1.00006e-4, 0.03, 0.01),
        paper_problem(1e-12, 0.03, 0.01),
        paper_problem(1e-5, 1e6, 0.01),
    ],
    ids=["one height", "one bore", "nearly a disc", "tiny", "huge radius"],
)
def test_extreme_limits_are_solved(problem):
    solution = solve_rim(problem)
    assert solution.residual < 1e-7
    assert solution.status in ("optimal", "optimal_inaccurate")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wheel_speed": -1.0}, "wheel_speed_max"),
        ({"envelope": envelope_with(0.0, 0.01)}, "outer_radius_max"),
        ({"envelope": envelope_with(0.03, float("nan"))}, "height_max"),
        ({"envelope": envelope_with(0.03, 0.01, wall_min=-1e-3)}, "wall_min"),
        ({"envelope": envelope_with(0.03, 0.01, mass_max=float("nan"))}, "mass_max"),
        ({"envelope": envelope_with(0.03, 0.01, stress_safety=0.0)}, "stress_safety"),
    ],
)
def test_invalid_limits_are_refused(change, message):
    valid = {
        "envelope": envelope_with(0.03, 0.01),
        "material": PAPER_STEEL,
        "wheel_speed": 754.0,
    }
    with pytest.raises(UsageError, match=message):
        check_limits(**(valid | change))
    check_limits(**valid)
    assert RimProblem(7e-5, **valid).hoop_stress_max == float("inf")


@few_examples
@given(rim_problems(), st.floats(0.3, 1.5), st.floats(0.0, 0.95))
def test_constraints_are_violated_where_the_rim_violates_the_limits(problem, share, bore):
    """Inactive limits too, which neither prices nor optimum show."""
    limits = problem.envelope
    outer = share * limits.outer_radius_max
    inner = bore * outer
    # The constraint on the wall is in b = r^2, and undefined for R below the wall.
    assume(outer > limits.wall_min)
    mass = 2.0 * problem.spin_inertia / (outer**2 + inner**2)
    height = mass / (np.pi * problem.material.density * (outer**2 - inner**2))
    over = utilization(problem, inner, outer, height, mass)
    scale = limits.outer_radius_max
    a, b = (load_solver().Variable(value=(radius / scale) ** 2) for radius in (outer, inner))
    for name, constraint in rim_constraints(problem, a, b, (a.value, b.value), scale).items():
        if abs(over[name] - 1.0) > 1e-9:
            assert (constraint.convex.violation() > 0.0) == (over[name] > 1.0), name
