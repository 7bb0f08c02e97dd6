"""Contact of feet, plates, masts and pedestals with what is below them.

A foot is held where the ring that its screws' lands sweep, whatever the incidence, lies on the
trunk whole: within `FLATNESS` below the plane that it stands on, and nothing above that plane under
its base. A plate is held by four screws, where the trunk is as flat under each head or sleeve.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, vector
from ocs_design.device.device import Device, Module
from ocs_design.device.solids import foot_of, pedestal_of
from ocs_design.parts.carrier_plate import CarrierPlate, Point
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.module import part_name
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import AROUND_SLOT
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import Surface, trunk_back, trunk_surface
from ocs_design.sizing.footing.feet import feet_of, leans
from ocs_design.sizing.footing.lands import (
    FLATNESS,
    PROUD,
    base_points,
    disc_points,
    heights_at,
    highest_of,
    plate_points,
    ring_points,
)


@dataclass(frozen=True)
class FootContact:
    """How something stands on what is below it.

    Attributes:
        name: what stands, as in "left foot" or "foot 1".
        on: what it stands on, as in "trunk".
        area: of contact [m^2]; None: not known.
        share: of its underside that is in contact; None likewise.
        gap: largest under its screws' lands [m]; inf: nothing is there; None: not known.
        proud: height of what is below over its underside [m]; 0: nothing is in its way.
        held: whether all its screws' lands are in contact and nothing is in its way; None: not
            known.
        leans: whether the module leans, and stands on nothing.
    """

    name: str
    on: str
    area: float | None
    share: float | None
    gap: float | None
    proud: float
    held: bool | None
    leans: bool = False


def contacts_of(robot: Robot, device: Device) -> tuple[FootContact, ...]:
    """What the feet stand on, and each screw of the plate where there is one.

    Empty for wheels without feet. A foot whose wheel's axis is not horizontal stands on its
    pedestal, and that on the trunk; without one it stands on nothing.
    """
    if device.carrier.mass == 0.0:
        return ()
    surface, plate, feet = trunk_surface(robot), device.plate, feet_of(device)
    height, found = foot_of(device).wheel_height, []
    for module, middle in zip(device.modules, feet.middles, strict=True):
        name, underside = part_name("foot", module.name), float(module.position[2]) - height
        under = [each for each in device.pedestals if each.module == module.name]
        if under and surface is None:
            found.append(
                FootContact(
                    part_name("pedestal", module.name), "trunk", None, None, None, 0.0, held=None
                )
            )
        elif under and surface is not None:
            found += [under_pedestal(surface, device, module, each) for each in under]
        elif leans(module):
            found.append(FootContact(name, "trunk", 0.0, 0.0, inf, 0.0, held=False, leans=True))
        elif plate is not None:
            # It carries a foot around the circle of its screws.
            gap = min(abs(underside - plate.top - level) for level in plate.heights)
            share = float(_over_plate(plate, disc_points(middle, feet.radius)).mean())
            lands = ring_points(middle, *feet.lands)
            held = bool(_over_plate(plate, lands).all()) and gap <= PROUD
            area = share * pi * feet.radius**2
            found.append(FootContact(name, "plate", area, share, gap, 0.0, held))
        elif surface is None:
            found.append(FootContact(name, "trunk", None, None, None, 0.0, held=None))
        else:
            found.append(
                contact_of(name, surface, middle, feet.radius, plane=underside, lands=feet.lands)
            )
    if plate is not None:
        found += _plate_contacts(robot, plate)
    return tuple(found)


def under_pedestal(
    surface: Surface, device: Device, module: Module, pedestal: Pedestal
) -> FootContact:
    """Contact of a pedestal with the trunk, which also has to bear the foot where it is."""
    plane, base, place = pedestal.position[2], base_points(pedestal), pedestal.placement
    depth = plane - heights_at(surface, base)
    share = float(((depth <= FLATNESS) & (depth >= -PROUD)).mean())
    lands = [
        disc_points(vector(place.rotation @ [*hole, 0.0] + place.position)[:2], AROUND_SLOT)
        for hole in pedestal.holes
    ]
    gap = max(0.0, float((plane - heights_at(surface, np.concatenate(lands))).max()))
    proud = max(0.0, -float(depth.min()))
    wheel = place.rotation @ pedestal.wheel + place.position
    seated = (
        bool(np.allclose(wheel, module.position, rtol=0.0, atol=1e-6))
        and pedestal.middle >= pedestal_of(device, module).middle - 1e-6
    )
    held = gap <= FLATNESS and proud <= PROUD and seated
    area = share * pedestal.width * (pedestal.length + 2.0 * pedestal.flange)
    return FootContact(part_name("pedestal", module.name), "trunk", area, share, gap, proud, held)


def _over_plate(plate: CarrierPlate, points: FloatArray) -> NDArray[np.bool_]:
    """Whether points of B are over a plate's aluminium, its holes for screws counted as full."""
    own, over = points - np.array(plate.position[:2]), np.zeros(len(points), dtype=bool)
    for shape in plate.shapes:
        inside = shape.holds(own)
        for middle in plate.across * directions(plate.arms) + [shape.x, 0.0]:
            inside &= np.hypot(*(own - middle).T) >= plate.window
        over |= inside
    return over


def _plate_contacts(robot: Robot, plate: CarrierPlate) -> Iterator[FootContact]:
    """Contact of each of a plate's screws, or of its sleeve, with the trunk."""
    (x, y, z), mast = plate.position, plate.mast
    if mast is None:
        surface, plane = trunk_surface(robot), z
        outline = -inf if surface is None else highest_of(surface, plate_points(plate))
    else:
        # Seen from behind.
        surface, plane, half = trunk_back(robot), -x - mast.face - mast.spacer, mast.side / 2.0
        x, outline = z, -inf
        if surface is not None:
            block, upright = (
                surface.farthest(z + low, z + high, half)
                for low, high in (plate.block, (mast.low, mast.high))
            )
            outline = max(block, upright - mast.spacer)
    what = "plate" if mast is None else "mast"
    for number, (hole, sleeve) in enumerate(zip(plate.trunk, plate.sleeves, strict=True), start=1):
        along, across = hole if mast is None else hole[::-1]
        name, middle = f"{what}'s screw {number}", (x + along, y + across)
        if surface is None:
            yield FootContact(name, "trunk", None, None, None, 0.0, held=None)
            continue
        radius = plate.sleeve_radius
        found = contact_of(name, surface, middle, radius, plane=plane - sleeve, lands=(0.0, radius))
        proud = max(found.proud, outline - plane)
        yield replace(found, proud=proud, held=bool(found.held) and proud <= PROUD)


def contact_of(
    name: str,
    surface: Surface,
    middle: Point,
    radius: float,
    *,
    plane: float,
    lands: tuple[float, float],
) -> FootContact:
    """Contact of a disc with the trunk, whose screws' lands are between two radii [m]."""
    depth = plane - heights_at(surface, disc_points(middle, radius))
    share = float(((depth <= FLATNESS) & (depth >= -PROUD)).mean())
    gap = max(0.0, float((plane - heights_at(surface, ring_points(middle, *lands))).max()))
    proud = max(0.0, -float(depth.min()))
    held = gap <= FLATNESS and proud <= PROUD
    return FootContact(name, "trunk", share * pi * radius**2, share, gap, proud, held)
