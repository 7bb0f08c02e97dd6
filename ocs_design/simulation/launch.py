"""The start of a maneuver: initial pose and motion, planned turn, and external push."""

from dataclasses import dataclass, field

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.export.physics import set_trunk
from ocs_design.requirement.boundary import NO_PUSH, Push, Y
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.reference import NO_TURN, Profile, Quintic, Turn


@dataclass(frozen=True, eq=False)
class Launch:
    """The start of a flight, or of a maneuver about a pivot.

    Attributes:
        rotation: of the trunk in the world, shape (3, 3).
        height: of the trunk frame's origin [m]; None: the feet are just clear of the ground.
        velocity: of its centre of mass [m/s], shape (3,).
        turn: of the trunk, to be followed.
        push: external push on the trunk.
        rate: of the whole robot, in B [rad/s], shape (3,).
        wheel_speed: of all wheels [rad/s].
        counted: axis about which whole turns count, in B, shape (3,).
    """

    rotation: FloatArray
    height: float | None
    velocity: FloatArray
    turn: Turn
    push: Push
    rate: FloatArray = field(default_factory=lambda: np.zeros(3))
    wheel_speed: FloatArray | float = 0.0
    counted: FloatArray = field(default_factory=lambda: Y)

    @property
    def undisturbed(self) -> "Launch":
        """This start with the trunk level and not turning, no turn to make and no push."""
        return Launch(np.eye(3), self.height, self.velocity, NO_TURN, NO_PUSH)


def launch(maneuver: Maneuver, standing_height: float, profile: Profile) -> Launch:
    """The start of a maneuver.

    Args:
        maneuver: of this body (`Maneuver.on`), if it is about a pivot.
        standing_height: of the trunk over the ground with the feet on it [m].
        profile: of a turn to level during a drop.

    Raises:
        SpecificationError: a drop has no height to fall from.
    """
    boundary, (forward, up) = maneuver.boundary(standing_height), maneuver.takeoff
    initial_turn = quaternions.rotation_vector(boundary.attitude)
    commanded_turn = np.append(maneuver.angles, 0.0)
    turn = NO_TURN
    if not maneuver.on_pivot and initial_turn.any():
        angle = float(np.linalg.norm(initial_turn))
        turn = Turn(initial_turn / angle, angle, 0.0, boundary.duration, profile, extendable=False)
    elif not maneuver.on_pivot and commanded_turn.any():
        angle = float(np.linalg.norm(commanded_turn))
        turn = Turn(commanded_turn / angle, 0.0, angle, boundary.duration, Quintic())
    return Launch(
        rotation=quaternions.matrix(boundary.attitude),
        height=boundary.height if maneuver.gravity else _ORBIT_HEIGHT,
        velocity=np.array([forward, 0.0, up]),
        turn=turn,
        push=boundary.push,
        rate=boundary.rate,
        wheel_speed=boundary.wheel_speed,
        counted=boundary.axis if maneuver.counts_turns else Y,
    )


def flight_time(maneuver: Maneuver, start: Launch, standing_height: float) -> float:
    """Time until the feet of the levelled robot meet the ground, or a turn or a catch ends [s]."""
    if maneuver.on_pivot or not maneuver.gravity:
        return maneuver.boundary(standing_height).duration
    drop = 0.0 if start.height is None else start.height - standing_height
    # The push is counted as if at lift-off, which makes the flight a little too long.
    push_velocity = start.push.acceleration[2] * start.push.duration
    up = start.velocity[2] + max(push_velocity, 0.0)
    return float((up + np.sqrt(up**2 + 2.0 * maneuver.gravity * drop)) / maneuver.gravity)


_ORBIT_HEIGHT = 100.0
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
