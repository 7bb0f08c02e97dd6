"""Flights as a table in the terminal."""

import io

import pytest
from rich.console import Console

from ocs_design.device.records.flights import (
    ValidationRecord,
    lift_off_and_touchdown,
    was_in_the_air,
)
from ocs_design.report.text.validation import print_runs

METRICS = {
    "touchdown_pitch": -0.2154, "touchdown_roll": -0.117, "final_pitch": 2.718, "final_roll": 0.0,
    "turned_angle": -6.285, "peak_wheel_speed": 2111.2, "peak_wheel_torque": 0.43768,
}  # fmt: skip


@pytest.mark.parametrize("width", [80, 110])
def test_no_line_of_a_flight_is_broken(width):
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
    ("times", "flown"),
    [
        ({"lift_off_time": 0.1, "touchdown_time": 0.5}, True),
        ({"lift_off_time": 0.1, "touchdown_time": None}, True),
        ({"lift_off_time": 0.1, "touchdown_time": 0.1}, False),
        ({"lift_off_time": None, "touchdown_time": None}, False),
        ({"touchdown_time": 0.5}, True),
    ],
    ids=["jumps", "stays up", "is shoved", "never leaves the ground", "of an older version"],
)
def test_who_flies(times, flown):
    assert was_in_the_air(*lift_off_and_touchdown(times)) is flown
