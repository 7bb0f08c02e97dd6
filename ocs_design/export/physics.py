"""Physics of the robot, the same in simulations and in the exported file.

Solver options, leg drives, and the standing pose. They replace the file's own settings: a model
tuned for speed may stop its solver after one iteration, one for learning may clamp every command to
one, and the file's default classes apply to whatever is added to it.

Legs carry robot and device, so their stiffness comes from the weight of both and their damping
from the robot's Froude time: `kp = m g L / 2`, `kd = kp sqrt(L / g) / 2` with the length L of the
leg. Its joints then yield by about a fifth of a radian in standing. Stiffer or less damped legs
topple most quadrupeds after a level landing, and softer ones let heavy robots sink.

All other joints (arms, fingers, neck and waist) are held in place. Their drives are unknown, some
move links with almost no inertia in the file, and none of them affects whether a robot lands level.
"""

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.robot import Robot

_Geom = mujoco.mjtGeom

STEP = 1e-3
"""Time step of the physics [s] (paper, table 1); a joint drive of 1 kHz can follow it."""

_OF_CONTACT = {"cone", "impratio"}
"""Options of the friction model."""

_OF_ACTUATOR = (
    *("gear", "gainprm", "biasprm", "dynprm", "dyntype", "actdim", "actearly", "delay", "nsample"),
    *("ctrllimited", "ctrlrange", "forcelimited", "forcerange", "actlimited", "actrange"),
    *("armature", "damping", "cranklength", "lengthrange", "inheritrange"),
)


def flight_options(spec: mujoco.MjSpec) -> None:
    """Set integrator, step and solver of the flights; of the file's options only contact ones stay.

    Runge-Kutta, because Euler and implicitfast drift with fast wheels (docs/theory.md, Numerics of
    fast wheels); the dense Jacobian, because MuJoCo 4.0's sparse Newton solver has a bug.
    """
    plain = mujoco.MjSpec().option
    _copy(plain, spec.option, (name for name in dir(plain) if name not in _OF_CONTACT))
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    # At the default 1e-8 the solver stops early on a warm start, and the residual force pushes the
    # floating base: 5e-5 of the momentum per second on a robot with joints at limits.
    spec.option.tolerance = 1e-12


def meet_no_link(spec: mujoco.MjSpec) -> None:
    """Let the robot's geoms collide with a floor or anything with `contype` 1, but not each other.

    Neighbouring links overlap in most robot files. Contact starts at zero distance, without a
    margin.
    """
    for geom in spec.geoms:
        geom.margin = geom.gap = 0.0
        geom.conaffinity = int(bool(geom.contype or geom.conaffinity))
        geom.contype = 0


def _copy(source: object, target: object, names: Iterable[str]) -> None:
    for name in names:
        value = getattr(source, name)
        if isinstance(value, np.ndarray):
            getattr(target, name)[:] = value
        elif not name.startswith("_") and not callable(value):
            setattr(target, name, value)


STEADY_LEGS = 3
"""Minimum number of legs with which a robot stands without balancing."""

HELD_ARMATURE = 1e6
"""Armature of a held joint [kg m^2 or kg]: 1 N m over a second moves it by 1e-6 rad/s."""

LEG_STIFFNESS = 0.5
LEG_DAMPING = 0.5
STABLE_SHARE = 0.5
"""Share of the explicit Runge-Kutta limit: largest `eigenvalue(M^-1 K_d) dt`."""


def leg_joints(robot: Robot) -> list[str]:
    """Names of the driven joints, those of the legs."""
    in_legs = {joint for leg in robot.legs for joint in leg.joints}
    return [name for name in robot.tree.joints if name in in_legs]


def add_drives(spec: mujoco.MjSpec, robot: Robot) -> None:
    """Add a drive for each leg joint, limited to its effort; gains are set after compiling."""
    for name in leg_joints(robot):
        limit = robot.tree.joints[name].effort
        drive = spec.add_actuator(
            name=name,
            target=name,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )
        # Discard the file's defaults; type, transmission and names stay.
        _copy(mujoco.MjSpec().add_actuator(), drive, _OF_ACTUATOR)
        # In files 0 means that the author left it open.
        if 0.0 < limit < np.inf:
            drive.forcelimited = 1
            drive.forcerange = [-limit, limit]


def hold_other_joints(spec: mujoco.MjSpec, robot: Robot) -> None:
    """Hold every joint outside the legs by a large armature, which needs no further computation.

    This includes ball joints, which are rigid in the robot's tree.
    """
    driven = leg_joints(robot)
    for joint in spec.joints:
        if joint.name not in driven and joint.type != mujoco.mjtJoint.mjJNT_FREE:
            joint.armature, joint.frictionloss = HELD_ARMATURE, 0.0
            joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE


