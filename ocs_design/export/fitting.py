"""What is left to do where a motor, its wheel and the printed parts do not simply fit together."""

from collections.abc import Iterator
from math import sqrt

from ocs_design.design import Device, Motor
from ocs_design.drawing.wheel import BROKEN_EDGE, lost_by_breaking
from ocs_design.drive.gear import DIRECT, GearRoom
from ocs_design.drive.mounting import Face, Mounting
from ocs_design.drive_solids import drive_solids, motor_mount
from ocs_design.export.made_wheel import made_wheel
from ocs_design.export.workshop import printed_foot
from ocs_design.parts.foot import Foot
from ocs_design.units import format_quantity

_UNDRILLED = "floor and plate are to be drilled for it"


def fitting_remarks(device: Device) -> tuple[str, ...]:
    """One sentence each.

    Args:
        device: whose motors, if any, stand on the back of their feet's plates.
    """
    return (*_broken(device), *standing_remarks(device))


def _broken(device: Device) -> Iterator[str]:
    """Of a wheel that was sized with sharp edges."""
    if device.flywheel.cuts.chamfer > 0.0:
        return
    _, share = lost_by_breaking(made_wheel(device.flywheel))
    edge = format_quantity(BROKEN_EDGE, "mm")
    yield f"with its edges broken {edge} a wheel has {share:.2%} less inertia than was designed"


def standing_remarks(device: Device) -> tuple[str, ...]:
    """Of motor and printed parts alone."""
    return () if device.carrier.mass == 0.0 else tuple(_standing(device))


def _standing(device: Device) -> Iterator[str]:
    motor, foot = device.motor, printed_foot(device)
    if motor.gear != DIRECT.name:
        yield from _geared(motor)
    else:
        mounting = motor.mounting or Mounting()
        yield from _held(mounting, device)
        yield from _driven(mounting, device, foot)
    yield from _apart(device, foot)


def _geared(motor: Motor) -> Iterator[str]:
    """What would have to be known to hold it."""
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
        f"how motor and gear are held is not designed, for the gear's {unknown} are not in the "
        f"catalogue: {stands}; {_UNDRILLED}"
    )


def _held(mounting: Mounting, device: Device) -> Iterator[str]:
    """How the motor is, on plate and floor."""
    stator, mount = mounting.stator, motor_mount(device)
    if stator is None:
        bare = mount.holes.pilot_radius == 0.0
        hole = format_quantity(2.0 * mount.holes.pilot_radius, "mm")
        there = "" if bare else f", beyond the hole of {hole} for what turns"
        yield f"the motor's threads are not in the catalogue: {_UNDRILLED}{there}"
    elif mount.holes.screws is None and mounting.stator_face is Face.BACK:
        yield (
            f"the motor's threads, {stator}, are at its back, and its size is not known or its "
            "cage does not fit the housing's floor: it needs a bracket of your own"
        )
    elif mount.holes.screws is None:
        room = format_quantity(2.0 * printed_foot(device).housing.inner_radius, "mm")
        yield (
            f"the motor's screws, {stator}, do not fit the housing's floor of {room}: {_UNDRILLED}"
        )


def _driven(mounting: Mounting, device: Device, foot: Foot) -> Iterator[str]:
    """How the wheel is: by the shaft through plate and floor, or by threads behind them."""
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
            "them: it needs a spacer, which is not designed"
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
    """Whether mirrored parts reach over the middle of the robot, and so into each other."""
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
