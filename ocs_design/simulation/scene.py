"""Robot, device and floor as one compiled MuJoCo model."""

from dataclasses import replace
from enum import StrEnum

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import SIDES, Device
from ocs_design.export.attach import attach_device
from ocs_design.export.naming import PREFIX
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.model import build_spec, trunk_body
from ocs_design.simulation.drives import HELD, add_drives, hold_other_joints
from ocs_design.simulation.ground import FLOOR, add_floor
from ocs_design.simulation.plain import plain_options
from ocs_design.sizing.carrier import Carrier

STEP = 1e-3
"""Time step of the physics [s] (paper, table 1); a joint drive of 1 kHz can follow it."""

JUMP_STEP = 5e-4
"""Time step where legs push off [s]. As they brake after lift-off they turn at 10 to 30 rad/s, and
Runge-Kutta at 1 ms loses up to 4e-6 of the angular momentum; at half of that, twenty times less."""

WHEEL_JOINTS = tuple(f"{PREFIX}{side}" for side in SIDES)
FLYWHEELS = tuple(f"{joint}_flywheel" for joint in WHEEL_JOINTS)


class Wheels(StrEnum):
    """What becomes of the wheels; all worlds have the same sizes, so that they run as one batch."""

    ACTIVE = "active"
    BRAKED = "braked"
    ABSENT = "absent"


class Sensor(StrEnum):
    """What the model measures at the start of each step."""

    CONTACT = "ocs_contact"
    COM = "ocs_com"
    MOMENTUM = "ocs_momentum"
    TRUNK = "ocs_trunk"


def robot_scene(robot: Robot) -> mujoco.MjSpec:
    """The bare robot on a floor, its legs on drives, with sensors; free to fall.

    Runge-Kutta, because Euler and implicitfast drift with fast wheels (docs/theory.md,
    Numerics of fast wheels); the
    dense Jacobian, because MuJoCo 4.0's sparse Newton solver has a fault.
    """
    spec = build_spec(robot, visuals=False).spec
    _remove_own_control(spec)
    add_floor(spec)
    add_drives(spec, robot)
    hold_other_joints(spec, robot)
    _add_sensors(spec, robot)
    plain_options(spec)
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    # At the default 1e-8 the solver stops early on a warm start, and what is left of the residual
    # pushes the floating base: 5e-5 of the momentum per second on a robot with joints at limits.
    spec.option.tolerance = 1e-12
    # A state that is not finite must stay so and be reported, not be reset to the start.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    return spec


def compile_scene(
    scene: mujoco.MjSpec, robot: Robot, device: Device, wheels: Wheels, gravity: float
) -> mujoco.MjModel:
    """The scene with the device on it; `scene` itself stays as it is."""
    spec = scene.copy()
    attach_device(spec, robot, _massless(device) if wheels is Wheels.ABSENT else device)
    for name in FLYWHEELS:
        for geom in spec.body(name).geoms:
            geom.contype, geom.conaffinity = 0, 1
    spec.option.gravity = [0.0, 0.0, -gravity]
    if wheels is not Wheels.ACTIVE:
        for name in WHEEL_JOINTS:
            spec.joint(name).armature = HELD
    model = spec.compile()
    if wheels is Wheels.ABSENT:
        # Only now: a geom that touches nothing would be compiled to other sizes, and the worlds
        # of a batch share their working memory.
        flywheels = [model.body(name).id for name in FLYWHEELS]
        model.geom_conaffinity[np.isin(model.geom_bodyid, flywheels)] = 0
    return model


def locked_inertia(model: mujoco.MjModel, data: mujoco.MjData, rotation: FloatArray) -> FloatArray:
    """Inertia of everything about its centre of mass, joints locked as in `data` [kg m^2], (3, 3).

    Args:
        model: compiled.
        data: with kinematics and centres of mass computed.
        rotation: of the frame to express it in, in the world, shape (3, 3).
    """
    axes = data.ximat.reshape(-1, 3, 3)
    offset = data.xipos - data.subtree_com[0]
    turned = np.einsum("bij,bj,bkj->ik", axes, model.body_inertia, axes)
    squares = np.einsum("b,bi,bi->", model.body_mass, offset, offset)
    outer = np.einsum("b,bi,bj->ij", model.body_mass, offset, offset)
    about_com = turned + squares * np.eye(3) - outer
    return np.asarray(rotation.T @ about_com @ rotation)


def _massless(device: Device) -> Device:
    """The same device without mass."""
    wheel = replace(device.flywheel, mass=1e-9, spin_inertia=1e-12, transverse_inertia=1e-12)
    motor = replace(device.motor, mass=0.0, rotor_inertia=0.0)
    # What has a body keeps it: all worlds of a batch have the same sizes.
    carrier = Carrier(1e-9, 1e-12, 1e-12) if device.carrier.mass > 0.0 else device.carrier
    return replace(device, flywheel=wheel, motor=motor, carrier=carrier)


def _remove_own_control(spec: mujoco.MjSpec) -> None:
    """Actuators, sensors and keyframes of the robot's own file."""
    for element in [*spec.actuators, *spec.sensors, *spec.keys]:
        spec.delete(element)


def _add_sensors(spec: mujoco.MjSpec, robot: Robot) -> None:
    body, kind = mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtSensor
    root = robot.tree.bodies[0].name
    _add_floor_contact(spec)
    spec.add_sensor(name=Sensor.COM, type=kind.mjSENS_SUBTREECOM, objtype=body, objname=root)
    spec.add_sensor(
        name=Sensor.MOMENTUM, type=kind.mjSENS_SUBTREEANGMOM, objtype=body, objname=root
    )
    spec.add_sensor(
        name=Sensor.TRUNK,
        type=kind.mjSENS_FRAMEPOS,
        objtype=mujoco.mjtObj.mjOBJ_XBODY,
        objname=trunk_body(spec, robot)[0].name,
    )


def _add_floor_contact(spec: mujoco.MjSpec) -> None:
    """Counts the contacts of the floor: data "found", no reduction, one slot."""
    spec.add_sensor(
        name=Sensor.CONTACT,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_GEOM,
        objname=FLOOR,
        intprm=[1, 0, 1],
    )
