"""Where a world starts: the robot put into its posture, over or on the floor."""

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.frames import quaternion
from ocs_design.simulation.ground import lowest_point
from ocs_design.simulation.launch import Launch

_CLEARANCE = 1e-3
"""Gap under the feet at lift-off, over the standing height."""


def stand(robot: Robot, model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Put the level trunk at the origin in the nominal posture; its height over its feet [m].

    Zero for a robot that has nothing to stand on: its file gives it no shape.
    """
    _set_posture(robot, model, data)
    _set_trunk(robot, model, data, np.eye(3), 0.0)
    mujoco.mj_forward(model, data)
    lowest = lowest_point(model, data)
    return -lowest if np.isfinite(lowest) else 0.0


def place(
    robot: Robot, model: mujoco.MjModel, data: mujoco.MjData, start: Launch, standing: float
) -> None:
    """Write the start of a flight into `data`."""
    height = standing * (1.0 + _CLEARANCE) if start.height is None else start.height
    _set_trunk(robot, model, data, start.rotation, height)
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    first = int(model.jnt_dofadr[free])
    data.qvel[first : first + 3] = start.velocity


def _set_posture(robot: Robot, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    for name, value in robot.posture.items():
        data.qpos[model.joint(name).qposadr[0]] = value


def _set_trunk(
    robot: Robot, model: mujoco.MjModel, data: mujoco.MjData, rotation: FloatArray, height: float
) -> None:
    """Move the floating base so that the trunk's frame stands over the origin as told."""
    index = robot.tree.body_of_link[robot.trunk]
    in_body = robot.tree.bodies[index].links[robot.trunk]
    in_root = robot.tree.placements(robot.posture)[index] @ in_body
    base = rotation @ in_root.rotation.T
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    first = int(model.jnt_qposadr[free])
    data.qpos[first : first + 3] = np.array([0.0, 0.0, height]) - base @ in_root.position
    data.qpos[first + 3 : first + 7] = quaternion(base)
