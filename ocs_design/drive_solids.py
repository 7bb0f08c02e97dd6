"""What drives a wheel, as cylinders: its motor, its gear, and the cage that holds them."""

from collections.abc import Iterator
from dataclasses import dataclass

from ocs_design.design import Device, Motor
from ocs_design.drive.gear import DIRECT, GearRoom
from ocs_design.sizing.foot import plate_back
from ocs_design.sizing.housing import WALL, half_height, housing_outer_radius
from ocs_design.sizing.motor_mount import MotorMount, mount_of


@dataclass(frozen=True)
class DriveSolid:
    """A cylinder about an axis that is parallel to the wheel's.

    Attributes:
        name: "motor", "gear" or "cage".
        radius: [m].
        low, high: where it begins and ends along the left wheel's axis, from its centre [m].
        up: of its axis above the wheel's [m].
    """

    name: str
    radius: float
    low: float
    high: float
    up: float = 0.0


def motor_mount(device: Device) -> MotorMount:
    """As far as it is known and fits the housing's floor."""
    mount = mount_of(device.motor, device.motor.gear_room)
    floor = housing_outer_radius(device.flywheel.outer_radius) - 2.0 * WALL
    return mount if mount.holes.reach <= floor else MotorMount()


def drive_solids(device: Device) -> tuple[DriveSolid, ...]:
    """As far as their sizes are known, behind the foot's plate."""
    back, mount = -plate_back(half_height(device.flywheel.height)), motor_mount(device)
    return (
        *_gear(device.motor.gear_room, back),
        *_motor(device.motor, mount, back),
        *_cage(device.motor, mount, back),
    )


def _gear(room: GearRoom | None, back: float) -> Iterator[DriveSolid]:
    """What turns with the wheel, and beside it what turns with the motor."""
    if room is None or room.depth == 0.0:
        return
    yield DriveSolid("gear", room.wheel_radius, back - room.depth, back)
    if room.offset > 0.0:
        yield DriveSolid("gear", room.motor_radius, back - room.depth, back, room.offset)


def _motor(motor: Motor, mount: MotorMount, back: float) -> Iterator[DriveSolid]:
    """Files of older versions do not know where it is behind a gear."""
    unknown = motor.gear != DIRECT.name and motor.gear_room is None
    if unknown or motor.diameter is None or motor.length is None:
        return
    front = back - mount.gap
    yield DriveSolid("motor", motor.diameter / 2.0, front - motor.length, front, mount.up)


def _cage(motor: Motor, mount: MotorMount, back: float) -> Iterator[DriveSolid]:
    """With the heads of the motor's screws behind it."""
    if mount.cage is not None:
        depth, radius = mount.behind(motor)
        yield DriveSolid("cage", radius, back - depth, back)
