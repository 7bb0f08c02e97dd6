"""Dots where they belong, and curves of the tilt."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.report.flights import off_level
from ocs_design.report.text.front import braille, frame
from ocs_design.report.text.size import LEAST_SPAN, tilt_plots

ANGLES = st.floats(-np.pi, np.pi)


def dots(lines):
    """Every dot as (column, row) of the fine grid, row 0 at the top."""
    offsets = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)]
    return {
        (2 * x + dx, 4 * y + dy)
        for y, row in enumerate(lines)
        for x, character in enumerate(row)
        for bit, (dx, dy) in enumerate(offsets)
        if (ord(character) - 0x2800) >> bit & 1
    }


def points(*places):
    """Coordinates of points with no line between them."""
    return np.array([each for place in places for each in (place, (np.nan, np.nan))]).T


def test_every_dot_of_a_cell_and_the_corners_of_a_plot():
    cell = points(*product((0.0, 1.0), (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0)))
    assert braille(*cell, 1, 1) == ["⣿"]
    corners = braille(*points(*product((0.0, 1.0), (0.0, 1.0))), 3, 2)
    assert dots(corners) == {(0, 7), (5, 7), (0, 0), (5, 0)}
    assert corners == ["⠁⠀⠈", "⡀⠀⢀"]


def test_a_line_has_no_gaps_and_keeps_its_ends():
    found = dots(braille(np.array([0.0, 1.0]), np.array([0.1, 0.9]), 20, 6))
    assert {column for column, _ in found} == set(range(40))
    upright = dots(braille(np.array([0.5, 0.5]), np.array([0.0, 1.0]), 20, 6))
    assert {row for _, row in upright} == set(range(24))


def test_the_frame_is_as_wide_as_it_says():
    ends = {"x_ends": ("300 ms", "600 ms"), "y_ends": ("8 g", "120 g")}
    rows = frame(4 * [30 * " "], **ends, marks={0: "x", 29: "o"})
    assert len(rows) == 6
    assert rows[0].startswith("120 g ┤")
    assert rows[3].startswith("  8 g ┤")
    assert rows[4].endswith("└x" + 28 * "─" + "o")
    assert rows[5] == 7 * " " + "300 ms" + 18 * " " + "600 ms"
    assert {len(row) for row in rows} == {37}


def flight(pitch, end=1.0):
    pitch = np.asarray(pitch, dtype=float)
    return SimpleNamespace(time=np.linspace(0.0, end, len(pitch)), roll=0.0 * pitch, pitch=pitch)


@given(ANGLES, ANGLES, ANGLES)
def test_off_level_is_the_angle_between_the_verticals(roll, pitch, yaw):
    up = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()[:, 2]
    assert np.cos(off_level(roll, pitch)) == pytest.approx(up[2], abs=1e-12)


def test_level_is_a_line_at_the_foot():
    assert tilt_plots([flight([0.0, 0.0, 0.0, 0.0])], 4) == (["▁▁▁▁"], LEAST_SPAN)


def test_bars_are_to_the_scale_of_the_largest_tilt_of_all():
    (low, high), top = tilt_plots([flight([0.0, 0.1, 0.2]), flight([-0.4, -0.4, -0.4])], 3)
    assert top == pytest.approx(0.4)
    assert (low, high) == ("▁▂▄", "███")


def test_a_shorter_flight_ends_earlier_and_the_highest_of_a_bar_shows():
    times = np.linspace(0.0, 0.4, 50)
    (short, long), _ = tilt_plots([flight(times, end=0.5), flight([0.0] * 50)], 8)
    assert len(short) == len(long) == 8
    assert short.endswith("█   ")
    assert long == "▁" * 8
