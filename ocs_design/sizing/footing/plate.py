"""The trunk itself, or the lightest carrier plate screwed on it, under feet at one place.

Each arm of a plate has two screws, at equal distances on either side of its middle line. With three
or more arms, each may share its screws with its neighbours. Heads stay clear of the feet and of the
next arm's heads.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, inf, isnan, nan, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.fasteners import Screw, screw
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.parts.carrier_plate import (
    ALUMINIUM,
    EDGE,
    SAFETY,
    SLEEVE_MAX,
    SLEEVE_WALL,
    SLOT_EDGE,
    STOCK,
    CarrierPlate,
    Point,
)
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.plate_strength import plate_screws_use, plate_stresses
from ocs_design.robot.surface import HeightMap
from ocs_design.sizing.footing.contact import (
    FLATNESS,
    INTERFERENCE_MAX,
    contact_of,
    disc_points,
    heights_at,
    highest_of,
    plate_points,
    ring_points,
)
from ocs_design.sizing.footing.feet import SAME_PLACE, SENSES, Feet

HEAD_TO_FOOT = 0.5e-3
"""Clearance between a screw's head and a foot's base [m]."""

PLATE_SCREW, STRONG_SCREW, POST_SCREW = screw("M3"), screw("M5"), screw("M8")
"""Screws that hold a plate on the trunk: usual ones, stronger ones where those do not withstand 20
g, and ones through posts."""

SPREAD = 0.02
"""Least distance of a plate's screws, forward and sideways [m]: four heads of M5 and a key."""

POST_WALL, POST_MAX, POST_SCREW_MAX = 4e-3, 0.17, 0.2
"""Wall of a post, longest post and longest screw through one [m], which leaves room for 12 mm
plates."""

PATTERN_STEP = 2e-3
"""Step between patterns of screws [m], or a fortieth of a module's reach."""


_POINTS_CHECKED_FIRST = 8
"""Number of points of each screw's land that are checked first."""

_PATTERNS_AT_ONCE = 16
"""Number of patterns whose lands are checked in full at once."""


@dataclass(frozen=True, eq=False)
class Patterns(Table):
    """Screw patterns under which the trunk may be flat, judged by a few points of each screw.

    Attributes:
        along, across: distance of a screw from the middle line of its arm and from the plate's
            centre [m], shape (n,).
        shared: whether neighbouring arms share it, shape (n,).
        widest: index of the plate at whose neck's edge it is; -1: on the grid common to all plates.
        along_max: largest `along` of each plate [m].
        places: of the screws relative to the plate's centre [m], shape (n, m, 2).
        top, low: height of the trunk at those points of each screw in B [m], shape (n, m).
    """

    along: FloatArray
    across: FloatArray
    shared: NDArray[np.bool_]
    widest: NDArray[np.int64]
    along_max: tuple[float, ...]
    places: FloatArray
    top: FloatArray
    low: FloatArray

    def __len__(self) -> int:
        return len(self.along)

    def of(self, index: int) -> "Patterns":
        """The patterns of the plate with this index."""
        inside = (self.widest < 0) & (self.along < self.along_max[index])
        return self.take(inside | (self.widest == index))


