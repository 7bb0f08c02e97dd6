"""Intervals that are short where the torques change fast."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.optimal_control.motion import Motion

_EVEN = 0.4
"""Share of the intervals that is spread evenly over the time."""

_SAMPLES = 16


def refined(motion: Motion, intervals: int) -> FloatArray:
    """Lengths [s] of so many intervals, short where the torques of `motion` change.

    Each takes the same part of a sum of time passed and of the torques' total variation. That of an
    interval is spread over its neighbours too: a switch moves a little as the mesh gets finer.
    """
    count = len(motion.lengths)
    torque = motion.torque_within(np.linspace(0.0, 1.0, _SAMPLES)).reshape(count, _SAMPLES, 2)
    inside = np.abs(np.diff(torque, axis=1)).sum(axis=(1, 2))
    jumps = np.append(np.abs(torque[1:, 0] - torque[:-1, -1]).sum(axis=1), 0.0)
    variation = inside + jumps
    spread = np.convolve(np.pad(variation, 1, mode="edge"), [0.25, 0.5, 0.25], mode="valid")
    even = motion.lengths / motion.lengths.sum()
    density = _EVEN * even + (1.0 - _EVEN) * spread / max(spread.sum(), np.finfo(float).tiny)
    reached = np.append(0.0, np.cumsum(density / density.sum()))
    edges = np.append(motion.starts, motion.lengths.sum())
    return np.diff(np.interp(np.linspace(0.0, 1.0, intervals + 1), reached, edges))
