"""A reference trajectory at the control instants of a run, with its feed-forward torque."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.simulation.controller import WheelLaw
from ocs_design.sizing.trajectory import Trajectory

_LEVEL = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Track:
    """What one trunk should do at k control instants; after the trajectory's end it stays level.

    Attributes:
        vertical: the world's upward direction in B, unit vectors (k, 3).
        rate: about roll and pitch in B [rad/s], (k, 2).
        torque: what the motors give before any feedback [N m], (k, 2); see `Target.torque`.
    """

    vertical: FloatArray
    rate: FloatArray
    torque: FloatArray


def track(trajectory: Trajectory, law: WheelLaw, times: FloatArray, period: float) -> Track:
    """The trajectory as the law of one world follows it.

    Args:
        trajectory: see `Trajectory`.
        law: of one world.
        times: of the control instants from lift-off or release [s], shape (k,).
        period: from one to the next [s].
    """
    flying = (times < trajectory.time[-1])[:, None]
    vertical = _at(times, trajectory.time, trajectory.vertical)
    vertical = vertical / np.linalg.norm(vertical, axis=1, keepdims=True)
    rate = flying * _at(times, trajectory.time, trajectory.rate)
    speed = _at(times, trajectory.time, trajectory.wheel_speed)
    given = _mean(trajectory.time, trajectory.wheel_torque, times, period)
    # The law adds the gyroscopic torque of the motion that it sees; that of the motion that was
    # planned is in the planned torque already.
    planned = law.gyroscopic(rate, speed) @ law.torque_map[0, :, 2:].T
    return Track(np.where(flying, vertical, _LEVEL), rate[:, :2], given - planned)


def _at(times: FloatArray, samples: FloatArray, values: FloatArray) -> FloatArray:
    """Linear between samples, shape (k, m)."""
    return np.column_stack([np.interp(times, samples, column) for column in values.T])


def _mean(samples: FloatArray, values: FloatArray, starts: FloatArray, period: float) -> FloatArray:
    """Mean over each control step of what is linear between samples and zero after the last.

    A torque that is held for a step then gives the momentum that was planned for that step.
    """
    integral = _integral(samples, values, np.append(starts, starts[-1] + period))
    return np.asarray(np.diff(integral, axis=0) / period)


def _integral(samples: FloatArray, values: FloatArray, ends: FloatArray) -> FloatArray:
    """From the first sample to each of `ends`, by trapezoids, which are exact here; (k, m)."""
    until = np.clip(ends, samples[0], samples[-1])
    before = np.clip(np.searchsorted(samples, until, side="right") - 1, 0, len(samples) - 2)
    steps = 0.5 * np.diff(samples)[:, None] * (values[1:] + values[:-1])
    whole = np.vstack([np.zeros(values.shape[1]), np.cumsum(steps, axis=0)])
    part = 0.5 * (until - samples[before])[:, None]
    return np.asarray(whole[before] + part * (values[before] + _at(until, samples, values)))
