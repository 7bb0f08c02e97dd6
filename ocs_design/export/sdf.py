"""Device alone as links and joints of an SDF model (sdformat.org, specification 1.9)."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ocs_design.device.device import Device, Module
from ocs_design.device.naming import PLATE, carrier_name, flywheel_name, joint_name
from ocs_design.export.device_urdf import inertial_values, trunk_link, visual_values
from ocs_design.export.formats import Seat
from ocs_design.export.module_bodies import (
    carrier_inertial,
    flywheel_inertial,
    largest_torque,
    under_feet,
    wheel_rpy,
)
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.visuals import Visual, plain_carrier_visuals, plain_plate_visuals
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.tree import ShapeKind


def export_snippet_sdf(device: Device, seat: Seat, path: Path) -> Path:
    """Write links and joints to paste into an SDF model.

    Args:
        device: to write.
        seat: that carries it.
        path: of the SDF.
    """
    link = trunk_link(seat)
    place = {"parent": quoted(link), "frame": quoted(link if seat.mount is None else BASE_FRAME)}
    base = ""
    if seat.mount is not None:
        # The frame with x forward and z up, where the robot's own link has none.
        at = seat.mount.placement
        pose = numbers([*at.position, *rpy_from_rotation(at.rotation)])
        parent = quoted(seat.mount.link)
        base = fill("base_frame.sdf", {"frame": BASE_FRAME, "parent": parent, "pose": pose})
    modules = "".join(_module(device, module, place) for module in device.modules)
    modules += _plate(device, place)
    values = {**place, "parent_in_comment": in_comment(link), "device": base + modules}
    path.write_bytes(fill("ocs.sdf", values).encode("utf-8"))
    return path


def _module(device: Device, module: Module, place: dict[str, str]) -> str:
    placed = {**place, "pose": numbers(np.concatenate([module.position, wheel_rpy(module.axis)]))}
    wheel = fill(
        "flywheel.sdf",
        {
            **placed,
            **inertial_values(flywheel_inertial(device)),
            "radius": numbers(device.flywheel.outer_radius),
            "length": numbers(device.flywheel.height),
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
    visuals = _visuals(plain_carrier_visuals(device, module))
    values = {**placed, **inertial_values(carrier), **names, "visuals": visuals}
    return wheel + fill("carrier.sdf", values)


def _plate(device: Device, place: dict[str, str]) -> str:
    """What is under the feet; empty where they stand on the trunk."""
    under = under_feet(device)
    if under is None:
        return ""
    own, position = under
    values = {
        **place,
        "pose": numbers([*position, 0.0, 0.0, 0.0]),
        **inertial_values(own),
        "link": PLATE,
        "joint": f"{PLATE}_fixed",
        "visuals": _visuals(plain_plate_visuals(device)),
    }
    return fill("carrier.sdf", values)


def _visuals(shown: Iterable[Visual]) -> str:
    """Visual elements of a link."""
    visuals = []
    for index, visual in enumerate(shown):
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
    return "".join(visuals)


def _limit(device: Device) -> str:
    """Limits of the motor; SDF has no armature."""
    torque, speed = largest_torque(device.motor), device.motor.top_speed
    effort = "" if torque is None else f"<effort>{numbers(torque)}</effort>"
    velocity = f"<velocity>{numbers(speed)}</velocity>" if np.isfinite(speed) else ""
    limit = f"<limit>{effort}{velocity}</limit>" if effort or velocity else ""
    if device.motor.armature == 0.0:
        return limit
    return f"{limit}\n        <!-- armature {numbers(device.motor.armature)} kg m^2 is left out -->"
