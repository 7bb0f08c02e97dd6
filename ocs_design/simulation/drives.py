"""Joint drives: proportional-derivative control inside the model, with gains from physics.

Legs carry the robot, so their stiffness comes from its weight and their damping from its Froude
time: `kp = m g L / 2`, `kd = kp sqrt(L / g) / 2` with the length L of the leg. Its joints then give
way by about a fifth of a radian where it stands. Stiffer or less damped legs throw most quadrupeds
over after a level landing, softer ones let the heavy ones sink.

All other joints, arms, fingers, neck and waist, are held where they are. They would have to be held
by drives that nobody knows, some of them turn links that their file gives next to no inertia, and
none of them matters to whether a robot lands level.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.requirement.maneuver import STANDARD_GRAVITY
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Joint
from ocs_design.simulation.plain import plain_actuator

DRIVE = "ocs_drive_"
"""Prefix of the names of the joint drives."""

HELD = 1e6
"""Armature of a held joint [kg m^2 or kg]: 1 N m over a second moves it by 1e-6 rad/s."""

LEG_STIFFNESS = 0.5
LEG_DAMPING = 0.5
STABLE_SHARE = 0.5
"""Of the explicit Runge-Kutta limit: largest `eigenvalue(M^-1 K_d) dt`."""


@dataclass(frozen=True, eq=False)
class DriveGains:
    """Of every leg joint, in the order of `leg_joints`.

    Attributes:
        stiffness: [N m/rad]. damping: of the drive [N m s/rad].
        friction: viscous, of the joint itself [N m s/rad].
    """

    stiffness: FloatArray
    damping: FloatArray
    friction: FloatArray


def leg_joints(robot: Robot) -> list[str]:
    """Names of the joints that are driven."""
    in_legs = {joint for leg in robot.legs for joint in leg.joints}
    return [name for name in robot.tree.joints if name in in_legs]


def add_drives(spec: mujoco.MjSpec, robot: Robot) -> None:
    """One drive for each leg joint, limited to its effort; gains follow after compiling."""
    for name in leg_joints(robot):
        limit = effort_limit(robot.tree.joints[name])
        drive = spec.add_actuator(
            name=DRIVE + name,
            target=name,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )
        plain_actuator(drive)
        if np.isfinite(limit):
            drive.forcelimited = 1
            drive.forcerange = [-limit, limit]


def hold_other_joints(spec: mujoco.MjSpec, robot: Robot) -> None:
    """Hold every joint that is in no leg, by inertia; nothing else need then be computed for it."""
    driven = leg_joints(robot)
    for name in robot.tree.joints:
        if name not in driven:
            joint = spec.joint(name)
            joint.armature, joint.frictionloss = HELD, 0.0
            joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE


def effort_limit(joint: Joint) -> float:
    """[N m or N]; files write 0 where the author left it open."""
    return joint.effort if joint.effort > 0.0 else np.inf


def set_gains(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot) -> None:
    """Give the drives of a compiled model their gains, for the posture that `data` is in."""
    names = leg_joints(robot)
    if not names:
        return
    actuators = [model.actuator(DRIVE + name).id for name in names]
    gains = drive_gains(model, data, robot)
    model.actuator_gainprm[actuators, 0] = gains.stiffness
    model.actuator_biasprm[actuators, 1] = -gains.stiffness
    model.actuator_biasprm[actuators, 2] = -gains.damping
    model.dof_damping[_dofs(model, names)] = gains.friction


def drive_gains(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot) -> DriveGains:
    """Gains from physics, then lowered where the step could not follow them."""
    length_of = {joint: leg.length for leg in robot.legs for joint in leg.joints}
    names = leg_joints(robot)
    lengths = np.array([length_of[name] for name in names])
    stiffness = LEG_STIFFNESS * robot.mass * STANDARD_GRAVITY * lengths
    damping = LEG_DAMPING * stiffness * np.sqrt(lengths / STANDARD_GRAVITY)
    dofs = _dofs(model, names)
    wanted = DriveGains(stiffness, damping, model.dof_damping[dofs])
    mobility = _mobility(model, data)[np.ix_(dofs, dofs)]
    return _stable(wanted, mobility, model.opt.timestep)


def _stable(gains: DriveGains, mobility: FloatArray, step: float) -> DriveGains:
    """Gains that the explicit step can follow: first each joint alone, then all together.

    A joint alone feels the inertia `1 / (M^-1)_jj`.

    Runge-Kutta of order four is stable for `|lambda| dt < 2.78` on the real axis and 2.82 on the
    imaginary one (Hairer and Wanner, Solving ODEs II, section IV.2). The friction that a file
    states counts as well: on a link that it gives next to no inertia none would be slow enough.
    """
    felt = 1.0 / np.diag(mobility)
    friction = np.minimum(gains.friction, STABLE_SHARE * felt / step)
    damping = np.minimum(gains.damping + friction, STABLE_SHARE * felt / step) - friction
    stiffness = np.minimum(gains.stiffness, (STABLE_SHARE / step) ** 2 * felt)
    root = np.sqrt(damping + friction)
    fastest = np.linalg.eigvalsh(root[:, None] * mobility * root).max() * step
    relax = min(1.0, 2.0 * STABLE_SHARE / fastest) if fastest > 0.0 else 1.0
    return DriveGains(stiffness * relax, damping * relax, friction * relax)


def _dofs(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    return [int(model.joint(name).dofadr[0]) for name in names]


def _mobility(model: mujoco.MjModel, data: mujoco.MjData) -> FloatArray:
    """Inverse of the joint-space inertia matrix, shape (nv, nv)."""
    inverse = np.empty((model.nv, model.nv))
    mujoco.mj_solveM(model, data, inverse, np.eye(model.nv))
    return inverse
