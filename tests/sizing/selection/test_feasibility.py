"""Whether a problem is feasible: against the exhaustive selection."""

from dataclasses import replace

import numpy as np
import pytest
from selections import has_device, random_problem, with_radius

from ocs_design.sizing import advice
from ocs_design.sizing.advice import (
    ADVICE_PRECISION,
    is_conceivable,
    is_feasible,
    single_changes,
)
from ocs_design.sizing.limits import SUPPLY_POWER
from ocs_design.sizing.selection.candidates import Candidates, Guess, drives_of
from ocs_design.sizing.selection.fixed_point import solve_stepwise
from ocs_design.sizing.selection.problem import with_limit
from ocs_design.sizing.selection.refinement import refine
from ocs_design.sizing.selection.search import search

SEEDS = (9, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (0, *range(10, 30))))


@pytest.mark.slow
@pytest.mark.parametrize(
    "share", [0.6, *(pytest.param(s, marks=pytest.mark.exhaustive) for s in (0.4, 0.75, 0.85))]
)
@pytest.mark.parametrize("seed", SEEDS)
def test_feasibility_agrees_with_the_selection(seed, share):
    """From envelopes without feasible wheels to some with them."""
    narrow = with_radius(random_problem(seed), share)
    assert is_feasible(narrow) == has_device(narrow)


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", SEEDS)
def test_bounds_rule_out_nothing_that_is_possible(seed):
    problem = random_problem(seed)
    narrowed = [with_radius(problem, share) for share in np.linspace(0.1, 1.0, 10)]
    assert all(map(is_conceivable, filter(is_feasible, narrowed)))
    assert not is_conceivable(narrowed[0])


def test_the_search_stops_after_a_number_of_candidates(monkeypatch):
    tried = []

    def none_solved(candidates, guess):
        tried.append(len(candidates))
        return ()

    problem = random_problem(9)
    assert is_feasible(problem)
    monkeypatch.setattr(advice, "solve_stepwise", none_solved)
    assert not is_feasible(problem)
    total = sum(tried)
    tried.clear()
    monkeypatch.setattr(advice, "_MOST_SOLVED", 3)
    assert not is_feasible(problem)
    assert 3 <= sum(tried) < total


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", SEEDS)
def test_each_change_is_sufficient_and_nearly_the_smallest(seed):
    problems = (with_radius(random_problem(seed), share) for share in (0.3, 0.25, 0.2, 0.15))
    small = next(problem for problem in problems if not has_device(problem))
    changes = single_changes(small)
    for limit, value in changes.items():
        factor = (1.0 + 1.01 * ADVICE_PRECISION) ** (-1 if limit.loosens_upwards else 1)
        assert has_device(with_limit(small, limit, value))
        assert not has_device(with_limit(small, limit, value * factor))
    assert seed != 9 or "r_max" in {limit.name for limit in changes}


@pytest.mark.slow
def test_more_power_is_advised_where_only_power_lacks():
    problem = random_problem(9, motors=2)
    weak = with_limit(problem, SUPPLY_POWER, 100.0)
    assert is_feasible(problem)
    assert not is_feasible(weak)
    assert SUPPLY_POWER in single_changes(weak)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_no_device_is_lighter_than_its_own_bound(seed):
    """Nor are its wheels smaller, for all devices that the search solves."""
    state = search(random_problem(seed))
    state.refine(refine)
    for batch in state.batches:
        feasible = batch.point.feasible
        assert (batch.mass >= batch.guess.mass)[feasible].all()
        assert (batch.point.spin_inertia >= batch.guess.spin_inertia)[feasible].all()
    assert any(batch.point.feasible.any() for batch in state.batches)


@pytest.mark.slow
@pytest.mark.parametrize(
    "seed", [0, 21, *(pytest.param(s, marks=pytest.mark.exhaustive) for s in (3, 9, 12, 17, 20))]
)
def test_an_unranked_search_finds_the_first_of_the_ranking(seed):
    """To 0.1 % at a specified incidence; heavier devices than the mass limit are not searched."""
    problem = replace(random_problem(seed), incidence=0.6)
    ranked, unranked = search(problem), search(problem, ranked=False)
    assert bool(unranked.ranking) == bool(ranked.ranking)
    assert unranked.lightest == pytest.approx(ranked.lightest, rel=1e-3)
    assert not search(problem, 0.5 * unranked.lightest, ranked=False).ranking
    limited = search(problem, 1.01 * unranked.lightest, ranked=False)
    assert limited.lightest == pytest.approx(unranked.lightest, rel=1e-9)


@pytest.mark.parametrize("seed", [0, 1, 4, 5])
def test_devices_are_found_from_a_poor_incidence(seed):
    """From near 0 deg, where the wheels for most of these robots would be too large to be made."""
    problem = replace(random_problem(seed), incidence=None)
    pairs = np.array([(motor, gear) for motor in range(3) for gear in range(3)])
    drives = drives_of(problem, np.repeat(pairs, 2, axis=0))
    candidates = Candidates(problem, drives, np.tile([0, 1], len(pairs)))
    none = np.zeros(len(drives))

    def masses(incidence, width):
        guess = Guess(none + 1e-9, none, none + incidence, none + width)
        *_, solved = solve_stepwise(candidates, guess)
        return solved.mass

    at_each = [masses(np.radians(angle), 0.0) for angle in np.arange(2.5, 90.0, 5.0)]
    lightest = np.min(at_each, axis=0)
    exists = np.isfinite(lightest)
    assert exists.sum() > 3
    found = masses(np.radians(2.5), np.radians(5.0))
    assert (found[exists] < 1.03 * lightest[exists]).all()
