"""The start of a maneuver: where the robot is put, its turn, and what hits it on the way."""

from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.maneuver import Disturbance, Drop, Flip, Maneuver, Shove
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.robot import Robot
from ocs_design.robot.rotations import rotation_about
from ocs_design.simulation.reference import LEVEL, Profile, Quintic, Turn
from ocs_design.simulation.scene import lowest_point

ROLL, PITCH = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Push:
    """A torque on the trunk in B [N m], shape (3,), from `onset` for `duration` [s].

    Attributes:
        acceleration: of all of the robot by a force beside it, in B [m/s^2], shape (3,): on each
            body in proportion to its mass, so that it turns nothing.
    """

    torque: FloatArray
    onset: float
    duration: float
    acceleration: FloatArray = field(default_factory=lambda: np.zeros(3))

    def share(self, starts: FloatArray, period: float) -> FloatArray:
        """Part of each control step, from `starts`, in which it acts: its impulse is exact."""
        begin = np.maximum(starts, self.onset)
        end = np.minimum(starts + period, self.onset + self.duration)
        share: FloatArray = np.clip(end - begin, 0.0, None) / period
        return share


NO_PUSH = Push(np.zeros(3), 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Launch:
    """The start of a ballistic flight.

    Attributes:
        rotation: of the trunk in the world, shape (3, 3).
        height: of the trunk frame's origin [m]; None: the feet just clear of the ground.
        velocity: of the whole robot, which does not turn [m/s], shape (3,).
        turn: what the trunk should do.
        push: what hits it.
    """

    rotation: FloatArray
    height: float | None
    velocity: FloatArray
    turn: Turn
    push: Push


def launch(maneuver: Maneuver, standing_height: float, profile: Profile) -> Launch:
    """The start that a maneuver asks for.

    Args:
        maneuver: see `Maneuver`.
        standing_height: of the trunk over the ground with the feet on it [m].
        profile: of a turn to level during a drop.
    """
    match maneuver:
        case Disturbance():
            forward, up = maneuver.takeoff_velocity
            push = Push(
                np.array(maneuver.torque),
                maneuver.onset,
                maneuver.duration,
                np.array(maneuver.velocity_change) / maneuver.duration,
            )
            return Launch(np.eye(3), None, np.array([forward, 0.0, up]), LEVEL, push)
        case Shove():
            push = Push(np.array(maneuver.torque), 0.0, maneuver.duration)
            return Launch(np.eye(3), standing_height, np.zeros(3), LEVEL, push)
        case Drop():
            if maneuver.height <= standing_height:
                raise SpecificationError(
                    f"maneuver {maneuver.name!r}: the trunk is released at {maneuver.height:.3g} "
                    f"m, but the robot stands {standing_height:.3g} m high",
                    hint="raise `height` of the drop",
                )
            rotation = rotation_about(PITCH, maneuver.pitch) @ rotation_about(ROLL, maneuver.roll)
            vector = _rotation_vector(rotation)
            angle = float(np.linalg.norm(vector))
            axis = vector / angle if angle > 0.0 else PITCH
            fall = maneuver.time(standing_height)
            turn = Turn(axis, angle, 0.0, fall, profile, extendable=False)
            return Launch(rotation, maneuver.height, np.zeros(3), turn, NO_PUSH)
        case Flip():
            up = np.sqrt(2.0 * maneuver.gravity * maneuver.jump_height)
            turn = Turn(PITCH, 0.0, maneuver.angle, maneuver.duration, Quintic())
            return Launch(np.eye(3), None, np.array([0.0, 0.0, up]), turn, NO_PUSH)
        case _:
            raise TypeError(f"no launch is known for a {type(maneuver).__name__}")


def level_launch(maneuver: Maneuver, standing_height: float) -> Launch:
    """Launch of the same flight, level and undisturbed: it shows what the legs can bear."""
    start = launch(maneuver, standing_height, Quintic())
    return Launch(np.eye(3), start.height, start.velocity, LEVEL, NO_PUSH)


def on_the_ground(start: Launch, standing_height: float) -> Launch:
    """Launch at rest with the feet on the ground: the legs make the flight."""
    return replace(start, height=standing_height, velocity=np.zeros(3))


def flight_time(start: Launch, standing_height: float, gravity: float) -> float:
    """Until the feet of the levelled robot meet the ground [s]."""
    drop = 0.0 if start.height is None else start.height - standing_height
    # Longer by what the push adds, were it at lift-off: a little too long.
    gained = start.push.acceleration[2] * start.push.duration
    up = start.velocity[2] + max(gained, 0.0)
    return float((up + np.sqrt(up**2 + 2.0 * gravity * drop)) / gravity)


def _rotation_vector(rotation: FloatArray) -> FloatArray:
    """Axis times angle of a rotation by less than half a turn, shape (3,)."""
    skew = 0.5 * (rotation - rotation.T)
    vector = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    sine = float(np.linalg.norm(vector))
    angle = np.arctan2(sine, 0.5 * (np.trace(rotation) - 1.0))
    return vector * (angle / sine if sine > 0.0 else 1.0)


_CLEARANCE = 1e-3
"""Gap under the feet at lift-off, over the standing height."""


def stand(robot: Robot, model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Put the level trunk at the origin in the nominal posture; its height over its feet [m].

    Zero for a robot that has nothing to stand on: its file gives it no shape.
    """
    for name, value in robot.posture.items():
        data.qpos[model.joint(name).qposadr[0]] = value
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
