"""Device alone, to paste, include or attach: URDF, xacro, ros2_control, MJCF and SDF."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import indent

import numpy as np

from ocs_design.common.frames import rpy_from_rotation
from ocs_design.device import bodies
from ocs_design.device.device import Device
from ocs_design.device.layout import PAIR
from ocs_design.export.formats import Base, Notes, Subject
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.urdf import (
    MOCK_PLUGIN,
    body_values,
    cylinder_urdf,
    device_urdf,
    inertial_values,
    limit_urdf,
    mount_urdf,
    ros2_control_urdf,
    trunk_link,
    visual_values,
    visuals_urdf,
)
from ocs_design.export.visuals import plain_visuals
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.tree import ShapeKind

_MACRO_PLACE = {"parent": "${parent}", "position": "${position}", "rpy": "${rpy}"}
"""Placement of wheel and carrier in terms of the xacro macro's arguments."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write all snippets."""
    for name, text in snippets(subject.device, subject.base).items():
        (folder / name).write_bytes(text.encode())
    return ()


def snippets(device: Device, base: Base) -> Mapping[str, str]:
    """All snippets by file name."""
    forms = {"urdf": snippet_urdf, "urdf.xacro": snippet_xacro}
    forms |= {"xml": snippet_mjcf, "sdf": snippet_sdf}
    texts = {f"ocs.{ending}": write_form(device, base) for ending, write_form in forms.items()}
    return {**texts, "ocs_ros2_control.urdf": snippet_ros2_control(device)}


def snippet_urdf(device: Device, base: Base) -> str:
    """Links and joints to paste into a URDF."""
    frame = "" if base.mount is None else mount_urdf(base.mount)
    return fill("ocs.urdf", {**_names(base), "device": frame + device_urdf(device, base.trunk)})


def snippet_xacro(device: Device, base: Base) -> str:
    """Xacro macro `ocs`."""
    joints = [f"${{prefix}}{joint}" for joint in bodies.joint_names(device)]
    control = ros2_control_urdf(device, joints, name="${prefix}ocs", plugin="${hardware_plugin}")
    rotation = np.eye(3) if base.mount is None else base.mount.placement.rotation
    # The supports of the feet are on the macro's own base.
    under = ""
    for body in bodies.device_bodies(device):
        if body.module is None:
            looks = visuals_urdf(plain_visuals(device, None))
            support = body_values(body, "${prefix}ocs_base") | {"visuals": looks}
            under += fill("carrier.urdf", {**support, "link": f"${{prefix}}{body.name}"})
    cylinder = cylinder_urdf(device.flywheel.outer_radius, device.flywheel.height)
    wheel = {
        **inertial_values(bodies.flywheel_inertial(device)),
        **_MACRO_PLACE,
        "link": "${prefix}ocs_${side}_flywheel",
        "joint": "${prefix}ocs_${side}",
        "visual": cylinder,
        "collision": cylinder,
        "limit": limit_urdf(device),
    }
    values = {
        **_names(base),
        "base_rpy": numbers(rpy_from_rotation(rotation)),
        **_macro_wheels(device),
        "flywheel": indent(fill("flywheel.urdf", wheel), "  "),
        "carrier": indent(_macro_carrier(device), "  "),
        "plate": indent(under, "  "),
        "plugin": MOCK_PLUGIN,
        "ros2_control": indent(control, "    "),
    }
    return fill("ocs.urdf.xacro", values)


