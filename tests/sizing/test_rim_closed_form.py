"""The closed form of the lightest rim against published cases and brute force."""

from collections import Counter
from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from naive_wheel import Rims, cylinder
from rims import STEEL, paper_problem, random_problem, utilization

from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import RimCuts, cylinder_spin_inertia
from ocs_design.sizing.bound.rim_problem import RimLimits, lightest_rim, smallest_rim_inertia

POINTS = 500


def shape_of(problem):
    return lightest_rim(problem.spin_inertia, problem.limits)


@pytest.mark.parametrize(
    ("spin_inertia", "outer_radius_max", "expected"),
    [
        (7.11e-5, 0.03, (0.021997, 0.030, 0.01, 0.10276)),
        (7.11e-5, 0.04, (0.037531, 0.040, 0.01, 0.04726)),
    ],
)
def test_theory_cases(spin_inertia, outer_radius_max, expected):
    shape = shape_of(paper_problem(spin_inertia, outer_radius_max, 0.01))
    assert np.array(shape) == pytest.approx(expected, abs=5e-6)


def violations(problem, outer, inner):
    """Relative violation of the limits at each grid point, at most 0 inside, and the mass."""
    mass = 2.0 * problem.spin_inertia / (outer**2 + inner**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        height = mass / (np.pi * problem.material.density * (outer**2 - inner**2))
        largest = reduce(np.maximum, utilization(problem, inner, outer, height, mass).values())
    return np.where(outer > inner, largest - 1.0, np.inf), mass


def brute_force(problem):
    """The least mass on a grid of radii and on two finer ones around its best point; inf if none.

    One grid of 500 x 500 points is too coarse for 0.1 % of the mass of a thin ring. Where no point
    is feasible, the next grid is around the least violation.
    """
    bore, radius = problem.envelope.inner_radius_min, problem.envelope.outer_radius_max
    box = limits = [(bore + (radius - bore) / POINTS, radius), (bore, radius)]
    best = np.inf
    for _ in range(3):
        outer, inner = (np.linspace(*side, POINTS) for side in box)
        violation, mass = violations(problem, outer[:, np.newaxis], inner[np.newaxis, :])
        feasible = np.where(violation <= 0.0, mass, np.inf)
        score = feasible if np.isfinite(feasible).any() else violation
        at = np.unravel_index(score.argmin(), score.shape)
        best = min(best, feasible.min())
        center = np.array([outer[at[0]], inner[at[1]]])
        reach = 25.0 * np.array([outer[1] - outer[0], inner[1] - inner[0]])
        box = np.clip(np.stack([center - reach, center + reach], axis=1).T, *np.transpose(limits)).T
    return best


def active_limits(problem, shape):
    """Names of the active limits of a rim."""
    ratios = utilization(problem, *map(float, shape))
    return {name for name, ratio in ratios.items() if abs(ratio - 1.0) < 1e-9 and name != "r_min"}


@pytest.mark.slow
def test_brute_force():
    rng = np.random.default_rng(20230123)
    vertices = Counter()
    for _ in range(200):
        problem = random_problem(rng)
        shape, by_grid = shape_of(problem), brute_force(problem)
        if np.isnan(shape.mass):
            assert np.isinf(by_grid), problem
            vertices["none"] += 1
            continue
        assert shape.mass <= by_grid * (1.0 + 1e-12), problem
        assert by_grid <= shape.mass * 1.001, problem
        inner, outer, height, mass = map(float, shape)
        spin = cylinder_spin_inertia(inner, outer, height, STEEL.density)
        assert spin == pytest.approx(problem.spin_inertia, rel=1e-10)
        assert cylinder_mass(inner, outer, height, STEEL.density) == pytest.approx(mass, rel=1e-10)
        vertices[" and ".join(sorted(active_limits(problem, shape)))] += 1
    # Each vertex of the derivation occurred, and many problems were infeasible.
    expected = {
        "h_max and r_max",
        "r_max and wall_min",
        "h_max and hoop_stress",
        "hoop_stress and wall_min",
        "h_min and wall_min",
    }
    assert set(vertices) == expected | {"none"}
    assert min(vertices.values()) >= 3, vertices


def test_arrays_and_single_problems_agree():
    rng = np.random.default_rng(7)
    problems = [random_problem(rng) for _ in range(100)]
    limits = [vars(problem.limits) for problem in problems]
    columns = {name: np.array([each[name] for each in limits]) for name in limits[0]}
    together = lightest_rim([problem.spin_inertia for problem in problems], RimLimits(**columns))
    one_by_one = np.array([shape_of(problem) for problem in problems])
    assert pytest.approx(one_by_one, rel=1e-14, nan_ok=True) == np.array(together).T


def test_shapes_broadcast():
    problem = paper_problem(7.11e-5, 0.03, 0.01)
    limits = replace(problem.limits, outer_radius_max=np.array([[0.03], [0.04]]))
    shape = lightest_rim([1e-5, 7.11e-5, 1.0], limits)
    assert {value.shape for value in shape} == {(2, 3)}
    assert np.isnan(shape.mass).tolist() == [[False, False, True]] * 2


def test_the_smallest_rim_inertia_is_where_feasibility_begins():
    rng = np.random.default_rng(11)
    met = 0
    for _ in range(300):
        problem = random_problem(rng)
        smallest = float(smallest_rim_inertia(problem.limits))
        wider = replace(problem, envelope=replace(problem.envelope, mass_max=np.inf))
        if smallest == 0.0 or np.isnan(lightest_rim(smallest * 1.001, wider.limits).mass):
            continue
        assert np.isnan(lightest_rim(smallest * 0.999, wider.limits).mass)
        assert lightest_rim(smallest * (1.0 + 1e-10), wider.limits).mass > 0.0
        met += 1
    assert met > 20


def test_chamfers_and_holes_reduce_the_smallest_rim_inertia():
    """Against solid cylinders and cones, and each blind hole."""
    bore, wall, height, web = 0.02, 0.008, 0.01, 0.001
    cuts = RimCuts(chamfer=1e-3, holes=8, hole_radius=1.25e-3, hole_depth=2e-3)
    limits = replace(
        paper_problem(1e-4, 0.05, 0.02).limits,
        inner_radius_min=bore,
        wall_min=wall,
        height_min=height,
        web=web,
        cuts=cuts,
    )
    ring = Rims(bore + wall, bore, height, limits.density, cuts.chamfer).body[1]
    disc = cylinder(bore, web, limits.density)[1]
    hole_mass, hole_inertia, _ = cylinder(cuts.hole_radius, cuts.hole_depth, limits.density)
    holes = 2 * cuts.holes * (hole_inertia + hole_mass * (bore + wall / 2.0) ** 2)
    assert float(smallest_rim_inertia(limits)) == pytest.approx(ring + disc - holes, rel=1e-12)
