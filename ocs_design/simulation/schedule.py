"""Schedule of a run, known before it starts: references of trunk and legs, and external torques.

`K_p (q_ref - q) + K_d (q_dot_ref - q_dot) + tau_ref` (paper, section 4) is what a position drive
gives for the command `q_ref + (K_d q_dot_ref + tau_ref) / K_p`; its force limit applies to the sum.
Unlike the wheel law it needs no feedback from the batch, and changes at every physics step.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray, interpolated
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.target import RegulatedPlan, Target
from ocs_design.simulation.wheel_law import WheelLaw
from ocs_design.simulation.world import World
from ocs_design.sizing.trajectory.gyrostat import shared_by_others
from ocs_design.sizing.trajectory.motion import Trajectory

_EARLIEST_LIFT_OFF = 0.5
"""Share of the push-off before which lost ground contact does not count as lift-off."""

FLIGHT_CONFIRMATION = 5e-3
"""Time without ground contact after which a robot counts as in flight [s]."""

SCRAPE_TIME = 30e-3
"""A foot that touches again within this time has not lifted off yet [s]: a hop as short rises by
1 mm."""

NEVER = -1


class FlightClock:
    """Counts each world's control steps since lift-off.

    A ballistic world flies from the start. A standing one waits until its legs have come to rest
    under its weight, and counts from then.
    """

    def __init__(self, worlds: Sequence[World], period: float) -> None:
        planned = np.array([0.0 if w.legs is None else w.legs.lift_off for w in worlds])
        self._earliest = np.ceil(_EARLIEST_LIFT_OFF * planned / period)
        self._sure = max(1, round(FLIGHT_CONFIRMATION / period))
        self._scrape = round(SCRAPE_TIME / period)
        self._in_air = np.zeros(len(worlds), dtype=np.int64)
        standing = np.array([world.stands or 0.0 for world in worlds])
        settled = np.round(standing / period).astype(np.int64)
        self.lift_off: NDArray[np.int64] = np.where(planned > 0.0, NEVER, settled)

    def steps(self, k: int, running: int) -> NDArray[np.int64]:
        """Control steps since lift-off at instant `k`; negative for a world on the ground."""
        lift_off = self.lift_off[:running]
        return np.where(lift_off == NEVER, NEVER, k - lift_off)

    def update(self, k: int, touches: NDArray[np.bool_]) -> None:
        """Note which worlds were in the air throughout control step `k`.

        Args:
            touches: whether anything touches the floor in each of its physics steps, (n, hold).
        """
        lift_off, in_air = self.lift_off[: len(touches)], self._in_air[: len(touches)]
        free = (k >= self._earliest[: len(touches)]) & ~touches.any(axis=1)
        in_air[:] = np.where(free, in_air + 1, 0)
        pushes_off = self._earliest[: len(touches)] > 0.0
        lift_off[pushes_off & touches.any(axis=1) & (k - lift_off < self._scrape)] = NEVER
        flies = (lift_off == NEVER) & (in_air == self._sure)
        lift_off[flies] = k + 1 - self._sure

    def bears_weight(self, k: int, contact: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which worlds touch the ground and are not pushing off, for which plans have torques."""
        n = len(contact)
        return np.asarray(contact & ((self.steps(k, n) >= 0) | (self._earliest[:n] == 0.0)))


class LegReferences:
    """Commands of the joint drives of all worlds; worlds with equal commands share a table."""

    def __init__(self, worlds: Sequence[World], hold: int) -> None:
        # Equal for worlds with the same commands.
        keys = [
            (
                id(world.legs),
                world.model.actuator_gainprm[:, 0].tobytes(),
                world.model.actuator_biasprm[:, 2].tobytes(),
                world.ctrl.tobytes(),
            )
            for world in worlds
        ]
        rows = {key: row for row, key in enumerate(dict.fromkeys(keys))}
        tables = [_commands(worlds[keys.index(key)]) for key in rows]
        length = max(map(len, tables)) + hold
        self._hold, self._last = hold, length - hold
        self._row = np.array([rows[key] for key in keys])
        self._support = np.stack([world.support for world in worlds])
        # The last command is held.
        self._commands = np.stack(
            [np.pad(table, ((0, length - len(table)), (0, 0)), mode="edge") for table in tables]
        )

    def write(self, k: int, control: FloatArray, bears_weight: NDArray[np.bool_]) -> None:
        """Put the commands of control step `k` into `control`, shape (n, hold, nu and more).

        `bears_weight`: whether the legs of each of these n worlds must support it, shape (n,).
        """
        first = min(k * self._hold, self._last)
        commands = self._commands[self._row[: len(control)], first : first + self._hold]
        control[:, :, : commands.shape[2]] = commands
        control[:, :, : commands.shape[2]] += (
            bears_weight[:, None] * self._support[: len(commands)]
        )[:, None]


