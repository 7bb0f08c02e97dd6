"""Names of the device's parts in every exported file, and the check that they are free."""

from collections.abc import Iterable

from ocs_design.common.errors import RobotError
from ocs_design.device.device import Device, Module
from ocs_design.device.layout import Layout, LayoutName

PREFIX = "ocs_"
PLATE = f"{PREFIX}plate"
"""Link and fixed joint in URDF, body in MJCF: the plate that the feet stand on."""

IMU = f"{PREFIX}imu"
"""Site in MJCF, at the base frame B."""


_FLYWHEEL = "_flywheel"


def flywheel_name(module: Module) -> str:
    """Name of a module's wheel: link in URDF, body in MJCF."""
    return f"{PREFIX}{module.name}{_FLYWHEEL}"


def flywheels_among(bodies: Iterable[str]) -> list[str]:
    """Bodies of a robot that are wheels of the device, in their order."""
    return [name for name in bodies if name.startswith(PREFIX) and name.endswith(_FLYWHEEL)]


def joint_name(module: Module) -> str:
    """Name of a wheel's joint, and in MJCF also of its motor."""
    return f"{PREFIX}{module.name}"


def carrier_name(module: Module) -> str:
    """Name of what stands still of a module: link and fixed joint in URDF, body in MJCF."""
    return f"{PREFIX}{module.name}_motor"


def velocity_sensor(module: Module) -> str:
    """Name of the sensor in MJCF of the wheel's speed relative to the trunk [rad/s]."""
    return f"{joint_name(module)}_velocity"


def torque_sensor(module: Module) -> str:
    """Name of the sensor in MJCF of the motor's torque on the wheel [N m]."""
    return f"{joint_name(module)}_torque"


def imu_sensors() -> tuple[str, str]:
    """Names of the sensors in MJCF of B's attitude as a quaternion and of its rate [rad/s]."""
    return f"{IMU}_attitude", f"{IMU}_rate"


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


def require_no_device(joints: Iterable[str]) -> None:
    """Refuse a robot that has a device already, by its joints, before another one is sized."""
    names = (name for each in LayoutName for name in Layout(each).names)
    require_free("joint", joints, (f"{PREFIX}{name}" for name in names))


def flywheel_names(device: Device) -> tuple[str, ...]:
    """Names of the wheels, in the modules' order."""
    return tuple(flywheel_name(module) for module in device.modules)


def carrier_names(device: Device) -> tuple[str, ...]:
    """Names of what stands still of each module; none where it weighs nothing."""
    if device.carrier.mass == 0.0:
        return ()
    return tuple(carrier_name(module) for module in device.modules)


def plate_names(device: Device) -> tuple[str, ...]:
    """Name of the body of what is under the feet; none where they stand on the trunk."""
    return (PLATE,) if device.under else ()


def joint_names(device: Device) -> tuple[str, ...]:
    """Names of the wheels' joints, in the modules' order."""
    return tuple(joint_name(module) for module in device.modules)
