"""Trunk and wheels over time as the polynomials of the collocation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.optimal_control.collocation import (
    DEGREE,
    TORQUE_DEGREE,
    bernstein_basis,
    collocation,
)

_INSIDE = 1e-6
# Torques may jump from one interval to the next: their ends are read just inside.


@dataclass(frozen=True, eq=False)
class Motion:
    """States and torques over k intervals, SI.

    Attributes:
        lengths: of the intervals [s], shape (k,).
        states: vertical, rate [rad/s] and wheel speeds [rad/s] at the nodes of all intervals, which
            share their ends, shape (8, k n + 1).
        torques: Bernstein coefficients of the motor torques of each interval [N m], shape (2, 3 k).
    """

    lengths: FloatArray
    states: FloatArray
    torques: FloatArray

    @property
    def starts(self) -> FloatArray:
        """Of the intervals [s], shape (k,)."""
        return np.append(0.0, np.cumsum(self.lengths)[:-1])

    def state_at(self, times: FloatArray) -> FloatArray:
        """Shape (8, len(times))."""
        interval, s = self._locate(times)
        nodes = interval[:, None] * DEGREE + np.arange(DEGREE + 1)
        weights = bernstein_basis(s, DEGREE) @ collocation().bernstein
        return np.asarray(np.einsum("imj,mj->im", self.states[:, nodes], weights))

    def torque_at(self, times: FloatArray) -> FloatArray:
        """Of the later interval where two meet [N m], shape (2, len(times))."""
        interval, s = self._locate(times)
        own = interval[:, None] * (TORQUE_DEGREE + 1) + np.arange(TORQUE_DEGREE + 1)
        return np.asarray(np.einsum("imj,mj->im", self.torques[:, own], bernstein_basis(s)))

    def torque_within(self, s: FloatArray) -> FloatArray:
        """In every interval at s = 0..1 [N m], shape (k len(s), 2), in the order of time."""
        count = len(self.lengths)
        coefficients = self.torques.reshape(2, count, TORQUE_DEGREE + 1)
        values: FloatArray = np.einsum("ikj,sj->ksi", coefficients, bernstein_basis(s))
        return values.reshape(count * len(s), 2)

    def onto(self, lengths: FloatArray) -> "Motion":
        """Nearly the same motion on other intervals."""
        starts = np.append(0.0, np.cumsum(lengths)[:-1])[:, None]
        nodes = starts + lengths[:, None] * collocation().nodes[1:]
        ends = starts + lengths[:, None] * np.array([_INSIDE, 0.5, 1.0 - _INSIDE])
        torques = self.torque_at(ends.ravel())
        # The parabola through its values at both ends and in the middle.
        torques[:, 1::3] = 2.0 * torques[:, 1::3] - (torques[:, 0::3] + torques[:, 2::3]) / 2.0
        return Motion(lengths, self.state_at(np.append(0.0, nodes.ravel())), torques)

    def _locate(self, times: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
        """Interval of each time, and how far through it, 0..1."""
        starts = self.starts
        interval = np.searchsorted(starts, times, side="right") - 1
        return interval, (times - starts[interval]) / self.lengths[interval]
