"""The device as links and joints of a URDF."""

from ocs_design.design import Device, Flywheel, Module
from ocs_design.export.motor import largest_torque
from ocs_design.export.naming import flywheel_name, joint_name
from ocs_design.export.templates import fill, numbers, quoted
from ocs_design.export.wheel_frame import wheel_rpy
from ocs_design.robot.robot import Mount
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.stance.base_frame import BASE_FRAME

UNLIMITED = 1e6
"""Where URDF asks for a limit of torque or speed and there is none [SI]."""


def mount_urdf(mount: Mount) -> str:
    """The base frame as a link fixed to the robot's own, where it has none with x forward, z up."""
    return fill(
        "base_frame.urdf",
        {
            "link": BASE_FRAME,
            "parent": quoted(mount.link),
            "position": numbers(mount.placement.position),
            "rpy": numbers(rpy_from_rotation(mount.placement.rotation)),
        },
    )


def device_urdf(device: Device, parent: str, *, mesh: str | None = None) -> str:
    """Both flywheels as URDF elements, each line indented by two spaces.

    Args:
        device: to write.
        parent: link that carries it; its frame is the base frame B.
        mesh: reference to the wheel's mesh in metres; without one it looks like a cylinder.
    """
    return "".join(_module_urdf(device, module, parent, mesh) for module in device.modules)


def _module_urdf(device: Device, module: Module, parent: str, mesh: str | None) -> str:
    return fill(
        "flywheel.urdf",
        {
            **flywheel_values(device.flywheel),
            "link": flywheel_name(module),
            "joint": joint_name(module),
            "parent": quoted(parent),
            "position": numbers(module.position),
            "rpy": numbers(wheel_rpy(module.axis)),
            "limit": limit_urdf(device),
            "visual": cylinder_urdf(device.flywheel)
            if mesh is None
            else f'<mesh filename="{quoted(mesh)}"/>',
            "collision": cylinder_urdf(device.flywheel),
        },
    )


def flywheel_values(flywheel: Flywheel) -> dict[str, str]:
    """Mass properties of a wheel, for templates."""
    return {
        "mass": numbers(flywheel.mass),
        "transverse_inertia": numbers(flywheel.transverse_inertia),
        "spin_inertia": numbers(flywheel.spin_inertia),
    }


def cylinder_urdf(flywheel: Flywheel) -> str:
    """The wheel's outline."""
    radius, length = numbers(flywheel.outer_radius), numbers(flywheel.height)
    return f'<cylinder radius="{radius}" length="{length}"/>'


def limit_urdf(device: Device) -> str:
    """What the motor can do; URDF has no limit of speed without one of torque."""
    torque = largest_torque(device.motor)
    if torque is None:
        return "<!-- the motor's torque is not limited -->"
    velocity = numbers(min(device.motor.no_load_speed, UNLIMITED))
    return f'<limit effort="{numbers(torque)}" velocity="{velocity}"/>'
