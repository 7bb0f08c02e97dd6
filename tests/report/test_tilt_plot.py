"""Curves of the tilt: what they show, and how far off level a trunk is."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.report.tilt_plot import HEIGHT, LEAST_SPAN, off_level, tilt_plots

ANGLES = st.floats(-np.pi, np.pi)


def flight(pitch, end=1.0):
    pitch = np.asarray(pitch, dtype=float)
    return SimpleNamespace(time=np.linspace(0.0, end, len(pitch)), roll=0.0 * pitch, pitch=pitch)


@given(ANGLES, ANGLES, ANGLES)
def test_off_level_is_the_angle_between_the_verticals(roll, pitch, yaw):
    up = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()[:, 2]
    assert np.cos(off_level(roll, pitch)) == pytest.approx(up[2], abs=1e-12)


def test_level_is_a_line_at_the_foot():
    (plot,), top = tilt_plots([flight([0.0, 0.0])], 4)
    assert plot == "⠀⠀⠀⠀\n⣀⣀⣀⣀"
    assert top == LEAST_SPAN


def test_the_largest_tilt_of_all_reaches_the_top():
    (low, high), top = tilt_plots([flight([0.0, 0.1]), flight([-0.4, -0.4])], 3)
    assert top == pytest.approx(0.4)
    assert high == "⠉⠉⠉\n⠀⠀⠀"
    assert low.splitlines()[0] == "⠀⠀⠀"


def test_a_shorter_flight_ends_earlier():
    (short, long), _ = tilt_plots([flight([0.0, 0.0], end=0.5), flight([0.0, 0.0])], 8)
    assert len(short.splitlines()) == HEIGHT
    assert len(short.splitlines()[1].rstrip("⠀")) in (4, 5)
    assert long.splitlines()[1] == "⣀" * 8


def test_a_steep_curve_has_no_gaps():
    (plot,), _ = tilt_plots([flight([0.0, 1.0])], 1)
    assert sum(bin(ord(cell) - 0x2800).count("1") for cell in plot if cell != "\n") >= 8
