"""Mass prices of limits, against a new selection with the looser limit."""

from dataclasses import replace

import pytest
from random_cases import random_case

from ocs_design.sizing.limits import BUS_VOLTAGE, LIMITS, TIME
from ocs_design.sizing.selection.problem import with_limit
from ocs_design.sizing.selection.refinement import mass_prices
from ocs_design.sizing.selection.select import select

SEED = 5
"""Seed of a device limited by radius, voltage and time, but not by height."""

CHECKED_LIMITS = {"r_max", "h_max", "bus_voltage", "time"}


@pytest.fixture(scope="module")
def priced():
    """The problem of the lightest drive alone, its device, and the price of each limit."""
    problem = random_case(SEED).problem
    best = select(problem).best
    alone = replace(problem, motors=(best.motor,), gears=(best.gear,), materials=(best.material,))
    return alone, best, tuple(mass_prices(problem, best))


@pytest.mark.slow
def test_a_price_is_what_a_new_selection_saves(priced):
    alone, best, prices = priced
    for price in (price for price in prices if price.limit in CHECKED_LIMITS):
        looser = select(with_limit(alone, LIMITS[price.limit], price.changed)).best
        saved = looser.mass - best.mass
        assert price.mass_change == pytest.approx(saved, rel=1e-4, abs=1e-6 * best.mass), price


def test_every_limit_is_loosened_and_none_adds_mass(priced):
    _, _, prices = priced
    assert {BUS_VOLTAGE.name, TIME.name} <= {price.limit for price in prices}
    for price in prices:
        assert (price.changed > price.value) == LIMITS[price.limit].loosens_upwards
        assert price.mass_change <= 0.0


def test_only_active_limits_have_a_price(priced):
    _, _, prices = priced
    saving = {price.limit for price in prices if price.mass_change < 0.0}
    assert saving == CHECKED_LIMITS - {"h_max"}
