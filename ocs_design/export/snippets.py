"""The device alone, to paste, include or attach."""

from pathlib import Path
from textwrap import indent

import numpy as np

from ocs_design.design import Device, Module
from ocs_design.export.attach import WHEEL_CONTACT_BIT
from ocs_design.export.device_urdf import (
    carrier_urdf,
    cylinder_urdf,
    device_urdf,
    inertial_values,
    limit_urdf,
    mount_urdf,
)
from ocs_design.export.inertials import carrier_inertial, flywheel_inertial
from ocs_design.export.motor import largest_torque
from ocs_design.export.naming import PREFIX, carrier_name, flywheel_name, joint_name
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.wheel_frame import wheel_placement
from ocs_design.robot.robot import Robot
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.spec.frames import quaternion

_MACRO_PLACE = {
    "link": "${prefix}ocs_${side}_motor",
    "parent": "${parent}",
    "position": "${position}",
    "rpy": "${-pi/2} 0 ${yaw}",
}
"""Of what stands still, in terms of the xacro macro's arguments."""


def export_snippet_urdf(device: Device, robot: Robot, path: Path) -> Path:
    """Write links and joints to paste into a URDF.

    Args:
        device: to write.
        robot: that carries it.
        path: of the text.
    """
    base = "" if robot.mount is None else mount_urdf(robot.mount)
    values = {**_names(robot), "device": base + device_urdf(device, robot.trunk)}
    return _write(path, fill("ocs.urdf", values))


def export_snippet_xacro(device: Device, robot: Robot, path: Path) -> Path:
    """Write a xacro macro `ocs`; arguments as in `export_snippet_urdf`."""
    left, right = device.modules
    rotation = np.eye(3) if robot.mount is None else robot.mount.placement.rotation
    values = {
        **_names(robot),
        "base_rpy": numbers(rpy_from_rotation(rotation)),
        **inertial_values(flywheel_inertial(device)),
        "incidence": numbers(device.incidence),
        "left_position": numbers(left.position),
        "right_position": numbers(right.position),
        "cylinder": cylinder_urdf(device.flywheel),
        "limit": limit_urdf(device),
        "carrier": indent(carrier_urdf(device, _MACRO_PLACE), "  "),
    }
    return _write(path, fill("ocs.urdf.xacro", values))


def export_snippet_mjcf(device: Device, robot: Robot, path: Path) -> Path:
    """Write a model to attach to a MJCF robot; arguments as in `export_snippet_urdf`."""
    modules = "".join(_module_mjcf(device, module) for module in device.modules)
    motors = "".join(f"    {_motor_mjcf(device, module)}\n" for module in device.modules)
    rotation = np.eye(3) if robot.mount is None else robot.mount.placement.rotation
    values = {
        **_names(robot),
        "base_quaternion": numbers(quaternion(rotation)),
        "modules": modules,
        "motors": motors,
    }
    return _write(path, fill("ocs.xml", values))


def _module_mjcf(device: Device, module: Module) -> str:
    placement, wheel, carrier = wheel_placement(module), device.flywheel, carrier_inertial(device)
    place = {
        "position": numbers(placement.position),
        "quaternion": numbers(quaternion(placement.rotation)),
    }
    turning = fill(
        "flywheel.xml",
        {
            **place,
            **inertial_values(flywheel_inertial(device)),
            "body": flywheel_name(module).removeprefix(PREFIX),
            "joint": joint_name(module).removeprefix(PREFIX),
            "armature": numbers(device.motor.armature),
            "size": numbers((wheel.outer_radius, wheel.height / 2.0)),
            "contact_bit": str(WHEEL_CONTACT_BIT),
        },
    )
    if carrier is None:
        return turning
    name = carrier_name(module).removeprefix(PREFIX)
    return turning + fill("carrier.xml", {**place, **inertial_values(carrier), "body": name})


def _motor_mjcf(device: Device, module: Module) -> str:
    name, limit = joint_name(module).removeprefix(PREFIX), largest_torque(device.motor)
    limits = "" if limit is None else f' ctrllimited="true" ctrlrange="{numbers((-limit, limit))}"'
    return f'<motor name="{name}" joint="{name}"{limits}/>'


def _names(robot: Robot) -> dict[str, str]:
    trunk = robot.trunk if robot.mount is None else robot.mount.link
    return {"parent": quoted(trunk), "parent_in_comment": in_comment(trunk)}


def _write(path: Path, text: str) -> Path:
    path.write_bytes(text.encode("utf-8"))
    return path
