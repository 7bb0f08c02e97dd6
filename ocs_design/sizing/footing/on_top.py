"""The nearest place on top of the trunk where feet, or pedestals under them, are held."""

from dataclasses import replace
from functools import lru_cache
from math import copysign, floor, isfinite

import numpy as np

from ocs_design.actuation.fasteners import Screw
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH
from ocs_design.common.arrays import frozen, vector
from ocs_design.device.device import Device
from ocs_design.device.layout import Layout
from ocs_design.device.solids import pedestal_of, pedestal_solids, plate_solids
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import AROUND_SLOT
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import HeightMap, trunk_surface
from ocs_design.sizing.footing.contact import (
    base_points,
    contact_of,
    disc_points,
    highest_of,
    under_pedestal,
)
from ocs_design.sizing.footing.feet import (
    FailedSearches,
    Feet,
    Footing,
    device_size,
    is_tilted,
    ring_of,
)
from ocs_design.sizing.footing.plate import PLATE_SCREW, POST_SCREW, STRONG_SCREW, support_at
from ocs_design.sizing.free_place import Search, place_on_top
from ocs_design.sizing.place import place_around, place_at

LATERAL_OFFSETS = (0.04, 0.08)
"""Extra distances to both sides to try for pairs, where a limb lies over the trunk's middle [m]."""

STEP = 4e-3
"""Step between places along the trunk [m], or a sixteenth of a module's reach."""

EXCESS_HEIGHT = 1e-3
"""Excess height of a pedestal that is tolerated [m], so that places converge."""

_ENDLESS_STEP = 1e3
"""Grid step of a surface of one point [m]."""


def footing_on_top(
    surface: HeightMap, feet: Feet, search: Search, failed: FailedSearches
) -> Footing | None:
    """The nearest place that holds the feet, as close together as possible; pairs also apart."""
    robot, layout = search.collision.robot, search.layout
    if failed.run(_with_usual_screws, robot, feet, layout, rounding=floor):
        footing = _nearest_footing(surface, feet, search, 0.0, PLATE_SCREW)
        if footing is not None:
            return footing
    arrangement = failed.run(_arrangement, robot, feet, layout)
    return None if arrangement is None else _nearest_footing(surface, feet, search, *arrangement)


@lru_cache(maxsize=64)
def _with_usual_screws(robot: Robot, feet: Feet, layout: Layout) -> Footing | None:
    """The nearest place of feet as close together as possible, with the usual screws."""
    surface, search = trunk_surface(robot), Search.of(robot, feet.size, layout)
    if surface is None:
        return None
    return _nearest_footing(surface, _at_com(robot, feet, layout), search, 0.0, PLATE_SCREW)


@lru_cache(maxsize=64)
def _arrangement(robot: Robot, feet: Feet, layout: Layout) -> tuple[float, Screw] | None:
    """Extra lateral distance of pairs and the screws of their plate; None: no footing is found.

    Tried in turn: stronger screws, farther apart, and on posts over what protrudes from the trunk.
    """
    surface, search = trunk_surface(robot), Search.of(robot, feet.size, layout)
    feet = _at_com(robot, feet, layout)
    arrangements = [(0.0, STRONG_SCREW)]
    if layout.pairs:
        screws = PLATE_SCREW, STRONG_SCREW
        arrangements += [
            *((lateral_offset, screw) for lateral_offset in LATERAL_OFFSETS for screw in screws),
            (0.0, POST_SCREW),
        ]
    feasible = (
        arrangement
        for arrangement in arrangements
        if surface and _nearest_footing(surface, feet, search, *arrangement)
    )
    return next(feasible, None)


def _at_com(robot: Robot, feet: Feet, layout: Layout) -> Feet:
    """Feet as close together as possible, around the robot's centre of mass."""
    x = round(float(robot.com[0]), 6) + 0.0
    return replace(feet, x=x, bases=ring_of(layout, feet.reach))


def _nearest_footing(
    surface: HeightMap, feet: Feet, search: Search, lateral_offset: float, plate_screw: Screw
) -> Footing | None:
    """The place nearest to that of the feet where they are held and no leg comes near.

    The cost is the distance forward or back plus the thickness of the plate and its longest sleeve.
    The feet are given as close together as possible, and `lateral_offset` is the extra distance of
    each to its side [m].
    """
    bases = tuple((x, y + copysign(lateral_offset, y)) for x, y in feet.bases)
    feet = replace(feet, bases=bases)
    low, high = surface.x_range
    step = max(STEP, feet.reach / 16.0)
    steps = np.arange(np.ceil((low - feet.x) / step), (high - feet.x) / step)
    candidates: list[tuple[float, Footing]] = []
    for shift in (*sorted((steps * step).tolist(), key=abs), np.inf):
        # No place farther away can have a lower cost than those waiting.
        while candidates and candidates[0][0] <= abs(shift):
            _, footing = candidates.pop(0)
            # Modules that stand apart leave room for a limb between them; a plate does not.
            posts = plate_screw is POST_SCREW
            between = plate_solids(footing.plate) if lateral_offset or posts else ()
            if search.is_free(footing.place) and not any(map(search.touches, between)):
                return footing
        if shift == np.inf:
            break
        moved = replace(feet, x=feet.x + shift)
        if len(moved.rows) > 1:
            # A limb may be where modules of several pairs would stand directly on the trunk. A
            # plate, which takes long to search for, would lift them only by its thickness.
            under_feet = [disc_points(middle, moved.radius) for middle in moved.centers]
            top = highest_of(surface, np.concatenate(under_feet))
            on_trunk = place_around((moved.x, 0.0, top), search.layout, lateral_offset)
            if isfinite(top) and not search.is_clear_at_rest(on_trunk):
                continue
        height, plate = support_at(surface, moved, screws=(plate_screw,))
        if isfinite(height):
            origin = round(feet.x + shift, 6) + 0.0, 0.0, height
            lift = 0.0 if plate is None else plate.thickness + max(plate.sleeves)
            place = place_around(origin, search.layout, lateral_offset)
            candidates.append((abs(shift) + lift, Footing(place, plate)))
            candidates.sort(key=lambda candidate: candidate[0])
    return None


