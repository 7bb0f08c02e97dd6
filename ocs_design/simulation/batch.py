"""Worlds that run in step: the physics in MuJoCo's `rollout`, the law vectorised in between."""

from collections.abc import Callable, Iterator, Sequence
from threading import Event

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from ocs_design.arrays import FloatArray
from ocs_design.simulation import quaternions
from ocs_design.simulation.controller import WheelLaw
from ocs_design.simulation.desaturation import WheelBrake
from ocs_design.simulation.imperfections import Drives, Sensing
from ocs_design.simulation.legs import LegReferences
from ocs_design.simulation.lift_off import FlightClock
from ocs_design.simulation.recording import Recording, empty_recording, pose_stride
from ocs_design.simulation.schedule import Pushes, References
from ocs_design.simulation.world import World, start_states

_CONTROL = mujoco.mjtState.mjSTATE_CTRL.value
_PUSHED = _CONTROL | mujoco.mjtState.mjSTATE_XFRC_APPLIED.value

_TELLING = 20
"""Control steps from one report of progress to the next."""


class Batch:
    """Worlds from start to end, with the buffers that this takes.

    Those that still run are a leading slice of every buffer, a view without copies.
    """

    def __init__(self, worlds: Sequence[World], hold: int, pose_rate: float | None = None) -> None:
        """Of worlds with models of equal sizes, longest first; see `simulate`."""
        first = worlds[0].model
        self._hold, self._period = hold, hold * first.opt.timestep
        self._models = [world.model for world in worlds]
        self._lengths = np.array([_control_steps(world, self._period) for world in worlds])
        times = self._period * np.arange(self._lengths[0])
        self._record = empty_recording(
            times, self._lengths, pose_stride=pose_stride(pose_rate, self._period), nq=first.nq
        )
        self._references = References(worlds, times, self._period)
        self._pushes = Pushes(worlds, times, self._period)
        self._legs = LegReferences(worlds, hold)
        self._clock = FlightClock(worlds, self._period)
        self._law = WheelLaw.stack([world.law for world in worlds])
        self._sensing, self._drives = self._reality(worlds)
        self._brake = WheelBrake.of(worlds, self._period)
        self._chain, self._addresses = worlds[0].chain, worlds[0].addresses
        self._wheels, self._motors = list(self._addresses.wheels), list(self._addresses.motors)
        self._state = start_states(worlds)
        self._qpos, self._qvel = np.split(
            self._state[:, 1 : 1 + first.nq + first.nv], [first.nq], 1
        )
        self._make_buffers(np.stack([world.ctrl for world in worlds]), first)

    def _reality(self, worlds: Sequence[World]) -> tuple[Sensing | None, Drives | None]:
        """Sensors and drives; None where they are perfect, as in all of a batch or in none."""
        own = [world.imperfections for world in worlds if world.imperfections is not None]
        if not own:
            return None, None
        drives = Drives(
            own,
            response=self._law.wheel_response,
            instants=int(self._lengths[0]),
            hold=self._hold,
            step=worlds[0].model.opt.timestep,
        )
        return Sensing(own, self._lengths.tolist()), drives

    def _make_buffers(self, ctrl: FloatArray, model: mujoco.MjModel) -> None:
        """What `rollout` reads and writes; every step of a control step has its own row."""
        n, hold = len(ctrl), self._hold
        self._states = np.empty((n, hold, self._state.shape[1]))
        self._sensors = np.empty((n, hold, model.nsensordata))
        self._control = _held(ctrl, hold)
        self._pushed_control = _held(np.hstack([ctrl, np.zeros((n, 6 * model.nbody))]), hold)
        self._push_address = model.nu + 6 * self._addresses.trunk + 3

    def run(self, threads: int, stop: Event, progress: Callable[[float], None]) -> Recording:
        """Run all worlds to their ends, once.

        Args:
            threads: of the physics.
            stop: set from elsewhere to give up; the recording is then not complete.
            progress: told the part of the work that is done, 0..1.
        """
        data = [mujoco.MjData(self._models[0]) for _ in range(threads)]
        # Without a pool the calling thread does the work.
        with Rollout(nthread=threads if threads > 1 else 0) as pool:
            for k, running, law in self._control_steps():
                if stop.is_set():
                    break
                if k % _TELLING == 0:
                    progress(float(np.minimum(self._lengths, k).sum() / self._lengths.sum()))
                torque = self._observe_and_decide(k, running, law)
                self._advance(pool, data, k, torque, self._push_in_world(k, running))
                self._sense(k, running)
        missing = np.abs(self._state[:, 0] - self._lengths * self._period)
        finite = np.isfinite(self._state).all(axis=1)
        self._record.stable[:] = finite & (missing < 0.5 * self._period)
        for index in np.flatnonzero(~self._record.stable).tolist():
            self._record.warning[index] = self._warning(index, data[0])
        self._record.lift_off[:] = self._clock.lift_off
        return self._record

    def _warning(self, index: int, data: mujoco.MjData) -> int:
        """What MuJoCo says to the last state of a world as it takes one more step; -1: nothing."""
        model = self._models[index]
        mujoco.mj_resetData(model, data)
        mujoco.mj_setState(model, data, self._state[index], mujoco.mjtState.mjSTATE_FULLPHYSICS)
        data.ctrl[:] = self._control[index, -1]
        mujoco.mj_step(model, data)
        said = np.flatnonzero(data.warning.number)
        return int(said[0]) if said.size else -1

    def _control_steps(self) -> Iterator[tuple[int, int, WheelLaw | None]]:
        """Each control instant, how many worlds run, and their law; None where all are off."""
        begin = 0
        for end in np.unique(self._lengths):
            running = int(np.count_nonzero(self._lengths > begin))
            law = self._law.take(slice(running))
            for k in range(begin, end):
                yield k, running, None if law.is_off else law
            begin = end

    def _observe_and_decide(self, k: int, running: int, law: WheelLaw | None) -> FloatArray:
        """Record trunk and wheels at instant `k`; torques on the wheels from then on.

        Shape (n, 1, 2) where they are held for the control step, (n, hold, 2) where they are not.
        """
        record, qpos, qvel = self._record, self._qpos[:running], self._qvel[:running]
        attitude, rate = self._chain.attitude(qpos), self._chain.rate(qpos, qvel)
        speed = qvel[:, self._wheels]
        record.attitude[k, :running] = attitude
        record.rate[k, :running] = rate
        record.wheel_speed[k, :running] = speed
        if record.pose_stride and k % record.pose_stride == 0:
            record.qpos[k // record.pose_stride, :running] = qpos
        if law is None:
            torque = np.zeros((running, 2))
        else:
            steps = self._clock.steps(k, running)
            vertical = quaternions.vertical(attitude)
            contact = record.contact[k - 1, :running]
            target = self._references.at(steps).landed(contact)
            if self._brake is not None:
                target = self._brake.added(target, speed, contact)
            if self._sensing is not None:
                vertical, rate = self._sensing.measured(k, vertical, rate)
            torque = law.torque(vertical, rate, speed, target, self._period)
            # The wheels wait for lift-off.
            torque[steps < 0] = 0.0
        acting = torque[:, None]
        if self._drives is not None:
            torque, acting = self._drives.driven(k, torque, speed)
        record.wheel_torque[k, :running] = torque
        return acting

    def _push_in_world(self, k: int, running: int) -> FloatArray | None:
        """The outer torque of this step in the world; its impulse is added to the record."""
        record, push, torque = self._record, self._pushes.at(self._clock.steps(k, running)), None
        if push is not None:
            rotation = quaternions.matrix(record.attitude[k, :running])
            torque = np.einsum("nij,nj->ni", rotation, push)
        if k + 1 < len(record.time):
            gained = 0.0 if torque is None else torque * self._period
            record.impulse[k + 1, :running] = record.impulse[k, :running] + gained
        return torque

    def _advance(
        self,
        pool: Rollout,
        data: list[mujoco.MjData],
        k: int,
        torque: FloatArray,
        push: FloatArray | None,
    ) -> None:
        """Control step `k` of physics."""
        n = len(torque)
        control, specification = self._control, _CONTROL
        if push is not None:
            control, specification = self._pushed_control, _PUSHED
            first = self._push_address
            control[:n, :, first : first + 3] = push[:, None]
        self._legs.write(k, control[:n])
        control[:n, :, self._motors] = torque
        pool.rollout(
            self._models[:n],
            data,
            self._state[:n],
            control[:n],
            control_spec=specification,
            skip_checks=True,
            nstep=self._hold,
            state=self._states[:n],
            sensordata=self._sensors[:n],
        )
        self._state[:n] = self._states[:n, -1]

    def _sense(self, k: int, running: int) -> None:
        """What the sensors saw at the start of the control step; contact throughout it."""
        where, record = self._addresses, self._record
        now = self._sensors[:running, 0]
        record.com[k, :running] = now[:, where.com : where.com + 3]
        record.momentum[k, :running] = now[:, where.momentum : where.momentum + 3]
        record.height[k, :running] = now[:, where.height]
        touches = self._sensors[:running, :, where.contact] > 0
        record.contact[k, :running] = touches.any(axis=1)
        self._clock.look(k, touches)
        if k > 0:
            # The last Runge-Kutta stage of the step before has felt this contact already.
            record.contact[k - 1, :running] |= touches[:, 0]


def _control_steps(world: World, period: float) -> int:
    return max(1, int(np.ceil(world.duration / period - 1e-9)))


def _held(values: FloatArray, hold: int) -> FloatArray:
    """The same values in each step of a control step, shape (n, hold, ...)."""
    return np.ascontiguousarray(np.repeat(values[:, None], hold, axis=1))
