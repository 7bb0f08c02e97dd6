"""A report's story without a simulator: a device for Solo12's figures, and sinusoidal flights."""

from dataclasses import replace
from functools import cache

import numpy as np
from designed_devices import MOTOR, design_with_motor, record_of

from ocs_design.device.records.flights import ValidationRecord
from ocs_design.report.story import RecordedFlight, Story

TOUCHDOWN = 0.4
"""Time of touchdown [s]."""


def design(motor=MOTOR, layout=None):
    """Record of a design without flights."""
    return _recorded(motor, layout)


@cache
def _recorded(motor, layout):
    task, design = design_with_motor(motor, layout=layout)
    return record_of(task, design, seed=7, files={"a.stl": "0"})


def flight(scenario="drop", *, ocs=True, limits=True):
    """Half a sine of trunk and wheels, then touchdown."""
    time = np.linspace(0.0, 0.6, 601)
    swing = np.sin(np.pi * time / TOUCHDOWN)
    columns = {
        "time_s": time,
        "roll_rad": 0.02 * swing,
        "pitch_rad": -0.3 * swing,
        "rate_x_rad_s": 0.1 * swing,
        "rate_y_rad_s": -2.0 * swing,
        "wheel_speed_left_rad_s": 300.0 * swing,
        "wheel_speed_right_rad_s": 200.0 * swing,
        "wheel_torque_left_nm": 0.2 * swing,
        "wheel_torque_right_nm": -0.1 * swing,
        "contact": (time >= TOUCHDOWN).astype(float),
    }
    if limits:
        columns["wheel_torque_lowest_left_nm"] = np.full_like(time, -1.0)
        columns["wheel_torque_highest_left_nm"] = np.full_like(time, 1.0)
    times = {"lift_off_time": 0.0, "touchdown_time": float(time[time < TOUCHDOWN][-1])}
    record = ValidationRecord(
        scenario=scenario, ocs=ocs, passed=ocs, reason="", note="", metrics=times
    )
    return RecordedFlight(record, columns)


def story(scenario="drop", motor=MOTOR):
    """One maneuver with the device and without."""
    outcomes = tuple(
        ValidationRecord(
            scenario=scenario, ocs=ocs, passed=ocs, reason="made up", note="",
            metrics={"touchdown_pitch": 0.1, "peak_wheel_speed": 300.0},
        )
        for ocs in (True, False)
    )  # fmt: skip
    flights = flight(scenario), flight(scenario, ocs=False)
    return Story(replace(design(motor), validation=outcomes), flights, ())
