"""The device alone, to paste, include or attach."""

from pathlib import Path

import numpy as np

from ocs_design.design import Device, Module
from ocs_design.export.attach import WHEEL_CONTACT_BIT
from ocs_design.export.device_urdf import (
    cylinder_urdf,
    device_urdf,
    flywheel_values,
    limit_urdf,
    mount_urdf,
)
from ocs_design.export.motor import largest_torque
from ocs_design.export.naming import PREFIX, flywheel_name, joint_name
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.wheel_frame import wheel_placement
from ocs_design.robot.robot import Robot
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.spec.frames import quaternion


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
        **flywheel_values(device.flywheel),
        "incidence": numbers(device.incidence),
        "left_position": numbers(left.position),
        "right_position": numbers(right.position),
        "cylinder": cylinder_urdf(device.flywheel),
        "limit": limit_urdf(device),
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
    place, wheel = wheel_placement(module), device.flywheel
    return fill(
        "flywheel.xml",
        {
            **flywheel_values(wheel),
            "body": flywheel_name(module).removeprefix(PREFIX),
            "joint": joint_name(module).removeprefix(PREFIX),
            "position": numbers(place.position),
            "quaternion": numbers(quaternion(place.rotation)),
            "size": numbers((wheel.outer_radius, wheel.height / 2.0)),
            "contact_bit": str(WHEEL_CONTACT_BIT),
        },
    )


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
