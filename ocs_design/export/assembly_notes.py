"""Work that is left where motor, wheel, printed parts and trunk do not simply fit together."""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.motor import DIRECT, Face, GearRoom, Mounting
from ocs_design.common.units import format_quantity
from ocs_design.device.device import Device
from ocs_design.device.solids import drive_solids, motor_mount
from ocs_design.export.device_parts import printed_foot, wheel_geometry
from ocs_design.export.drawing.wheel import BROKEN_EDGE, lost_by_breaking
from ocs_design.parts.foot import TRUNK_SCREW, Foot
from ocs_design.robot.meshes import trunk_extent, trunk_top
from ocs_design.robot.robot import Robot

_UNDRILLED = "drill floor and plate for it"

_LEFT = np.array([0.0, 1.0, 0.0])

_STANDS = 1e-4
"""Distance from the trunk's top up to which a foot stands on it [m]."""


def device_notes(device: Device) -> tuple[str, ...]:
    """Notes on wheel, motor and printed parts, one sentence each."""
    notes = drive_notes(device)
    if device.flywheel.cuts.chamfer > 0.0:
        return notes
    # The wheel was sized with sharp edges.
    _, share = lost_by_breaking(wheel_geometry(device.flywheel))
    edge = format_quantity(BROKEN_EDGE, "mm")
    return (
        f"with its edges broken {edge} a wheel has {share:.2%} less inertia than was designed",
        *notes,
    )


def drive_notes(device: Device) -> tuple[str, ...]:
    """Notes on motor and printed parts, one sentence each; none for wheels without motors."""
    if device.carrier.mass == 0.0:
        return ()
    motor, foot = device.motor, printed_foot(device)
    if motor.gear != DIRECT.name:
        return (*_geared(motor), *_apart(device, foot))
    mounting = motor.mounting or Mounting()
    return (*_held(mounting, device), *_driven(mounting, device, foot), *_apart(device, foot))


def _geared(motor: Drive) -> Iterator[str]:
    """Dimensions that would have to be known to hold motor and gear."""
    room = motor.gear_room or GearRoom()
    beside = (
        f", its axis {format_quantity(room.offset, 'mm')} above the wheel's" if room.offset else ""
    )
    unknown = "shaft and the motor's threads" if room.depth else "room and the threads of both"
    stands = (
        f"the motor stands {format_quantity(room.depth, 'mm')} behind the plate{beside}, where it "
        "is counted and shown"
        if room.depth
        else "the motor is counted right behind the plate"
    )
    yield (
        f"how motor and gear are held is not designed, because the gear's {unknown} are not in the "
        f"catalogue: {stands}; {_UNDRILLED}"
    )


def _held(mounting: Mounting, device: Device) -> Iterator[str]:
    """Notes on how the motor is fixed to plate and floor."""
    stator, mount = mounting.stator, motor_mount(device)
    if stator is None:
        bare = mount.holes.pilot_radius == 0.0
        hole = format_quantity(2.0 * mount.holes.pilot_radius, "mm")
        there = "" if bare else f", besides the hole of {hole} for the rotating parts"
        yield f"the motor's threads are not in the catalogue: {_UNDRILLED}{there}"
    elif mount.holes.screws is None and mounting.stator_face is Face.BACK:
        yield (
            f"the motor's threads, {stator}, are at its back, and its size is not known or its "
            "cage does not fit the housing's floor: make a bracket for it"
        )
    elif mount.holes.screws is None:
        room = format_quantity(2.0 * printed_foot(device).housing.inner_radius, "mm")
        yield (
            f"the motor's screws, {stator}, do not fit the housing's floor of {room}: {_UNDRILLED}"
        )


def _driven(mounting: Mounting, device: Device, foot: Foot) -> Iterator[str]:
    """Notes on how the wheel is driven: by the shaft, or by threads behind plate and floor."""
    web, middle = device.flywheel.web, foot.back + motor_mount(device).gap
    if web is None:
        return
    half = web.hub.height / 2.0
    near, reach, far = (
        format_quantity(length, "mm", digits=3) for length in (middle - half, middle, middle + half)
    )
    if mounting.rotor is not None:
        yield (
            f"the hub stands {near} off the rotor that it is screwed to, plate and floor between "
            "them: make a spacer, which is not designed"
        )
    elif mounting.shaft_length is None:
        yield (
            f"the shaft has to stand out by {reach} to reach the hub's middle, by {far} to go "
            "through it; its length is not in the catalogue"
        )
    elif mounting.shaft_length < middle:
        short = format_quantity(middle - mounting.shaft_length, "mm", digits=3)
        yield f"the shaft ends {short} short of the hub's middle"


def _apart(device: Device, foot: Foot) -> Iterator[str]:
    """Feet and motors that reach over the middle of the robot, and so into each other."""
    left = device.modules[0]
    room, inwards = float(left.position[1]), float(left.axis[1])
    if foot.base_radius > room:
        yield _overlap("feet", foot.base_radius - room)
    across = sqrt(max(0.0, 1.0 - inwards**2))
    behind = (solid.radius * across - solid.low * inwards for solid in drive_solids(device))
    reach = max(behind, default=0.0)
    if reach > room:
        yield _overlap("motors", reach - room)


def _overlap(parts: str, beyond: float) -> str:
    each = format_quantity(beyond, "mm", digits=2)
    return (
        f"the {parts} stand in each other's way, {each} each beyond the robot's middle: set the "
        "modules farther apart with --position"
    )


def trunk_notes(robot: Robot, device: Device) -> tuple[str, ...]:
    """Notes on the trunk under the feet: whether it is level there and wide enough.

    The trunk is the box around its shapes.

    Args:
        robot: that carries the device.
        device: whose feet are looked at, if it has any.
    """
    if device.carrier.mass == 0.0:
        return ()
    underside = float(device.modules[0].position[2]) - printed_foot(device).wheel_height
    above = underside - trunk_top(robot.tree, robot.trunk)
    if abs(above) > _STANDS:
        gap = format_quantity(abs(above), "mm", digits=3)
        where = "above" if above > 0.0 else "below"
        return (
            f"the feet are {gap} {where} the trunk's top: make a level bracket for each and fix it "
            "to the trunk; the device's mass does not include it",
        )
    foot, out = printed_foot(device), float(device.modules[0].position[1])
    half = min(trunk_extent(robot.tree, robot.trunk, side) for side in (_LEFT, -_LEFT))
    over = out + foot.base_radius - half
    # Without shapes the trunk has no width.
    if half <= 0.0 or over <= 0.0:
        return ()
    beyond = format_quantity(over, "mm", digits=2)
    screw = out + foot.slot_radius / sqrt(2.0) + TRUNK_SCREW.clearance_hole / 2.0 - half
    if screw <= 0.0:
        return (f"the feet stand {beyond} over the trunk's sides; their screws are on it",)
    width = format_quantity(2.0 * (half + over), "mm")
    return (
        f"the feet stand {beyond} over the trunk's sides, and the outer screw of each is "
        f"{format_quantity(screw, 'mm', digits=2)} off it: put a plate of {width} across the "
        "trunk under both, which the device's mass does not include, or ask for a smaller device "
        "with --r-max",
    )