def _commands(world: World) -> FloatArray:
    """Commands at each physics step until they no longer change, shape (steps, nu)."""
    if world.legs is None:
        return world.ctrl[None]
    model, legs = world.model, world.legs
    times = np.arange(0.0, legs.time[-1] + model.opt.timestep, model.opt.timestep)
    commands = np.tile(world.ctrl, (len(times) + 1, 1))
    actuators = [model.actuator(name).id for name in legs.joints]
    stiffness = model.actuator_gainprm[actuators, 0]
    damping = -model.actuator_biasprm[actuators, 2]
    position, velocity, torque = (
        interpolated(times, legs.time, values)
        for values in (legs.position, legs.velocity, legs.torque)
    )
    commands[:-1, actuators] = position + (damping * velocity + torque) / stiffness
    return commands


_LEVEL = np.array([0.0, 0.0, 1.0])

_LEVEL_COSINE = np.cos(LANDING_TOLERANCE)
"""Cosine of the tilt up to which a plan ends level: an axis that no wheel controls may drift."""


def track(trajectory: Trajectory, law: WheelLaw, times: FloatArray, period: float) -> Target:
    """The trajectory as the law of one world follows it; its last attitude is held after the end.

    Args:
        law: of one world.
        times: of the control instants from lift-off or release [s], shape (k,).
        period: from one to the next [s].

    Returns:
        Target with instants in place of worlds. Its acceleration is zero: the torque includes it.
    """
    flying = (times < trajectory.time[-1])[:, None]
    vertical = interpolated(times, trajectory.time, trajectory.vertical)
    vertical = vertical / np.linalg.norm(vertical, axis=1, keepdims=True)
    rate = flying * interpolated(times, trajectory.time, trajectory.rate)
    speed = interpolated(times, trajectory.time, trajectory.wheel_speed)

    # The mean over each control step of a torque that is linear between samples and zero after the
    # last: held for a step, it gives the momentum planned for that step.
    samples, values = trajectory.time, trajectory.wheel_torque
    until = np.clip(np.append(times, times[-1] + period), samples[0], samples[-1])
    before = np.clip(np.searchsorted(samples, until, side="right") - 1, 0, len(samples) - 2)
    steps = 0.5 * np.diff(samples)[:, None] * (values[1:] + values[:-1])
    cumulative = np.vstack([np.zeros(values.shape[1]), np.cumsum(steps, axis=0)])
    part = 0.5 * (until - samples[before])[:, None]
    integral = cumulative[before] + part * (values[before] + interpolated(until, samples, values))
    mean_torque = np.diff(integral, axis=0) / period

    final_vertical = trajectory.vertical[-1]
    if trajectory.gains is None and final_vertical[2] >= _LEVEL_COSINE:
        final_vertical = _LEVEL
    verticals = np.where(flying, vertical, final_vertical)
    stands = np.zeros(len(times), dtype=np.bool_)
    if trajectory.gains is not None and trajectory.attitude is not None:
        attitude = interpolated(times, trajectory.time, trajectory.attitude)
        gains = interpolated(times, trajectory.time, trajectory.gains.reshape(len(samples), -1))
        plan = RegulatedPlan(
            attitude / np.linalg.norm(attitude, axis=1, keepdims=True),
            rate,
            speed,
            mean_torque,
            gains.reshape(len(times), *trajectory.gains.shape[1:]),
            flying[:, 0],
        )
        return Target(
            verticals, rate, np.zeros_like(rate), np.zeros_like(mean_torque), stands, plan
        )
    # The law adds the gyroscopic torque of the measured motion; that of the planned motion is
    # already in the planned torque.
    planned = law.gyroscopic(rate, speed) @ law.torque_map[0, :, 2:].T
    return Target(verticals, rate, np.zeros_like(rate), mean_torque - planned, stands)


Steps: TypeAlias = NDArray[np.int64]
"""Control steps since lift-off, one number per world; negative on the ground."""


