"""Footing of a device on its robot, before the device is chosen and after."""

from dataclasses import replace

import numpy as np

from ocs_design.common.arrays import frozen
from ocs_design.device.device import Device
from ocs_design.device.layout import ISOTROPIC, PAIR, Layout
from ocs_design.parts.foot import Foot
from ocs_design.parts.housing import Housing
from ocs_design.requirement.device_sections import Envelope
from ocs_design.robot.collision import collision_model
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import trunk_surface
from ocs_design.sizing.footing.feet import (
    SENSES,
    FailedSearches,
    Feet,
    Footing,
    device_size,
    feet_of,
    ring_of,
    slopes_of,
)
from ocs_design.sizing.footing.mast import footing_behind
from ocs_design.sizing.footing.on_top import footing_on_pedestals, footing_on_top
from ocs_design.sizing.footing.plate import support_at
from ocs_design.sizing.free_place import Search, Sizes, place_free
from ocs_design.sizing.place import place_at

MODULE_SHARE = 0.1
"""Ratio of a module's mass to the robot's, to estimate the plate before a module is chosen:
Solo12's."""


def footing_of(
    robot: Robot,
    envelope: Envelope,
    position: tuple[float, ...] | None = None,
    layout: Layout = PAIR,
) -> Footing:
    """Place of modules with feet, and the plate under them where the trunk does not hold them.

    The place is the nearest one on top of the trunk over the centre of mass where the largest
    module's feet are held, by the trunk or by a plate, and where no leg comes near. Where there is
    none, or the trunk's shapes are unknown, it is that of `place_free`: a mast, whose place and
    mass depend on the modules, is searched for only for a chosen device (`footing_under`). Plates
    carry pairs and rings of three or more. `position`: as specified in B [m] (`place_at`); None:
    free.
    """
    sizes, surface = Sizes.of(envelope), trunk_surface(robot)
    largest, mass = sizes.largest, MODULE_SHARE * robot.mass
    foot = Foot(Housing(envelope.outer_radius_max, envelope.height_max))
    base = foot.base_radius, foot.slot_radius, largest.reach, largest.wheel_height
    if position is not None:
        place = place_at(position, layout)
        if surface is None or layout != PAIR:
            return Footing(place, None)
        x, y, z = position
        feet = Feet(x, ((0.0, y), (0.0, -y)), SENSES, *base, mass)
        return Footing(place, support_at(surface, feet, z - largest.wheel_height)[1])
    if surface is not None:
        start = round(float(robot.com[0]), 6) + 0.0
        slopes = slopes_of(layout.axes(ISOTROPIC if layout.angle is None else layout.angle))
        feet = Feet(start, ring_of(layout, largest.reach), slopes, *base, mass)
        search = Search(collision_model(robot), sizes, layout)
        footing = footing_on_top(surface, feet, search, FailedSearches())
        if footing is not None:
            return footing
    return Footing(place_free(robot, envelope, layout).place, None)


def standing_on(device: Device, footing: Footing) -> Device:
    """The device with its modules at the positions of its footing."""
    centers = footing.place.centers(device_size(device))
    modules = (
        replace(module, position=frozen(center))
        for module, center in zip(device.modules, centers, strict=True)
    )
    return replace(device, modules=tuple(modules), plate=footing.plate, pedestals=footing.pedestals)


def footing_under(
    device: Device,
    robot: Robot,
    *,
    specified: bool,
    formed: bool = False,
    failed: FailedSearches | None = None,
) -> Footing | None:
    """Footing of a selected device: its feet on the trunk, and a plate where they are not held.

    Modules whose place is not specified move to the height of their support, and forward or back to
    the nearest place where they are held. None: there is none, or no known one (`contacts_of`).

    Args:
        specified: whether the modules' positions are specified.
        formed: whether a mast may stand on a block shaped to the trunk.
        failed: searches on this robot that have failed; None: none yet.
    """
    failed = failed or FailedSearches()
    surface = trunk_surface(robot)
    if device.wheels_alone:
        return None
    feet, layout = feet_of(device), device.layout
    if not feet.slopes:
        return footing_on_pedestals(robot, surface, device, specified=specified)
    if surface is None:
        return None
    if specified:
        places = [module.position for module in device.modules]
        if layout != PAIR:
            return Footing(place_at(tuple(np.concatenate(places).tolist()), layout), None)
        _, plate = support_at(surface, feet, float(places[0][2]) - device.foot.wheel_height)
        return Footing(place_at(tuple(places[0].tolist())), plate)
    feet = replace(feet, bases=ring_of(layout, feet.reach))
    footing = footing_on_top(surface, feet, Search.of(robot, feet.size, layout), failed)
    return footing or footing_behind(robot, feet, layout, failed, formed=formed)
