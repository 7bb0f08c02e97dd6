"""What the joint drives are told at every step: a posture, or a jump and then the posture.

`K_p (q_ref - q) + K_d (q_dot_ref - q_dot) + tau_ref` (paper, section 4) is what a position drive
does whose command is `q_ref + (K_d q_dot_ref + tau_ref) / K_p`; its limit of force holds for the
sum. Unlike the wheels' law it needs no feedback from the batch, and changes at every physics step.
"""

from collections.abc import Sequence

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.jumping.leg_trajectory import LegTrajectory
from ocs_design.simulation.drives import DRIVE
from ocs_design.simulation.world import World


class LegReferences:
    """Commands of the joint drives of all worlds, those of equal worlds held once."""

    def __init__(self, worlds: Sequence[World], hold: int) -> None:
        keys = [_key(world) for world in worlds]
        rows = {key: row for row, key in enumerate(dict.fromkeys(keys))}
        tables = [_commands(worlds[keys.index(key)]) for key in rows]
        length = max(map(len, tables)) + hold
        self._hold, self._last = hold, length - hold
        self._row = np.array([rows[key] for key in keys])
        self._commands = np.stack([_lengthened(table, length) for table in tables])

    def write(self, k: int, control: FloatArray) -> None:
        """Put the commands of control step `k` into `control`, shape (n, hold, nu and more)."""
        first = min(k * self._hold, self._last)
        now = self._commands[self._row[: len(control)], first : first + self._hold]
        control[:, :, : now.shape[2]] = now


def _key(world: World) -> tuple[int, bytes, bytes, bytes]:
    """Equal for worlds with the same commands."""
    gain, bias = world.model.actuator_gainprm[:, 0], world.model.actuator_biasprm[:, 2]
    return id(world.legs), gain.tobytes(), bias.tobytes(), world.ctrl.tobytes()


def _commands(world: World) -> FloatArray:
    """At each physics step until they no longer change, shape (steps, nu)."""
    if world.legs is None:
        return world.ctrl[None]
    model, legs = world.model, world.legs
    times = np.arange(0.0, legs.time[-1] + model.opt.timestep, model.opt.timestep)
    commands = np.tile(world.ctrl, (len(times) + 1, 1))
    actuators = [model.actuator(DRIVE + name).id for name in legs.joints]
    commands[:-1, actuators] = _followed(model, legs, actuators, times)
    return commands


def _followed(
    model: mujoco.MjModel, legs: LegTrajectory, actuators: Sequence[int], times: FloatArray
) -> FloatArray:
    stiffness = model.actuator_gainprm[actuators, 0]
    damping = -model.actuator_biasprm[actuators, 2]
    position, velocity, torque = (
        np.column_stack([np.interp(times, legs.time, column) for column in values.T])
        for values in (legs.position, legs.velocity, legs.torque)
    )
    command: FloatArray = position + (damping * velocity + torque) / stiffness
    return command


def _lengthened(table: FloatArray, length: int) -> FloatArray:
    """Its last row repeated."""
    return np.vstack([table, np.repeat(table[-1:], length - len(table), axis=0)])