def set_gains(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot) -> None:
    """Set the gains of the drives of a compiled model, for the posture of `data`.

    They are reduced if the explicit step would be unstable: fourth-order Runge-Kutta is stable for
    `|lambda| dt < 2.78` on the real axis and 2.82 on the imaginary one (Hairer and Wanner, Solving
    ODEs II, section IV.2). The file's joint friction counts as well: on a link with almost no
    inertia it alone could be unstable.
    """
    names = leg_joints(robot)
    if not names:
        return
    length_of = {joint: leg.length for leg in robot.legs for joint in leg.joints}
    lengths = np.array([length_of[name] for name in names])
    # The bodies that hold a pivot are gravity-compensated: the legs do not carry them.
    borne = float(model.body_mass @ (1.0 - model.body_gravcomp))
    stiffness = LEG_STIFFNESS * borne * STANDARD_GRAVITY * lengths
    damping = LEG_DAMPING * stiffness * np.sqrt(lengths / STANDARD_GRAVITY)
    dofs, actuators = _dofs(model, names), [model.actuator(name).id for name in names]
    inverse = np.empty((model.nv, model.nv))
    mujoco.mj_solveM(model, data, inverse, np.eye(model.nv))
    mobility, step = inverse[np.ix_(dofs, dofs)], model.opt.timestep

    # First each joint alone, with the effective inertia `1 / (M^-1)_jj`, then all together.
    felt = 1.0 / np.diag(mobility)
    friction = np.minimum(model.dof_damping[dofs], STABLE_SHARE * felt / step)
    damping = np.minimum(damping + friction, STABLE_SHARE * felt / step) - friction
    stiffness = np.minimum(stiffness, (STABLE_SHARE / step) ** 2 * felt)
    root = np.sqrt(damping + friction)
    fastest = np.linalg.eigvalsh(root[:, None] * mobility * root).max() * step
    relax = min(1.0, 2.0 * STABLE_SHARE / fastest) if fastest > 0.0 else 1.0
    model.actuator_gainprm[actuators, 0] = stiffness * relax
    model.actuator_biasprm[actuators, 1] = -stiffness * relax
    model.actuator_biasprm[actuators, 2] = -damping * relax
    model.dof_damping[dofs] = friction * relax


def standing_torques(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot) -> FloatArray:
    """Torques of the leg joints of the robot standing level in the pose of `data` [N m].

    Gravity's generalised forces `g(q) = tau + sum_i J_i^T f_i`: the rows of the floating base give
    the smallest vertical forces f_i on the feet, those of the joints the torques.
    """
    if not robot.legs:
        return np.zeros(0)
    mujoco.mj_forward(model, data)
    pull, floats = data.qfrc_bias, model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)
    first = int(model.jnt_dofadr[floats][0])
    free = slice(first, first + 6)
    columns = []
    for leg in robot.legs:
        body = model.body(robot.tree.bodies[leg.body].name).id
        sole = data.xpos[body] + data.xmat[body].reshape(3, 3) @ leg.foot
        sole[2] -= leg.foot_radius
        jacobian = np.empty((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, sole, body)
        columns.append(jacobian[2])
    lifts = np.stack(columns, axis=1)
    forces = np.linalg.lstsq(lifts[free], pull[free], rcond=None)[0]
    torque: FloatArray = (pull - lifts @ np.maximum(forces, 0.0))[_dofs(model, leg_joints(robot))]
    return torque


def _dofs(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    return [int(model.joint(name).dofadr[0]) for name in names]


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Height of the lowest point that can touch the floor [m]; inf if there is none."""
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    touching = np.flatnonzero(solid & (model.geom_bodyid > 0))
    heights = []
    for geom in touching.tolist():
        # Support point of the geom downwards; `up` is the world's vertical in the geom's frame.
        up: FloatArray = data.geom_xmat[geom].reshape(3, 3)[2]
        size = model.geom_size[geom]
        across = np.sqrt(max(0.0, 1.0 - up[2] ** 2))
        match model.geom_type[geom]:
            case _Geom.mjGEOM_SPHERE:
                reach = size[0]
            case _Geom.mjGEOM_CAPSULE:
                reach = size[0] + size[1] * abs(up[2])
            case _Geom.mjGEOM_CYLINDER:
                reach = size[0] * across + size[1] * abs(up[2])
            case _Geom.mjGEOM_BOX:
                reach = size @ np.abs(up)
            case _Geom.mjGEOM_ELLIPSOID:
                reach = np.linalg.norm(size * up)
            case _Geom.mjGEOM_MESH:
                first = model.mesh_vertadr[model.geom_dataid[geom]]
                count = model.mesh_vertnum[model.geom_dataid[geom]]
                reach = -(model.mesh_vert[first : first + count] @ up).min()
            case _:
                reach = model.geom_rbound[geom]
        heights.append(float(data.geom_xpos[geom, 2] - reach))
    return min(heights, default=np.inf)


def stand(robot: Robot, model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Put the level trunk at the origin in the nominal posture; returns its standing height [m].

    The height is 0 for a robot without geometry.
    """
    for name, value in robot.posture.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    set_trunk(robot, model, data, np.eye(3), 0.0)
    mujoco.mj_forward(model, data)
    lowest = lowest_point(model, data)
    return -lowest if np.isfinite(lowest) else 0.0


def set_trunk(
    robot: Robot, model: mujoco.MjModel, data: mujoco.MjData, rotation: FloatArray, height: float
) -> None:
    """Move the floating base so that the trunk has this rotation and height above the origin."""
    index = robot.tree.body_of_link[robot.trunk]
    in_body = robot.tree.bodies[index].links[robot.trunk]
    in_root = robot.tree.placements(robot.posture)[index] @ in_body
    base = rotation @ in_root.rotation.T
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    first = int(model.jnt_qposadr[free])
    data.qpos[first : first + 3] = np.array([0.0, 0.0, height]) - base @ in_root.position
    data.qpos[first + 3 : first + 7] = quaternion(base)
