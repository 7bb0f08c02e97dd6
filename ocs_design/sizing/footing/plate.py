"""The trunk itself, or the lightest carrier plate on it, under feet at one place."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from math import inf, isnan, nan, sqrt

import numpy as np

from ocs_design.actuation.fasteners import Screw
from ocs_design.parts.carrier_plate import (
    EDGE,
    SAFETY,
    SLEEVE_WALL,
    SLOT_EDGE,
    STOCK,
    YIELD_STRENGTH,
    CarrierPlate,
)
from ocs_design.parts.plate_strength import plate_screws_use, plate_stresses
from ocs_design.robot.surface import Surface
from ocs_design.sizing.footing.contact import contact_of
from ocs_design.sizing.footing.feet import SENSES, Feet
from ocs_design.sizing.footing.lands import (
    FLATNESS,
    PROUD,
    disc_points,
    heights_at,
    highest_of,
    plate_points,
    ring_points,
)
from ocs_design.sizing.footing.screws import (
    PATTERN_STEP,
    PLATE_SCREW,
    POST_SCREW,
    POST_WALL,
    SPREAD,
    STRONG_SCREW,
    Patterns,
    flat_patterns,
    room_to_foot,
    screwed,
)

WIDER = (0.0, 5e-3, 10e-3, 15e-3, 20e-3)
"""Steps by which half a neck's width may grow, to find where the trunk takes its screws or to bear
what the narrowest does not [m]."""

_FEW = 29
"""Of so many points of a screw's land one is looked at first."""


def held_at(
    surface: Surface,
    feet: Feet,
    underside: float | None = None,
    held_by: Sequence[Screw] = (PLATE_SCREW, STRONG_SCREW),
) -> CarrierPlate | float | None:
    """What holds the feet at their place: the trunk at a height [m], a plate, or nothing.

    Args:
        surface: of the trunk. feet: on it.
        underside: height of the feet in B, where it is stated [m]; None: what the trunk has.
        held_by: screws of a plate, tried in turn.
    """
    plane = nan if underside is None else underside
    if underside is None:
        # A few points of the screws' lands tell of most places that they are not at one height.
        few = np.concatenate([ring_points(side, *feet.lands)[::_FEW] for side in feet.middles])
        heights = heights_at(surface, few)
        with np.errstate(invalid="ignore"):
            level = heights.max() - heights.min() <= FLATNESS
        if level:
            bases = [disc_points(side, feet.radius) for side in feet.middles]
            plane = highest_of(surface, np.concatenate(bases))
    if np.isfinite(plane) and all(
        contact_of("", surface, side, feet.radius, plane=plane, lands=feet.lands).held
        for side in feet.middles
    ):
        return float(round(plane, 6))
    plates = (_plate(surface, feet, underside, each) for each in held_by if feet.rows)
    return next((plate for plate in plates if plate is not None), None)


def _plate(
    surface: Surface, feet: Feet, underside: float | None, held_by: Screw
) -> CarrierPlate | None:
    """The lightest plate of its necks in stock that carries all modules; None: there is none.

    Each pair of them has a plate of its own, all alike and at one height. A ring has one.
    """
    outlines = _outlines(replace(feet, x=0.0), held_by)
    if not outlines:
        return None
    flat = [flat_patterns(surface, feet, row, outlines) for row in feet.rows]
    best, lightest, beside = None, inf, nan
    for index, outline in enumerate(outlines):
        patterns = [row.of(index) for row in flat]
        if not all(len(row) for row in patterns):
            continue
        if isnan(beside):
            # Beside the plate the trunk may be as high as its top: modules begin above that.
            beneath = np.concatenate([disc_points(middle, feet.reach) for middle in feet.middles])
            beside = highest_of(surface, beneath) - STOCK[0]
        plate = replace(outline, position=(feet.x, 0.0, 0.0))
        level = max(highest_of(surface, plate_points(plate)), beside)
        borne = _borne(surface, feet, plate, patterns, (underside, level))
        if borne is not None and (mass := borne.mass) < lightest:
            best, lightest = borne, mass
        # What is wider and as thick is heavier.
        if best is not None and best.thickness == STOCK[0]:
            return best
    return best