class References:
    """References of every trunk at each control instant of its flight, tabulated in advance."""

    def __init__(self, worlds: Sequence[World], times: FloatArray, period: float) -> None:
        later = np.append(times, times[-1] + period)
        axis = np.stack([world.turn.axis for world in worlds])
        angle = np.stack([world.turn.angle(times) for world in worlds], axis=1)
        rates = np.stack([world.turn.rate(later) for world in worlds], axis=1)[..., None]
        self._vertical = quaternions.vertical(quaternions.from_axis_angle(axis, angle))
        self._rate = rates[:-1] * axis
        # The mean over the step for which the torque is held brings the rate to its next reference.
        self._acceleration = np.diff(rates, axis=0) / period * axis
        self._torque = np.zeros((len(times), len(worlds), len(worlds[0].wheels)))
        # First row of each world's regulated plan among the rows of all; samples share theirs.
        plans: dict[int, RegulatedPlan] = {}
        self._first_row = np.full(len(worlds), NEVER)
        for index, world in enumerate(worlds):
            if world.trajectory is not None:
                planned = track(world.trajectory, world.law, times, period)
                self._vertical[:, index] = planned.vertical
                self._rate[:, index] = planned.rate
                self._acceleration[:, index] = planned.acceleration
                self._torque[:, index] = planned.torque
                if planned.plan is not None:
                    plans[id(world.trajectory)] = planned.plan
                    self._first_row[index] = len(times) * list(plans).index(id(world.trajectory))
        self._plans = RegulatedPlan.joined(list(plans.values())) if plans else None

    def at(self, steps: Steps) -> Target:
        """References of the worlds in the air, each at its number of steps since lift-off."""
        rows, plan = (np.maximum(steps, 0), np.arange(len(steps))), None
        if self._plans is not None:
            first = self._first_row[: len(steps)]
            plan = self._plans.take(np.maximum(first, 0) + rows[0])
            plan = replace(plan, holds=plan.holds & (first != NEVER))
        return Target(
            self._vertical[rows],
            self._rate[rows],
            self._acceleration[rows],
            self._torque[rows],
            np.zeros(len(steps), dtype=np.bool_),
            plan,
        )


class Pushes:
    """External torques on the trunks [N m] and accelerations [m/s^2] in B, per control step."""

    def __init__(self, worlds: Sequence[World], times: FloatArray, period: float) -> None:
        self._pushed = np.zeros((len(times), len(worlds), 2, 3))
        for index, world in enumerate(worlds):
            for specified in world.pushes:
                push = specified
                if specified.force.any():
                    # Centre of mass of everything that flies, at the start, in B.
                    model, data = world.model, mujoco.MjData(world.model)
                    data.qpos[:] = world.qpos
                    mujoco.mj_kinematics(model, data)
                    mujoco.mj_comPos(model, data)
                    trunk = world.addresses.trunk
                    to_body = data.xmat[trunk].reshape(3, 3)
                    origin = data.xpos[trunk] + to_body @ world.chain.origin
                    to_world = quaternions.matrix(world.chain.attitude(world.qpos))
                    com = (data.subtree_com[0] - origin) @ to_world
                    push = specified.of_force(float(model.body_mass.sum()), com)
                share = push.share(times, period)[:, None, None]
                self._pushed[:, index] += share * np.stack([push.torque, push.acceleration])
        acting = np.flatnonzero(self._pushed.any(axis=(1, 2, 3)))
        self._first = int(acting[0]) if acting.size else 1
        self._last = int(acting[-1]) if acting.size else 0

    def at(self, steps: Steps) -> FloatArray | None:
        """Torque and acceleration of the first n worlds, shape (n, 2, 3); None: all are zero."""
        if not ((steps >= self._first) & (steps <= self._last)).any():
            return None
        rows = np.maximum(steps, 0), np.arange(len(steps))
        return np.where(steps[:, None, None] < 0, 0.0, self._pushed[rows])


class StoppedDrives:
    """Drives that stop in flight, and how the law shares torques once it knows."""

    def __init__(self, worlds: Sequence[World], period: float) -> None:
        count, wheels = len(worlds), len(worlds[0].wheels)
        self._last = np.full(count, np.iinfo(np.int64).max)
        self._known, self._is_running = self._last.copy(), np.ones((count, wheels), dtype=np.bool_)
        self._shared = np.tile(np.eye(wheels), (count, 1, 1))
        for row, world in enumerate(worlds):
            if (stopped := world.stopped) is not None:
                self._last[row] = round(stopped.instant / period)
                self._known[row] = round((stopped.instant + stopped.detection) / period)
                self._is_running[row, stopped.wheel] = False
                self._shared[row] = shared_by_others(world.body.axes, stopped.wheel)

    def shared(self, steps: Steps) -> FloatArray:
        """Matrices from commands to torques of the running motors, see `Target`, (n, m, m)."""
        known = steps >= self._known[: len(steps)]
        unshared = np.eye(self._is_running.shape[1])
        return np.where(known[:, None, None], self._shared[: len(steps)], unshared)

    def without_stopped(self, steps: Steps, torque: FloatArray) -> FloatArray:
        """Torques with those of stopped motors set to zero, shape (n, m)."""
        runs = self._is_running[: len(steps)] | (steps < self._last[: len(steps)])[:, None]
        return np.where(runs, torque, 0.0)
