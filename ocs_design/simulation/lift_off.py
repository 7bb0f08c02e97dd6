"""When each world leaves the ground: its wheels, and what hits it, wait for that."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ocs_design.simulation.world import World

_EARLIEST = 0.5
"""Share of the push-off before which feet that let go of the ground do not count."""

_SURE = 5e-3
"""How long nothing may touch the ground before a robot is taken to fly [s]."""

NEVER = -1


class FlightClock:
    """Counts each world's control steps since lift-off.

    A ballistic world flies from the start. One that stands is left to itself until its legs have
    come to rest under its weight, and counts from then.
    """

    def __init__(self, worlds: Sequence[World], period: float) -> None:
        planned = np.array([0.0 if w.legs is None else w.legs.lift_off for w in worlds])
        self._earliest = np.ceil(_EARLIEST * planned / period)
        self._sure = max(1, round(_SURE / period))
        self._in_air = np.zeros(len(worlds), dtype=np.int64)
        standing = np.array([world.stands or 0.0 for world in worlds])
        settled = np.round(standing / period).astype(np.int64)
        self.lift_off: NDArray[np.int64] = np.where(planned > 0.0, NEVER, settled)

    def steps(self, k: int, running: int) -> NDArray[np.int64]:
        """Since lift-off, at control instant `k`; negative for a world that is on the ground."""
        left = self.lift_off[:running]
        return np.where(left == NEVER, NEVER, k - left)

    def look(self, k: int, touches: NDArray[np.bool_]) -> None:
        """Note which worlds were in the air throughout control step `k`.

        Args:
            k: control step that has passed.
            touches: whether anything touches the floor in each of its physics steps, (n, hold).
        """
        left, in_air = self.lift_off[: len(touches)], self._in_air[: len(touches)]
        free = (k >= self._earliest[: len(touches)]) & ~touches.any(axis=1)
        in_air[:] = np.where(free, in_air + 1, 0)
        flies = (left == NEVER) & (in_air == self._sure)
        left[flies] = k + 1 - self._sure
