"""The poses of a run, to show it again."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.simulation.recording import Recording
from ocs_design.simulation.scene import WHEEL_JOINTS
from ocs_design.simulation.world import World

POSE_RATE = 60.0
"""Poses per second of a replay on a screen [1/s]."""


@dataclass(frozen=True, eq=False)
class Poses:
    """What a model looked like, again and again.

    Attributes:
        time: [s], shape (n,).
        qpos: of the simulated model, free joint first as (x, y, z) [m] and quaternion (w, x, y, z),
            then joints [rad or m]; shape (n, nq).
        bodies: names of the model's b bodies, the world left out.
        position: of their frames in the world [m], shape (n, b, 3).
        attitude: of their frames in the world, quaternions (w, x, y, z), shape (n, b, 4).
        wheel_angle: of the left and the right wheel, all turns counted [rad], shape (n, 2).
    """

    time: FloatArray
    qpos: FloatArray
    bodies: tuple[str, ...]
    position: FloatArray
    attitude: FloatArray
    wheel_angle: FloatArray


def poses_of(recording: Recording, index: int, world: World) -> Poses | None:
    """Poses of one world of a recording; None if there are none."""
    if not recording.pose_stride:
        return None
    time = recording.time[: recording.lengths[index] : recording.pose_stride]
    qpos, model = recording.qpos[: len(time), index], world.model
    position, attitude = _frames(model, qpos)
    wheels = [int(model.joint(name).qposadr[0]) for name in WHEEL_JOINTS]
    return Poses(
        time=time,
        qpos=qpos,
        bodies=tuple(model.body(body).name for body in range(1, model.nbody)),
        position=position,
        attitude=attitude,
        wheel_angle=qpos[:, wheels],
    )


def _frames(model: mujoco.MjModel, qpos: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Positions and quaternions of all bodies but the world, at each pose."""
    data = mujoco.MjData(model)
    position = np.empty((len(qpos), model.nbody - 1, 3))
    attitude = np.empty((len(qpos), model.nbody - 1, 4))
    for k, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        position[k], attitude[k] = data.xpos[1:], data.xquat[1:]
    return position, attitude
