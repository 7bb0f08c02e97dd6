"""Complete devices on the paper's wheel, with all that holds them."""

from dataclasses import replace

import numpy as np
from wheels import EC45, PAPER_WHEEL, driven_device, geared, paper_device

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import DIRECT, Face, GearRoom, Mounting
from ocs_design.catalogue.motors import motor
from ocs_design.device.device import Device, Module
from ocs_design.parts.carrier_plate import CarrierPlate, Mast
from ocs_design.parts.module import carrier_of
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.motor_mount import hub_of
from ocs_design.parts.rim import WEB_THICKNESS
from ocs_design.parts.solids import Carrier
from ocs_design.parts.wheel import Web

CAGED = motor("MN5212 KV340")
FLAT = Mounting(0.004, stator=BoltCircle(0.02, 4, "M3"), stator_face=Face.OUTPUT)


def housed_device(
    mounting: Mounting | None, outer_radius: float = 0.04, guard_wall: float = 0.0
) -> Device:
    """Device with the paper's rim on a web, in a housing, on a motor with this mounting."""
    caged_motor = replace(CAGED, mounting=mounting)
    hub = hub_of(mounting, caged_motor.diameter)
    density = PAPER_WHEEL.density
    disc = cylinder_mass(0.0, PAPER_WHEEL.inner_radius, WEB_THICKNESS, density)
    mass = disc + hub.beyond_web(density).mass
    web = Web(PAPER_WHEEL.material, density, WEB_THICKNESS, mass, hub)
    wheel = replace(PAPER_WHEEL, mass=PAPER_WHEEL.mass + mass, web=web, outer_radius=outer_radius)
    drive = replace(
        EC45, mounting=mounting, mass=caged_motor.mass, diameter=caged_motor.diameter,
        length=caged_motor.length, torque_constant=0.028,
    )  # fmt: skip
    carrier = carrier_of(caged_motor, DIRECT, wheel.outer_radius, wheel.height, guard_wall)
    device = driven_device(drive=drive, carrier=carrier)
    return replace(device, flywheel=wheel, guard_wall=guard_wall)


def geared_device() -> Device:
    drive = replace(
        geared(4.0), gear_mass=0.02, gear_room=GearRoom(0.01, 0.03, 0.01, 0.01), diameter=0.04,
        length=0.03,
    )  # fmt: skip
    return driven_device(drive=drive, carrier=Carrier(0.3, 1e-4, 1e-4))


def in_two_rows(plate: CarrierPlate, outwards: float) -> CarrierPlate:
    """Two plates behind one another; the rear one's trunk screws are farther out by this [m]."""
    front, rear = 0.1, -0.1
    return replace(
        plate,
        rows=(front, rear),
        feet=tuple((x + row, y) for row in (front, rear) for x, y in plate.feet),
        trunk=tuple((x + front, y) for x, y in plate.trunk)
        + tuple((x + rear, y + outwards * np.sign(y)) for x, y in plate.trunk),
        sleeves=plate.sleeves * 2,
    )


def with_plate(device: Device) -> Device:
    """The device on a plate; three of its screws have sleeves, two of them of equal length."""
    (x, y, z), foot = device.modules[0].position.tolist(), device.foot
    radius, screws = foot.slot_radius + 0.0045, foot.slot_radius / 2**0.5
    plate = CarrierPlate(
        position=(x, 0.0, z - foot.wheel_height - 0.003), radius=radius, half_length=y + radius,
        neck=0.015, thickness=0.003, across=y, window=foot.slot_radius - 0.0045,
        feet=tuple((s * screws, t * y + s * screws) for t in (1, -1) for s in (1, -1)),
        trunk=tuple((s * 0.01, t * 0.01) for t in (1, -1) for s in (1, -1)),
        sleeves=(0.0, 0.002, 0.002, 0.0045),
    )  # fmt: skip
    return replace(device, plate=plate)


CAGED_DEVICE = housed_device(CAGED.mounting)

DEVICES = {
    "caged": CAGED_DEVICE,
    "by its face": housed_device(FLAT),
    "unknown threads": housed_device(None),
    "gear": geared_device(),
    "in a guard ring": housed_device(CAGED.mounting, guard_wall=0.0015),
    "on a plate": with_plate(CAGED_DEVICE),
    "wheels alone": paper_device(),
}


MAST = Mast(side=0.04, wall=0.003, face=0.14, below=0.0988, high=0.04, overhang=0.09, spacer=0.01)
MAST_PLATE = replace(
    DEVICES["on a plate"].plate,
    thread="M6",
    trunk=tuple((y, z) for z in (-0.0689, -0.0889) for y in (0.0115, -0.0115)),
    sleeves=(0.0,) * 4,
    rows=(0.0, 0.0),
    levels=(0.0, 0.09),
    feet=DEVICES["on a plate"].plate.feet * 2,
    mast=replace(MAST, high=0.09),
)
"""Plate of a device on the two arms of a mast."""


def device_in_layout(layout):
    """The caged device with modules in this layout around the middle of the trunk, on the trunk."""
    places = 0.04 * np.array(layout.ring) + [0.0, 0.0, CAGED_DEVICE.modules[0].position[2]]
    modules = map(Module, layout.names, layout.axes(layout.angle).T, places)
    return replace(CAGED_DEVICE, modules=tuple(modules), layout=layout, incidence=layout.angle)
