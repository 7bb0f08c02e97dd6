"""The device as links and joints of a URDF."""

from ocs_design.design import Device, Flywheel, Module
from ocs_design.export.inertials import carrier_inertial, flywheel_inertial
from ocs_design.export.motor import highest_speed, largest_torque
from ocs_design.export.naming import carrier_name, flywheel_name, joint_name
from ocs_design.export.standing import plain_standing_visuals, standing_visuals
from ocs_design.export.standing_text import visuals_urdf
from ocs_design.export.templates import fill, numbers, quoted
from ocs_design.export.wheel_frame import wheel_rpy
from ocs_design.robot.mass_properties import MassProperties
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
    carrier = carrier_inertial(device, module)
    if carrier is None:
        return wheel
    values = {**place, **inertial_values(carrier), "link": carrier_name(module)}
    return wheel + fill("carrier.urdf", {**values, "visuals": visuals})


def inertial_values(body: MassProperties) -> dict[str, str]:
    """Mass properties of a body that is symmetric to its yz plane, for templates."""
    moments = {f"i{axis}{axis}": body.inertia[k, k] for k, axis in enumerate("xyz")}
    return {
        "mass": numbers(body.mass),
        "com": numbers(body.com),
        "iyz": numbers(body.inertia[1, 2]),
        **{name: numbers(value) for name, value in moments.items()},
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