def _macro_wheels(device: Device) -> dict[str, str]:
    """Arguments of the macro, their descriptions, and its wheels.

    A pair's incidence is an argument, because its modules may be turned by hand.
    """
    what, params, wheels = {}, [], []
    turns = {"left": "${-pi/2} 0 ${-incidence}", "right": "${-pi/2} 0 ${incidence}"}
    if device.layout == PAIR:
        what["incidence"] = "angle between each spin axis and the lateral direction y"
        params.append(f"incidence:={numbers(device.incidence)}")
        wheels.append("    <!-- The axes are (sin, cos, 0) and (-sin, cos, 0) of it. -->\n")
    for module in device.modules:
        pair, name = device.layout == PAIR, module.name
        place = f"{name}_position" if pair else f"position_{name}"
        wheel = f"the {name} flywheel" if pair else f"flywheel {name}"
        what[place] = f"centre of {wheel} in that frame"
        params.append(f"{place}:='{numbers(module.position)}'")
        rpy = turns[name] if pair else numbers(bodies.wheel_rpy(module.axis))
        wheels.append(
            f'    <xacro:ocs_flywheel side="{name}" rpy="{rpy}" position="${{{place}}}" '
            'parent="${prefix}ocs_base" prefix="${prefix}"/>\n'
        )
    words = "".join(f"  {name:<15} {text}\n" for name, text in what.items())
    return {"arguments": words, "params": " ".join(params), "wheels": "".join(wheels)}


def _macro_carrier(device: Device) -> str:
    """Carrier, with the differences between modules selected by the macro's argument."""
    inertials = [bodies.carrier_inertial(device, module) for module in device.modules]
    values_of_modules = [inertial_values(body) for body in inertials if body is not None]
    if not values_of_modules:
        return ""
    # Xacro reads names that look like numbers as numbers.
    sides = [name if name.isdigit() else f"'{name}'" for name in device.layout.names]

    def by_side(values: Sequence[str]) -> str:
        """The common value, or an expression for that of each side."""
        if len({*values}) == 1:
            return values[0]
        pairs = zip(values, sides[:-1], strict=False)
        chain = "".join(f"'{value}' if side == {side} else " for value, side in pairs)
        return f"${{{chain}'{values[-1]}'}}"

    names = values_of_modules[0]
    sided = {name: by_side([values[name] for values in values_of_modules]) for name in names}
    looks = [visuals_urdf(plain_visuals(device, module)) for module in device.modules]
    visuals = looks[0]
    if len({*looks}) > 1:
        visuals = "".join(
            f'    <xacro:if value="${{side == {side}}}">\n{look}    </xacro:if>\n'
            for side, look in zip(sides, looks, strict=True)
        )
    link = "${prefix}ocs_${side}_motor"
    return fill("carrier.urdf", {**_MACRO_PLACE, **sided, "link": link, "visuals": visuals})


def snippet_ros2_control(device: Device) -> str:
    """The wheels' motors for ros2_control, to paste into a URDF that has the device."""
    element = ros2_control_urdf(device, bodies.joint_names(device))
    return fill("ocs_ros2_control.urdf", {"ros2_control": element})


def snippet_mjcf(device: Device, base: Base) -> str:
    """Model to attach to an MJCF robot."""
    limit = bodies.largest_torque(device.motor)
    limits = "" if limit is None else f' ctrllimited="true" ctrlrange="{numbers((-limit, limit))}"'
    # Attaching prepends the prefix to the names.
    imu, attitude, rate = map(_unprefixed, (bodies.IMU, *bodies.IMU_SENSORS))
    device_bodies = list(bodies.device_bodies(device))
    wheels_first = sorted(device_bodies, key=lambda body: not body.joint)
    motors, sensors = "", ""
    for module in device.modules:
        joint, speed, torque = map(
            _unprefixed, (bodies.joint_name(module), *bodies.wheel_sensors(module))
        )
        motors += f'    <motor name="{joint}" joint="{joint}"{limits}/>\n'
        sensors += f'    <jointvel name="{speed}" joint="{joint}"/>\n'
        sensors += f'    <jointactuatorfrc name="{torque}" joint="{joint}"/>\n'
    sensors += f'    <framequat name="{attitude}" objtype="site" objname="{imu}"/>\n'
    sensors += f'    <gyro name="{rate}" site="{imu}"/>\n'
    rotation = np.eye(3) if base.mount is None else base.mount.placement.rotation
    values = {
        **_names(base),
        "bodies": ", ".join(body.name for body in wheels_first),
        "joints": ", ".join(bodies.joint_names(device)),
        **dict(zip(("speed", "torque"), bodies.wheel_sensors(device.modules[0]), strict=True)),
        "base_quaternion": numbers(quaternion(rotation)),
        "modules": "".join(_body_mjcf(device, body) for body in device_bodies),
        "motors": motors,
        "imu": imu,
        "sensors": sensors,
    }
    return fill("ocs.xml", values)


