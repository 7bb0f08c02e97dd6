"""What a module fills, as cylinders in B: for what it is near, and what could hit it."""

from dataclasses import dataclass

import numpy as np

from ocs_design.actuation.motor import DIRECT
from ocs_design.device.device import Device, Module
from ocs_design.parts.foot import BASE_THICKNESS, Foot
from ocs_design.parts.housing import Housing, housing_outer_radius
from ocs_design.parts.motor_mount import DriveSolid, MotorMount, drive_cylinders, mount_of
from ocs_design.parts.printed import WALL
from ocs_design.robot.tree import Drum

PLATE_DISCS = 0.5
"""Distance of the discs that stand for a plate's neck, over half its width."""

_UP = np.array([0.0, 0.0, 1.0])


def motor_mount(device: Device) -> MotorMount:
    """How the motor is held, as far as that is known and fits the housing's floor."""
    motor = device.motor
    mount = mount_of(motor, motor.gear_room, device.foot_plate).around(device.flywheel.height)
    floor = housing_outer_radius(device.flywheel.outer_radius) - 2.0 * WALL
    return mount if mount.holes.reach <= floor else MotorMount(foot_plate=device.foot_plate)


def foot_of(device: Device) -> Foot:
    """Foot of one module, around the housing that it carries."""
    wheel, mount = device.flywheel, motor_mount(device).holes
    housing = Housing(wheel.outer_radius, wheel.height, mount, guard_wall=device.guard_wall)
    return Foot(housing, device.foot_plate)


def drive_solids(device: Device) -> tuple[DriveSolid, ...]:
    """Gear, motor and cage as far as their sizes are known, behind the foot's plate."""
    motor, height = device.motor, device.flywheel.height
    found = drive_cylinders(motor, motor.gear_room, motor_mount(device), height)
    # Files of older versions do not know where the motor is behind a gear.
    unknown = motor.gear != DIRECT.name and motor.gear_room is None
    return tuple(solid for solid in found if not (unknown and solid.name == "motor"))


@dataclass(frozen=True)
class ModuleSolids:
    """What one module fills.

    Attributes:
        body: its housing, or its bare wheel where it has none, and what drives it as far as known.
        foot: the foot's base, which stands on the trunk.
    """

    body: tuple[Drum, ...]
    foot: tuple[Drum, ...] = ()

    @property
    def all(self) -> tuple[Drum, ...]:
        """Body and foot."""
        return self.body + self.foot


def module_solids(device: Device, module: Module) -> ModuleSolids:
    """What a module fills at the device's incidence."""
    wheel = device.flywheel
    if device.carrier.mass == 0.0:
        return ModuleSolids((Drum(module.position, module.axis, wheel.outer_radius, wheel.height),))
    foot = foot_of(device)
    housing, tall = foot.housing, 2.0 * foot.housing.half_height
    down = foot.wheel_height - BASE_THICKNESS / 2.0
    _, outward, up = module.frame.T
    base = Drum(module.position - down * up, up, foot.base_radius, BASE_THICKNESS)
    drum = Drum(module.position, module.axis, housing.radius, tall)
    # What drives the wheel stands behind the foot's plate; the other modules are behind both.
    driving = [
        Drum(
            module.position + (solid.low + solid.high) / 2.0 * outward + solid.up * up,
            module.axis,
            solid.radius,
            solid.high - solid.low,
        )
        for solid in drive_solids(device)
    ]
    return ModuleSolids((drum, *driving), (base,))


def plate_solids(device: Device) -> tuple[Drum, ...]:
    """What the plate under the feet fills, none without one: discs side by side, and its sleeves.

    The first and the last disc of each plate are its ends. Between two of them the neck's edge is
    up to 3 % of their radius farther out. The roundings where it meets the ends are left out.
    """
    plate = device.plate
    if plate is None:
        return ()
    middle, straight = np.array(plate.position), plate.half_length - plate.radius
    count = 1 + int(np.ceil(2.0 * straight / (PLATE_DISCS * plate.neck)))
    up = plate.thickness / 2.0 * _UP
    along_neck = [(across, plate.neck) for across in np.linspace(-straight, straight, count)[1:-1]]
    discs = [
        Drum(middle + up + np.array([row, across, 0.0]), _UP, radius, plate.thickness)
        for row in plate.rows
        for across, radius in ((-straight, plate.radius), *along_neck, (straight, plate.radius))
    ]
    sleeves = [
        Drum(middle + np.array([x, y, -length / 2.0]), _UP, plate.sleeve_radius, length)
        for (x, y), length in zip(plate.trunk, plate.sleeves, strict=True)
        if length > 0.0
    ]
    return (*discs, *sleeves)


def plate_heads(device: Device) -> tuple[Drum, ...]:
    """Heads of the screws that hold the plate on the trunk."""
    plate = device.plate
    if plate is None:
        return ()
    held, top = plate.screw, np.array([*plate.position[:2], plate.top])
    return tuple(
        Drum(
            top + np.array([x, y, held.head_height / 2.0]),
            _UP,
            held.head_diameter / 2.0,
            held.head_height,
        )
        for x, y in plate.trunk
    )
