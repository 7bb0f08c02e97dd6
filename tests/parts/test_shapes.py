"""Moments of flat shapes against handbook figures, Green's theorem and dense polygons."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from naive_outline import area_moments, as_area_moments

from ocs_design.parts.moments import MassMoments
from ocs_design.parts.outline import Outline, flat_outline
from ocs_design.parts.shapes import ArcSlot, Disc, Eared, Keyhole, Post, Rectangle

RADII = st.floats(0.5, 3.0)
OFFSETS = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def assert_same(moments, expected, tolerance=1e-12):
    """Compare area, first and second moments, with tolerances that scale with the size."""
    size = 1.0 + np.sqrt(np.trace(expected[2]) / expected[0])
    for power, (one, other) in enumerate(zip(moments, expected, strict=True)):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=tolerance * expected[0] * size**power)


@given(RADII, OFFSETS)
def test_disc(radius, centre):
    area = np.pi * radius**2
    expected = area * (radius**2 / 4.0 * np.eye(2) + np.outer(centre, centre))
    disc = Disc(radius, centre)
    for moments in (as_area_moments(disc.moments), area_moments(disc.outline())):
        assert_same(moments, (area, area * np.array(centre), expected))


@given(st.floats(0.1, 2.0), st.floats(0.1, 2.0), OFFSETS)
def test_rectangle(width, height, corner):
    x, y = corner
    shape = Rectangle(x, x + width, y, y + height)
    centre = np.array([x + width / 2.0, y + height / 2.0])
    own_moments = np.diag([width**2, height**2]) / 12.0
    area = width * height
    for moments in (as_area_moments(shape.moments), area_moments(shape.outline())):
        assert_same(moments, (area, area * centre, area * (own_moments + np.outer(centre, centre))))


def test_half_disc():
    # Centroid 4 r / (3 pi), second moments pi r^4 / 8 (any handbook).
    expected = (2.0 * np.pi, 2.0 * np.pi * np.array([0.0, -8.0 / (3.0 * np.pi)]))
    moments = area_moments(Outline(np.array([[-2.0, 0.0], [2.0, 0.0]]), np.array([1.0, 0.0])))
    assert_same(moments, (*expected, 2.0 * np.pi * np.eye(2)))


@given(st.floats(1.0, 3.0), st.floats(0.1, 0.9), st.floats(0.1, 6.0), st.floats(0.0, 6.0))
def test_slot_has_the_area_that_its_cutter_sweeps(radius, width, turn, start):
    slot = ArcSlot(radius, width, start, start + turn)
    # Pappus: width times the path of its centre, and a disc for both ends.
    area = radius * turn * width + np.pi * width**2 / 4.0
    assert slot.area == pytest.approx(area)
    assert_same(as_area_moments(slot.moments), area_moments(slot.outline()), 1e-11)


@given(RADII, st.floats(0.2, 0.98), st.floats(-3.0, 1.0), st.floats(1.0, 3.0))
def test_keyhole(radius, share, low, tall):
    keyhole = Keyhole(radius, share * radius, low, low + tall * radius)
    assert keyhole.area == pytest.approx(keyhole.moments.mass)
    assert_same(as_area_moments(keyhole.moments), area_moments(keyhole.outline()))


@given(st.floats(1.0, 5.0), st.floats(0.0, 0.5), st.floats(0.05, 0.6), st.floats(-2.0, 2.0))
def test_ears(radius, beyond, side, first):
    eared = Eared(radius, radius + beyond, side, first)
    assert eared.area == pytest.approx(eared.moments.mass)
    assert_same(as_area_moments(eared.moments), area_moments(eared.outline()))


@given(st.floats(1.5, 5.0), st.floats(0.7, 0.9), st.floats(0.3, 0.7))
def test_four_posts(radius, bore, half_angle):
    post = Post(Eared(radius, radius + 0.1, 0.2), bore * radius, half_angle)
    area, _, second = area_moments(post.outline())
    polar = np.trace(second)
    expected = (4.0 * area, np.zeros(2), 2.0 * polar * np.eye(2))
    assert_same(as_area_moments(post.moments.around(4)), expected)
    assert post.area == pytest.approx(area)


@pytest.mark.parametrize(
    "shape",
    [
        lambda r: Disc(r, (0.1 * r, 0.2)),
        lambda r: Rectangle(-r, r, 0.0, r),
        lambda r: ArcSlot(r, 0.1, 0.3, 1.0),
        lambda r: Keyhole(r, 0.8 * r, -r, 0.5),
        lambda r: Eared(r, r + 0.1, 0.05),
    ],
)
def test_arrays_and_numbers_agree(shape):
    radii = np.array([0.5, 0.7, 2.0])
    moments, areas = shape(radii).moments, shape(radii).area
    for index, radius in enumerate(radii.tolist()):
        alone = shape(radius).moments
        assert areas[index] == pytest.approx(shape(radius).area, rel=1e-15)
        for name in ("mass", "x", "y", "xx", "yy", "xy"):
            column = np.broadcast_to(getattr(moments, name), radii.shape)
            assert column[index] == pytest.approx(getattr(alone, name), rel=1e-14)


@pytest.mark.parametrize("count", [1, 2, 3, 8])
@given(st.floats(-3.0, 3.0), OFFSETS)
def test_a_circular_pattern_is_the_sum_of_its_members(count, first, centre):
    angles = first + 2.0 * np.pi * np.arange(count) / count
    outline = Disc(0.3, centre).outline()
    members = [area_moments(outline.turned(angle)) for angle in angles]
    expected = [sum(figures) for figures in zip(*members, strict=True)]
    assert_same(as_area_moments(Disc(0.3, centre).moments.around(count, first)), expected)


def test_moments_in_another_frame():
    body = MassMoments(2.0, 0.1, 0.2, 3.0, 4.0, 5.0, 0.3, x=0.4, xy=0.5, xz=0.6)
    rotation = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    moments = body.turned(rotation).moved(0.1, 0.2, 0.3)
    first, move = rotation @ [0.4, 0.1, 0.2], np.array([0.1, 0.2, 0.3])
    second = rotation @ [[3.0, 0.5, 0.6], [0.5, 4.0, 0.3], [0.6, 0.3, 5.0]] @ rotation.T
    second = second + np.outer(first, move) + np.outer(move, first) + 2.0 * np.outer(move, move)
    np.testing.assert_allclose([moments.x, moments.y, moments.z], first + 2.0 * move, rtol=1e-14)
    rows = [
        [moments.xx, moments.xy, moments.xz],
        [moments.xy, moments.yy, moments.yz],
        [moments.xz, moments.yz, moments.zz],
    ]
    np.testing.assert_allclose(rows, second, rtol=1e-13)


BULGES = st.one_of(st.just(0.0), st.floats(0.01, 0.45), st.floats(-0.45, -0.01))


@pytest.mark.slow
@given(st.lists(BULGES, min_size=5, max_size=5), OFFSETS)
def test_convex_and_concave_arcs_agree_with_a_dense_polygon(bulges, offset):
    # Corners of a pentagon of radius 3, whose arcs do not cross with these bulges.
    angles = 2.0 * np.pi * np.arange(5) / 5
    corners = 3.0 * np.column_stack([np.cos(angles), np.sin(angles)]) + offset
    outline = Outline(corners, np.array(bulges))
    exact = area_moments(outline)
    flat = flat_outline(outline, 2048)
    dense = area_moments(Outline(flat, np.zeros(len(flat))))
    assert dense[0] == pytest.approx(exact[0], rel=1e-12)
    np.testing.assert_allclose(dense[1], exact[1], atol=1e-5 * exact[0])
    np.testing.assert_allclose(dense[2], exact[2], atol=1e-5 * exact[0] * 10.0)
