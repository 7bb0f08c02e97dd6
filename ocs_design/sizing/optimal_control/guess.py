"""Where the search for a maneuver begins: a smooth turn about a fixed axis."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.collocation import collocation
from ocs_design.sizing.optimal_control.motion import Motion


@dataclass(frozen=True, eq=False)
class FixedAxisTurn:
    """A cubic from one angle and rate to another angle at rest.

    Attributes:
        vertical: at the start, in B, shape (3,). axis: unit vector, shape (3,).
        rate: at the start [rad/s]. angle: at the end, 0 at the start [rad]. duration: [s].
    """

    vertical: FloatArray
    axis: FloatArray
    rate: float
    angle: float
    duration: float

    @classmethod
    def of(cls, asked: Boundary, start: FloatArray) -> "FixedAxisTurn":
        """The turn that a maneuver asks for.

        Args:
            asked: see `Boundary`.
            start: vertical and rate at the start, shape (6,).
        """
        vertical, rate = start[:3], float(np.linalg.norm(start[3:6]))
        if rate == 0.0:
            return cls(vertical, asked.axis, 0.0, asked.angle, asked.duration)
        # A push has turned the trunk about the axis of its rate, and is to be undone.
        tilt = float(np.arccos(np.clip(vertical @ asked.final_vertical, -1.0, 1.0)))
        return cls(vertical, start[3:6] / rate, rate, -tilt, asked.duration)

    @property
    def peak_rate(self) -> float:
        """About the largest rate of the trunk [rad/s]."""
        return max(1.5 * abs(self.angle) / self.duration, abs(self.rate))

    @property
    def peak_acceleration(self) -> float:
        """Largest of the cubic [rad/s^2]."""
        return (6.0 * abs(self.angle) / self.duration + 4.0 * abs(self.rate)) / self.duration

    def motion(self, gyrostat: Gyrostat, intervals: int) -> Motion:
        """The turn and the wheels that drive it, their limits ignored."""
        lengths = np.full(intervals, self.duration / intervals)
        edges = np.arange(intervals)[:, None] / intervals
        nodes = np.append(0.0, (edges + collocation().nodes[1:] / intervals).ravel())
        angle, rate, _ = self._profile(nodes)
        _, _, acceleration = self._profile((edges + np.array([0.0, 0.5, 1.0]) / intervals).ravel())
        to_wheels = np.linalg.pinv(gyrostat.spin_inertia * gyrostat.axes, rcond=1e-6)
        share = (gyrostat.spin_inertia + gyrostat.armature) / gyrostat.spin_inertia
        momentum = gyrostat.inertia @ self.axis
        held = self.rate * momentum[:, None]
        states = np.vstack(
            [
                self._vertical(angle),
                np.outer(self.axis, rate),
                to_wheels @ (held - np.outer(momentum, rate)),
            ]
        )
        torques = -share * gyrostat.spin_inertia * to_wheels @ np.outer(momentum, acceleration)
        return Motion(lengths, states, torques)

    def _profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Angle [rad], rate and acceleration at s = 0..1."""
        run, end, time = self.rate * self.duration, self.angle, self.duration
        angle = end * s**2 * (3.0 - 2.0 * s) + run * s * (1.0 - s) ** 2
        slope = 6.0 * end * s * (1.0 - s) + run * (1.0 - s) * (1.0 - 3.0 * s)
        bend = 6.0 * end * (1.0 - 2.0 * s) + run * (6.0 * s - 4.0)
        return angle, slope / time, bend / time**2

    def _vertical(self, angle: FloatArray) -> FloatArray:
        """In B after turns by `angle`, which turn it the other way round; shape (3, len(angle))."""
        along = self.axis * (self.axis @ self.vertical)
        across, ahead = self.vertical - along, np.cross(self.vertical, self.axis)
        turned = np.outer(across, np.cos(angle)) + np.outer(ahead, np.sin(angle))
        return np.asarray(along[:, None] + turned)
