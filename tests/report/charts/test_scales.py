"""Axes: ticks that people know, and ends that runs which broke down do not stretch."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.report.charts.chart import Axis, tick_text

ENDS = st.tuples(st.floats(-1e6, 1e6), st.floats(1e-6, 1e7))


@given(ENDS, st.sampled_from(["", "deg", "rpm"]))
def test_ticks_lie_on_the_axis_at_equal_round_distances(ends, unit):
    low, span = ends
    axis = Axis("x", unit, low, low + span)
    ticks = np.array(axis.ticks())
    slack = 1e-6 * span + 1e-9
    assert ((ticks >= low - slack) & (ticks <= low + span + slack)).all()
    assert len(ticks) <= 8
    if len(ticks) > 2:
        np.testing.assert_allclose(np.diff(ticks), np.diff(ticks)[0], rtol=1e-3, atol=1e-10)


def test_angles_have_ticks_that_people_know():
    assert Axis("pitch", "deg", -380.0, 20.0).ticks() == [-360.0, -270.0, -180.0, -90.0, 0.0]
    assert Axis("alpha", "deg", 0.0, 90.0).ticks() == [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0]


def test_a_logarithmic_axis_has_equal_ratios_at_equal_distances():
    axis = Axis("I", "kg m2", 1e-6, 1e-2, log=True)
    np.testing.assert_allclose(axis.parts(np.array([1e-6, 1e-4, 1e-2])), [0.0, 0.5, 1.0])
    np.testing.assert_allclose(axis.ticks(), [1e-6, 1e-5, 1e-4, 1e-3, 1e-2])


def test_a_narrow_logarithmic_axis_has_ticks_between_the_powers():
    np.testing.assert_allclose(Axis("I", "", 1.1e-5, 8e-5, log=True).ticks(), [2e-5, 5e-5])


def test_an_axis_is_not_empty_where_its_values_are_equal_or_none():
    for values in ([3.0, 3.0], [3.0, 3.0 + 1e-12], [0.0], [], [np.nan]):
        axis = Axis.around("x", "m", values)
        assert axis.low < axis.high
        assert len(axis.ticks()) > 1


def test_numbers_are_short_and_typeset():
    texts = {
        0.0: "0",
        -0.25: "\N{MINUS SIGN}0.25",
        20000.0: "20\N{THIN SPACE}000",
        1e-4: "10⁻⁴",
        5e-5: "5·10⁻⁵",
    }
    assert {value: tick_text(value) for value in texts} == texts


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf, 1.7e308, -1.7e308])
def test_what_is_beyond_measure_stretches_no_axis(odd):
    axis = Axis.around("tilt", "deg", [0.0, odd, 10.0, -odd])
    assert (axis.low, axis.high) == pytest.approx((-0.6, 10.6))
    assert axis.ticks()[-1] == 10.0
    parts = axis.parts(np.array([odd, 5.0]))
    assert np.isnan(parts[0]) or abs(parts[0]) <= 1e3
    assert parts[1] == pytest.approx(0.5)
