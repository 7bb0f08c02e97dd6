"""A sheet's letters, hatching and scales, against Adobe's metrics, areas and ISO 5455."""

import math

import pytest

from ocs_design.export.drawing.sheet import SPACING, Scale, Text, hatching, largest_scale, printable


def test_a_capital_is_as_high_as_told_and_as_wide_as_the_font_has_it():
    """Helvetica's M is 833 thousandths of the font's size wide, and its capitals are 718 high."""
    assert Text((0.0, 0.0), "M", 7.18).width == pytest.approx(8.33)


def test_every_code_that_can_be_encoded_is_printable():
    for code in range(0xA0, 0x100):
        assert printable(chr(code)) == chr(code)


def test_what_the_font_lacks_becomes_a_question_mark():
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


def test_a_length_on_paper_and_back():
    assert Scale(2, 1)(0.01) == 20.0
    assert Scale(1, 5)(0.1) == 20.0
    assert Scale(1, 5).length(20.0) == 0.1


def test_the_largest_scale_of_the_standard_at_which_all_fit():
    assert str(largest_scale((0.3, 61.0))) == "1:5"
    assert str(largest_scale((0.3, 61.0), (0.001, 0.05))) == "1:20"
    assert str(largest_scale((0.001, 600.0))) == "500:1"
    assert str(largest_scale((0.3, 76.0), standard=False)) == "1:4"


def test_the_smallest_if_nothing_fits():
    assert largest_scale((1.0, 0.0)).paper == 1
