"""The lightest rim with housing: never heavier than any on a grid, and equally feasible."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from rims import random_problem, rim_problems, scaled_problem

from ocs_design.parts.module import Printed
from ocs_design.parts.rim import RimCuts
from ocs_design.sizing.bound.rim_problem import largest_spin_inertia, lightest_rim
from ocs_design.sizing.lightest_module import (
    lightest_module,
    lightest_module_at,
)

GRID = 350

SHELL = Printed(mount_reach=0.012)
"""Around small wheels its plate is as wide as the mount."""


def lightest_on_grid(inertia, limits):
    """Mass of the lightest module with this spin inertia on a grid of radii; inf if none."""
    outer = np.linspace(0.02, 1.0, GRID)[:, None] * limits.outer_radius_max
    inner = np.linspace(0.01, 1.0, GRID)[None, :-1] * outer
    disc = np.pi * limits.density * limits.web * inner**2
    web = disc * limits.web_weight
    rest = inertia - disc * inner**2 / 2.0 + limits.cuts.axial_inertia(inner, outer, limits.density)
    height = 2.0 * rest / (np.pi * limits.density * (outer**4 - inner**4))
    rim = 2.0 * rest / (outer**2 + inner**2) - limits.cuts.mass(inner, outer, limits.density)
    nu = limits.poisson_ratio
    stretch = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
    fits = (height <= limits.height_max) & (height >= limits.height_min)
    fits &= (outer - inner >= limits.wall_min) & (inner >= limits.inner_radius_min)
    fits &= (rim <= limits.mass_max) & (stretch <= limits.stretch_max)
    return np.where(fits, rim + web + SHELL.mass(outer, height), np.inf).min()


def with_web(limits, share, weight=1.0):
    """Limits with a web of a share of the least height, which is at least 0.1 mm."""
    height = max(limits.height_min, 1e-4) if share else limits.height_min
    return replace(limits, height_min=height, web=share * height, web_weight=weight)


LIGHTENED_WEIGHT = 0.9
"""Ratio of mass to spin inertia of a web with holes, relative to that of a disc."""


def check_within_limits(shape, inertia, limits):
    inner, outer, height = map(float, (shape.inner_radius, shape.outer_radius, shape.height))
    nu, slack = limits.poisson_ratio, 1.0 + 1e-9
    plain = np.pi * limits.density * height * (outer**2 - inner**2)
    mass = plain - limits.cuts.mass(inner, outer, limits.density)
    assert float(shape.rim_mass) == pytest.approx(mass, rel=1e-9)
    disc = np.pi * limits.density * limits.web * inner**2
    assert float(shape.web_mass) == pytest.approx(disc * limits.web_weight, rel=1e-9)
    spin = plain * (outer**2 + inner**2) / 2.0 + disc * inner**2 / 2.0
    spin -= limits.cuts.axial_inertia(inner, outer, limits.density)
    assert spin == pytest.approx(inertia, rel=1e-9)
    assert outer <= limits.outer_radius_max * slack
    assert limits.height_min <= height * slack
    assert height <= limits.height_max * slack
    assert outer - inner >= limits.wall_min - 1e-9 * outer
    assert inner * slack >= max(limits.inner_radius_min, 0.01 * outer)
    assert mass <= limits.mass_max * slack
    assert (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2 <= limits.stretch_max * slack


@pytest.mark.slow
@given(rim_problems())
def test_a_module_exists_where_a_rim_exists(problem):
    limits = replace(problem.limits, height_min=max(problem.limits.height_min, 1e-5))
    rim = lightest_rim(problem.spin_inertia, limits)
    shape = lightest_module(problem.spin_inertia, limits, SHELL)
    assert np.isnan(float(shape.mass)) == np.isnan(float(rim.mass))
    if float(shape.mass) > 0.0:
        check_within_limits(shape, problem.spin_inertia, limits)
        assert float(shape.rim_mass) >= float(rim.mass) * (1.0 - 1e-9)


@pytest.mark.slow
@settings(max_examples=30)
@given(rim_problems(), st.floats(0.01, 0.95), st.sampled_from([1.0, LIGHTENED_WEIGHT]))
def test_modules_with_a_web_are_within_limits_and_no_heavier_than_on_a_grid(problem, share, weight):
    limits = with_web(problem.limits, share, weight)
    # A rim with almost no wall around a light web has too few correct digits.
    assume(weight == 1.0 or limits.wall_min > 1e-3 * limits.outer_radius_max)
    shape = lightest_module(problem.spin_inertia, limits, SHELL)
    mass, grid = float(shape.mass), lightest_on_grid(problem.spin_inertia, limits)
    assert grid == np.inf or mass <= grid * (1.0 + 1e-9)
    if mass > 0.0:
        check_within_limits(shape, problem.spin_inertia, limits)


def with_cuts(limits, share, holes):
    """Limits with chamfers of a share of the largest radius, and holes that fit between."""
    smallest = 4.0 * share * limits.outer_radius_max
    wall, height = max(limits.wall_min, smallest), max(limits.height_min, smallest)
    cuts = RimCuts(share * limits.outer_radius_max, holes, 0.2 * wall, 0.3 * height)
    return replace(limits, wall_min=wall, height_min=height, cuts=cuts)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("web", "weight", "holes", "seed", "count"),
    [
        (0.0, 1.0, None, 3, 30),
        (0.6, LIGHTENED_WEIGHT, None, 3, 30),
        pytest.param(0.3, 1.0, None, 3, 30, marks=pytest.mark.exhaustive),
        pytest.param(0.3, LIGHTENED_WEIGHT, None, 3, 30, marks=pytest.mark.exhaustive),
        pytest.param(0.9, 1.0, None, 3, 30, marks=pytest.mark.exhaustive),
        # With chamfers and balancing holes, whose inertia the rim makes up for.
        (0.0, 1.0, 0, 11, 12),
        (0.3, 1.0, 6, 11, 12),
    ],
)
def test_no_module_on_a_grid_is_lighter(web, weight, holes, seed, count):
    rng = np.random.default_rng(seed)
    gaps = []
    for _ in range(count):
        problem = random_problem(rng)
        limits = with_web(problem.limits, web, weight)
        limits = limits if holes is None else with_cuts(limits, 0.005, holes)
        shape = lightest_module(problem.spin_inertia, limits, SHELL)
        grid = lightest_on_grid(problem.spin_inertia, limits)
        if np.isfinite(grid):
            if limits.cuts.any:
                check_within_limits(shape, problem.spin_inertia, limits)
            gaps.append(float(grid / shape.mass) - 1.0)
    assert len(gaps) > count / 3.0
    assert min(gaps) > -1e-12
    assert np.median(gaps) < 2e-3


WITHOUT_A_WALL = scaled_problem(
    size=0.0234375, slim=0.5, fill=1.0, bore=0.0, flat=0.5, wall=0.0, mass=np.inf, stress=100.0
)
"""Only the least height keeps its widest wheel from being all web."""


@pytest.mark.slow
@settings(max_examples=40)
@given(rim_problems(), st.sampled_from([0.0, 0.5]), st.sampled_from([1.0, LIGHTENED_WEIGHT]))
@example(WITHOUT_A_WALL, 0.5, 1.0)
def test_more_spin_inertia_is_no_lighter(problem, web, weight):
    inertia = problem.spin_inertia * np.geomspace(0.05, 1.0, 40)
    mass = lightest_module(inertia, with_web(problem.limits, web, weight), SHELL).mass
    mass = mass[np.isfinite(mass)]
    assert (np.diff(mass) >= -1e-9 * mass[1:]).all()


def test_modules_of_a_given_radius():
    """No other radius is lighter; the nearest is taken where none is feasible."""
    rng = np.random.default_rng(5)
    problem = random_problem(rng)
    while np.isnan(float(lightest_module(problem.spin_inertia, problem.limits, SHELL).mass)):
        problem = random_problem(rng)
    inertia, limits = problem.spin_inertia, problem.limits
    best = lightest_module(inertia, limits, SHELL)
    radii = best.outer_radius * np.geomspace(0.01, 100.0, 50)
    others = lightest_module_at(inertia, radii, limits, SHELL)
    assert (others.mass >= best.mass * (1.0 - 1e-12)).all()
    for index in (0, -1):
        check_within_limits(others.take(index), inertia, limits)


def test_no_rim_exceeds_the_largest_spin_inertia():
    rng, compared = np.random.default_rng(12), 0
    for _ in range(40):
        limits = with_web(random_problem(rng).limits, 0.3)
        largest = float(largest_spin_inertia(limits))
        inertias = largest * np.array([0.9, 0.99, 1.0 + 1e-6, 1.5, 10.0])
        exists = lightest_module(inertias, limits, SHELL).mass > 0.0
        assert not exists[2:].any()
        compared += int(exists[0])
    assert compared > 0


@pytest.mark.parametrize("web", [0.0, 0.5])
def test_infinite_limits_are_no_limits(web):
    """Hoop stress and mass, alone or together."""
    rng = np.random.default_rng(7)
    limits = with_web(random_problem(rng).limits, web)
    disc = np.pi * limits.density * limits.height_max * limits.outer_radius_max**4 / 2.0
    ample = replace(limits, mass_max=1e3 * disc / limits.outer_radius_max**2, stretch_max=1.0)
    for names in ([], ["stretch_max"], ["mass_max"], ["stretch_max", "mass_max"]):
        free = replace(ample, **dict.fromkeys(names, np.inf))
        shape, grid = lightest_module(0.4 * disc, free, SHELL), lightest_on_grid(0.4 * disc, free)
        assert float(shape.mass) <= grid < np.inf
