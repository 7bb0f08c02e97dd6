"""What trunk and wheels do over time, in a form that can be integrated exactly."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Motion:
    """Linear between samples; two samples at one time are a jump.

    Attributes:
        time: [s], not falling, shape (n,).
        wheel_speed: relative to the trunk [rad/s], shape (n, 2).
        wheel_torque: of the motors at the wheels [N m], shape (n, 2).
        rate: of the trunk in B [rad/s], shape (n, 3).
        acceleration: of the trunk in B [rad/s^2], shape (n, 3).
    """

    time: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    rate: FloatArray
    acceleration: FloatArray

    @classmethod
    def along(cls, trajectory: Trajectory) -> "Motion":
        """Of a reference, which is linear between its samples too."""
        return cls(
            trajectory.time,
            trajectory.wheel_speed,
            trajectory.wheel_torque,
            trajectory.rate,
            trajectory.acceleration,
        )

    @classmethod
    def flown(
        cls,
        time: FloatArray,
        wheel_speed: FloatArray,
        wheel_torque: FloatArray,
        rate: FloatArray,
    ) -> "Motion":
        """Of a recorded flight, whose torque is held from each sample to the next.

        The trunk's acceleration is the mean one between two samples. A landing's is not that of a
        maneuver: leave out what comes after touchdown.

        Args:
            time: [s], increasing, shape (n,), n >= 2.
            wheel_speed, wheel_torque, rate: see `Motion`; the last torque is not used.
        """
        acceleration = np.diff(rate, axis=0) / np.diff(time)[:, None]
        return cls(
            _both_ends(time),
            _both_ends(wheel_speed),
            np.repeat(wheel_torque[:-1], 2, axis=0),
            _both_ends(rate),
            np.repeat(acceleration, 2, axis=0),
        )

    @property
    def duration(self) -> float:
        """[s]."""
        return float(self.time[-1] - self.time[0])

    def between(self) -> "Motion":
        """Samples with the middle of each interval between them, shape (2 n - 1, ...)."""
        return Motion(
            _with_middles(self.time),
            _with_middles(self.wheel_speed),
            _with_middles(self.wheel_torque),
            _with_middles(self.rate),
            _with_middles(self.acceleration),
        )


def integral(values: FloatArray, time: FloatArray) -> float:
    """Simpson's rule over intervals with their middles: exact for what is quadratic in each.

    Args:
        values: shape (2 n - 1,).
        time: as `Motion.between` gives it, shape (2 n - 1,).
    """
    step = time[2::2] - time[:-2:2]
    return float(step @ (values[:-2:2] + 4.0 * values[1::2] + values[2::2]) / 6.0)


def _both_ends(values: FloatArray) -> FloatArray:
    """Start and end of each interval, one after the other."""
    return np.repeat(values, 2, axis=0)[1:-1]


def _with_middles(values: FloatArray) -> FloatArray:
    found = np.repeat(values, 2, axis=0)[:-1]
    found[1::2] = 0.5 * (values[:-1] + values[1:])
    return found
