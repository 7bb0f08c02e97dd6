"""Hatching fills its polygon, and nothing else."""

import math

import pytest

from ocs_design.export.drawing.sheet import SPACING, hatching

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
