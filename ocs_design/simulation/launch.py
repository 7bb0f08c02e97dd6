"""The start of a simulated maneuver: the turn to be followed, and the initial pose and motion."""

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.export.physics import set_trunk
from ocs_design.requirement.boundary import Boundary
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.reference import NO_TURN, Turn

_ORBIT_HEIGHT = 100.0
"""Height of a robot in orbit over the model's floor, which it never touches [m]."""

_CLEARANCE = 1e-3
"""Gap under the feet at lift-off, over the standing height."""


def turn_of(maneuver: Maneuver, boundary: Boundary, *, drop_at_once: bool = False) -> Turn:
    """Turn of the trunk in a maneuver that is not planned; `drop_at_once`: see `Options`."""
    initial = quaternions.rotation_vector(boundary.attitude)
    commanded = np.append(maneuver.angles, 0.0)
    if maneuver.on_pivot or not (initial.any() or commanded.any()):
        return NO_TURN
    falls, turn = bool(initial.any()), initial if initial.any() else commanded
    angle = float(np.linalg.norm(turn))
    return Turn(
        turn / angle,
        start=angle if falls else 0.0,
        end=0.0 if falls else angle,
        duration=boundary.duration,
        extendable=not falls,
        at_once=falls and drop_at_once,
    )


def flight_time(maneuver: Maneuver, boundary: Boundary) -> float:
    """Time until the feet of the levelled robot meet the ground, or a turn or a catch ends [s]."""
    if maneuver.on_pivot or not maneuver.gravity:
        return boundary.duration
    drop = 0.0 if boundary.height is None else boundary.height - maneuver.standing_height
    # The push is counted as if at lift-off, which makes the flight a little too long.
    push_velocity = boundary.push.acceleration[2] * boundary.push.duration
    up = maneuver.takeoff[1] + max(push_velocity, 0.0)
    return float((up + np.sqrt(up**2 + 2.0 * maneuver.gravity * drop)) / maneuver.gravity)


def start_height(maneuver: Maneuver, boundary: Boundary, standing_height: float) -> float:
    """Height of the trunk frame's origin at the start [m]; at lift-off the feet are just clear."""
    if not maneuver.gravity:
        return _ORBIT_HEIGHT
    lift_off = standing_height * (1.0 + _CLEARANCE)
    return lift_off if boundary.height is None else boundary.height


def place(
    robot: Robot, model: mujoco.MjModel, data: mujoco.MjData, start: Boundary, velocity: FloatArray
) -> None:
    """Write the start of a flight into `data`.

    Args:
        start: its attitude, height and rate.
        velocity: of the robot's centre of mass [m/s], shape (3,).
    """
    assert start.height is not None
    rotation = quaternions.matrix(start.attitude)
    set_trunk(robot, model, data, rotation, start.height)
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    first = int(model.jnt_dofadr[free])
    data.qvel[first : first + 3] = velocity
    if start.rate.any():
        mujoco.mj_forward(model, data)
        # Everything turns about the centre of mass as one rigid body; the free joint's angular rate
        # is in the frame of its own body.
        base = np.array(data.xmat[model.jnt_bodyid[free]]).reshape(3, 3)
        rate = rotation @ start.rate
        arm = data.xpos[model.jnt_bodyid[free]] - data.subtree_com[0]
        data.qvel[first : first + 3] += np.cross(rate, arm)
        data.qvel[first + 3 : first + 6] = base.T @ rate
