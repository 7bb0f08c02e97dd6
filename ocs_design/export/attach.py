"""Puts the device on a robot's MuJoCo model."""

import mujoco

from ocs_design.design import Device, Module, Motor
from ocs_design.export.inertials import carrier_inertial, flywheel_inertial
from ocs_design.export.motor import largest_torque
from ocs_design.export.naming import (
    PREFIX,
    carrier_name,
    carrier_names,
    flywheel_name,
    flywheel_names,
    joint_name,
    joint_names,
    require_free,
)
from ocs_design.export.wheel_frame import wheel_placement
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.spec.inertia import inertial
from ocs_design.robot.spec.model import trunk_body
from ocs_design.robot.tree import Placement

WHEEL_CONTACT_BIT = 1 << 16
"""`conaffinity` of the wheels: a floor with this bit in its `contype` meets them, no link does."""

_STEEL = (0.55, 0.57, 0.6, 1.0)


def attach_device(spec: mujoco.MjSpec, robot: Robot, device: Device) -> None:
    """Attach both flywheels with their joints and motors, and what carries them, to the trunk.

    Args:
        spec: of `build_spec(robot)`; changed in place. Its keyframes keep the robot's own values.
        robot: that the spec was built from.
        device: its wheels turn about the z axis of their own frames.
    """
    _require_free_names(spec, device)
    trunk, base = trunk_body(spec, robot)
    wheels = mujoco.MjSpec()
    frame = wheels.worldbody.add_frame()
    for module in device.modules:
        place = base @ wheel_placement(module)
        _add_wheel(wheels, module, device, place).set_frame(frame)
        carrier = carrier_inertial(device, module)
        if carrier is not None:
            _add_body(wheels, carrier_name(module), carrier, place).set_frame(frame)
    # Bodies added in any other way shift the values of keyframes to wrong joints.
    trunk.attach_frame(frame, PREFIX, "")


def _require_free_names(spec: mujoco.MjSpec, device: Device) -> None:
    bodies, joints = flywheel_names(device), joint_names(device)
    require_free("body", (body.name for body in spec.bodies), bodies + carrier_names(device))
    require_free("joint", (joint.name for joint in spec.joints), joints)
    require_free("actuator", (actuator.name for actuator in spec.actuators), joints)
    require_free("geom", (geom.name for geom in spec.geoms), bodies)


def _add_wheel(
    spec: mujoco.MjSpec, module: Module, device: Device, placement: Placement
) -> mujoco.MjsBody:
    """Add a wheel with its joint, its motor and its outline to a model of its own."""
    wheel, joint = device.flywheel, joint_name(module).removeprefix(PREFIX)
    body = _add_body(spec, flywheel_name(module), flywheel_inertial(device), placement)
    body.add_joint(
        name=joint,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=(0.0, 0.0, 1.0),
        armature=device.motor.armature,
    )
    body.add_geom(
        name=body.name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=(wheel.outer_radius, wheel.height / 2.0, 0.0),
        contype=0,
        conaffinity=WHEEL_CONTACT_BIT,
        rgba=_STEEL,
    )
    _add_motor(spec, joint, device.motor)
    return body


def _add_body(
    spec: mujoco.MjSpec, name: str, raw: MassProperties, placement: Placement
) -> mujoco.MjsBody:
    """Add a body of these mass properties; attaching puts the prefix in front of its name."""
    body = inertial(raw)
    return spec.worldbody.add_body(
        name=name.removeprefix(PREFIX),
        pos=placement.position,
        quat=quaternion(placement.rotation),
        mass=body.mass,
        ipos=body.position,
        iquat=body.quaternion,
        inertia=body.moments,
        explicitinertial=True,
    )


def _add_motor(spec: mujoco.MjSpec, joint: str, motor: Motor) -> None:
    actuator = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    actuator.set_to_motor()
    limit = largest_torque(motor)
    if limit is not None:
        actuator.ctrllimited = True
        actuator.ctrlrange = (-limit, limit)