def _unprefixed(name: str) -> str:
    return name.removeprefix(bodies.PREFIX)


def _body_mjcf(device: Device, body: bodies.DeviceBody) -> str:
    values = {
        **inertial_values(body.mass_properties),
        "body": _unprefixed(body.name),
        "position": numbers(body.position),
        "quaternion": numbers(quaternion(body.place.rotation)),
    }
    if body.joint:
        wheel = device.flywheel
        values["joint"] = _unprefixed(body.joint)
        values["armature"] = numbers(device.motor.armature)
        values["size"] = numbers((wheel.outer_radius, wheel.height / 2.0))
        values["contact_bit"] = str(bodies.WHEEL_CONTACT_BIT)
        return fill("flywheel.xml", values)
    values["geoms"] = ""
    for visual in plain_visuals(device, body.module):
        turn = numbers(quaternion(visual.place.rotation))
        shape = {"type": visual.kind.value, "size": numbers(visual.size), "quaternion": turn}
        values["geoms"] += fill("visual.xml", {**visual_values(visual), **shape})
    return fill("carrier.xml", values)


def snippet_sdf(device: Device, base: Base) -> str:
    """Links and joints to paste into an SDF model (sdformat.org, specification 1.9)."""
    link = trunk_link(base)
    place = {"parent": quoted(link), "frame": quoted(link if base.mount is None else BASE_FRAME)}
    frame = ""
    if base.mount is not None:
        # The frame with x forward and z up if the robot's own link has a different one.
        at = base.mount.placement
        pose = numbers([*at.position, *rpy_from_rotation(at.rotation)])
        parent = quoted(base.mount.link)
        frame = fill("base_frame.sdf", {"frame": BASE_FRAME, "parent": parent, "pose": pose})
    parts = "".join(_body_sdf(device, body, place) for body in bodies.device_bodies(device))
    values = {**place, "parent_in_comment": in_comment(link), "device": frame + parts}
    return fill("ocs.sdf", values)


def _body_sdf(device: Device, body: bodies.DeviceBody, place: dict[str, str]) -> str:
    values = {
        **place,
        **inertial_values(body.mass_properties),
        "link": body.name,
        # Unlike in URDF, a link and a joint of a model may not share a name.
        "joint": body.joint or f"{body.name}_fixed",
        "pose": numbers([*body.position, *body.rpy]),
    }
    if body.joint:
        values["radius"] = numbers(device.flywheel.outer_radius)
        values["length"] = numbers(device.flywheel.height)
        motor, torque = device.motor, bodies.largest_torque(device.motor)
        limit = "" if torque is None else f"<effort>{numbers(torque)}</effort>"
        if np.isfinite(motor.top_speed):
            limit += f"<velocity>{numbers(motor.top_speed)}</velocity>"
        limit = f"<limit>{limit}</limit>" if limit else ""
        if motor.armature != 0.0:
            left = f"<!-- armature {numbers(motor.armature)} kg m^2 is left out -->"
            limit = f"{limit}\n        {left}"
        values["limit"] = limit
        return fill("flywheel.sdf", values)
    visuals = []
    for index, visual in enumerate(plain_visuals(device, body.module)):
        if visual.kind is ShapeKind.BOX:
            geometry = f"<box><size>{numbers(2.0 * np.array(visual.size))}</size></box>"
        else:
            radius, length = numbers(visual.size[0]), numbers(2.0 * visual.size[1])
            geometry = f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"
        look = {
            **visual_values(visual),
            "name": f"{visual.name}_{index}",
            "geometry": geometry,
            "transparency": numbers(1.0 - visual.color[3]),
        }
        visuals.append(fill("visual.sdf", look))
    return fill("carrier.sdf", {**values, "visuals": "".join(visuals)})


def _names(base: Base) -> dict[str, str]:
    trunk = trunk_link(base)
    return {"parent": quoted(trunk), "parent_in_comment": in_comment(trunk)}
