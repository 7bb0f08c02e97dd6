"""The search for the smallest change of a limit, and rounded figures."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.common.units import round_outwards
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.limits import RIM_LIMITS, TOP_SPEED, smallest_changes

BY_NAME = {limit.name: limit for limit in (*RIM_LIMITS, TOP_SPEED)}


PRECISION = 1e-6


def smallest_change(limit, now, mends):
    """Smallest change of one limit; None if no change is enough."""
    changes = smallest_changes({limit: now}, lambda _, value: mends(value), precision=PRECISION)
    return changes.get(limit)


@given(st.floats(1e-3, 1e3), st.floats(1.0001, 900.0))
def test_smallest_change_finds_the_edge(now, factor):
    upper = smallest_change(BY_NAME["r_max"], now, lambda value: value >= now * factor)
    assert now * factor <= upper <= now * factor * (1.0 + PRECISION)
    lower = smallest_change(BY_NAME["r_min"], now, lambda value: value <= now / factor)
    assert now / factor >= lower >= now / factor * (1.0 - PRECISION)


def test_changes_beyond_a_factor_of_a_thousand_are_not_searched():
    assert smallest_change(BY_NAME["h_max"], 0.01, lambda value: value >= 20.0) is None


@pytest.mark.parametrize("now", [0.0, float("inf")])
def test_absent_limits_cannot_be_loosened(now):
    assert smallest_change(BY_NAME["wheel_mass_max"], now, lambda _: True) is None


def test_the_nearest_edge_of_a_window_is_found():
    nearest = smallest_change(BY_NAME["r_max"], 1.0, lambda value: 2.0 <= value <= 3.0)
    assert nearest == pytest.approx(2.0, rel=PRECISION)


def test_the_smallest_change_comes_first():
    edges = {BY_NAME["r_max"]: 3.0, BY_NAME["wall_min"]: 0.5, BY_NAME["h_max"]: 1e6}

    def feasible(limit, value):
        return value >= edges[limit] if limit.loosens_upwards else value <= edges[limit]

    changes = smallest_changes(dict.fromkeys(edges, 1.0), feasible, precision=PRECISION)
    assert [limit.name for limit in changes] == ["wall_min", "r_max"]


@given(st.floats(1e-6, 1e6))
def test_rounding_outwards(value):
    up, down = round_outwards(value, upwards=True), round_outwards(value, upwards=False)
    assert down * (1.0 - 1e-6) <= value <= up * (1.0 + 1e-6)
    assert up - down <= 0.0101 * value
    assert len(f"{up:.6g}".replace(".", "").strip("0").split("e")[0]) <= 3


def test_figures_with_few_digits_are_not_changed():
    for upwards in (True, False):
        assert round_outwards(0.3, upwards=upwards) == pytest.approx(0.3, rel=1e-15)
        assert round_outwards(20.0, upwards=upwards) == 20.0


def test_texts():
    assert BY_NAME["r_max"].text(0.03) == "r_max 30 mm"
    assert BY_NAME["r_max"].loose_text(0.04898713) == "r_max 49 mm"
    assert BY_NAME["r_min"].loose_text(0.0069399) == "r_min 6.93 mm"
    assert BY_NAME["wheel_mass_max"].loose_text(0.1027556) == "wheel_mass_max 103 g"
    assert BY_NAME["hoop_stress"].text(2.0) == "stress_safety 2"
    assert TOP_SPEED.text(753.9822368615503) == "wheel_speed_max 7200 rpm"


def test_every_limit_of_the_envelope_is_named():
    assert {limit.field for limit in RIM_LIMITS} == set(Envelope.__dataclass_fields__)
