"""The poses of a run, to show it again."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray
from ocs_design.simulation.recording import Recording

POSE_RATE = 60.0
"""Poses per second of a replay on a screen [1/s]."""


@dataclass(frozen=True, eq=False)
class Poses:
    """What a model looked like, again and again.

    Attributes:
        time: [s], shape (n,).
        qpos: of the simulated model, free joint first as (x, y, z) [m] and quaternion (w, x, y, z),
            then joints [rad or m]; shape (n, nq). Angles of the wheels count all their turns.
    """

    time: FloatArray
    qpos: FloatArray


def pose_stride(rate: float | None, period: float) -> int:
    """Control steps from one pose to the next; 0 where none are wanted.

    Args:
        rate: of the poses [1/s].
        period: of the control steps [s].
    """
    return 0 if rate is None else max(1, round(1.0 / (rate * period)))


def poses_of(recording: Recording, index: int) -> Poses | None:
    """Poses of one world of a recording; None if there are none."""
    if not recording.pose_stride:
        return None
    time = recording.time[: recording.lengths[index] : recording.pose_stride]
    return Poses(time, recording.qpos[: len(time), index])
