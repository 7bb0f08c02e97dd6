"""The closed form of the lightest rim against published cases and brute force."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from naive_wheel import Rims, solid
from rims import STEEL, paper_problem, random_problem

from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import RimCuts, cylinder_spin_inertia, hoop_stress
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
    """How far each point of the grid is outside the limits, relative; at most 0 inside.

    Straight from the definitions, with the height from the spin inertia.
    """
    room, rho = problem.envelope, problem.material.density
    a, b = outer**2, inner**2
    mass = 2.0 * problem.spin_inertia / (a + b)
    with np.errstate(divide="ignore"):
        height = mass / (np.pi * rho * (a - b))
    stress = hoop_stress(
        inner,
        outer,
        density=rho,
        poisson_ratio=problem.material.poisson_ratio,
        wheel_speed=problem.wheel_speed,
    )
    excess = np.maximum(height / room.height_max, mass / room.mass_max)
    np.maximum(excess, stress / problem.hoop_stress_max, out=excess)
    np.maximum(excess, room.height_min / height, out=excess)
    if room.wall_min > 0.0:
        np.maximum(excess, 2.0 - (outer - inner) / room.wall_min, out=excess)
    excess[np.broadcast_to(outer <= inner, excess.shape)] = np.inf
    return excess - 1.0, mass


def brute_force(problem):
    """The best mass on a grid of radii and on two finer ones around its best point.

    One grid of 500 points a side is not fine enough for 0.1 % of the mass of a thin ring. Where no
    point is within the limits, the least violation leads the way. Returns inf if none ever is.
    """
    room = problem.envelope
    bore, radius = room.inner_radius_min, room.outer_radius_max
    box = limits = [(bore + (radius - bore) / POINTS, radius), (bore, radius)]
    best = np.inf
    for _ in range(3):
        outer, inner = (np.linspace(*side, POINTS) for side in box)
        violation, mass = violations(problem, outer[:, np.newaxis], inner[np.newaxis, :])
        found = np.where(violation <= 0.0, mass, np.inf)
        score = found if np.isfinite(found).any() else violation
        at = np.unravel_index(score.argmin(), score.shape)
        best = min(best, found.min())
        center = np.array([outer[at[0]], inner[at[1]]])
        reach = 25.0 * np.array([outer[1] - outer[0], inner[1] - inner[0]])
        box = np.clip(np.stack([center - reach, center + reach], axis=1).T, *np.transpose(limits)).T
    return best


def touching(problem, shape):
    """Names of the limits that a rim lies on."""
    room = problem.envelope
    inner, outer, height, mass = (float(value) for value in shape)
    stress = hoop_stress(
        inner, outer, density=STEEL.density, poisson_ratio=0.3, wheel_speed=problem.wheel_speed
    )
    ratios = {
        "r_max": outer / room.outer_radius_max,
        "h_max": height / room.height_max,
        "h_min": height / room.height_min if room.height_min else np.inf,
        "wall_min": (outer - inner) / room.wall_min if room.wall_min else np.inf,
        "hoop_stress": stress / problem.hoop_stress_max,
        "wheel_mass_max": mass / room.mass_max,
    }
    return tuple(name for name, ratio in ratios.items() if abs(ratio - 1.0) < 1e-9)


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
        vertices[touching(problem, shape)] += 1
    # Every vertex that the derivation names was met, and many problems had no solution.
    expected = {
        ("r_max", "h_max"),
        ("r_max", "wall_min"),
        ("h_max", "hoop_stress"),
        ("wall_min", "hoop_stress"),
        ("h_min", "wall_min"),
    }
    assert set(vertices) == expected | {"none"}
    assert min(vertices.values()) >= 3, vertices


def test_many_at_once_equal_one_by_one():
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


def test_what_is_cut_off_the_smallest_rim_is_not_counted():
    """A chamfered ring as solid cylinders and cones, and blind holes one by one."""
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
    disc = solid(bore, web, limits.density)[1]
    drilled, own, _ = solid(cuts.hole_radius, cuts.hole_depth, limits.density)
    holes = 2 * cuts.holes * (own + drilled * (bore + wall / 2.0) ** 2)
    assert float(smallest_rim_inertia(limits)) == pytest.approx(ring + disc - holes, rel=1e-12)
