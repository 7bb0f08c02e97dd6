"""Names of the device's parts in every exported file, and the check that they are free."""

from collections.abc import Iterable

from ocs_design.design import Device, Module
from ocs_design.exceptions import RobotError

PREFIX = "ocs_"


def flywheel_name(module: Module) -> str:
    """Link in URDF, body in MJCF."""
    return f"{PREFIX}{module.name}_flywheel"


def joint_name(module: Module) -> str:
    """Joint, and in MJCF also its motor."""
    return f"{PREFIX}{module.name}"


def carrier_name(module: Module) -> str:
    """Of what stands still: link and fixed joint in URDF, body in MJCF."""
    return f"{PREFIX}{module.name}_motor"


def require_free(kind: str, taken: Iterable[str], wanted: Iterable[str]) -> None:
    """Refuse a robot that uses one of the device's names itself.

    Args:
        kind: what is named, for the message: link, joint, actuator.
        taken: the robot's own names.
        wanted: the device's.
    """
    clash = sorted(set(taken) & set(wanted))
    if clash:
        raise RobotError(
            f"the robot already has a {kind} named {clash[0]!r}, which the device needs",
            hint=f"rename that {kind} in the robot's file, or give the file without a device in it",
        )


def flywheel_names(device: Device) -> tuple[str, ...]:
    """Of both modules."""
    return tuple(flywheel_name(module) for module in device.modules)


def carrier_names(device: Device) -> tuple[str, ...]:
    """Of both modules; none where what stands still weighs nothing."""
    if device.carrier.mass == 0.0:
        return ()
    return tuple(carrier_name(module) for module in device.modules)


def joint_names(device: Device) -> tuple[str, ...]:
    """Of both modules."""
    return tuple(joint_name(module) for module in device.modules)
