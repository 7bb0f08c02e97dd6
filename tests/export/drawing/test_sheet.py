"""The drawing's sheet: text, scale, tolerances and balance of a wheel."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_parts import RIM_ALONE, TWO_PIECES
from wheel_drawings import FLAT

from ocs_design.device.joints import permissible_eccentricity
from ocs_design.export.drawing.sheet import (
    SPACING,
    Lettering,
    Scale,
    hatching,
    largest_scale,
    printable,
)
from ocs_design.export.drawing.wheel import BROKEN_EDGE, lost_by_breaking, plus_minus
from ocs_design.export.drawing.wheel_sheet import wheel_sheet
from ocs_design.parts.joints import Grade, tolerance_width
from ocs_design.parts.rim import NO_CUTS


def test_a_capital_is_as_high_as_told_and_as_wide_as_the_font_has_it():
    """Helvetica's M is 833 thousandths of the font's size wide, and its capitals are 718 high."""
    assert Lettering((0.0, 0.0), "M", 7.18).width == pytest.approx(8.33)


def test_what_can_be_encoded_is_printable_and_all_else_a_question_mark():
    for code in range(0xA0, 0x100):
        assert printable(chr(code)) == chr(code)
    assert printable("a机\n≤\x7f\x81?") == "a?????" + "?"


LETTER_T = [(1, 2), (31, 2), (31, 12), (21, 12), (21, 42), (11, 42), (11, 12), (1, 12)]


def inside(point, corners):
    """By the winding of the angles to the corners."""
    x, y = point
    turn = 0.0
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        step = math.atan2(y1 - y, x1 - x) - math.atan2(y0 - y, x0 - x)
        turn += (step + math.pi) % (2.0 * math.pi) - math.pi
    return abs(turn) > math.pi


@pytest.mark.parametrize("mirrored", [False, True])
def test_lines_are_inside_and_as_long_as_the_area_asks(mirrored):
    lines = hatching(LETTER_T, mirrored=mirrored)
    for line in lines:
        (x0, y0), (x1, y1) = line.start, line.end
        for part in (0.05, 0.3, 0.5, 0.8, 0.95):
            assert inside((x0 + part * (x1 - x0), y0 + part * (y1 - y0)), LETTER_T)
    length = sum(math.dist(line.start, line.end) for line in lines)
    assert length * SPACING == pytest.approx(600.0, rel=0.03)


def test_neighbouring_faces_share_their_lines():
    left, right = [(0, 0), (10, 0), (10, 20), (0, 20)], [(10, 0), (25, 0), (25, 20), (10, 20)]
    whole = [(0, 0), (25, 0), (25, 20), (0, 20)]
    parts = sum(math.dist(each.start, each.end) for each in hatching(left) + hatching(right))
    assert parts == pytest.approx(sum(math.dist(a.start, a.end) for a in hatching(whole)))


def test_the_largest_scale_of_the_standard_at_which_all_fit_and_the_smallest_if_none_does():
    assert str(largest_scale((0.3, 61.0))) == "1:5"
    assert str(largest_scale((0.3, 61.0), (0.001, 0.05))) == "1:20"
    assert str(largest_scale((0.001, 600.0))) == "500:1"
    assert str(largest_scale((0.3, 76.0), standard=False)) == "1:4"
    assert largest_scale((1.0, 0.0)).paper == 1
    assert (Scale(2, 1)(0.01), Scale(1, 5)(0.1), Scale(1, 5).length(20.0)) == (20.0, 20.0, 0.1)


STEPS = [3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000]
UNITS = {Grade.IT7: 16.0, Grade.IT9: 40.0, Grade.IT11: 100.0, Grade.IT12: 160.0}


def unit(low, high):
    """Standard tolerance factor [um] at the geometric mean of a step [mm] (ISO 286-1, annex)."""
    mean = (low * high) ** 0.5
    return 0.45 * mean ** (1.0 / 3.0) + 0.001 * mean if high <= 500 else 0.004 * mean + 2.1


@pytest.mark.parametrize("grade", UNITS)
def test_widths_are_the_rounded_multiples_of_the_tolerance_factor(grade):
    for low, high in pairwise(STEPS):
        expected = UNITS[grade] * unit(low, high)
        assert 1e6 * tolerance_width(1e-3 * high, grade) == pytest.approx(expected, rel=0.05)


def test_the_upper_end_belongs_to_its_step():
    # H7: 15 um over 6 up to and including 10 mm, 18 um beyond.
    assert tolerance_width(0.010, Grade.IT7) == pytest.approx(15e-6)
    assert tolerance_width(0.01001, Grade.IT7) == pytest.approx(18e-6)


@given(st.floats(1e-4, 5.0), st.sampled_from(list(Grade)))
def test_what_is_written_is_within_the_grade_but_not_below_a_hundredth(size, grade):
    half = tolerance_width(size, grade) / 2.0
    written = plus_minus(size, grade)
    assert 1e5 * written == pytest.approx(round(1e5 * written))
    assert written == pytest.approx(1e-5) or half - 1e-5 < written <= half + 1e-12


def test_balance_of_the_example_in_the_handbooks():
    # G 6.3 at 3000 rpm: 20 um, or 20 g mm for each kilogram (ISO 21940-11, figure 2).
    speed = 3000.0 * 3.141592653589793 / 30.0
    assert 1e6 * permissible_eccentricity(speed) == pytest.approx(20.0, rel=0.01)


@pytest.mark.parametrize("wheel", [RIM_ALONE, TWO_PIECES])
def test_four_rings_of_triangles_are_lost(wheel):
    """Two legs of c, so c^2 / 2 each, turned about the axis at c / 3 off the edges."""
    rim, c = wheel.rim, BROKEN_EDGE
    rings = np.array([rim.outer_radius - c / 3.0, rim.inner_radius + c / 3.0])
    mass, _ = lost_by_breaking(wheel)
    assert mass == pytest.approx(2.0 * np.pi * c**2 * rim.density * rings.sum(), rel=1e-9)


def test_the_share_is_of_the_whole_wheel():
    rim, c = RIM_ALONE.rim, BROKEN_EDGE
    sharp = np.pi * rim.density * rim.height / 2.0 * (rim.outer_radius**4 - rim.inner_radius**4)
    lost = 2.0 * np.pi * c**2 * rim.density * (rim.outer_radius**3 + rim.inner_radius**3)
    _, share = lost_by_breaking(replace(RIM_ALONE, rim=replace(rim, cuts=NO_CUTS)))
    assert share == pytest.approx(lost / sharp, rel=0.01)
    _, less = lost_by_breaking(TWO_PIECES)
    assert 0.0 < less < share


def test_the_sheet_says_so():
    sharp = replace(FLAT, wheel=replace(FLAT.wheel, rim=replace(FLAT.wheel.rim, cuts=NO_CUTS)))
    words = " ".join(item.text for item in wheel_sheet(sharp) if hasattr(item, "text"))
    mass, share = lost_by_breaking(sharp.wheel)
    assert f"broken 0.2: those of the rim are {1e3 * mass:.2g} g and {100 * share:.2g} %" in words
