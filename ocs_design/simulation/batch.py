"""Worlds that run in lockstep: physics in MuJoCo's `rollout`, the vectorised law in between."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields, replace
from threading import Event

import mujoco
import numpy as np
from mujoco.rollout import Rollout
from numpy.typing import NDArray

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.desaturation import WheelBrake
from ocs_design.simulation.engine import Engine, Physics
from ocs_design.simulation.imperfections import ImperfectDrives, Sensing
from ocs_design.simulation.schedule import (
    FlightClock,
    LegReferences,
    Pushes,
    References,
    StoppedDrives,
)
from ocs_design.simulation.wheel_law import WheelLaw
from ocs_design.simulation.world import ANCHOR, World, start_states, total_mass_properties


@dataclass(frozen=True, eq=False)
class Recording:
    """What happened in n worlds at k control instants; a world that has ended holds NaN.

    Attributes:
        time: [s], shape (k,).
        attitude: of the trunk, quaternions (k, n, 4).
        rate: of the trunk in B [rad/s], (k, n, 3).
        wheel_speed: relative to the trunk [rad/s], (k, n, wheels).
        wheel_torque: of the motors on the wheels, held until the next instant [N m],
            (k, n, wheels).
        com: centre of mass in the world, without an anchor [m], (k, n, 3).
        momentum: angular, about the centre of mass or the pivot, in the world [N m s], (k, n, 3).
        impulse: of the external torque since the start, and of gravity's about a pivot, in the
            world [N m s], (k, n, 3).
        height: of B's origin over the floor [m], (k, n).
        contact: whether anything touches the floor before the next instant, (k, n).
        pose_stride: control steps from one recorded pose to the next; 0: no poses are recorded.
        qpos: the poses, as the models have them, (frames, n, nq).
        lengths: number of instants of each world, (n,).
        stable: whether MuJoCo ran each world to its end, (n,); it stops a world whose state is
            huge or not finite, and repeats its last state from then on.
        warning: what stopped it, an `mjtWarning`, (n,); -1: nothing, or unknown.
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
    times: FloatArray,
    lengths: NDArray[np.int64],
    *,
    wheels: int,
    pose_stride: int = 0,
    nq: int = 0,
) -> Recording:
    """Recording filled with NaN, with zero impulse at the start; `nq` is the length of a pose."""
    k, n = len(times), len(lengths)
    frames = len(times[::pose_stride]) if pose_stride else 0

    def unknown(*shape: int) -> FloatArray:
        """NaN for each instant and world."""
        return np.full((k, n, *shape), np.nan)

    impulse = unknown(3)
    impulse[0] = 0.0
    return Recording(
        time=times,
        attitude=unknown(4),
        rate=unknown(3),
        wheel_speed=unknown(wheels),
        wheel_torque=unknown(wheels),
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


def joined(parts: Sequence[Recording], places: Sequence[NDArray[np.intp]]) -> Recording:
    """Several recordings with equal control steps as one.

    `places`: for each part, the indices of its worlds among all worlds.
    """
    longest = max(parts, key=lambda part: len(part.time))
    combined = empty_recording(
        longest.time,
        np.empty(sum(map(len, places)), dtype=np.int64),
        wheels=longest.wheel_speed.shape[2],
        pose_stride=longest.pose_stride,
        nq=longest.qpos.shape[2],
    )
    for part, place in zip(parts, places, strict=True):
        for name in _PER_WORLD:
            getattr(combined, name)[place] = getattr(part, name)
        for name in _PER_INSTANT:
            series = getattr(part, name)
            getattr(combined, name)[: len(series), place] = series
    return combined


_PER_WORLD = ("lengths", "stable", "warning", "lift_off")
"""Quantities with one value per world."""

_PER_INSTANT = [
    field.name
    for field in fields(Recording)
    if field.name not in {"time", "pose_stride", *_PER_WORLD}
]


_CONTROL = mujoco.mjtState.mjSTATE_CTRL.value
_CONTROL_AND_PUSH = _CONTROL | mujoco.mjtState.mjSTATE_XFRC_APPLIED.value

_REPORT_INTERVAL = 20
"""Control steps between two progress reports."""


class Batch:
    """Runs worlds from start to end, in preallocated buffers.

    The worlds still running are a leading slice of every buffer, so they are views, not copies.
    """

    def __init__(
        self,
        worlds: Sequence[World],
        hold: int,
        pose_rate: float | None = None,
        engine: Engine | None = None,
    ) -> None:
        """Batch of worlds with models of equal sizes, longest first; see `simulate`."""
        self._engine, first = engine, worlds[0].model
        self._hold, self._period = hold, hold * first.opt.timestep
        self._models = [world.model for world in worlds]
        self._lengths = np.array(
            [max(1, int(np.ceil(world.duration / self._period - 1e-9))) for world in worlds]
        )
        times = self._period * np.arange(self._lengths[0])
        self._record = empty_recording(
            times,
            self._lengths,
            wheels=len(worlds[0].wheels),
            pose_stride=max(1, round(1.0 / (pose_rate * self._period))) if pose_rate else 0,
            nq=first.nq,
        )
        self._references = References(worlds, times, self._period)
        self._pushes = Pushes(worlds, times, self._period)
        self._legs = LegReferences(worlds, hold)
        self._clock = FlightClock(worlds, self._period)
        self._law = WheelLaw.joined([world.law for world in worlds])
        # Sensors and drives are perfect in all worlds of a batch or in none.
        imperfections = [world.imperfections for world in worlds if world.imperfections is not None]
        self._sensing = (
            Sensing(imperfections, self._lengths.tolist(), self._period) if imperfections else None
        )
        self._drives = None
        if imperfections:
            self._drives = ImperfectDrives(
                imperfections,
                response=self._law.wheel_response,
                instants=int(self._lengths[0]),
                hold=hold,
                step=first.opt.timestep,
            )
        brakes = [world.desaturation for world in worlds]
        self._brake = WheelBrake(brakes, self._period) if any(brakes) else None
        stops = any(world.stopped for world in worlds)
        self._stopped = StoppedDrives(worlds, self._period) if stops else None
        self._chain, self._addresses = worlds[0].chain, worlds[0].addresses
        self._wheels, self._motors = list(self._addresses.wheels), list(self._addresses.motors)
        self._state = start_states(worlds)
        self._qpos, self._qvel = np.split(
            self._state[:, 1 : 1 + first.nq + first.nv], [first.nq], 1
        )
        # What `rollout` reads and writes, with one row per physics step of a control step.
        n, ctrl = len(worlds), np.stack([world.ctrl for world in worlds])
        self._states = np.empty((n, hold, self._state.shape[1]))
        self._sensors = np.empty((n, hold, first.nsensordata))
        self._control = np.repeat(ctrl[:, None], hold, axis=1)
        unpushed = np.zeros((n, hold, 6 * first.nbody))
        self._pushed_control = np.concatenate([self._control, unpushed], axis=2)
        self._push_address = first.nu + 6 * self._addresses.trunk + 3
        self._body_mass = np.stack([world.model.body_mass for world in worlds])
        # Weights and levers as built, in B; worlds on a pivot form a batch of their own.
        self._weight: FloatArray | None = None
        self._lever: FloatArray | None = None
        if worlds[0].body.stands:
            weights, levers = zip(*map(_weight_and_lever, worlds), strict=True)
            self._weight, self._lever = np.array(weights), np.stack(levers)

    def run(self, threads: int, stop: Event, progress: Callable[[float], None]) -> Recording:
        """Run all worlds to their ends, once.

        If another thread sets `stop`, it is aborted, and the recording is incomplete.
        """
        data = [mujoco.MjData(self._models[0]) for _ in range(threads)]
        # Without a pool the calling thread does the work.
        physics: AbstractContextManager[Physics] = Rollout(nthread=threads if threads > 1 else 0)
        if self._engine is not None:
            physics = self._engine.physics()
        with physics as pool:
            law = self._law
            for k in range(int(self._lengths[0])):
                if stop.is_set():
                    break
                if k % _REPORT_INTERVAL == 0:
                    progress(float(np.minimum(self._lengths, k).sum() / self._lengths.sum()))
                running = int(np.count_nonzero(self._lengths > k))
                if running < len(law.stiffness):
                    law = law.take(slice(running))
                commanded, _ = self.observe_and_decide(k, law)
                self.advance(pool, data, k, self.applied_torque(k, commanded))
                self.record_sensors(k, running)
        return self.recorded(data[0])

    def recorded(self, scratch: mujoco.MjData) -> Recording:
        """The recording, completed with what is known at the end; `scratch` is overwritten."""
        missing = np.abs(self._state[:, 0] - self._lengths * self._period)
        finite = np.isfinite(self._state).all(axis=1)
        self._record.stable[:] = finite & (missing < 0.5 * self._period)
        for index in np.flatnonzero(~self._record.stable).tolist():
            # One more step from the last state shows which warning MuJoCo raises.
            model = self._models[index]
            mujoco.mj_resetData(model, scratch)
            mujoco.mj_setState(
                model, scratch, self._state[index], mujoco.mjtState.mjSTATE_FULLPHYSICS
            )
            scratch.ctrl[:] = self._control[index, -1]
            mujoco.mj_step(model, scratch)
            raised = np.flatnonzero(scratch.warning.number)
            self._record.warning[index] = int(raised[0]) if raised.size else -1
        self._record.lift_off[:] = self._clock.lift_off
        return self._record

    def observe_and_decide(
        self, k: int, law: WheelLaw
    ) -> tuple[FloatArray, tuple[FloatArray, FloatArray, FloatArray]]:
        """Record trunk and wheels at instant `k` of the first n worlds, and evaluate their law.

        Returns:
            Torques commanded to the motors [N m], (n, wheels); vertical, rate and attitude as
            measured, see `WheelLaw.torque`.
        """
        running = len(law.stiffness)
        record, qpos, qvel = self._record, self._qpos[:running], self._qvel[:running]
        attitude, rate = self._chain.attitude(qpos), self._chain.rate(qpos, qvel)
        speed, vertical = qvel[:, self._wheels], quaternions.vertical(attitude)
        record.attitude[k, :running] = attitude
        record.rate[k, :running] = rate
        record.wheel_speed[k, :running] = speed
        if record.pose_stride and k % record.pose_stride == 0:
            record.qpos[k // record.pose_stride, :running] = qpos
        if law.is_off:
            return np.zeros((running, len(self._wheels))), (vertical, rate, attitude)
        steps, contact = self._clock.steps(k, running), record.contact[k - 1, :running]
        target = self._references.at(steps).landed(contact)
        if self._brake is not None:
            target = self._brake.with_braking(target, speed, contact)
        if self._sensing is not None:
            vertical, rate = self._sensing.measured(k, vertical, rate)
            attitude = self._sensing.attitude(k, attitude)
        if self._stopped is not None:
            target = replace(target, shared=self._stopped.shared(steps))
        commanded = law.torque(vertical, rate, speed, target, self._period, attitude=attitude)
        # The wheels wait for lift-off.
        commanded[steps < 0] = 0.0
        if self._stopped is not None:
            commanded = self._stopped.without_stopped(steps, commanded)
        return commanded, (vertical, rate, attitude)

    def applied_torque(self, k: int, torque: FloatArray) -> FloatArray:
        """Torques that the motors apply to the wheels from instant `k` on, given the commands.

        Shape (n, 1, wheels) if they are held for the control step, else (n, hold, wheels).
        """
        n, acting = len(torque), torque[:, None]
        if self._drives is not None:
            torque, acting = self._drives.applied_torque(k, torque, self._record.wheel_speed[k, :n])
        self._record.wheel_torque[k, :n] = torque
        return acting

    def advance(self, pool: Physics, data: list[mujoco.MjData], k: int, torque: FloatArray) -> None:
        """Advance the physics by control step `k`, with its external torque and impulse."""
        n, record = len(torque), self._record
        control, specification = self._control, _CONTROL
        push, impulse = self._pushes.at(self._clock.steps(k, n)), None
        if push is not None:
            to_world = quaternions.matrix(record.attitude[k, :n])
            torque_on, acceleration = np.einsum("nij,npj->pni", to_world, push)
            impulse = torque_on * self._period
            control, specification = self._pushed_control, _CONTROL_AND_PUSH
            first = self._push_address
            control[:n, :, first : first + 3] = torque_on[:, None]
            wrenches = control[:n, :, self._models[0].nu :].reshape(n, self._hold, -1, 6)
            wrenches[..., :3] = (self._body_mass[:n, :, None] * acceleration[:, None])[:, None]
        self._legs.write(k, control[:n], self._clock.bears_weight(k, record.contact[k - 1, :n]))
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
        if self._weight is not None and self._lever is not None:
            impulse = self._gravity_impulse(self._weight[:n, None] * self._lever[:n])
        if k + 1 < len(record.time):
            record.impulse[k + 1, :n] = record.impulse[k, :n] + (
                0.0 if impulse is None else impulse
            )
        self._state[:n] = self._states[:n, -1]

    def _gravity_impulse(self, pull: FloatArray) -> FloatArray:
        """Impulse of gravity's torque about the pivots in a control step [N m s], (n, 3).

        The torque is `z x R (m g l)` and its slope `z x (w x R (m g l))`; over each physics step
        the cubic that matches both at the ends is integrated.
        """
        n, model = len(pull), self._models[0]
        states = np.concatenate([self._state[:n, None], self._states[:n]], axis=1)
        qpos, qvel = np.split(states[..., 1 : 1 + model.nq + model.nv], [model.nq], axis=-1)
        to_world = quaternions.matrix(self._chain.attitude(qpos))
        lever = np.einsum("nsij,nj->nsi", to_world, pull)
        rate = np.einsum("nsij,nsj->nsi", to_world, self._chain.rate(qpos, qvel))
        up, step = np.array([0.0, 0.0, 1.0]), model.opt.timestep
        torque, slope = np.cross(up, lever), np.cross(up, np.cross(rate, lever))
        ends = slope[:, 0] - slope[:, -1]
        means = 0.5 * (torque[:, 1:] + torque[:, :-1])
        return np.asarray(step * means.sum(axis=1) + step**2 / 12.0 * ends)

    def record_sensors(self, k: int, running: int) -> None:
        """Record the sensors at the start of the control step, and any contact during it."""
        addresses, record = self._addresses, self._record
        sensors = self._sensors[:running, 0]
        record.com[k, :running] = sensors[:, addresses.com : addresses.com + 3]
        if self._lever is not None:
            # With its anchor, the centre of mass of the whole is at the pivot.
            to_world = quaternions.matrix(record.attitude[k, :running])
            record.com[k, :running] += np.einsum("nij,nj->ni", to_world, self._lever[:running])
        record.momentum[k, :running] = sensors[:, addresses.momentum : addresses.momentum + 3]
        record.height[k, :running] = sensors[:, addresses.height]
        touches = self._sensors[:running, :, addresses.contact] > 0
        record.contact[k, :running] = touches.any(axis=1)
        self._clock.update(k, touches)
        if k > 0:
            # The last Runge-Kutta stage of the previous step already felt this contact.
            record.contact[k - 1, :running] |= touches[:, 0]


def _weight_and_lever(world: World) -> tuple[float, FloatArray]:
    """Weight of the robot as built [N], and its centre of mass from the pivot, in B [m], (3,)."""
    model, data = world.model, mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    mujoco.mj_kinematics(model, data)
    built = total_mass_properties(model, data)
    lever = built.com - data.xpos[model.body(ANCHOR).id]
    to_world = quaternions.matrix(world.chain.attitude(world.qpos))
    return -built.mass * float(model.opt.gravity[2]), lever @ to_world
