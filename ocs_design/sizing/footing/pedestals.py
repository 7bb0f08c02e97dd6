"""Modules that lean, each on a pedestal of its own, and what else stands beside them."""

from dataclasses import replace
from math import isfinite

import numpy as np

from ocs_design.actuation.tilt_inertia import OUT_OF_REACH
from ocs_design.common.arrays import frozen, vector
from ocs_design.device.device import Device
from ocs_design.device.solids import foot_of, pedestal_of, pedestal_solids
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import AROUND_SLOT
from ocs_design.robot.collision import collision_model
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import Surface
from ocs_design.sizing.footing.contact import contact_of, under_pedestal
from ocs_design.sizing.footing.feet import Footing, device_size, leans, ring_of
from ocs_design.sizing.footing.lands import base_points, disc_points, highest_of
from ocs_design.sizing.footing.on_top import STEP
from ocs_design.sizing.place import around, place_at
from ocs_design.sizing.placement import Search, Sizes, place_on_top

SPARE = 1e-3
"""Height by which a pedestal may be higher than it must be [m], so that places settle."""

_ENDLESS = 1e3
"""Step of a surface of one place [m]."""


def footing_on_pedestals(
    robot: Robot, surface: Surface | None, device: Device, *, stated: bool
) -> Footing | None:
    """The nearest place where the trunk holds the pedestals of those that lean, and other feet.

    Each stands on what the trunk has beneath it, and no limb comes near. Stated places stay, and a
    pedestal is as high as there is room under its foot. A trunk whose shapes are not known counts
    as flat.
    """
    layout, size = device.layout, device_size(device)
    if surface is None:
        _, _, top = place_on_top(robot, layout).origins[0]
        surface = Surface(0.0, 0.0, _ENDLESS, np.array([[top]]))
    if any(leans(module) and module.frame[2, 1] < -OUT_OF_REACH for module in device.modules):
        return None
    if stated:
        held = _all_held(surface, device, fixed=True)
        place = place_at(tuple(np.ravel([each.position for each in device.modules])), layout)
        return None if held is None else Footing(place, None, held[1])
    search = Search(collision_model(robot), Sizes(size, size), layout)
    ring, start = np.array(ring_of(layout, size.reach)), round(float(robot.com[0]), 6) + 0.0
    low, high = surface.x_range
    steps = np.arange(np.ceil((low - start) / STEP), (high - start) / STEP) * STEP
    for shift in (0.0, *sorted(steps[steps != 0.0].tolist(), key=abs)):
        x = round(start + shift, 6)
        modules = tuple(
            replace(module, position=frozen([x + along, across, float(module.position[2])]))
            for module, (along, across) in zip(device.modules, ring.tolist(), strict=True)
        )
        held = _all_held(surface, replace(device, modules=modules), fixed=False)
        if held is None:
            continue
        heights, pedestals = held
        around_it = around((x, 0.0, 0.0), layout)
        # Not rounded: a pedestal's seat is where its foot is.
        origins = tuple((x, 0.0, height - size.standing) for height in heights)
        place = replace(around_it, origins=origins)
        solids = [solid for each in pedestals for solid in pedestal_solids(each)]
        if search.is_off(solids) and search.is_free(place) and not any(map(search.touches, solids)):
            return Footing(place, None, pedestals)
    return None


def _all_held(
    surface: Surface, device: Device, *, fixed: bool
) -> tuple[list[float], tuple[Pedestal, ...]] | None:
    """Heights of the modules in B and the pedestals under them; None: the trunk does not hold all.

    Args:
        surface: of the trunk. device: with its modules over the places that they shall have.
        fixed: whether their heights are theirs as well.
    """
    heights, found, foot = [], [], foot_of(device)
    for module in device.modules:
        own = float(module.position[2])
        low = pedestal_of(device, module) if leans(module) else None
        middle = vector(module.position)[:2]
        beneath = disc_points(middle, foot.base_radius) if low is None else base_points(low)
        plane = round(highest_of(surface, beneath), 6)
        if not isfinite(plane):
            return None
        least = plane + (foot.wheel_height if low is None else float(low.wheel[2]))
        if low is None:
            lands = foot.slot_radius - AROUND_SLOT, foot.slot_radius + AROUND_SLOT
            height = own if fixed else least
            under = height - foot.wheel_height
            on = contact_of("", surface, middle, foot.base_radius, plane=under, lands=lands)
        else:
            # As high as it is, where that does, so that places settle.
            within = least <= own <= least + SPARE
            height = own if fixed or within else round(least + SPARE / 2.0, 5)
            placed = replace(module, position=frozen([*module.position[:2], height]))
            found.append(pedestal_of(device, placed, plane))
            on = under_pedestal(surface, device, placed, found[-1])
        if not on.held:
            return None
        heights.append(height)
    return heights, tuple(found)
