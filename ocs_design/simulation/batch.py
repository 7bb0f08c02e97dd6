"""Worlds that run in step: the physics in MuJoCo's `rollout`, the law vectorised in between."""

from collections.abc import Callable, Sequence
from threading import Event

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import WheelLaw
from ocs_design.simulation.recording import Recording, empty_recording
from ocs_design.simulation.schedule import References, push_torques
from ocs_design.simulation.world import World, start_states

_CONTROL = mujoco.mjtState.mjSTATE_CTRL.value
_PUSHED = _CONTROL | mujoco.mjtState.mjSTATE_XFRC_APPLIED.value

_TELLING = 20
"""Control steps from one report of progress to the next."""


class Batch:
    """The buffers of one run and the loop over its control steps.

    The worlds that still run are a leading slice of all buffers, a view without copies.
    """

    def __init__(self, worlds: Sequence[World], hold: int) -> None:
        """Worlds sorted, longest first; one control step is `hold` physics steps."""
        first = worlds[0].model
        self._worlds, self._hold = worlds, hold
        self._models = [world.model for world in worlds]
        self._period = hold * first.opt.timestep
        self._lengths = np.array([_control_steps(world, self._period) for world in worlds])
        self._addresses, self._chain = worlds[0].addresses, worlds[0].chain
        self._wheels, self._motors = list(self._addresses.wheels), list(self._addresses.motors)
        self._qpos, self._qvel = slice(1, 1 + first.nq), slice(1 + first.nq, 1 + first.nq + first.nv)
        self._push = first.nu + 6 * self._addresses.trunk + 3
        self._state = start_states(worlds)
        n = len(worlds)
        self._states = np.empty((n, hold, self._state.shape[1]))
        self._sensors = np.empty((n, hold, first.nsensordata))
        ctrl = np.stack([world.ctrl for world in worlds])
        self._control = _held(ctrl, hold)
        self._pushed_control = _held(np.hstack([ctrl, np.zeros((n, 6 * first.nbody))]), hold)

    def run(self, threads: int, stop: Event, progress: Callable[[float], None]) -> Recording:
        """Run all worlds to their ends.

        Args:
            threads: of the physics.
            stop: set from elsewhere to give up; the recording is then not complete.
            progress: told the part of the work that is done, 0..1.
        """
        times = self._period * np.arange(self._lengths[0])
        record = empty_recording(times, self._lengths)
        references = References(self._worlds, times, self._period)
        pushes = push_torques(self._worlds, times, self._period)
        law = WheelLaw.stack([world.law for world in self._worlds])
        data = [mujoco.MjData(self._models[0]) for _ in range(threads)]
        # Without a pool the calling thread does the work.
        with Rollout(nthread=threads if threads > 1 else 0) as pool:
            for k in range(len(times)):
                if stop.is_set():
                    break
                running = int(np.count_nonzero(self._lengths > k))
                ...
        return record
