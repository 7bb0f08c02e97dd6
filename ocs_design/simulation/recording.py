"""What happened in a batch of worlds."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Recording:
    """What happened in n worlds at k control instants; a world that has ended holds NaN.

    Attributes:
        time: [s], shape (k,).
        attitude: of the trunk, quaternions (k, n, 4).
        rate: of the trunk in B [rad/s], (k, n, 3).
        wheel_speed: relative to the trunk [rad/s], (k, n, 2).
        wheel_torque: of the motors on the wheels, held until the next instant [N m], (k, n, 2).
        com: centre of mass in the world [m], (k, n, 3).
        momentum: angular, about the centre of mass, in the world [N m s], (k, n, 3).
        impulse: of the outer torque since the start, in the world [N m s], (k, n, 3).
        height: of the trunk's body over the floor [m], (k, n).
        contact: whether anything touches the floor before the next instant, (k, n).
        pose_stride: control steps from one recorded pose to the next; 0: none is recorded.
        qpos: the poses, as the models have them, (frames, n, nq).
        lengths: number of instants of each world, (n,).
        stable: whether MuJoCo got each world to its end, (n,); it stops one whose state is huge or
            not finite, and its last state then stands still.
        warning: what stopped it, an `mjtWarning`, (n,); -1: nothing, or it is not known.
        lift_off: first control instant in flight, (n,); -1 for a world that never left the ground.
    """

    time: FloatArray
    attitude: FloatArray
    rate: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    com: FloatArray
    momentum: FloatArray
    impulse: FloatArray
    height: FloatArray
    contact: NDArray[np.bool_]
    pose_stride: int
    qpos: FloatArray
    lengths: NDArray[np.int64]
    stable: NDArray[np.bool_]
    warning: NDArray[np.int8]
    lift_off: NDArray[np.int64]


def empty_recording(
    times: FloatArray, lengths: NDArray[np.int64], *, pose_stride: int = 0, nq: int = 0
) -> Recording:
    """Nothing known yet, no impulse at the start; `nq` is the length of a pose."""
    k, n = len(times), len(lengths)
    frames = len(times[::pose_stride]) if pose_stride else 0

    def unknown(*shape: int) -> FloatArray:
        """One such value per time and world."""
        return np.full((k, n, *shape), np.nan)

    impulse = unknown(3)
    impulse[0] = 0.0
    return Recording(
        time=times,
        attitude=unknown(4),
        rate=unknown(3),
        wheel_speed=unknown(2),
        wheel_torque=unknown(2),
        com=unknown(3),
        momentum=unknown(3),
        impulse=impulse,
        height=unknown(),
        contact=np.zeros((k, n), dtype=bool),
        pose_stride=pose_stride,
        qpos=np.full((frames, n, nq), np.nan),
        lengths=lengths,
        stable=np.zeros(n, dtype=bool),
        warning=np.full(n, -1, dtype=np.int8),
        lift_off=np.zeros(n, dtype=np.int64),
    )


def pose_stride(rate: float | None, period: float) -> int:
    """Control steps from one pose to the next; 0 where none are wanted.

    Args:
        rate: of the poses [1/s].
        period: of the control steps [s].
    """
    return 0 if rate is None else max(1, round(1.0 / (rate * period)))


def joined(parts: Sequence[Recording], places: Sequence[NDArray[np.intp]]) -> Recording:
    """Several recordings as one.

    Args:
        parts: with equal control steps.
        places: for each part, where its worlds belong among all worlds.
    """
    longest = max(parts, key=lambda part: len(part.time))
    whole = empty_recording(
        longest.time,
        np.empty(sum(map(len, places)), dtype=np.int64),
        pose_stride=longest.pose_stride,
        nq=longest.qpos.shape[2],
    )
    for part, place in zip(parts, places, strict=True):
        for name in _ONCE:
            getattr(whole, name)[place] = getattr(part, name)
        for name in _SERIES:
            series = getattr(part, name)
            getattr(whole, name)[: len(series), place] = series
    return whole


_ONCE = ("lengths", "stable", "warning", "lift_off")
"""What a world has one value of."""

_SERIES = [
    field.name for field in fields(Recording) if field.name not in {"time", "pose_stride", *_ONCE}
]
