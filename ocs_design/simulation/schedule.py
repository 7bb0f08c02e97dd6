"""What is known of a run before it starts: references and outer torques at each control instant."""

from collections.abc import Sequence

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import Target
from ocs_design.simulation.tracking import Track, track
from ocs_design.simulation.world import World


class References:
    """What every trunk should do at each control instant, tabulated before the run."""

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

    def at(self, k: int, running: int) -> Target:
        """At control instant `k`, of the first `running` worlds."""
        return Target(
            self._vertical[k, :running],
            self._rate[k, :running],
            self._acceleration[k, :running],
            self._torque[k, :running],
        )


def push_torques(
    worlds: Sequence[World], times: FloatArray, period: float
) -> dict[int, FloatArray]:
    """Outer torques in B [N m], shape (n, 3), by control step; steps without any are left out."""
    shares = np.stack([world.push.share(times, period) for world in worlds], axis=1)
    torques = np.stack([world.push.torque for world in worlds])
    return {int(k): shares[k][:, None] * torques for k in np.flatnonzero(shares.any(axis=1))}
