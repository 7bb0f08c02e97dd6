"""Refinement of one candidate: from any nearby start the same device, or none."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from random_cases import random_case
from threadpoolctl import threadpool_limits

from ocs_design.sizing.lightest_module import ModuleShape
from ocs_design.sizing.selection.candidates import Candidates, drives_of
from ocs_design.sizing.selection.fixed_point import FixedPoint
from ocs_design.sizing.selection.refinement import Programme, coordinates, lightest, refine
from ocs_design.sizing.selection.select import select


@cache
def solved_case(seed):
    """A random problem and its lightest device."""
    problem = random_case(seed).problem
    return problem, select(problem).best


def candidates_of(problem, chosen):
    """The selected drive and material alone."""
    pair = np.array([[problem.motors.index(chosen.motor), problem.gears.index(chosen.gear)]])
    material = np.array([problem.materials.index(chosen.material)])
    return Candidates(problem, drives_of(problem, pair), material)


def start_near(chosen, factors, turn):
    """A start with scaled radii and height, and an incidence changed by `turn` [rad]."""
    bore, radius, height = factors
    sizes = (chosen.inner_radius * bore, chosen.outer_radius * radius, chosen.height * height)
    zero = np.zeros(1)
    return FixedPoint(
        spin_inertia=zero,
        radius=zero,
        angle=np.array([chosen.incidence + turn]),
        shapes=ModuleShape(*np.array([*sizes, 1.0, 0.0, 1.0])[:, None]),
        feasible=np.zeros(1, dtype=bool),
        margin=zero,
        residual=zero,
        iterations=np.zeros(1, dtype=int),
    )


@pytest.mark.parametrize(
    "seed", [2, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (15, 21, 53))]
)
@pytest.mark.parametrize(
    ("factors", "turn"),
    [((1.0, 1.0, 1.0), 0.0), ((0.97, 0.98, 0.95), 0.01), ((1.0, 1.02, 1.1), -0.02)],
)
def test_the_start_does_not_matter(seed, factors, turn):
    problem, chosen = solved_case(seed)
    turn = turn if problem.incidence is None else 0.0
    candidates = candidates_of(problem, chosen)
    refined = refine(candidates, start_near(chosen, factors, turn))
    assert refined.feasible.all()
    mass = 2.0 * (refined.shapes.mass[0] + candidates.drives.mass[0])
    assert mass == pytest.approx(chosen.mass, rel=1e-9)
    assert refined.margin[0] >= 1.0 - 1e-9
    assert refined.residual[0] < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 4])
def test_the_number_of_threads_does_not_matter(seed):
    """To the last digit, though rounding in libraries depends on the number of threads."""
    problem, chosen = solved_case(seed)
    candidates = candidates_of(problem, chosen)
    turn = 0.01 if problem.incidence is None else 0.0
    shapes = []
    for threads in (1, 2, 4):
        with threadpool_limits(limits=threads, user_api="blas"):
            shapes.append(refine(candidates, start_near(chosen, (0.97, 0.98, 0.95), turn)).shapes)
    for name in ("inner_radius", "outer_radius", "height"):
        assert len({getattr(shape, name).item() for shape in shapes}) == 1, name


def test_at_a_discontinuity_it_stops_early_with_the_best_point(monkeypatch):
    """A limit that no step satisfies, with a slope that says one would."""
    problem, chosen = solved_case(2)
    programme, points = Programme(candidates_of(problem, chosen)), []
    evaluation = Programme.evaluation

    def discontinuous(self, point, low, high):
        points.append(point)
        values = evaluation(self, point, low, high)
        violation = 1e-4 + np.abs(point - start).max()
        slopes = np.vstack([values.slopes, np.ones(point.size)])
        return values._replace(limits=np.append(values.limits, -violation), slopes=slopes)

    start = coordinates(chosen.outer_radius, chosen.height, chosen.inner_radius, chosen.incidence)
    monkeypatch.setattr(Programme, "evaluation", discontinuous)
    solution = lightest(programme, start)
    assert len(points) < 20
    np.testing.assert_array_equal(solution.point, start)
    assert solution.violation == pytest.approx(1e-4)


def test_an_infeasible_candidate_stays_infeasible():
    problem, chosen = solved_case(2)
    small = replace(problem.envelope, outer_radius_max=0.3 * problem.envelope.outer_radius_max)
    narrow = replace(problem, envelope=small)
    assert not refine(
        candidates_of(narrow, chosen), start_near(chosen, (1.0, 1.0, 1.0), 0.0)
    ).feasible


def test_specified_incidence_and_spin_inertia_are_kept():
    problem, chosen = solved_case(2)
    more = replace(problem.requirement, spin_inertia=1.1 * chosen.spin_inertia)
    specified = replace(problem, incidence=chosen.incidence, requirement=more)
    refined = refine(candidates_of(specified, chosen), start_near(chosen, (0.99, 1.0, 1.0), 0.0))
    assert refined.feasible.all()
    assert refined.angle[0] == chosen.incidence
    assert refined.spin_inertia[0] == pytest.approx(1.1 * chosen.spin_inertia, rel=1e-9)
