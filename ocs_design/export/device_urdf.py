"""The device as links and joints of a URDF."""

from ocs_design.design import Device, Flywheel, Module
from ocs_design.export.inertials import Inertial, carrier_inertial, flywheel_inertial
from ocs_design.export.motor import highest_speed, largest_torque
from ocs_design.export.naming import carrier_name, flywheel_name, joint_name
from ocs_design.export.standing import plain_standing_visuals, standing_visuals
from ocs_design.export.standing_text import visuals_urdf
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
    """Both flywheels and what carries them as URDF elements, indented by two spaces.

    Args:
        device: to write.
        parent: link that carries it; its frame is the base frame B.
        mesh: reference to the wheel's mesh in metres, with those of `standing_meshes` beside it;
            without one all looks like cylinders and boxes.
    """
    return "".join(_module_urdf(device, module, parent, mesh) for module in device.modules)


def _module_urdf(device: Device, module: Module, parent: str, mesh: str | None) -> str:
    look = plain_standing_visuals if mesh is None else standing_visuals
    place = {
        "parent": quoted(parent),
        "position": numbers(module.position),
        "rpy": numbers(wheel_rpy(module.axis)),
    }
    wheel = fill(
        "flywheel.urdf",
        {
            **place,
            **inertial_values(flywheel_inertial(device)),
            "link": flywheel_name(module),
            "joint": joint_name(module),
            "limit": limit_urdf(device),
            "visual": cylinder_urdf(device.flywheel)
            if mesh is None
            else f'<mesh filename="{quoted(mesh)}"/>',
            "collision": cylinder_urdf(device.flywheel),
        },
    )
    visuals = visuals_urdf(look(device, module))
    return wheel + carrier_urdf(device, {**place, "link": carrier_name(module)}, visuals)


def carrier_urdf(device: Device, place: dict[str, str], visuals: str) -> str:
    """What stands still as a fixed link; nothing if it is massless.

    Args:
        device: to write.
        place: `link`, `parent`, `position` and `rpy`, ready to stand in XML.
        visuals: its elements to look at.
    """
    carrier = carrier_inertial(device)
    if carrier is None:
        return ""
    return fill("carrier.urdf", {**place, **inertial_values(carrier), "visuals": visuals})


def inertial_values(inertial: Inertial) -> dict[str, str]:
    """Mass properties, for templates."""
    return {
        "mass": numbers(inertial.mass),
        "transverse_inertia": numbers(inertial.transverse_inertia),
        "axial_inertia": numbers(inertial.axial_inertia),
    }


def cylinder_urdf(flywheel: Flywheel) -> str:
    """The wheel's outline."""
    radius, length = numbers(flywheel.outer_radius), numbers(flywheel.height)
    return f'<cylinder radius="{radius}" length="{length}"/>'


def limit_urdf(device: Device) -> str:
    """What the motor can do; URDF has no limit of speed without one of torque, and no armature."""
    motor, torque = device.motor, largest_torque(device.motor)
    velocity = numbers(min(highest_speed(motor), UNLIMITED))
    limit = (
        "<!-- the motor's torque is not limited -->"
        if torque is None
        else f'<limit effort="{numbers(torque)}" velocity="{velocity}"/>'
    )
    if motor.armature == 0.0:
        return limit
    return f"{limit}\n    <!-- armature {numbers(motor.armature)} kg m^2, which URDF cannot say -->"
