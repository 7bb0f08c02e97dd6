"""The batch engine: one world or thousands, the wheel law closed over all of them at once.

The physics runs in MuJoCo's threaded `rollout`, a few steps at a time; in between, the law runs
vectorised over the worlds. One control step is `hold` physics steps, through which motor torque and
outer torque stay as they are.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import WheelLaw
from ocs_design.simulation.recording import Recording, empty_recording, reordered
from ocs_design.simulation.schedule import References, push_torques
from ocs_design.simulation.world import World, start_states

Progress = Callable[[float], None]

_CONTROL = mujoco.mjtState.mjSTATE_CTRL.value
_PUSHED = _CONTROL | mujoco.mjtState.mjSTATE_XFRC_APPLIED.value


def simulate(
    worlds: Sequence[World],
    *,
    hold: int = 5,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Recording:
    """Run all worlds to their ends.

    Args:
        worlds: with models of equal sizes.
        hold: physics steps per control step.
        threads: of the physics; None: one per processor. The numbers do not depend on it.
        progress: told the part of the work that is done, 0..1.
    """
    # Longest first: the worlds still running are then a leading slice, a view without copies.
    order = np.argsort([-world.duration for world in worlds], kind="stable")
    batch = _Batch([worlds[index] for index in order], hold)
    with _no_warnings(), Rollout(nthread=_pool_size(threads, len(worlds))) as pool:
        recording = batch.run(pool, progress)
    return reordered(recording, np.argsort(order))


class _Batch:
    """The buffers of one run and the loop over its control steps; worlds sorted, longest first."""

    def __init__(self, worlds: Sequence[World], hold: int) -> None:
        first = worlds[0].model
        self.worlds, self.hold = worlds, hold
        self.models = [world.model for world in worlds]
        self.period = hold * first.opt.timestep
        self.lengths = np.array([_control_steps(world, self.period) for world in worlds])
        self.nq, self.nu = first.nq, first.nu
        self.addresses, self.chain = worlds[0].addresses, worlds[0].chain
        self.wheels, self.motors = list(self.addresses.wheels), list(self.addresses.motors)
        self.state = start_states(worlds)
        n = len(worlds)
        self.states = np.empty((n, hold, self.state.shape[1]))
        self.sensors = np.empty((n, hold, first.nsensordata))
        ctrl = np.stack([world.ctrl for world in worlds])
        wrenches = np.zeros((n, 6 * first.nbody))
        self.control = _held(ctrl, hold)
        self.pushed_control = _held(np.hstack([ctrl, wrenches]), hold)
        self.push_address = self.nu + 6 * self.addresses.trunk + 3

    def run(self, pool: Rollout, progress: Progress | None) -> Recording:
        count = int(self.lengths[0])
        times = self.period * np.arange(count)
        record = empty_recording(times, self.lengths)
        references = References(self.worlds, times, self.period)
        pushes = push_torques(self.worlds, times, self.period)
        law = WheelLaw.stack([world.law for world in self.worlds])
        data = [mujoco.MjData(self.models[0]) for _ in range(max(1, pool.nthread))]
        running = len(self.worlds)
        active, models = law, self.models
        for k in range(count):
            if self.lengths[running - 1] <= k:
                running = int(np.count_nonzero(self.lengths > k))
                active, models = law.take(slice(running)), self.models[:running]
            vertical, rate, wheel_speed = self._observe(record, k, running)
            target = references.at(k, running)
            torque = active.torque(vertical, rate, wheel_speed, target, self.period)
            record.wheel_torque[k, :running] = torque
            push = pushes.get(k)
            self._advance(pool, models, data, torque, self._in_world(record, k, running, push))
            self._sense(record, k, running)
            if progress is not None and k % 20 == 0:
                progress(float(np.minimum(self.lengths, k).sum() / self.lengths.sum()))
        if progress is not None:
            progress(1.0)
        record.stable[:] = np.abs(self.state[:, 0] - self.lengths * self.period) < 0.5 * self.period
        return record

    def _observe(
        self, record: Recording, k: int, running: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Trunk and wheels at instant `k`, recorded; what the law needs of them."""
        qpos = self.state[:running, 1 : 1 + self.nq]
        qvel = self.state[:running, 1 + self.nq :]
        attitude, rate = self.chain.attitude(qpos), self.chain.rate(qpos, qvel)
        wheel_speed = qvel[:, self.wheels]
        record.attitude[k, :running] = attitude
        record.rate[k, :running] = rate
        record.wheel_speed[k, :running] = wheel_speed
        return quaternions.vertical(attitude), rate, wheel_speed

    def _in_world(
        self, record: Recording, k: int, running: int, push: FloatArray | None
    ) -> FloatArray | None:
        """The outer torque of this step in the world; its impulse is added to the record."""
        before = record.impulse[k, :running]
        if push is None:
            if k + 1 < len(record.time):
                record.impulse[k + 1, :running] = before
            return None
        rotation = quaternions.matrix(record.attitude[k, :running])
        torque: FloatArray = np.einsum("nij,nj->ni", rotation, push[:running])
        if k + 1 < len(record.time):
            record.impulse[k + 1, :running] = before + torque * self.period
        return torque

    def _advance(
        self,
        pool: Rollout,
        models: list[mujoco.MjModel],
        data: list[mujoco.MjData],
        torque: FloatArray,
        push: FloatArray | None,
    ) -> None:
        """One control step of physics."""
        n = len(models)
        control, specification = self.control, _CONTROL
        if push is not None:
            control, specification = self.pushed_control, _PUSHED
            first = self.push_address
            control[:n, :, first : first + 3] = push[:, None]
        control[:n, :, self.motors] = torque[:, None]
        pool.rollout(
            models,
            data,
            self.state[:n],
            control[:n],
            control_spec=specification,
            skip_checks=True,
            nstep=self.hold,
            state=self.states[:n],
            sensordata=self.sensors[:n],
        )
        self.state[:n] = self.states[:n, -1]

    def _sense(self, record: Recording, k: int, running: int) -> None:
        """What the sensors saw at the start of the control step; contact throughout it."""
        where, now = self.addresses, self.sensors[:running, 0]
        record.com[k, :running] = now[:, where.com : where.com + 3]
        record.momentum[k, :running] = now[:, where.momentum : where.momentum + 3]
        record.height[k, :running] = now[:, where.height]
        touches = self.sensors[:running, :, where.contact] > 0
        record.contact[k, :running] = touches.any(axis=1)
        if k > 0:
            # The last Runge-Kutta stage of the step before has felt this contact already.
            record.contact[k - 1, :running] |= touches[:, 0]


@contextmanager
def _no_warnings() -> Iterator[None]:
    """Keeps MuJoCo from writing MUJOCO_LOG.TXT where the user stands; `Recording.stable` tells."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _message: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def _control_steps(world: World, period: float) -> int:
    return max(1, int(np.ceil(world.duration / period - 1e-9)))


def _held(values: FloatArray, hold: int) -> FloatArray:
    """The same values in each step of a control step, shape (n, hold, ...)."""
    return np.ascontiguousarray(np.repeat(values[:, None], hold, axis=1))


def _pool_size(threads: int | None, worlds: int) -> int:
    """Threads beside the calling one; a single thread runs without a pool."""
    wanted = min(threads or len(os.sched_getaffinity(0)), worlds)
    return wanted if wanted > 1 else 0
