"""Space occupied by a module, as cylinders in B, for clearances and collisions."""

from dataclasses import dataclass, replace
from math import acos, atan2, ceil, cos, hypot, sin, sqrt

import numpy as np

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.frames import BACKWARDS, Placement
from ocs_design.device.device import Device, Module
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.motor_mount import motor_front
from ocs_design.parts.pedestal import Pedestal, strengthened
from ocs_design.parts.printed import CLEARANCE, PANEL, TRUNK_SCREW
from ocs_design.robot.probe import Drum

DISC_SPACING = 0.5
"""Spacing of the discs that represent a plate's neck, relative to half its width."""

_LEFT, _UP = np.eye(3)[1:]


def shaft_cut(device: Device) -> tuple[float, float]:
    """Length of a motor's shaft left in front of the motor, and length cut off [m].

    A shaft that protrudes from the hub and would come closer to the lid than `CLEARANCE` is cut
    flush with the hub. Nothing is cut where the length is unknown; a ring's housing has room for
    the whole shaft.
    """
    mounting, web = device.motor.mounting, device.flywheel.web
    length = 0.0 if mounting is None else mounting.shaft_length or 0.0
    if web is None or length == 0.0 or device.motor.gear != DIRECT.name:
        return length, 0.0
    housing = device.foot.housing
    front = motor_front(device.mount, housing.rim_height)
    hub_length = web.hub.height / 2.0 - front
    clear_length = housing.half_height - PANEL - CLEARANCE - front
    if length <= max(hub_length, clear_length):
        return length, 0.0
    return hub_length, length - hub_length


def pedestal_of(device: Device, module: Module, plane: float | None = None) -> Pedestal:
    """Pedestal under the foot of a tilted module, as thick as the module requires.

    The foot is at least far enough up the seat that housing and drive clear the screw heads of the
    near flange.

    Args:
        device, module: in its place.
        plane: height of its supporting surface in B [m]; None: that of the lowest possible
            pedestal.
    """
    foot, frame = device.foot, module.frame
    lean = acos(min(1.0, max(0.0, float(frame[2, 2]))))
    behind = [(-foot.housing.half_height, foot.wheel_height - foot.housing.radius)]
    behind += [
        (solid.low, foot.wheel_height + solid.up - solid.radius) for solid in device.drive_solids
    ]
    high = TRUNK_SCREW.head_height + CLEARANCE
    middle = max((high - up * cos(lean)) / sin(lean) - along for along, up in behind)
    along = cos(lean) * frame[:, 1] - sin(lean) * frame[:, 2]
    low = Pedestal(
        foot.base_radius,
        foot.slot_radius,
        foot.wheel_height,
        lean,
        max(foot.base_radius, middle),
        foot_base=float(foot.base),
        module=module.name,
        heading=atan2(along[1], along[0]),
    )
    above = None if plane is None else float(module.position[2]) - plane
    pedestal = strengthened(low, device.module_mass, above)
    x, y, z = (module.position - pedestal.placement.rotation @ pedestal.wheel).tolist()
    return replace(pedestal, position=(x, y, z))


def pedestal_solids(pedestal: Pedestal) -> tuple[Drum, ...]:
    """Space occupied by a pedestal: cylinders side by side around base, seat and brace."""
    thickness, place = max(pedestal.base, pedestal.thickness), pedestal.placement
    end, far = pedestal.length, pedestal.seat.rotation[:, 1] * pedestal.length
    floor, up = np.array([0.0, 0.0, pedestal.base / 2.0]), np.array([0.0, 0.0, pedestal.base])
    along = np.array([0.0, 1.0, 0.0])
    bars = [(floor - pedestal.flange * along, floor + (end + pedestal.flange) * along)]
    bars += [(up, up + far), (up + end * along, up + far)]
    drums = []
    for start, stop in bars:
        # Close enough that they cover each bar to half its thickness on either side.
        count = 1 + ceil(float(np.linalg.norm(stop - start)) / (sqrt(3.0) * thickness))
        for share in np.linspace(0.0, 1.0, count):
            middle = place.point(start + share * (stop - start))
            drums.append(Drum(middle, place.rotation[:, 0], thickness, pedestal.width))
    return tuple(drums)


@dataclass(frozen=True)
class ModuleSolids:
    """Space occupied by one module.

    Attributes:
        body: its housing, or its bare wheel without one, and its drive as far as known.
        foot: the foot's base, which stands on the trunk.
    """

    body: tuple[Drum, ...]
    foot: tuple[Drum, ...] = ()

    @property
    def all(self) -> tuple[Drum, ...]:
        """Body and foot."""
        return self.body + self.foot


