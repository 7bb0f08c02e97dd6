"""What is known of a run before it starts: references and outer torques, from lift-off on."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import Target
from ocs_design.simulation.tracking import Track, track
from ocs_design.simulation.world import World

Steps: TypeAlias = NDArray[np.int64]
"""Control steps since lift-off, one number a world; negative on the ground."""


class References:
    """What every trunk should do at each control instant of its flight, tabulated before it."""

    def __init__(self, worlds: Sequence[World], times: FloatArray, period: float) -> None:
        later = np.append(times, times[-1] + period)
        axis = np.stack([world.turn.axis for world in worlds])
        angle = np.stack([world.turn.angle(times) for world in worlds], axis=1)
        rates = np.stack([world.turn.rate(later) for world in worlds], axis=1)[..., None]
        self._vertical = quaternions.vertical(quaternions.from_axis_angle(axis, angle))
        self._rate = rates[:-1] * axis[:, :2]
        # The mean over the step that the torque is held for brings the rate to where it should be.
        self._acceleration = np.diff(rates, axis=0) / period * axis[:, :2]
        self._torque = np.zeros((len(times), len(worlds), 2))
        for index, world in enumerate(worlds):
            if world.trajectory is not None:
                self._follow(index, track(world.trajectory, world.law, times, period))

    def _follow(self, index: int, planned: Track) -> None:
        """Put a trajectory in place of one world's turn; its torque holds its acceleration."""
        self._vertical[:, index] = planned.vertical
        self._rate[:, index] = planned.rate
        self._acceleration[:, index] = 0.0
        self._torque[:, index] = planned.torque

    def at(self, steps: Steps) -> Target:
        """Of the first worlds in the air, each so many control steps after its lift-off."""
        rows = np.maximum(steps, 0), np.arange(len(steps))
        return Target(
            self._vertical[rows],
            self._rate[rows],
            self._acceleration[rows],
            self._torque[rows],
            np.zeros(len(steps), dtype=np.bool_),
        )


class Pushes:
    """Outer torques on the trunks in B [N m], by control steps since lift-off."""

    def __init__(self, worlds: Sequence[World], times: FloatArray, period: float) -> None:
        self._shares = np.stack([world.push.share(times, period) for world in worlds], axis=1)
        self._torques = np.stack([world.push.torque for world in worlds])
        acting = np.flatnonzero(self._shares.any(axis=1))
        self._first = int(acting[0]) if acting.size else 1
        self._last = int(acting[-1]) if acting.size else 0

    def at(self, steps: Steps) -> FloatArray | None:
        """On the first worlds, shape (n, 3); None: on none of them."""
        if not ((steps >= self._first) & (steps <= self._last)).any():
            return None
        rows = np.maximum(steps, 0), np.arange(len(steps))
        share = np.where(steps < 0, 0.0, self._shares[rows])
        return share[:, None] * self._torques[: len(steps)]