def footing_on_pedestals(
    robot: Robot, surface: HeightMap | None, device: Device, *, specified: bool
) -> Footing | None:
    """The nearest place where the trunk holds the pedestals of tilted modules, and the other feet.

    Each stands on the trunk beneath it, and no limb comes near. Specified positions are kept, and a
    pedestal then fills the height under its foot. A trunk of unknown shape counts as flat.
    """
    layout, size = device.layout, device_size(device)
    if surface is None:
        _, _, top = place_on_top(robot, layout).origins[0]
        surface = HeightMap(0.0, 0.0, _ENDLESS_STEP, np.array([[top]]))
    if any(is_tilted(module) and module.frame[2, 1] < -OUT_OF_REACH for module in device.modules):
        return None
    if specified:
        supports = _supports(surface, device, fixed=True)
        place = place_at(tuple(np.ravel([module.position for module in device.modules])), layout)
        return None if supports is None else Footing(place, None, supports[1])
    search = Search.of(robot, size, layout)
    ring, start = np.array(ring_of(layout, size.reach)), round(float(robot.com[0]), 6) + 0.0
    low, high = surface.x_range
    steps = np.arange(np.ceil((low - start) / STEP), (high - start) / STEP) * STEP
    for shift in (0.0, *sorted(steps[steps != 0.0].tolist(), key=abs)):
        x = round(start + shift, 6)
        modules = tuple(
            replace(module, position=frozen([x + along, across, float(module.position[2])]))
            for module, (along, across) in zip(device.modules, ring.tolist(), strict=True)
        )
        supports = _supports(surface, replace(device, modules=modules), fixed=False)
        if supports is None:
            continue
        heights, pedestals = supports
        ring_place = place_around((x, 0.0, 0.0), layout)
        # Not rounded, so that a pedestal's seat coincides with its foot.
        origins = tuple((x, 0.0, height - size.wheel_height) for height in heights)
        place = replace(ring_place, origins=origins)
        solids = [solid for pedestal in pedestals for solid in pedestal_solids(pedestal)]
        if (
            search.clears_limbs(solids)
            and search.is_free(place)
            and not any(map(search.touches, solids))
        ):
            return Footing(place, None, pedestals)
    return None


def _supports(
    surface: HeightMap, device: Device, *, fixed: bool
) -> tuple[list[float], tuple[Pedestal, ...]] | None:
    """Heights of the modules in B and the pedestals under them; None: the trunk does not hold all.

    The modules are above their intended places; `fixed`: whether their heights are fixed too.
    """
    heights, pedestals, foot = [], [], device.foot
    for module in device.modules:
        present_height = float(module.position[2])
        lowest = pedestal_of(device, module) if is_tilted(module) else None
        middle = vector(module.position)[:2]
        beneath = disc_points(middle, foot.base_radius) if lowest is None else base_points(lowest)
        plane = round(highest_of(surface, beneath), 6)
        if not isfinite(plane):
            return None
        least_height = plane + (foot.wheel_height if lowest is None else float(lowest.wheel[2]))
        if fixed and present_height < least_height - EXCESS_HEIGHT:
            # Specified too low for any support under it.
            return None
        if lowest is None:
            lands = foot.slot_radius - AROUND_SLOT, foot.slot_radius + AROUND_SLOT
            height = present_height if fixed else least_height
            under = height - foot.wheel_height
            contact = contact_of("", surface, middle, foot.base_radius, plane=under, lands=lands)
        else:
            # The present height is kept where it fits, so that places converge.
            fits = least_height <= present_height <= least_height + EXCESS_HEIGHT
            height = (
                present_height if fixed or fits else round(least_height + EXCESS_HEIGHT / 2.0, 5)
            )
            placed = replace(module, position=frozen([*module.position[:2], height]))
            pedestals.append(pedestal_of(device, placed, plane))
            contact = under_pedestal(surface, device, placed, pedestals[-1])
        if not contact.held:
            return None
        heights.append(height)
    return heights, tuple(pedestals)