def blank_plate(feet: Feet, radius: float, neck: float) -> CarrierPlate:
    """Plate of the thinnest stock under feet around the origin, without screws.

    Args:
        feet: that stand on it. radius: of its ends [m]. neck: half the width between them [m].
    """
    return CarrierPlate(
        position=(0.0, 0.0, 0.0),
        radius=radius,
        half_length=feet.y + radius,
        # A rounding this flat is none.
        neck=neck if neck < radius - PATTERN_STEP else radius,
        thickness=STOCK[0],
        across=feet.y,
        window=max(0.0, feet.slot_radius - SLOT_EDGE),
        feet=feet.screws,
        trunk=(),
        sleeves=(),
        rows=feet.rows,
    )


@lru_cache(maxsize=8)
def _outlines(feet: Feet, held_by: Screw) -> tuple[CarrierPlate, ...]:
    """Plates of all necks under feet around the origin, without screws, the narrowest first."""
    ring = feet.slot_radius + SLOT_EDGE
    # Heads stand clear of the feet, before and behind where these are nearest to each other.
    inside = max(0.0, feet.y - SPREAD / 2.0)
    off = room_to_foot(feet, held_by)
    ahead = sqrt(max(0.0, off**2 - inside**2)) if feet.arms == len(SENSES) else 0.0
    least = max(SPREAD / 2.0, ahead + PATTERN_STEP) + EDGE * held_by.clearance_hole
    plates = []
    for neck in (least + wider for wider in WIDER):
        radius = max(ring, neck)
        plate = replace(
            blank_plate(feet, radius, neck),
            thread=held_by.name,
            arms=feet.arms,
            sleeve_wall=POST_WALL if held_by is POST_SCREW else SLEEVE_WALL,
        )
        if plate.shape.fits:
            plates.append(plate)
    return tuple(plates)


def _borne(
    surface: Surface,
    feet: Feet,
    blank: CarrierPlate,
    patterns: Sequence[Patterns],
    heights: tuple[float | None, float],
) -> CarrierPlate | None:
    """The thinnest plate of this outline that the trunk holds and that bears the modules.

    Args:
        surface: of the trunk. feet: on it. blank: the plate without screws.
        patterns: of screws that may be flat on the trunk, of each row.
        heights: of the feet in B, where it is stated, and the least one of the plate, for what is
            beneath and beside it [m].
    """
    underside, highest = heights
    if not np.isfinite(highest):
        return None
    x, y, _ = blank.position
    if underside is None:
        held = screwed(surface, replace(blank, position=(x, y, round(highest, 6))), patterns)
        return None if held is None else _bearing(held, feet, STOCK)
    for thickness in STOCK:
        height = underside - thickness
        if height < highest - PROUD:
            return None
        held = screwed(surface, replace(blank, position=(x, y, height)), patterns)
        if held is None:
            return None
        plate = _bearing(held, feet, (thickness,))
        if plate is not None:
            return plate
    return None


def _bearing(held: CarrierPlate, feet: Feet, thicknesses: tuple[float, ...]) -> CarrierPlate | None:
    """The plate in the first of some thicknesses [m] that bears the modules; None: in none."""
    for plate in thick_enough(held, feet, YIELD_STRENGTH / SAFETY, thicknesses):
        if plate_screws_use(plate, feet.mass, feet.height) <= 1.0:
            return plate
    return None


def thick_enough(
    blank: CarrierPlate, feet: Feet, stress: float, thicknesses: tuple[float, ...] = STOCK
) -> Iterator[CarrierPlate]:
    """The plate in those of some thicknesses [m] that keep it below a stress, in their order.

    Args:
        blank: of any thickness. feet: on it. stress: allowed [Pa].
    """
    stresses = plate_stresses(blank, np.array(thicknesses), feet.mass, feet.height)
    for thickness, own in zip(thicknesses, stresses.tolist(), strict=True):
        if own <= stress:
            yield replace(blank, thickness=thickness)


def plate_of(held: CarrierPlate | float | None) -> CarrierPlate | None:
    """The plate, where it is one that holds the feet."""
    return held if isinstance(held, CarrierPlate) else None
