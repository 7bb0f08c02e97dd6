"""CPU time of a plan, warm, for one to four wheels: turns that can be done and that cannot.

    PYTHONPATH=. python benchmarks/plans.py [SECONDS]

A turn of 30 deg in 0.5 to 2 times the time that the wheels were chosen for. The goal is 0.5 s, or
SECONDS; the largest time of both kinds is told as a ratio to it.
"""

import statistics
import sys
import time

import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.turns import TurnTo
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import least_power_turn

INERTIA = np.diag([0.030, 0.0535, 0.068])
LINE = DriveLine(1.4566, 650.4, 1.0, np.inf, 300.0)
WHEELS = {"single": 1.9e-4, "pair": 1.1e-4, "triad": 7e-5, "orthogonal": 1.8e-4, "pyramid": 6e-5}
"""Spin inertia of each layout's wheels [kg m^2]."""

FACTORS = (2.0, 1.0, 0.5)


def main() -> None:
    """Print one line a plan, then the largest and the median of both kinds."""
    goal = float(sys.argv[1]) if len(sys.argv) > 1 else 0.5
    times: dict[bool, list[float]] = {True: [], False: []}
    for name, spin_inertia in WHEELS.items():
        axes = Layout(LayoutName(name)).axes(np.radians(35.0))
        plant = Gyrostat(INERTIA, np.asarray(axes), spin_inertia, 0.0)
        for factor in FACTORS:
            turn = TurnTo(name="turn", pitch=np.pi / 6.0, duration=0.385 * factor, jump_height=9.0)
            boundary = turn.boundary()
            least_power_turn(boundary, plant, LINE)  # warm
            start = time.process_time()
            planned = least_power_turn(boundary, plant, LINE)
            seconds = time.process_time() - start
            times[not planned.failure].append(seconds)
            outcome = planned.failure or "planned"
            print(f"{name:11} x {factor:3.1f}  {seconds:6.3f} s  {outcome}", flush=True)
    for is_planned, word in ((True, "planned"), (False, "not planned")):
        if times[is_planned]:
            most, middle = max(times[is_planned]), statistics.median(times[is_planned])
            share = f"{most / goal:.2f} of the goal"
            print(f"{word:11}  most {most:.3f} s ({share}), median {middle:.3f} s")


if __name__ == "__main__":
    main()
