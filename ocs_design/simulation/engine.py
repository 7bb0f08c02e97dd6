"""The batch engine: one world or thousands, the wheel law closed over all of them at once.

The physics runs in MuJoCo's threaded `rollout`, a few steps at a time; in between, the law runs
vectorised over the worlds. One control step is `hold` physics steps, through which motor torque and
outer torque stay as they are.
"""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import mujoco
import numpy as np
from mujoco.rollout import Rollout
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import Target, WheelLaw
from ocs_design.simulation.world import World, start_states

Progress = Callable[[float], None]

_CONTROL = mujoco.mjtState.mjSTATE_CTRL.value
_PUSHED = _CONTROL | mujoco.mjtState.mjSTATE_XFRC_APPLIED.value


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
        lengths: number of instants of each world, (n,).
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
    lengths: NDArray[np.int64]


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
    with Rollout(nthread=_pool_size(threads, len(worlds))) as pool:
        recording = batch.run(pool, progress)
    return _reordered(recording, np.argsort(order))


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
        record = _empty_recording(times, self.lengths)
        references = _References(self.worlds, times, self.period)
        pushes = _push_torques(self.worlds, times, self.period)
        law = WheelLaw.stack([world.law for world in self.worlds])
        data = [mujoco.MjData(self.models[0]) for _ in range(max(1, pool.nthread))]
        running = len(self.worlds)
        active, models = law, self.models
        for k in range(count):
            if self.lengths[running - 1] <= k:
                running = int(np.count_nonzero(self.lengths > k))
                active, models = law.take(slice(running)), self.models[:running]
                references.keep(running)
            self._observe(record, k, running)
            torque = active.torque(
                record.attitude[k, :running],
                record.rate[k, :running],
                record.wheel_speed[k, :running],
                references.at(k),
                self.period,
            )
            record.wheel_torque[k, :running] = torque
            push = pushes.get(k)
            self._advance(pool, models, data, torque, self._in_world(record, k, running, push))
            self._sense(record, k, running)
            if progress is not None and k % 20 == 0:
                progress(float(np.minimum(self.lengths, k).sum() / self.lengths.sum()))
        if progress is not None:
            progress(1.0)
        return record

    def _observe(self, record: Recording, k: int, running: int) -> None:
        """Trunk and wheels at instant `k`."""
        qpos = self.state[:running, 1 : 1 + self.nq]
        qvel = self.state[:running, 1 + self.nq :]
        record.attitude[k, :running] = self.chain.attitude(qpos)
        record.rate[k, :running] = self.chain.rate(qpos, qvel)
        record.wheel_speed[k, :running] = qvel[:, self.wheels]

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


class _References:
    """What every trunk should do at each control instant, tabulated before the run."""

    def __init__(self, worlds: Sequence[World], times: FloatArray, period: float) -> None:
        self._axis = np.stack([world.turn.axis for world in worlds])
        later = np.append(times, times[-1] + period)
        self._angle = np.stack([world.turn.angle(times) for world in worlds], axis=1)
        rates = np.stack([world.turn.rate(later) for world in worlds], axis=1)
        self._rate = rates[:-1]
        # The mean over the step that the torque is held for brings the rate to where it should be.
        self._acceleration = np.diff(rates, axis=0) / period

    def keep(self, running: int) -> None:
        """Forget worlds that have ended."""
        self._axis = self._axis[:running]
        self._angle = self._angle[:, :running]
        self._rate = self._rate[:, :running]
        self._acceleration = self._acceleration[:, :running]

    def at(self, k: int) -> Target:
        """At control instant `k`."""
        tilt_axis = self._axis[:, :2]
        return Target(
            quaternions.from_axis_angle(self._axis, self._angle[k]),
            self._rate[k][:, None] * tilt_axis,
            self._acceleration[k][:, None] * tilt_axis,
        )


def _push_torques(
    worlds: Sequence[World], times: FloatArray, period: float
) -> dict[int, FloatArray]:
    """Outer torques in B [N m], shape (n, 3), by control step; steps without any are left out."""
    shares = np.stack([world.push.share(times, period) for world in worlds], axis=1)
    torques = np.stack([world.push.torque for world in worlds])
    return {int(k): shares[k][:, None] * torques for k in np.flatnonzero(shares.any(axis=1))}


def _control_steps(world: World, period: float) -> int:
    return max(1, int(np.ceil(world.duration / period - 1e-9)))


def _held(values: FloatArray, hold: int) -> FloatArray:
    """The same values in each step of a control step, shape (n, hold, ...)."""
    return np.ascontiguousarray(np.repeat(values[:, None], hold, axis=1))


def _pool_size(threads: int | None, worlds: int) -> int:
    """Threads beside the calling one; a single thread runs without a pool."""
    wanted = min(threads or len(os.sched_getaffinity(0)), worlds)
    return wanted if wanted > 1 else 0


def _empty_recording(times: FloatArray, lengths: NDArray[np.int64]) -> Recording:
    k, n = len(times), len(lengths)

    def unknown(*shape: int) -> FloatArray:
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
        lengths=lengths,
    )


def _reordered(recording: Recording, order: NDArray[np.intp]) -> Recording:
    """The worlds back in the caller's order."""
    series = {
        field.name: getattr(recording, field.name)[:, order]
        for field in fields(Recording)
        if field.name not in {"time", "lengths"}
    }
    return Recording(time=recording.time, lengths=recording.lengths[order], **series)
