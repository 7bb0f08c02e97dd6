"""Whether a problem is feasible: against the exhaustive selection."""

from dataclasses import replace

import numpy as np
import pytest
from selections import has_device, random_problem, with_radius

from ocs_design.sizing import advice
from ocs_design.sizing.advice import ADVICE_PRECISION, Field, single_changes
from ocs_design.sizing.limits import BUS_VOLTAGE, RIM_LIMITS, TIME
from ocs_design.sizing.selection.problem import limits_of, with_limit
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
    assert Field.of(narrow).possible == has_device(narrow)


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", SEEDS)
def test_bounds_rule_out_nothing_that_is_possible(seed):
    problem = random_problem(seed)
    fields = [Field.of(with_radius(problem, share)) for share in np.linspace(0.1, 1.0, 10)]
    assert all(field.conceivable for field in fields if field.possible)
    assert not fields[0].conceivable


@pytest.mark.parametrize("limit", [RIM_LIMITS[0], BUS_VOLTAGE, TIME], ids=lambda limit: limit.name)
def test_a_changed_field_equals_a_new_one(limit):
    problem = random_problem(9, motors=1)
    now = limits_of(problem)[limit]
    changed = with_limit(problem, limit, limit.loosened(now, 1.3))
    kept, anew = Field.of(problem).changed(changed), Field.of(changed)
    assert kept.drives.gear.tolist() == anew.drives.gear.tolist()
    assert kept.needed == pytest.approx(anew.needed, rel=1e-14)
    stall = anew.drives.full_line.stall_torque
    assert kept.drives.full_line.stall_torque == pytest.approx(stall, rel=1e-14)


def test_the_search_stops_after_a_number_of_candidates(monkeypatch):
    tried = []

    def none_solved(candidates, guess):
        tried.append(len(candidates))
        return ()

    field = Field.of(random_problem(9))
    assert field.possible
    monkeypatch.setattr(advice, "solve_stepwise", none_solved)
    assert not field.possible
    total = sum(tried)
    tried.clear()
    monkeypatch.setattr(advice, "_MOST_SOLVED", 3)
    assert not field.possible
    assert 3 <= sum(tried) < total


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", SEEDS)
def test_each_change_is_sufficient_and_nearly_the_smallest(seed):
    problems = (with_radius(random_problem(seed), share) for share in (0.3, 0.25, 0.2, 0.15))
    small = next(problem for problem in problems if not has_device(problem))
    changes = single_changes(Field.of(small))
    for limit, value in changes.items():
        factor = (1.0 + 1.01 * ADVICE_PRECISION) ** (-1 if limit.loosens_upwards else 1)
        assert has_device(with_limit(small, limit, value))
        assert not has_device(with_limit(small, limit, value * factor))
    assert seed != 9 or "r_max" in {limit.name for limit in changes}


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
