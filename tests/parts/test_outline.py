"""Area moments against handbook figures and against dense polygons."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.parts.flattening import flat_outline
from ocs_design.parts.outline import Outline, arc_slot, circle, polygon, rectangle

RADII = st.floats(0.5, 3.0)
OFFSETS = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


@given(RADII, OFFSETS)
def test_circle(radius, centre):
    moments = circle(radius, centre).moments()
    area = np.pi * radius**2
    assert moments.area == pytest.approx(area, rel=1e-14)
    np.testing.assert_allclose(moments.first, area * np.array(centre), atol=1e-13 * area * 3.0)
    expected = area * (radius**2 / 4.0 * np.eye(2) + np.outer(centre, centre))
    np.testing.assert_allclose(moments.second, expected, atol=1e-13 * area * 20.0)


@given(st.floats(0.1, 2.0), st.floats(0.1, 2.0), OFFSETS)
def test_rectangle(width, height, corner):
    x, y = corner
    moments = rectangle(x, x + width, y, y + height).moments()
    middle = np.array([x + width / 2.0, y + height / 2.0])
    own = np.diag([width**2, height**2]) / 12.0
    area = width * height
    np.testing.assert_allclose(moments.area, area, rtol=1e-12)
    np.testing.assert_allclose(moments.first, area * middle, atol=1e-12)
    np.testing.assert_allclose(moments.second, area * (own + np.outer(middle, middle)), atol=1e-12)


def test_half_disc():
    # Centroid 4 r / (3 pi), second moments pi r^4 / 8 (any handbook).
    moments = Outline(np.array([[2.0, 0.0], [-2.0, 0.0]]), np.array([1.0, 0.0])).moments()
    assert moments.area == pytest.approx(2.0 * np.pi)
    np.testing.assert_allclose(moments.first / moments.area, [0.0, 8.0 / (3.0 * np.pi)], atol=1e-15)
    np.testing.assert_allclose(moments.second, 2.0 * np.pi * np.eye(2), atol=1e-14)


@given(st.floats(1.0, 3.0), st.floats(0.1, 0.9), st.floats(0.1, 6.0), st.floats(0.0, 6.0))
def test_slot_has_the_area_its_cutter_sweeps(radius, width, turn, start):
    # Pappus: width times the path of its middle, and a disc for both ends.
    moments = arc_slot(radius, width, start, start + turn).moments()
    assert moments.area == pytest.approx(radius * turn * width + np.pi * width**2 / 4.0)


BULGES = st.one_of(st.just(0.0), st.floats(0.01, 0.45), st.floats(-0.45, -0.01))


@given(st.lists(BULGES, min_size=5, max_size=5), OFFSETS)
def test_arcs_both_ways_agree_with_a_dense_polygon(bulges, offset):
    # Corners of a pentagon of radius 3; arcs of these bulges do not cross each other.
    angles = 2.0 * np.pi * np.arange(5) / 5
    corners = 3.0 * np.column_stack([np.cos(angles), np.sin(angles)]) + offset
    outline = Outline(corners, np.array(bulges))
    exact = outline.moments()
    dense = polygon(flat_outline(outline, 2048)).moments()
    assert dense.area == pytest.approx(exact.area, rel=1e-12)
    np.testing.assert_allclose(dense.first, exact.first, atol=1e-5 * exact.area)
    np.testing.assert_allclose(dense.second, exact.second, atol=1e-5 * exact.area * 10.0)


def test_small_arcs_have_fewer_sections():
    assert len(flat_outline(circle(0.04), 256)) == 256
    assert len(flat_outline(circle(0.0025), 256)) == 64
    assert len(flat_outline(circle(1e-7), 256)) == 8
