"""The start of a maneuver: initial pose and motion, planned turn, and external push."""

from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.frames import rotation_about
from ocs_design.export.physics import set_trunk
from ocs_design.requirement.maneuver import Disturbance, Drop, Flip, Maneuver, Shove
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.requirement.turns import TurnTo
from ocs_design.robot.robot import Robot
from ocs_design.simulation.reference import NO_TURN, Profile, Quintic, Turn
from ocs_design.sizing.trajectory.boundary import pivot_boundary
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

ROLL, PITCH = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Push:
    """A torque on the trunk in B [N m], shape (3,), from `onset` for `duration` [s].

    Attributes:
        acceleration: of the whole robot by an additional force, in B [m/s^2], shape (3,): on each
            body in proportion to its mass, so that it turns nothing.
        force: in B [N], shape (3,); if it is not zero, `of_force` replaces torque and acceleration
            by its effect on the robot as flown.
        point: where the force acts, in B [m], shape (3,).
    """

    torque: FloatArray
    onset: float
    duration: float
    acceleration: FloatArray = field(default_factory=lambda: np.zeros(3))
    force: FloatArray = field(default_factory=lambda: np.zeros(3))
    point: FloatArray = field(default_factory=lambda: np.zeros(3))

    def of_force(self, mass: float, com: FloatArray) -> "Push":
        """The push of its force on a body of this mass [kg] and centre of mass in B [m]."""
        arm = self.point - com
        return replace(self, torque=np.cross(arm, self.force), acceleration=self.force / mass)

    def share(self, starts: FloatArray, period: float) -> FloatArray:
        """Share of each control step, from `starts`, in which it acts: its impulse is exact."""
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
        height: of the trunk frame's origin [m]; None: the feet are just clear of the ground.
        velocity: of its centre of mass [m/s], shape (3,).
        turn: of the trunk, to be followed.
        push: external push on the trunk.
        rate: of the whole robot, in B [rad/s], shape (3,).
        wheel_speed: of all wheels [rad/s].
    """

    rotation: FloatArray
    height: float | None
    velocity: FloatArray
    turn: Turn
    push: Push
    rate: FloatArray = field(default_factory=lambda: np.zeros(3))
    wheel_speed: float = 0.0

    @property
    def undisturbed(self) -> "Launch":
        """The same start, level and without anything to do."""
        return Launch(np.eye(3), self.height, self.velocity, NO_TURN, NO_PUSH)


def launch(maneuver: Maneuver, standing_height: float, profile: Profile) -> Launch:
    """The start of a maneuver other than one about a pivot.

    Args:
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
                np.array(maneuver.impulse) / maneuver.duration,
                np.array(maneuver.point),
            )
            return Launch(np.eye(3), None, np.array([forward, 0.0, up]), NO_TURN, push)
        case Shove():
            push = Push(np.array(maneuver.torque), 0.0, maneuver.duration)
            return Launch(np.eye(3), standing_height, np.zeros(3), NO_TURN, push)
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
        case TurnTo():
            up = maneuver.gravity * maneuver.flight_time / 2.0
            vector = np.array([maneuver.roll, maneuver.pitch, 0.0])
            angle = float(np.linalg.norm(vector))
            turn = NO_TURN
            if angle > 0.0:
                turn = Turn(vector / angle, 0.0, angle, maneuver.duration, Quintic())
            rate, spin = np.array(maneuver.rate), maneuver.wheel_speed
            height = None if maneuver.gravity else _AFLOAT
            return Launch(np.eye(3), height, np.array([0.0, 0.0, up]), turn, NO_PUSH, rate, spin)
        case _:
            raise TypeError(f"no launch is known for a {type(maneuver).__name__}")


def on_pivot(maneuver: Pivoted, gyrostat: Gyrostat, *, planned: bool) -> Launch:
    """The start of a maneuver about a pivot, which is at floor height.

    Args:
        maneuver: the maneuver. gyrostat: robot and device, about the pivot.
        planned: whether wheels follow a plan: else there is nothing to spin up and brake.
    """
    asked = pivot_boundary(maneuver, gyrostat)
    rotation = quaternions.matrix(asked.attitude)
    height = -float((rotation @ np.array(maneuver.pivot))[2])
    rate, speed = asked.rate if planned else maneuver.struck, maneuver.wheel_speed
    return Launch(rotation, height, np.zeros(3), NO_TURN, NO_PUSH, rate, speed)


def flight_time(maneuver: Maneuver, start: Launch, standing_height: float) -> float:
    """Time until the feet of the levelled robot meet the ground, or a turn or a catch ends [s]."""
    if isinstance(maneuver, TurnTo):
        return maneuver.flight_time
    if isinstance(maneuver, Pivoted):
        return maneuver.duration
    gravity = maneuver.gravity
    drop = 0.0 if start.height is None else start.height - standing_height
    # The push is counted as if at lift-off, which makes the flight a little too long.
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


_AFLOAT = 100.0
"""Height of a robot in orbit over the model's floor, which it never touches [m]."""

_CLEARANCE = 1e-3
"""Gap under the feet at lift-off, over the standing height."""


def place(
    robot: Robot, model: mujoco.MjModel, data: mujoco.MjData, start: Launch, standing: float
) -> None:
    """Write the start of a flight into `data`."""
    height = standing * (1.0 + _CLEARANCE) if start.height is None else start.height
    set_trunk(robot, model, data, start.rotation, height)
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    first = int(model.jnt_dofadr[free])
    data.qvel[first : first + 3] = start.velocity
    if start.rate.any():
        mujoco.mj_forward(model, data)
        # Everything turns about the centre of mass as one rigid body; the free joint's angular rate
        # is in the frame of its own body.
        base = np.array(data.xmat[model.jnt_bodyid[free]]).reshape(3, 3)
        rate = start.rotation @ start.rate
        arm = data.xpos[model.jnt_bodyid[free]] - data.subtree_com[0]
        data.qvel[first : first + 3] += np.cross(rate, arm)
        data.qvel[first + 3 : first + 6] = base.T @ rate