def module_solids(device: Device, module: Module) -> ModuleSolids:
    """Space occupied by a module at the device's incidence."""
    wheel = device.flywheel
    if device.wheels_alone:
        return ModuleSolids((Drum(module.position, module.axis, wheel.outer_radius, wheel.height),))
    foot = device.foot
    housing, tall = foot.housing, 2.0 * foot.housing.half_height
    down = foot.wheel_height - foot.base / 2.0
    _, outward, up = module.frame.T
    base = Drum(module.position - down * up, up, foot.base_radius, foot.base)
    drum = Drum(module.position, module.axis, housing.radius, tall)
    # The drive stands behind the foot's plate; the other modules are behind both.
    drive = [
        Drum(
            module.position + (solid.low + solid.high) / 2.0 * outward + solid.up * up,
            module.axis,
            solid.radius,
            solid.high - solid.low,
        )
        for solid in device.drive_solids
    ]
    return ModuleSolids((drum, *drive), (base,))


def plate_solids(plate: CarrierPlate | None) -> tuple[Drum, ...]:
    """Space occupied by the plate under the feet: discs side by side, and its sleeves.

    Empty without a plate. The first discs of each plate are its ends. Between two others the neck's
    edge protrudes by up to 3 % of their radius. The fillets where it meets the ends are left out. A
    mast's tubes, which come last, are four cylinders each, around a quarter of their section.
    """
    if plate is None:
        return ()
    middle, up = np.array(plate.position), plate.thickness / 2.0 * _UP
    count = int(np.ceil(plate.across / (DISC_SPACING * plate.neck)))
    along_neck = [(share / count * plate.across, plate.neck) for share in range(count)]
    discs = [
        Drum(middle + up + [row + out * x, out * y, level], _UP, radius, plate.thickness)
        for row, level in zip(plate.rows, plate.heights, strict=True)
        for out, radius in ((plate.across, plate.radius), *along_neck)
        for x, y in directions(plate.arms)
    ]
    sleeves = [
        _around_screw(plate, place, -length / 2.0, plate.sleeve_radius, length)
        for place, length in zip(plate.screw_places, plate.sleeves, strict=True)
        if length > 0.0
    ]
    return (*discs, *sleeves, *mast_solids(plate))


def mast_solids(plate: CarrierPlate | None) -> tuple[Drum, ...]:
    """Upright and arms of the mast that carries the plates; empty without one."""
    if plate is None or plate.mast is None:
        return ()
    mast, middle, backwards = plate.mast, np.array(plate.position), BACKWARDS[:, 2]
    quarter, arm = mast.side / 4.0, mast.back + plate.neck
    tubes = [(mast.face - 2.0 * quarter, (mast.low + mast.high) / 2.0, _UP, mast.high - mast.low)]
    tubes += [
        (arm / 2.0 - plate.neck, level - 2.0 * quarter, backwards, arm) for level in plate.heights
    ]
    drums = [
        Drum(middle + [x, aside, z] + off * square, axis, sqrt(2.0) * quarter, length)
        for x, z, axis, length in tubes
        for square in (np.cross(axis, _LEFT),)
        for aside in (quarter, -quarter)
        for off in (quarter, -quarter)
    ]
    if mast.off > 0.0:
        low, high = plate.block
        count = int(np.ceil(mast.off / (2.0 * quarter)))
        half = mast.off / count / 2.0
        drums += [
            Drum(
                middle + np.array([mast.face + off, aside, (low + high) / 2.0]),
                _UP,
                hypot(half, quarter),
                high - low,
            )
            for off in half * np.arange(1, 2 * count, 2)
            for aside in (quarter, -quarter)
        ]
    return tuple(drums)


def plate_heads(plate: CarrierPlate | None) -> tuple[Drum, ...]:
    """Heads of the screws that hold the plate on the trunk."""
    if plate is None:
        return ()
    radius, height = plate.screw.head_diameter / 2.0, plate.screw.head_height
    return tuple(
        _around_screw(plate, place, plate.clamped + height / 2.0, radius, height)
        for place in plate.screw_places
    )


def _around_screw(
    plate: CarrierPlate, place: Placement, middle: float, radius: float, length: float
) -> Drum:
    """Cylinder about a screw in the trunk, with its middle so far along the screw [m]."""
    axis = place.rotation[:, 2]
    return Drum(np.array(plate.position) + place.position + middle * axis, axis, radius, length)
