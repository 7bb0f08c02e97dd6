"""Steels of equal density give devices of equal mass: rounding must not decide between them."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from designed_devices import solo12_task
from selections import ALUMINIUM, random_problem

from ocs_design.catalogue.materials import Material, material
from ocs_design.device.layout import Criterion
from ocs_design.sizing.design import design_device
from ocs_design.sizing.selection.problem import SAME_MASS, devices_by_mass, lightest_first
from ocs_design.sizing.selection.search import search
from ocs_design.sizing.selection.select import select, select_by

STRONG = Material(
    name="strong", density=7833.0, yield_strength=621e6, ultimate_strength=827e6,
    poisson_ratio=0.32, source="for tests",
)  # fmt: skip
WEAK = Material(
    name="weak", density=7833.0, yield_strength=552e6, ultimate_strength=621e6,
    poisson_ratio=0.32, source="for tests",
)  # fmt: skip
ROUNDING = 1e-9
"""Relative change of a mass, larger than differences between processors."""
SEED, MOTORS = 1, 1


@pytest.fixture(params=(-ROUNDING, ROUNDING), ids=("lighter", "heavier"))
def steels(request):
    """Materials with the weaker steel first, slightly lighter or heavier than the stronger."""
    return replace(WEAK, density=WEAK.density * (1.0 + request.param)), ALUMINIUM, STRONG


def problem_of(steels, **changes):
    return replace(random_problem(SEED, MOTORS), materials=steels, **changes)


@pytest.mark.parametrize("incidence", [0.6, pytest.param(None, marks=pytest.mark.slow)])
def test_the_stronger_steel_leads_the_ranking(steels, incidence):
    selection = select(problem_of(steels, incidence=incidence))
    assert selection.best.material.name == "strong"
    twins = [
        (one.material.name, other.material.name)
        for one, other in zip(selection.ranking, selection.ranking[1:], strict=False)
        if other.mass == pytest.approx(one.mass, rel=10.0 * ROUNDING)
    ]
    assert twins
    assert set(twins) == {("strong", "weak")}


@pytest.mark.slow
def test_the_stronger_steel_leads_at_the_incidence_of_a_criterion(steels):
    problem = problem_of(steels, incidence=None)
    assert select_by(problem, Criterion.EQUAL_RATE).best.material.name == "strong"


def test_the_stronger_steel_is_found_by_an_unranked_search(steels):
    result = search(problem_of(steels, incidence=0.6), ranked=False)
    assert steels[result.ranking[0].parts[2]].name == "strong"


@pytest.mark.slow
def test_twins_are_equally_light_at_the_incidence_of_the_criterion():
    """Solo12's device is barely feasible: a step too far would end at a smaller radius."""
    design = design_device(solo12_task(motor__name="Antigravity MN5006 KV450"), ranked=False)
    strong, weak = material("steel-4140-qt"), material("steel-1045-normalized")
    for heavier in (-ROUNDING, ROUNDING):
        steels = replace(weak, density=weak.density * (1.0 + heavier)), strong
        problem = replace(design.choice.problem, materials=steels, incidence=None)
        best, second, *_ = select_by(problem, Criterion.EQUAL_RATE).ranking
        assert (best.material.name, second.material.name) == (strong.name, weak.name)
        assert second.mass == pytest.approx(best.mass, rel=10.0 * ROUNDING)


def test_a_lighter_device_leads_whatever_its_strength(steels):
    problem = problem_of(steels, incidence=0.6)
    twin = select(problem).best
    lighter = replace(twin, material=WEAK, height=twin.height * (1.0 - 1e-3))
    assert devices_by_mass([twin, lighter]) == [lighter, twin]


def test_equal_masses_are_within_a_tolerance_of_the_lightest():
    """No chain of small differences makes a heavy entry equal to a light one."""
    step = 0.6 * SAME_MASS
    masses = [1.0, 1.0 + step, 1.0 + 2.0 * step]
    entries = [SimpleNamespace(mass=mass, rank=-mass) for mass in masses]
    result = lightest_first(entries, lambda each: each.mass, lambda each: each.rank)
    assert [each.mass for each in result] == [masses[1], masses[0], masses[2]]
