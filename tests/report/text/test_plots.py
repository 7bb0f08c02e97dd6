"""Plots and validation tables as text."""

import io
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from scipy.spatial.transform import Rotation

from ocs_design.device.records.flights import ValidationRecord
from ocs_design.report.flights import off_level
from ocs_design.report.text.front import braille, frame
from ocs_design.report.text.size import LEAST_SPAN, tilt_plots
from ocs_design.report.text.validation import print_runs

ANGLES = st.floats(-np.pi, np.pi)


def dots(lines):
    """Dots as (column, row) of the fine grid, row 0 at the top."""
    offsets = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)]
    return {
        (2 * x + dx, 4 * y + dy)
        for y, row in enumerate(lines)
        for x, character in enumerate(row)
        for bit, (dx, dy) in enumerate(offsets)
        if (ord(character) - 0x2800) >> bit & 1
    }


def points(*places):
    """Coordinates of separate points, without lines between them."""
    return np.array([point for place in places for point in (place, (np.nan, np.nan))]).T


def test_dots_of_a_full_cell_and_of_the_corners():
    cell = points(*product((0.0, 1.0), (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0)))
    assert braille(*cell, 1, 1) == ["⣿"]
    corners = braille(*points(*product((0.0, 1.0), (0.0, 1.0))), 3, 2)
    assert dots(corners) == {(0, 7), (5, 7), (0, 0), (5, 0)}
    assert corners == ["⠁⠀⠈", "⡀⠀⢀"]


def test_a_line_has_no_gaps_and_keeps_its_ends():
    slanted = dots(braille(np.array([0.0, 1.0]), np.array([0.1, 0.9]), 20, 6))
    assert {column for column, _ in slanted} == set(range(40))
    upright = dots(braille(np.array([0.5, 0.5]), np.array([0.0, 1.0]), 20, 6))
    assert {row for _, row in upright} == set(range(24))


def test_the_frame_aligns_its_labels():
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


def test_bars_share_the_scale_of_the_largest_tilt():
    assert tilt_plots([flight([0.0, 0.0, 0.0, 0.0])], 4) == (["▁▁▁▁"], LEAST_SPAN)
    (low, high), top = tilt_plots([flight([0.0, 0.1, 0.2]), flight([-0.4, -0.4, -0.4])], 3)
    assert top == pytest.approx(0.4)
    assert (low, high) == ("▁▂▄", "███")


def test_a_shorter_flight_ends_earlier():
    times = np.linspace(0.0, 0.4, 50)
    (short, long), _ = tilt_plots([flight(times, end=0.5), flight([0.0] * 50)], 8)
    assert len(short) == len(long) == 8
    assert short.endswith("█   ")
    assert long == "▁" * 8


METRICS = {
    "touchdown_pitch": -0.2154, "touchdown_roll": -0.117, "final_pitch": 2.718, "final_roll": 0.0,
    "turned_angle": -6.285, "peak_wheel_speed": 2111.2, "peak_wheel_torque": 0.43768,
}  # fmt: skip


@pytest.mark.parametrize("width", [80, 110])
def test_flights_are_one_line_each(width):
    runs = [
        ValidationRecord(
            scenario=scenario, ocs=ocs, passed=ocs, reason="", note="", metrics=METRICS
        )
        for scenario in ("disturbance", "back-flip")
        for ocs in (True, False)
    ]
    file = io.StringIO()
    print_runs(Console(file=file, width=width, color_system=None), runs)
    rows = [" ".join(row.split()) for row in file.getvalue().splitlines()]
    assert "disturbance pass -12.3 -6.7 155.7 0.0 -360.1 20,160 0.438" in rows
    assert rows.count("without fails -12.3 -6.7 155.7 0.0 -360.1 - -") == 2


@pytest.mark.parametrize(
    ("times", "airborne"),
    [
        ({"lift_off_time": 0.1, "touchdown_time": 0.5}, True),
        ({"lift_off_time": 0.1, "touchdown_time": None}, True),
        ({"lift_off_time": 0.1, "touchdown_time": 0.1}, False),
        ({"lift_off_time": None, "touchdown_time": None}, False),
        ({"touchdown_time": 0.5}, True),
    ],
    ids=["jumps", "stays up", "is shoved", "never leaves the ground", "of an older version"],
)
def test_flights_are_in_the_air_between_lift_off_and_touchdown(times, airborne):
    run = ValidationRecord(scenario="hop", ocs=True, passed=True, reason="", note="", metrics=times)
    assert run.was_airborne is airborne
