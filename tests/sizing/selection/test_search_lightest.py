"""The search for the lightest device alone, beside the one that ranks."""

from dataclasses import replace

import pytest
from selections import random_problem

from ocs_design.sizing.selection.search import search, search_lightest

SEEDS = (0, 21, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (3, 9, 12, 17, 20)))
ABOUT = 1e-3
"""To which it is not refined at a stated incidence."""


@pytest.mark.parametrize("seed", SEEDS)
def test_it_is_the_first_of_the_ranking(seed):
    problem = replace(random_problem(seed), incidence=0.6)
    ranked, found = search(problem), search_lightest(problem)
    assert bool(found.places) == bool(ranked.places)
    assert found.lightest == pytest.approx(ranked.lightest, rel=ABOUT)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_heavier_than_asked_for_is_not_looked_for(seed):
    problem = replace(random_problem(seed), incidence=0.6)
    lightest = search_lightest(problem).lightest
    assert not search_lightest(problem, below=0.5 * lightest).places
    near = search_lightest(problem, below=1.01 * lightest)
    assert near.lightest == pytest.approx(lightest, rel=1e-9)
