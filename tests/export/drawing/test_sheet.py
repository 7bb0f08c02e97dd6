"""Drawing sheets: lettering, hatching, scales, tolerances, balance and broken edges."""

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
from ocs_design.export.drawing.wheel import BROKEN_EDGE, broken_edge_losses, plus_minus
from ocs_design.export.drawing.wheel_sheet import wheel_sheet
from ocs_design.parts.joints import Grade, tolerance_width
from ocs_design.parts.rim import NO_CUTS


def test_the_width_of_a_letter_is_that_of_the_font():
    """Helvetica's M is 833 thousandths of the font's size wide, and its capitals are 718 high."""
    assert Lettering((0.0, 0.0), "M", 7.18).width == pytest.approx(8.33)


def test_characters_outside_latin_1_become_question_marks():
    for code in range(0xA0, 0x100):
        assert printable(chr(code)) == chr(code)
    assert printable("a机\n≤\x7f\x81?") == "a?????" + "?"


LETTER_T = [(1, 2), (31, 2), (31, 12), (21, 12), (21, 42), (11, 42), (11, 12), (1, 12)]


def inside(point, corners):
    """Whether a point is inside a polygon, by its winding number."""
    x, y = point
    winding = 0.0
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        step = math.atan2(y1 - y, x1 - x) - math.atan2(y0 - y, x0 - x)
        winding += (step + math.pi) % (2.0 * math.pi) - math.pi
    return abs(winding) > math.pi


@pytest.mark.parametrize("mirrored", [False, True])
def test_hatching_lines_are_inside_with_a_length_of_area_over_spacing(mirrored):
    lines = hatching(LETTER_T, mirrored=mirrored)
    for line in lines:
        (x0, y0), (x1, y1) = line.start, line.end
        for part in (0.05, 0.3, 0.5, 0.8, 0.95):
            assert inside((x0 + part * (x1 - x0), y0 + part * (y1 - y0)), LETTER_T)
    length = sum(math.dist(line.start, line.end) for line in lines)
    assert length * SPACING == pytest.approx(600.0, rel=0.03)


def test_hatching_lines_of_neighbouring_faces_are_aligned():
    left, right = [(0, 0), (10, 0), (10, 20), (0, 20)], [(10, 0), (25, 0), (25, 20), (10, 20)]
    whole = [(0, 0), (25, 0), (25, 20), (0, 20)]
    parts = sum(math.dist(line.start, line.end) for line in hatching(left) + hatching(right))
    assert parts == pytest.approx(sum(math.dist(line.start, line.end) for line in hatching(whole)))


def test_the_largest_standard_scale_that_fits():
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
def test_tolerance_widths_are_rounded_multiples_of_the_tolerance_factor(grade):
    for low, high in pairwise(STEPS):
        expected = UNITS[grade] * unit(low, high)
        assert 1e6 * tolerance_width(1e-3 * high, grade) == pytest.approx(expected, rel=0.05)


def test_the_upper_end_belongs_to_its_size_range():
    # H7: 15 um over 6 up to and including 10 mm, 18 um beyond.
    assert tolerance_width(0.010, Grade.IT7) == pytest.approx(15e-6)
    assert tolerance_width(0.01001, Grade.IT7) == pytest.approx(18e-6)


@given(st.floats(1e-4, 5.0), st.sampled_from(list(Grade)))
def test_written_tolerances_are_within_the_grade_but_at_least_a_hundredth(size, grade):
    half = tolerance_width(size, grade) / 2.0
    written = plus_minus(size, grade)
    assert 1e5 * written == pytest.approx(round(1e5 * written))
    assert written == pytest.approx(1e-5) or half - 1e-5 < written <= half + 1e-12


def test_permissible_eccentricity_of_the_standard():
    # G 6.3 at 3000 rpm: 20 um, or 20 g mm for each kilogram (ISO 21940-11, figure 2).
    speed = 3000.0 * 3.141592653589793 / 30.0
    assert 1e6 * permissible_eccentricity(speed) == pytest.approx(20.0, rel=0.01)


@pytest.mark.parametrize("wheel", [RIM_ALONE, TWO_PIECES])
def test_broken_edges_remove_four_rings_of_triangles(wheel):
    """Pappus: triangles with legs c and area c^2 / 2, with centroids c / 3 from the edges."""
    rim, c = wheel.rim, BROKEN_EDGE
    rings = np.array([rim.outer_radius - c / 3.0, rim.inner_radius + c / 3.0])
    mass, _ = broken_edge_losses(wheel)
    assert mass == pytest.approx(2.0 * np.pi * c**2 * rim.density * rings.sum(), rel=1e-9)


def test_the_share_of_inertia_is_relative_to_the_whole_wheel():
    rim, c = RIM_ALONE.rim, BROKEN_EDGE
    sharp = np.pi * rim.density * rim.height / 2.0 * (rim.outer_radius**4 - rim.inner_radius**4)
    lost = 2.0 * np.pi * c**2 * rim.density * (rim.outer_radius**3 + rim.inner_radius**3)
    _, share = broken_edge_losses(replace(RIM_ALONE, rim=replace(rim, cuts=NO_CUTS)))
    assert share == pytest.approx(lost / sharp, rel=0.01)
    _, less = broken_edge_losses(TWO_PIECES)
    assert 0.0 < less < share


def test_the_sheet_notes_the_effect_of_broken_edges():
    sharp = replace(FLAT, wheel=replace(FLAT.wheel, rim=replace(FLAT.wheel.rim, cuts=NO_CUTS)))
    words = " ".join(item.text for item in wheel_sheet(sharp) if hasattr(item, "text"))
    mass, share = broken_edge_losses(sharp.wheel)
    assert f"broken 0.2: those of the rim are {1e3 * mass:.2g} g and {100 * share:.2g} %" in words
