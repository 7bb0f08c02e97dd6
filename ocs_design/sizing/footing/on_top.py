"""The nearest place on top of the trunk where feet are held and no limb comes near."""

from dataclasses import replace
from functools import lru_cache
from math import copysign, isfinite

import numpy as np

from ocs_design.actuation.fasteners import Screw
from ocs_design.device.layout import Layout
from ocs_design.device.solids import plate_solids
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.robot.collision import collision_model
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import Surface, trunk_surface
from ocs_design.sizing.footing.feet import Feet, Footing, ring_of, rough
from ocs_design.sizing.footing.lands import disc_points, highest_of
from ocs_design.sizing.footing.plate import held_at, plate_of
from ocs_design.sizing.footing.screws import PLATE_SCREW, POST_SCREW, STRONG_SCREW
from ocs_design.sizing.place import Size, around
from ocs_design.sizing.placement import Search, Sizes

ASIDE = (0.04, 0.08)
"""How much farther to both sides pairs are tried, where a limb lies over the trunk's middle [m]."""

STEP = 4e-3
"""Step between places along the trunk [m], or a sixteenth of a module's reach."""


def footing_on_top(surface: Surface, feet: Feet, search: Search) -> Footing | None:
    """The nearest place of the feet, as close together as they fit; pairs also farther apart."""
    found = _nearest_footing(surface, feet, search, 0.0, PLATE_SCREW)
    if found is None:
        way = _way(search.collision.robot, *rough(feet, search.sizes.largest), search.layout)
        return None if way is None else _nearest_footing(surface, feet, search, *way)
    return found


@lru_cache(maxsize=64)
def _way(robot: Robot, feet: Feet, size: Size[float], layout: Layout) -> tuple[float, Screw] | None:
    """How much farther apart pairs stand than they must, and what screws hold their plate.

    With stronger screws first, then farther apart, then on posts, over what stands up from the
    trunk; None: none does.
    """
    surface, x = trunk_surface(robot), round(float(robot.com[0]), 6) + 0.0
    search = Search(collision_model(robot), Sizes(size, size), layout)
    feet = replace(feet, x=x, bases=ring_of(layout, size.reach))
    ways = [(0.0, STRONG_SCREW)]
    if layout.pairs:
        both = PLATE_SCREW, STRONG_SCREW
        ways += [*((aside, each) for aside in ASIDE for each in both), (0.0, POST_SCREW)]
    found = (way for way in ways if surface and _nearest_footing(surface, feet, search, *way))
    return next(found, None)


def _nearest_footing(
    surface: Surface, feet: Feet, search: Search, aside: float, held_by: Screw
) -> Footing | None:
    """The nearest place to that of the feet where they are held and no leg comes near.

    A longer sleeve is as bad as as far a way forward, and so is a plate as its thickness.

    Args:
        surface: of the trunk. feet: on it, as near to each other as may be. search: of places.
        aside: how much farther to its side each stands [m]. held_by: screws of a plate.
    """
    bases = tuple((x, y + copysign(aside, y)) for x, y in feet.bases)
    feet = replace(feet, bases=bases)
    low, high = surface.x_range
    step = max(STEP, feet.reach / 16.0)
    steps = np.arange(np.ceil((low - feet.x) / step), (high - feet.x) / step)
    waiting: list[tuple[float, Footing]] = []
    for shift in (*sorted((steps * step).tolist(), key=abs), np.inf):
        # Nothing farther away can be better than what is nearer than that.
        while waiting and waiting[0][0] <= abs(shift):
            _, footing = waiting.pop(0)
            # Farther apart, modules leave room for a limb between them, but not a plate.
            posts = held_by is POST_SCREW
            between = plate_solids(footing.plate) if aside or posts else ()
            if search.is_free(footing.place) and not any(map(search.touches, between)):
                return footing
        if shift == np.inf:
            break
        moved = replace(feet, x=feet.x + shift)
        if len(moved.rows) > 1:
            # A limb may be where modules of several pairs would stand on the trunk itself. A plate,
            # which takes long to look for, would lift them by its thickness only.
            beneath = [disc_points(middle, moved.radius) for middle in moved.middles]
            top = highest_of(surface, np.concatenate(beneath))
            on_trunk = around((moved.x, 0.0, top), search.layout, aside)
            if isfinite(top) and not search.is_clear(on_trunk):
                continue
        held = held_at(surface, moved, held_by=(held_by,))
        if held is not None:
            plate = plate_of(held)
            height = held.top if isinstance(held, CarrierPlate) else held
            origin = round(feet.x + shift, 6) + 0.0, 0.0, height
            lift = 0.0 if plate is None else plate.thickness + max(plate.sleeves)
            place = around(origin, search.layout, aside)
            waiting.append((abs(shift) + lift, Footing(place, plate)))
            waiting.sort(key=lambda each: each[0])
    return None