def flat_patterns(
    surface: HeightMap, feet: Feet, row: float, plates: Sequence[CarrierPlate]
) -> Patterns:
    """Screw patterns at which the trunk may be flat, whatever its height.

    `row`: distance of the plates' centre ahead of the feet's [m]; `plates` differ only in their
    necks, the narrowest first.
    """
    grid = _pattern_grid(
        feet.y,
        max(PATTERN_STEP, feet.reach / 40.0),
        screw_to_foot(feet, plates[0].screw),
        tuple(plate.neck - EDGE * plate.screw.clearance_hole for plate in plates),
        feet.arms,
    )
    lands, middle = disc_points((0.0, 0.0), plates[0].sleeve_radius), np.array([feet.x + row, 0.0])
    few_points, rows = lands[:: max(1, len(lands) // _POINTS_CHECKED_FIRST)], np.arange(len(grid))
    # Most patterns already fail at a few points of their first screw.
    for screw_places in grid.places.swapaxes(0, 1):
        top, low = _top_and_low(surface, screw_places[rows, None] + few_points + middle)
        with np.errstate(invalid="ignore"):
            rows = rows[top - low <= FLATNESS]
        if not len(rows):
            break
    top, low = _top_and_low(surface, grid.places[rows, :, None] + few_points + middle)
    return replace(grid.take(rows), top=top, low=low)


def _top_and_low(surface: HeightMap, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Largest and least height of a trunk at the points of each disc [m], shape (..., m, 2)."""
    heights = heights_at(surface, points)
    return heights.max(axis=-1), heights.min(axis=-1)


@lru_cache(maxsize=8)
def _pattern_grid(
    foot_distance: float, step: float, clearance: float, along_max: tuple[float, ...], arms: int
) -> Patterns:
    """Screw patterns clear of the feet, regardless of the surface below them.

    Args:
        foot_distance: distance of a foot's centre from its plate's [m]. step: between patterns [m].
        clearance: least distance of a screw from the centre of a foot [m].
        along_max: largest distance of a screw from the middle line of its arm, for each plate [m].
        arms: number of arms of each plate.
    """
    steps = np.concatenate([np.arange(SPREAD / 2.0, max(along_max), step), along_max])
    widest = np.concatenate([np.full(len(steps) - len(along_max), -1), np.arange(len(along_max))])
    order = np.argsort(steps, kind="stable")
    steps, widest = steps[order], widest[order]
    distances = np.append(np.arange(SPREAD / 2.0, foot_distance, step), foot_distance)
    along, across = (grid.ravel() for grid in np.meshgrid(steps, distances, indexing="ij"))
    half_angle, plate_index = pi / arms, np.repeat(widest, len(distances))
    shared = np.zeros(len(along), dtype=bool)
    clear = across * sin(half_angle) - along * cos(half_angle) >= SPREAD / 2.0 - SAME_PLACE
    if arms > len(SENSES):
        between = steps / np.tan(half_angle)
        along, across = np.append(along, steps), np.append(across, between)
        shared = np.append(shared, np.ones(len(between), dtype=bool))
        clear, plate_index = np.append(clear, shared[shared]), np.append(plate_index, widest)
    clear &= np.hypot(along, foot_distance - across) >= clearance
    places = np.stack(
        [
            np.stack([y * side * along + x * across, y * across - x * side * along], axis=1)
            for sense in SENSES
            for x, y in directions(arms)
            # On both arms of a pair the same side counts first: forward.
            for side in (sense * y if arms == len(SENSES) else sense,)
        ],
        axis=1,
    )
    empty = np.empty(places.shape[:2])
    patterns = Patterns(along, across, shared, plate_index, along_max, places, empty, empty)
    return patterns.take(clear)


def with_screws(
    surface: HeightMap, plate: CarrierPlate, patterns: Sequence[Patterns]
) -> CarrierPlate | None:
    """The plate with the widest pattern of screws that the trunk holds; None: there is none.

    Patterns without sleeves come first. There are candidates for each row of the plate.
    """
    trunk: list[Point] = []
    sleeves: list[float] = []
    for ahead, row_patterns in zip(plate.rows, patterns, strict=True):
        widest = _widest_pattern(surface, plate, plate.position[0] + ahead, row_patterns)
        if widest is None:
            return None
        index, gaps = widest
        count = plate.arms if row_patterns.shared[index] else len(gaps)
        trunk += [
            (ahead + round(float(x), 6), round(float(y), 6))
            for x, y in row_patterns.places[index][:count]
        ]
        sleeves += gaps[:count].tolist()
    return replace(plate, trunk=tuple(trunk), sleeves=tuple(sleeves))


def _widest_pattern(
    surface: HeightMap, plate: CarrierPlate, x: float, patterns: Patterns
) -> tuple[int, FloatArray] | None:
    """Index of the widest pattern that holds one row of a plate, and its sleeves' lengths [m].

    `x`: of the row's middle in B [m].
    """
    z, longest = plate.position[2], POST_MAX if plate.on_posts else SLEEVE_MAX
    spread = np.minimum(patterns.along, patterns.across) + 0.1 * (patterns.along + patterns.across)
    may_reach = patterns.top <= z + INTERFERENCE_MAX
    # A flat land is nowhere higher than a few of its points by more than that.
    may_reach &= z - patterns.top <= longest + FLATNESS
    score_max = spread + (z - patterns.low <= FLATNESS).all(axis=1)
    order = np.flatnonzero(may_reach.all(axis=1))
    order = order[np.argsort(-score_max[order], kind="stable")]
    lands, middle = disc_points((0.0, 0.0), plate.sleeve_radius), np.array([x, 0.0])
    best, score, sleeves = -1, 0.0, np.empty(0)
    for start in range(0, len(order), _PATTERNS_AT_ONCE):
        rows = order[start : start + _PATTERNS_AT_ONCE]
        if score_max[rows[0]] < score:
            break
        top, low = _top_and_low(surface, patterns.places[rows, :, None] + lands + middle)
        with np.errstate(invalid="ignore"):
            holds = (top - low <= FLATNESS) & (top <= z + INTERFERENCE_MAX) & (z - top <= longest)
        direct = (z - low <= FLATNESS).all(axis=1)
        scores = np.where(holds.all(axis=1), spread[rows] + direct, -1.0)
        # Among equals, the first one.
        for row, index in enumerate(rows.tolist()):
            if scores[row] > score or (scores[row] == score and index < best):
                best, score = index, float(scores[row])
                sleeves = np.where(z - low[row] <= FLATNESS, 0.0, np.round(z - top[row], 5))
    return None if best < 0 else (best, sleeves)


def screw_to_foot(feet: Feet, plate_screw: Screw) -> float:
    """Least distance of a plate's screws from the centre of a foot [m]."""
    return feet.radius + plate_screw.head_diameter / 2.0 + HEAD_TO_FOOT


NECK_INCREMENTS = (0.0, 5e-3, 10e-3, 15e-3, 20e-3)
"""Increments of half a neck's width to try [m], where the trunk does not take the narrowest plate's
screws or that plate is too weak."""

_EVERY_NTH = 29
"""One in this many points of a foot's screw lands is checked first."""


def support_at(
    surface: HeightMap,
    feet: Feet,
    underside: float | None = None,
    screws: Sequence[Screw] = (PLATE_SCREW, STRONG_SCREW),
) -> tuple[float, CarrierPlate | None]:
    """Height at which the trunk, or a plate on it, holds the feet [m], and that plate.

    The height is NaN where neither does.

    Args:
        underside: specified height of the feet in B [m]; None: the trunk's height.
        screws: screws of a plate, tried in turn.
    """
    plane = nan if underside is None else underside
    if underside is None:
        # A few points of the screws' lands rule out most places, where they are not level.
        sampled = np.concatenate(
            [ring_points(center, *feet.lands)[::_EVERY_NTH] for center in feet.centers]
        )
        heights = heights_at(surface, sampled)
        with np.errstate(invalid="ignore"):
            level = heights.max() - heights.min() <= FLATNESS
        if level:
            bases = [disc_points(center, feet.radius) for center in feet.centers]
            plane = highest_of(surface, np.concatenate(bases))
    if np.isfinite(plane) and all(
        contact_of("", surface, center, feet.radius, plane=plane, lands=feet.lands).held
        for center in feet.centers
    ):
        return float(round(plane, 6)), None
    plates = (_plate(surface, feet, underside, plate_screw) for plate_screw in screws if feet.rows)
    return next(((plate.top, plate) for plate in plates if plate is not None), (nan, None))


def _plate(
    surface: HeightMap, feet: Feet, underside: float | None, plate_screw: Screw
) -> CarrierPlate | None:
    """The lightest plate, over all necks and stock thicknesses, that carries all modules; or None.

    Each pair has its own plate, all identical and at one height. A ring has a single plate.
    """
    outlines = _outlines(replace(feet, x=0.0), plate_screw)
    if not outlines:
        return None
    flat = [flat_patterns(surface, feet, row, outlines) for row in feet.rows]
    best, lightest, trunk_beside = None, inf, nan
    for index, outline in enumerate(outlines):
        patterns = [row.of(index) for row in flat]
        if not all(len(row) for row in patterns):
            continue
        if isnan(trunk_beside):
            around = np.concatenate([disc_points(middle, feet.reach) for middle in feet.centers])
            trunk_beside = highest_of(surface, around)
        plate = replace(outline, position=(feet.x, 0.0, 0.0))
        trunk_below = highest_of(surface, plate_points(plate))
        # Beside the plate the trunk may be as high as the plate's top: modules begin above that.
        levels: list[tuple[float, tuple[float, ...]]]
        levels = [(round(max(trunk_below, trunk_beside - STOCK[0]), 6), STOCK)]
        if underside is not None:
            # A thicker plate is lower.
            levels = [
                (underside - thickness, (thickness,))
                for thickness in STOCK
                if underside - thickness >= trunk_below - INTERFERENCE_MAX
                and underside >= trunk_beside - INTERFERENCE_MAX
            ]
        strong = _thinnest_plate(surface, feet, plate, patterns, levels)
        if strong is not None and (mass := strong.mass) < lightest:
            best, lightest = strong, mass
        # Wider plates of the same thickness are heavier.
        if best is not None and best.thickness == STOCK[0]:
            return best
    return best


def blank_plate(feet: Feet, radius: float, neck: float) -> CarrierPlate:
    """Plate of the thinnest stock under feet around the origin, without screws.

    `radius`: of its ends [m]; `neck`: half the width between them [m].
    """
    return CarrierPlate(
        position=(0.0, 0.0, 0.0),
        radius=radius,
        half_length=feet.y + radius,
        # A neck of nearly full width counts as no neck.
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
def _outlines(feet: Feet, plate_screw: Screw) -> tuple[CarrierPlate, ...]:
    """Plates of all necks under feet around the origin, without screws, the narrowest first."""
    ring = feet.slot_radius + SLOT_EDGE
    # Heads clear the feet in front of and behind the point where these are closest to each other.
    inside = max(0.0, feet.y - SPREAD / 2.0)
    clearance = screw_to_foot(feet, plate_screw)
    ahead = sqrt(max(0.0, clearance**2 - inside**2)) if feet.arms == len(SENSES) else 0.0
    neck_min = max(SPREAD / 2.0, ahead + PATTERN_STEP) + EDGE * plate_screw.clearance_hole
    plates = []
    for neck in (neck_min + increment for increment in NECK_INCREMENTS):
        radius = max(ring, neck)
        plate = replace(
            blank_plate(feet, radius, neck),
            thread=plate_screw.name,
            arms=feet.arms,
            sleeve_wall=POST_WALL if plate_screw is POST_SCREW else SLEEVE_WALL,
        )
        if plate.shape.fits:
            plates.append(plate)
    return tuple(plates)


def _thinnest_plate(
    surface: HeightMap,
    feet: Feet,
    blank: CarrierPlate,
    patterns: Sequence[Patterns],
    levels: Sequence[tuple[float, tuple[float, ...]]],
) -> CarrierPlate | None:
    """The thinnest plate of this outline that the trunk holds and that is strong enough.

    `patterns`: candidates for each row; `levels`: heights of its underside in B, and the
    thicknesses to try at each [m].
    """
    x, y, _ = blank.position
    for height, thicknesses in levels:
        fastened = with_screws(surface, replace(blank, position=(x, y, height)), patterns)
        if fastened is None:
            # Under a thicker plate sleeves are shorter, so another pattern may be within reach.
            continue
        for plate in thick_enough(fastened, feet, ALUMINIUM.strength / SAFETY, thicknesses):
            if plate.on_posts and max(plate.screw_lengths) > POST_SCREW_MAX:
                break
            if plate_screws_use(plate, feet.mass, feet.height) <= 1.0:
                return plate
    return None


def thick_enough(
    blank: CarrierPlate, feet: Feet, stress: float, thicknesses: tuple[float, ...] = STOCK
) -> Iterator[CarrierPlate]:
    """The plate in each of the thicknesses [m] that keep it below a stress [Pa], in order."""
    stresses = plate_stresses(blank, np.array(thicknesses), feet.mass, feet.height)
    for thickness, largest in zip(thicknesses, stresses.tolist(), strict=True):
        if largest <= stress:
            yield replace(blank, thickness=thickness)
