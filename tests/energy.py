"""Energy balance of a recorded run, replayed by a plain loop over MuJoCo's steps."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.batch import Recording
from ocs_design.simulation.schedule import LegReferences
from ocs_design.simulation.world import World


@dataclass(frozen=True, eq=False)
class EnergyBalance:
    """Energies at each control instant.

    Attributes:
        residual: change of energy that no work accounts for [J].
        work: sum of the magnitudes of all work by drives, motors and push since the start [J].
        height: of the centre of mass [m].
    """

    residual: FloatArray
    work: FloatArray
    height: FloatArray

    def relative_residual(self, interval: slice) -> float:
        """Range of the residual in an interval of the run, over the work done by its end."""
        return float(np.ptp(self.residual[interval]) / self.work[interval][-1])


def energy_balance(
    world: World, recording: Recording, index: int, *, period: float, until: float
) -> EnergyBalance:
    """Energy balance of one world, with its recorded wheel torques and push applied again.

    Args:
        world: the world of the recording with number `index`.
        recording: of all worlds.
        index: number of the world in the recording.
        period: time between torques [s].
        until: end of the replay [s].
    """
    model, data, middle = world.model, *(mujoco.MjData(world.model) for _ in range(2))
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    steps, motors = round(period / model.opt.timestep), list(world.addresses.motors)
    legs, control = LegReferences([world], steps), np.zeros((1, steps, model.nu))
    push = np.diff(recording.impulse[:, index], axis=0) / period
    rows, work = [], np.zeros(2)
    for k in range(round(until / period)):
        mujoco.mj_forward(model, data)
        rows.append((data.energy.sum() - work[0], work[1], data.subtree_com[0, 2]))
        legs.write(k, control, np.zeros(1, dtype=bool))
        data.xfrc_applied[world.addresses.trunk, 3:] = push[k]
        for row in control[0]:
            data.ctrl[:] = row
            data.ctrl[motors] = recording.wheel_torque[k, index]
            work += step_with_work(model, data, middle)
    residual, total_work, height = np.array(rows).T
    return EnergyBalance(residual, total_work, height)


def step_with_work(model: mujoco.MjModel, data: mujoco.MjData, middle: mujoco.MjData) -> FloatArray:
    """Advance by a step; integrals of `_powers` over it [J], by Simpson's rule, shape (2,).

    The command jumps from step to step: both ends of the step count with its own. `middle` is
    overwritten.
    """
    step = model.opt.timestep
    mujoco.mj_copyData(middle, model, data)
    try:
        model.opt.timestep = 0.5 * step
        mujoco.mj_step(model, middle)
    finally:
        model.opt.timestep = step
    before = _powers(model, data)
    mujoco.mj_step(model, data)
    return step / 6.0 * (before + 4.0 * _powers(model, middle) + _powers(model, data))


def _powers(model, data) -> FloatArray:
    """Power of all but gravity; sum of magnitudes for drives, motors and push [W]."""
    mujoco.mj_forward(model, data)
    pushed = np.zeros(model.nv)
    for body in np.flatnonzero(data.xfrc_applied.any(axis=1)):
        force, torque = np.split(data.xfrc_applied[body], 2)
        mujoco.mj_applyFT(model, data, force, torque, data.xipos[body], int(body), pushed)
    generalized_force = data.qfrc_actuator + data.qfrc_passive + data.qfrc_constraint + pushed
    driven = np.abs(data.qfrc_actuator * data.qvel).sum() + abs(pushed @ data.qvel)
    return np.array([generalized_force @ data.qvel, driven])
