"""The device alone as links and joints of an SDF model (sdformat.org, specification 1.9)."""

from pathlib import Path

import numpy as np

from ocs_design.design import Device, Flywheel, Module
from ocs_design.export.device_urdf import inertial_values
from ocs_design.export.inertials import carrier_inertial, flywheel_inertial
from ocs_design.export.motor import highest_speed, largest_torque
from ocs_design.export.naming import carrier_name, flywheel_name, joint_name
from ocs_design.export.seat import Seat, trunk_link
from ocs_design.export.standing import plain_standing_visuals
from ocs_design.export.standing_text import visuals_sdf
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.wheel_frame import wheel_rpy
from ocs_design.robot.robot import Mount
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.stance.base_frame import BASE_FRAME


def export_snippet_sdf(device: Device, seat: Seat, path: Path) -> Path:
    """Write links and joints to paste into an SDF model.

    Args:
        device: to write.
        seat: that carries it.
        path: of the SDF.
    """
    link = trunk_link(seat)
    place = {"parent": quoted(link), "frame": quoted(link if seat.mount is None else BASE_FRAME)}
    base = "" if seat.mount is None else _base_frame(seat.mount)
    modules = "".join(_module(device, module, place) for module in device.modules)
    values = {**place, "parent_in_comment": in_comment(link), "device": base + modules}
    path.write_bytes(fill("ocs.sdf", values).encode("utf-8"))
    return path


def _base_frame(mount: Mount) -> str:
    """The frame with x forward and z up, where the robot's own link has none."""
    place = mount.placement
    pose = numbers([*place.position, *rpy_from_rotation(place.rotation)])
    return fill("base_frame.sdf", {"frame": BASE_FRAME, "parent": quoted(mount.link), "pose": pose})


def _module(device: Device, module: Module, place: dict[str, str]) -> str:
    placed = {**place, "pose": numbers(np.concatenate([module.position, wheel_rpy(module.axis)]))}
    wheel = fill(
        "flywheel.sdf",
        {
            **placed,
            **inertial_values(flywheel_inertial(device)),
            **_outline(device.flywheel),
            "link": flywheel_name(module),
            "joint": joint_name(module),
            "limit": _limit(device),
        },
    )
    carrier = carrier_inertial(device, module)
    if carrier is None:
        return wheel
    link = carrier_name(module)
    # Unlike in URDF, a link and a joint of a model may not share a name.
    names = {"link": link, "joint": f"{link}_fixed"}
    visuals = visuals_sdf(plain_standing_visuals(device, module))
    values = {**placed, **inertial_values(carrier), **names, "visuals": visuals}
    return wheel + fill("carrier.sdf", values)


def _outline(wheel: Flywheel) -> dict[str, str]:
    return {"radius": numbers(wheel.outer_radius), "length": numbers(wheel.height)}


def _limit(device: Device) -> str:
    """What the motor can do; SDF has no armature."""
    torque, speed = largest_torque(device.motor), highest_speed(device.motor)
    effort = "" if torque is None else f"<effort>{numbers(torque)}</effort>"
    velocity = f"<velocity>{numbers(speed)}</velocity>" if np.isfinite(speed) else ""
    limit = f"<limit>{effort}{velocity}</limit>" if effort or velocity else ""
    if device.motor.armature == 0.0:
        return limit
    return f"{limit}\n        <!-- armature {numbers(device.motor.armature)} kg m^2 is left out -->"
