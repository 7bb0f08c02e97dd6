"""Device as links, joints and ros2_control elements of a URDF."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from ocs_design.common.frames import rpy_from_rotation
from ocs_design.device.bodies import DeviceBody, device_bodies, largest_torque
from ocs_design.device.device import Device, Flywheel
from ocs_design.export.formats import Base
from ocs_design.export.templates import fill, numbers, quoted
from ocs_design.export.visuals import Visual, plain_visuals, still_visuals
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Mount
from ocs_design.robot.tree import ShapeKind

UNLIMITED = 1e6
"""Limit of torque or speed where URDF asks for one and there is none [SI]."""

MOCK_PLUGIN = "mock_components/GenericSystem"
"""Hardware of ros2_control's own that moves nothing."""


def trunk_link(base: Base) -> str:
    """Name of the robot's own link that carries the device."""
    return base.trunk if base.mount is None else base.mount.link


def mount_urdf(mount: Mount) -> str:
    """Base frame as a link fixed to the robot's own, where it has none with x forward, z up."""
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
    """Flywheels and their carriers on `parent` as URDF elements, indented by two spaces.

    `mesh` is the wheel's in metres, with those of `still_meshes` beside it; without one all looks
    like cylinders and boxes.
    """
    looks = plain_visuals if mesh is None else still_visuals
    solid, elements = cylinder_urdf(device.flywheel), []
    for body in device_bodies(device):
        values = body_values(body, quoted(parent))
        if body.joint:
            values["limit"], values["collision"] = limit_urdf(device), solid
            values["visual"] = solid if mesh is None else f'<mesh filename="{quoted(mesh)}"/>'
            elements.append(fill("flywheel.urdf", values))
        else:
            values["visuals"] = visuals_urdf(looks(device, body.module))
            elements.append(fill("carrier.urdf", values))
    return "".join(elements)


def body_values(body: DeviceBody, parent: str) -> dict[str, str]:
    """Names, place and mass properties of a body, for templates."""
    return {
        **inertial_values(body.own),
        "link": body.name,
        "joint": body.joint,
        "parent": parent,
        "position": numbers(body.position),
        "rpy": numbers(body.rpy),
    }


def visuals_urdf(visuals: Iterable[Visual]) -> str:
    """Visual elements of a link."""
    elements = []
    for visual in visuals:
        match visual.kind:
            case ShapeKind.BOX:
                geometry = f'<box size="{numbers(2.0 * np.array(visual.size))}"/>'
            case ShapeKind.CYLINDER:
                radius, half = visual.size
                length = numbers(2.0 * half)
                geometry = f'<cylinder radius="{numbers(radius)}" length="{length}"/>'
            case _:
                geometry = f'<mesh filename="{visual.mesh}"/>'
        elements.append(fill("visual.urdf", {**visual_values(visual), "geometry": geometry}))
    return "".join(elements)


def visual_values(visual: Visual) -> dict[str, str]:
    """Name, place and colour of a visual shape, for templates."""
    place = visual.place
    return {
        "name": visual.name,
        "position": numbers(place.position),
        "rpy": numbers(rpy_from_rotation(place.rotation)),
        "color": numbers(visual.color),
    }


def inertial_values(body: MassProperties) -> dict[str, str]:
    """Mass properties of a body, for templates."""
    moments = {f"i{axis}{axis}": body.inertia[k, k] for k, axis in enumerate("xyz")}
    return {
        "mass": numbers(body.mass),
        "com": numbers(body.com),
        "ixy": numbers(body.inertia[0, 1]),
        "ixz": numbers(body.inertia[0, 2]),
        "iyz": numbers(body.inertia[1, 2]),
        **{name: numbers(value) for name, value in moments.items()},
    }


def cylinder_urdf(flywheel: Flywheel) -> str:
    """Cylinder around the wheel."""
    radius, length = numbers(flywheel.outer_radius), numbers(flywheel.height)
    return f'<cylinder radius="{radius}" length="{length}"/>'


def limit_urdf(device: Device) -> str:
    """Limits of the motor; URDF has none of speed without one of torque, and no armature."""
    motor, torque = device.motor, largest_torque(device.motor)
    velocity = numbers(min(motor.top_speed, UNLIMITED))
    limit = (
        "<!-- the motor's torque is not limited -->"
        if torque is None
        else f'<limit effort="{numbers(torque)}" velocity="{velocity}"/>'
    )
    if motor.armature == 0.0:
        return limit
    return f"{limit}\n    <!-- armature {numbers(motor.armature)} kg m^2, which URDF cannot say -->"


def ros2_control_urdf(
    device: Device, joints: Iterable[str], *, name: str = "ocs", plugin: str = MOCK_PLUGIN
) -> str:
    """Motors for ros2_control, indented by two spaces: torque in; angle, speed and torque out.

    See control.ros.org, "ros2_control hardware interface types". All texts are ready to stand in
    XML: `joints` of the wheels, `name` of the system, and `plugin`, its hardware.
    """
    elements = "".join(control_wheels(device, joints))
    return fill("ros2_control.urdf", {"name": name, "plugin": plugin, "joints": elements})


def control_wheels(device: Device, joints: Iterable[str]) -> Iterator[str]:
    """Element of each wheel's joint, commanded by torque; arguments of `ros2_control_urdf`."""
    limit = largest_torque(device.motor)
    bounds = {} if limit is None else {"min": -limit, "max": limit}
    for joint in joints:
        yield control_joint(joint, "effort", bounds)


def control_joint(
    joint: str, command: str, bounds: Mapping[str, float], position: float | None = None
) -> str:
    """Element of ros2_control of one joint, whose name is ready to stand in XML.

    Args:
        joint: its name.
        command: its command interface; empty: none.
        bounds: of the command, `min` and `max`.
        position: at the start [rad or m]; None: not stated.
    """
    start = {} if position is None else {"initial_value": position}
    interface = f"      {_interface('command', command, bounds)}\n" if command else ""
    state = _interface("state", "position", start)
    values = {"joint": joint, "command": interface, "position": state}
    return fill("ros2_control_joint.urdf", values)


def _interface(kind: str, name: str, parameters: Mapping[str, float]) -> str:
    inside = "".join(
        f'<param name="{each}">{numbers(value)}</param>' for each, value in parameters.items()
    )
    tag = f"{kind}_interface"
    return f'<{tag} name="{name}">{inside}</{tag}>' if inside else f'<{tag} name="{name}"/>'
