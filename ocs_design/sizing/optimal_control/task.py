"""A maneuver put into numbers for a program: units, limits, and where its search begins."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.flight import after_push
from ocs_design.sizing.optimal_control.guess import FixedAxisTurn
from ocs_design.sizing.optimal_control.motion import Motion
from ocs_design.sizing.optimal_control.units import Limits, Units, torque_unit

INTERVALS = 16
"""Of the first guess, of equal length."""

_REACH = 1e-6
"""An axis on which the wheels have less than this share of their torque is left alone."""


@dataclass(frozen=True, eq=False)
class Task:
    """One maneuver to be transcribed.

    Attributes:
        asked: see `Boundary`. limits: of the drives. units: of the numbers.
        reach: whether the wheels act on roll and on pitch. Where they do not, what the robot's
            products of inertia make of that axis is left as it is.
        guess: where the search begins; its intervals are used.
        axis: about which the trunk mainly turns, in B, shape (3,).
        angle: by which it does [rad].
    """

    asked: Boundary
    limits: Limits
    units: Units
    reach: tuple[bool, bool]
    guess: Motion
    axis: FloatArray
    angle: float


def maneuver_task(
    gyrostat: Gyrostat, line: DriveLine, asked: Boundary, intervals: int = INTERVALS
) -> Task:
    """The maneuver in the units that suit it, with a first guess.

    Args:
        gyrostat: robot and device. line: of the drives. asked: of the maneuver.
        intervals: of equal length.
    """
    turn = FixedAxisTurn.of(asked, after_push(gyrostat, asked))
    guess = turn.motion(gyrostat, intervals)
    inertia = float(np.linalg.eigvalsh(gyrostat.inertia)[-1])
    units = Units(
        time=asked.duration,
        # A trunk that is asked for no turn has no rate to count in.
        rate=turn.peak_rate or 1.0 / asked.duration,
        speed=float(line.no_load_speed),
        torque=torque_unit(line, turn.peak_acceleration * inertia),
        inertia=inertia,
    )
    sine, cosine = np.abs(gyrostat.axes[:2, 0]) > _REACH
    return Task(
        asked=asked,
        limits=Limits.of(line, units),
        units=units,
        reach=(bool(sine), bool(cosine)),
        guess=guess,
        axis=turn.axis,
        angle=turn.angle,
    )
