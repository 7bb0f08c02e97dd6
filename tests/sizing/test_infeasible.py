"""Infeasible problems: conflicting limits, largest spin inertia, and relaxations."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from rims import PAPER_STEEL, STEEL, envelope_with, paper_problem, rim_problems

from ocs_design.common.errors import Infeasible
from ocs_design.device.layout import Criterion
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_sizing import (
    DeviceProblem,
    conflicting_limits,
    is_feasible,
    largest_spin_inertia,
    size_device,
)
from ocs_design.sizing.bound.rim_problem import RimProblem, lightest_rim
from ocs_design.sizing.bound.rim_program import solve_rim
from ocs_design.sizing.limits import LARGEST_CHANGE, RIM_LIMITS

BY_NAME = {limit.name: limit for limit in RIM_LIMITS}
few_examples = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


def failure(problem):
    """The error for a device whose wheels' spin inertia is specified."""
    requirement = Requirement((), None, problem.wheel_speed, problem.spin_inertia, 0.25)
    robot = MassProperties(2.5, np.zeros(3), 0.05 * np.eye(3))
    device = DeviceProblem(
        robot, requirement, problem.envelope, problem.material,
        lambda *_: np.array([[0.0, 0.07, 0.1], [0.0, -0.07, 0.1]]), 0.7, Criterion.EQUAL_RATE,
    )  # fmt: skip
    with pytest.raises(Infeasible) as caught:
        size_device(device)
    return caught.value


def limit_value(problem, name, value):
    """Value of the limit for a relaxation: for a hoop stress, the safety that allows it."""
    return problem.material.yield_strength / value if name == "hoop_stress" else value


def test_theory_case():
    error = failure(paper_problem(7.11e-4, 0.03, 0.01))
    assert error.binding == ("r_max", "h_max")
    assert error.required_spin_inertia == 7.11e-4
    assert error.largest_spin_inertia == pytest.approx(1.0001e-4, abs=5e-9)
    assert error.relaxations == pytest.approx({"h_max": 0.0711, "r_max": 0.0490}, abs=5e-5)
    # h_max in closed form: a disc of the required inertia.
    height = 2.0 * 7.11e-4 / (np.pi * PAPER_STEEL.density * 0.03**4)
    assert error.relaxations["h_max"] == pytest.approx(height, rel=1e-6)
    assert "r_max 30 mm and h_max 10 mm" in error.message
    assert "1.0001e-04 kg m^2" in error.message or "0.00010001 kg m^2" in error.message
    assert error.hint.startswith("Any one of these alone would do: r_max 49 mm; h_max 71.1 mm.")


def test_an_error_survives_the_way_out_of_another_process():
    """A pool that could not unpickle it broke, or waited forever."""
    error = failure(paper_problem(7.11e-4, 0.03, 0.01))
    error.assumptions = ("24 V",)
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.hint) == (type(error), str(error), error.hint)
    assert (again.data(), again.exit_code) == (error.data(), 4)


def test_bore_and_wall_that_leave_no_rim():
    problem = RimProblem(
        1e-5, envelope_with(0.03, 0.01, inner_radius_min=0.029, wall_min=0.002), STEEL, 100
    )
    error = failure(problem)
    assert set(error.binding) == {"r_max", "r_min", "wall_min"}
    assert error.largest_spin_inertia == 0.0
    expected = {"r_max": 0.031, "r_min": 0.028, "wall_min": 0.001}
    assert error.relaxations == pytest.approx(expected, rel=1e-6)
    assert "no rim at all" in error.message.lower()


def test_less_than_the_smallest_rim():
    limits = envelope_with(0.03, 0.01, inner_radius_min=0.02, wall_min=0.002, height_min=0.002)
    error = failure(RimProblem(1e-7, limits, STEEL, 100.0))
    assert set(error.binding) == {"r_min", "h_min", "wall_min"}
    smallest = np.pi * STEEL.density * 0.002 * (0.022**4 - 0.020**4) / 2.0
    assert error.relaxations["h_min"] == pytest.approx(0.002 * 1e-7 / smallest, rel=2e-6)
    assert f"{smallest:.5g}" in error.message


def test_hoop_stress_names_safety_and_strength():
    limits = envelope_with(0.03, 0.01, inner_radius_min=0.005, stress_safety=4.0)
    error = failure(RimProblem(7.11e-5, limits, STEEL, 4500.0))
    assert "hoop_stress" in error.binding
    allowed = error.relaxations["hoop_stress"]
    assert allowed > STEEL.yield_strength / 4.0
    safety = STEEL.yield_strength / allowed
    assert f"stress_safety {np.floor(safety * 100) / 100:g}" in error.hint
    assert f"yields at {np.ceil(4.0 * allowed / 1e6):g} MPa" in error.hint


def test_hoop_stress_beyond_the_material_names_a_yield_strength():
    error = failure(
        RimProblem(7.11e-5, envelope_with(0.03, 0.01, stress_safety=1.2), STEEL, 9000.0)
    )
    assert "stress_safety" not in error.hint
    assert "a material that yields at" in error.hint


def test_no_single_relaxation_is_enough():
    error = failure(RimProblem(1e3, envelope_with(0.03, 0.01, mass_max=0.1), STEEL, 100.0))
    assert error.relaxations == {}
    assert "No single change within reason would do: loosen" in error.hint


@few_examples
@given(rim_problems())
@pytest.mark.exhaustive
def test_each_relaxation_is_the_smallest(problem):
    assume(not is_feasible(problem))
    error = failure(problem)
    for name, relaxed in error.relaxations.items():
        limit, value = BY_NAME[name], limit_value(problem, name, relaxed)
        solve_rim(problem.with_limit(limit, value))
        tighter = limit.loosened(value, 1.0 / (1.0 + 3e-6))
        assert not is_feasible(problem.with_limit(limit, tighter))
    for limit in RIM_LIMITS:
        if limit.name not in error.relaxations:
            loose = limit.loosened(limit.value(problem.envelope), LARGEST_CHANGE)
            assert not is_feasible(problem.with_limit(limit, loose))


@few_examples
@given(rim_problems())
def test_conflict_is_minimal(problem):
    """Without all other limits no rim is feasible; without any one of the conflict, one is."""
    assume(not is_feasible(problem))
    conflict = conflicting_limits(problem)
    assert conflict
    for limit in RIM_LIMITS:
        if limit not in conflict:
            problem = problem.with_limit(
                limit, limit.loosened(limit.value(problem.envelope), LARGEST_CHANGE)
            )
    assert not is_feasible(problem)
    for limit in conflict:
        loose = limit.loosened(limit.value(problem.envelope), LARGEST_CHANGE)
        assert is_feasible(problem.with_limit(limit, loose))


@few_examples
@given(rim_problems())
def test_largest_spin_inertia_is_where_feasibility_ends(problem):
    largest = largest_spin_inertia(problem)
    spins = np.geomspace(1e-12, 10.0, 2000)
    feasible = ~np.isnan(lightest_rim(spins, problem.limits).mass)
    if largest == 0.0:
        assert not feasible.any()
        return
    assert is_feasible(replace(problem, spin_inertia=largest))
    assert not is_feasible(replace(problem, spin_inertia=largest * (1.0 + 1e-9)))
    assert spins[feasible].max(initial=0.0) <= largest
    # The feasible set is one interval, as the docstring says.
    assert np.count_nonzero(np.diff(feasible.astype(int)) == 1) <= 1
