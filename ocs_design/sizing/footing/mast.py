"""Pairs of modules behind the trunk, one above the other, on a mast."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain, product
from math import inf, sqrt, tan
from typing import NamedTuple

import numpy as np

from ocs_design.actuation.fasteners import screw
from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.device.layout import Layout
from ocs_design.device.solids import mast_solids, plate_solids
from ocs_design.parts.carrier_plate import (
    EDGE,
    MAST_YIELD,
    SLEEVE_MAX,
    SLOT_EDGE,
    TUBES,
    CarrierPlate,
    Mast,
    Point,
    plate_part,
    steepest,
)
from ocs_design.parts.joints import pattern_use
from ocs_design.parts.plate_strength import arm_stress, mast_screws_use, mast_stress
from ocs_design.parts.printed import SHOCK
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import HeightMap, trunk_back
from ocs_design.sizing.footing.contact import FLATNESS, INTERFERENCE_MAX, disc_points
from ocs_design.sizing.footing.feet import SENSES, FailedSearches, Feet, Footing
from ocs_design.sizing.footing.formed import (
    DEPTH_MAX,
    THICKNESS_MIN,
    TILT_MAX,
    block_thicknesses,
    front_of,
)
from ocs_design.sizing.footing.plate import (
    HEAD_TO_FOOT,
    NECK_INCREMENTS,
    PATTERN_STEP,
    SPREAD,
    blank_plate,
    thick_enough,
)
from ocs_design.sizing.free_place import Search
from ocs_design.sizing.place import SPACING, Place, Size

MAST_SCREWS = tuple(map(screw, ("M4", "M5", "M6", "M8")))

SPACERS = (0.0, 0.02, 0.04, 0.06, 0.08)
"""Thicknesses of blocks between a mast and the trunk to try, where a limb is in the way [m]."""

FORMED_SPACERS = (THICKNESS_MIN, *SPACERS[1:])
"""Least thicknesses of formed blocks to try [m]."""

SPREAD_MAX = 0.15
"""Largest vertical distance of a mast's screws [m]."""

_STEPS = 1.0 / 4.0, 1.0 / 12.0
"""Steps between heights of a mast's lowest plate, relative to a module's reach; the second is used
where the first finds no place."""

_PATTERNS = 8
"""Number of screw patterns of a mast that are tried."""


@dataclass(frozen=True)
class _MastPlace:
    """Place of a mast behind the trunk.

    Attributes:
        far: whether its arms are long. height: of its lowest plate in B [m].
        spacer: thickness of the block before its upright [m].
        formed: whether that block is shaped to the trunk, which is nowhere flat.
        lowest: lowest point of the upright that is known to be clear of limbs [m].
    """

    far: bool
    height: float
    spacer: float
    formed: bool
    lowest: float = -inf


def footing_behind(
    robot: Robot, feet: Feet, layout: Layout, failed: FailedSearches, *, formed: bool = False
) -> Footing | None:
    """The place behind the trunk nearest to the robot's centre where a mast carries pairs.

    They stand one above the other, on plates of one kind, on the lightest tube that is strong
    enough. Where none fits, a block shaped to the trunk may be put before it (`formed`).
    """
    back = trunk_back(robot)
    if back is None:
        return None
    spot = failed.run(_mast_place, robot, feet, layout, False)
    if spot is None and formed:
        spot = failed.run(_mast_place, robot, feet, layout, True)
    if spot is None:
        return None
    feet = _stacked(feet, layout)
    search, arms = Search.of(robot, feet.size, layout), _arm_plates(feet, far=spot.far)
    footings = (_footing_on_mast(back, feet, plate, search, spot) for plate in arms)
    return next((footing for footing in footings if footing is not None), None)


@dataclass(frozen=True)
class Pads:
    """Flat spots on a trunk's back that would suffice for the four screws of a mast.

    Attributes:
        screw: its name. diameter: of each spot [m].
        aside, up: their lateral distance and least vertical distance [m].
        exist: whether the trunk's back has them, so that only room behind it is lacking.
    """

    screw: str
    diameter: float
    aside: float
    up: float
    exist: bool


def pads_needed(robot: Robot, feet: Feet, layout: Layout) -> Pads | None:
    """Spots for a mast level with its modules, directly on the trunk; None: no mast will do."""
    back = trunk_back(robot)
    if back is None or not layout.pairs:
        return None
    feet, force = _stacked(feet, layout), 2.0 * feet.mass * SHOCK * layout.pairs
    half = np.arange(SPREAD, SPREAD_MAX, PATTERN_STEP) / 2.0
    for plate, mast_screw in product(_arm_plates(feet, far=False), MAST_SCREWS):
        screwed_plate = replace(plate, thread=mast_screw.name)
        assert screwed_plate.mast is not None, "a plate on arms"
        aside = screwed_plate.mast.bore / 2.0 - screwed_plate.sleeve_radius
        if aside < mast_screw.head_diameter / 2.0 + HEAD_TO_FOOT:
            continue
        arms = screwed_plate.mast.face, np.zeros(len(half))
        bearing = half[
            pattern_use(mast_screw, force, arms, (half, np.full(len(half), aside))) <= 1.0
        ]
        if len(bearing):
            least, radius = float(bearing.min()), screwed_plate.sleeve_radius
            pairs = _pairs(back, radius, aside, aside + PATTERN_STEP / 2.0)
            exist = pairs is not None and bool((np.diff(pairs.z) / 2.0 >= least).any())
            return Pads(mast_screw.name, 2.0 * radius, 2.0 * aside, 2.0 * least, exist)
    return None


def _stacked(feet: Feet, layout: Layout) -> Feet:
    """Feet of pairs one above the other."""
    out = SPACING * feet.reach
    return replace(feet, bases=((0.0, out), (0.0, -out)) * layout.pairs)


@lru_cache(maxsize=64)
def _mast_place(robot: Robot, feet: Feet, layout: Layout, is_formed: bool) -> _MastPlace | None:
    """Place of a mast whose modules no limb reaches while the legs give way; None: there is none.

    With a block shaped to the trunk (`is_formed`) or without.
    """
    back = trunk_back(robot)
    if back is None or not layout.pairs:
        return None
    size = feet.size
    search = Search.of(robot, size, layout, on_feet=is_formed)
    feet = _stacked(feet, layout)
    down, up = back.x_range
    arms = {far: list(_arm_plates(feet, far=far)) for far in (False, True)}
    if not all(arms.values()):
        return None
    face = back.farthest(down, up, arms[False][0].support)

    def spots(step: float) -> list[tuple[Place, bool, float, float]]:
        heights = np.arange(down - 2.0 * size.wheel_height, up + size.wheel_height, step).tolist()
        spacers = FORMED_SPACERS if is_formed else SPACERS
        places = [
            (_place_behind(back, plates[0], size, height, face + spacer), far, height, spacer)
            for (far, plates), height, spacer in product(arms.items(), heights, spacers)
        ]
        # A thicker block is heavier than a longer upright.
        return sorted(
            places, key=lambda candidate: (candidate[3], search.added_inertia(candidate[0]))
        )

    each_step = (spots(share * size.reach) for share in _STEPS)
    for place, far, height, spacer in chain.from_iterable(each_step):
        # Upright and arms of the plates of modules at this place.
        plate, centers = arms[far][0], place.centers(size)
        assert plate.mast is not None, "a plate on arms"
        x, levels = float(centers[0, 0]), (centers[:: len(SENSES), 2] - centers[0, 2]).tolist()
        upright = replace(
            plate.mast, face=-(face + spacer) - x, below=plate.mast.side, high=levels[-1]
        )
        tubes = mast_solids(
            replace(plate, position=(x, 0.0, height), levels=tuple(levels), mast=upright)
        )
        if not (search.clears_limbs(tubes) and search.is_free(place)) or any(
            map(search.touches, tubes)
        ):
            continue
        spot = _MastPlace(far, height, spacer, is_formed)
        masted = (_footing_on_mast(back, feet, plate, search, spot) for plate in arms[far])
        for footing in filter(None, masted):
            # A wider tube moves modules by less than the clearance around them.
            if not search.is_free(footing.place):
                break
            if not any(map(search.touches, plate_solids(footing.plate))):
                held = footing.plate
                assert held is not None and held.mast is not None, "plates on a mast"
                return replace(spot, lowest=height - held.mast.below)
    return None


def _arm_plates(feet: Feet, *, far: bool) -> Iterator[CarrierPlate]:
    """Plates on arms, short or long (`far`), for each tube in stock that is strong enough.

    On short arms, pairs stand on both sides of the upright; on long ones behind it.
    """
    ring = feet.slot_radius + SLOT_EDGE
    for side, wall in TUBES:
        back = side + max(_clear_distance(side, feet.reach), side, feet.y * far)
        mast = Mast(side, wall, back, 0.0, 0.0, 0.0)
        blanks = (
            replace(blank_plate(feet, ring, side / 2.0 + wider), mast=mast)
            for wider in NECK_INCREMENTS
        )
        # Thicker plates stand higher, which bends the arms more.
        bearing = (
            plate
            for blank in blanks
            if blank.shape.half_width(np.asarray(side / 2.0)) <= mast.back
            and (plate := next(thick_enough(blank, feet, MAST_YIELD), None)) is not None
            and arm_stress(plate, feet.mass, feet.height) <= MAST_YIELD
        )
        lightest = min(bearing, key=lambda plate: plate_part(plate).mass(), default=None)
        if lightest is not None:
            yield lightest


def _place_behind(
    back: HeightMap, plate: CarrierPlate, size: Size[float], height: float, face: float
) -> Place:
    """Place of pairs behind the trunk, clear of it and of a mast's upright.

    `height`: of the lowest plate in B [m]; `face`: distance of the upright's front backwards [m].
    """
    mast, out = plate.mast, SPACING * size.reach
    assert mast is not None, "a plate on arms"
    # Arms reach down between the modules below, which stand on both sides of the upright.
    room = (
        max(0.0, sqrt(2.0) * mast.side - out + _clear_distance(mast.side, size.reach))
        + plate.thickness
    )
    apart = size.wheel_height / size.reach + SPACING
    rows = range(len(plate.rows))
    top = (
        height + rows[-1] * (room + apart * size.reach) + plate.thickness + size.wheel_height + out
    )
    behind = max(back.farthest(height, top, 2.0 * out), face + mast.face - out)
    x = -round(behind, 6)
    origins = [(x, 0.0, height + plate.thickness + row * room) for row in rows]
    sides = [(-SPACING, sense * SPACING) for sense in SENSES]
    return Place(
        tuple(origin for origin in origins for _ in SENSES),
        tuple((*side, row * apart) for row in rows for side in sides),
        upright=True,
    )


def _clear_distance(side: float, reach: float) -> float:
    """Distance from a tube at which modules on both its sides clear it [m].

    Its width counts across the corners.
    """
    aside = SPACING * reach - side / sqrt(2.0)
    return sqrt(max(0.0, reach**2 - aside**2))


def _footing_on_mast(
    back: HeightMap,
    feet: Feet,
    plate: CarrierPlate,
    search: Search,
    spot: _MastPlace,
) -> Footing | None:
    """Pairs on a mast behind the trunk; None: the mast cannot hold them there."""
    mast, height, spacer = plate.mast, spot.height, spot.spacer
    assert mast is not None, "a plate on arms"
    half, best, size = mast.side / 2.0, None, search.sizes.largest
    centers = _place_behind(back, plate, size, height, 0.0).centers(size)[:: len(SENSES)]
    levels = tuple((centers[:, 2] - centers[0, 2]).tolist())
    # Where the strongest screws do not hold, no others do; but they need the widest tube.
    for mast_screw in reversed(MAST_SCREWS):
        edge, previous = EDGE * mast_screw.clearance_hole, best
        blank = replace(plate, thread=mast_screw.name)
        for low, high, aside, pads in _patterns(back, feet, blank, spot, centers):
            bottom, top = min(low - edge, height - mast.side), max(high + edge, height + levels[-1])
            if bottom < spot.lowest:
                continue
            # The block rests on the rearmost point of the trunk beneath it.
            plane = round(back.farthest(low - edge, high + edge, half), 6)
            front: tuple[tuple[float, ...], ...] = ()
            if spot.formed:
                formed_front = front_of(back, half, round(low - edge, 9), round(high + edge, 9))
                if formed_front is None:
                    continue
                plane, front = block_thicknesses(formed_front, spacer)
            face = plane + spacer
            if face < back.farthest(bottom, top, half) - INTERFERENCE_MAX:
                continue
            place = _place_behind(back, blank, size, height, face)
            x = float(place.centers(size)[0, 0])
            holes = [(y, z - height) for z in (low, high) for y in (aside, -aside)]
            gaps = [
                0.0 if front or plane - deep <= FLATNESS else round(plane - top, 5)
                for deep, top in pads
            ]
            arms = [height + level - half for level in levels]
            mast_there = replace(
                mast,
                face=-face - x,
                below=height - bottom,
                high=top - height,
                overhang=max(0.0, *(max(arm - high, low - arm) for arm in arms)),
                spacer=spacer,
                formed=front,
            )
            plate_on_mast = replace(
                blank,
                position=(x, 0.0, height),
                levels=levels,
                trunk=tuple(holes),
                sleeves=tuple(gap for gap in gaps for _ in SENSES),
                mast=mast_there,
            )
            if (
                steepest(plate_on_mast) <= TILT_MAX
                and mast_stress(plate_on_mast, feet.mass, feet.height) <= MAST_YIELD
                and mast_screws_use(plate_on_mast, feet.mass, feet.height) <= 1.0
                and search.clears_limbs(plate_solids(plate_on_mast))
            ):
                best = Footing(place, plate_on_mast)
                break
        if best is previous and best is not None:
            break
    return best


def _patterns(
    back: HeightMap, feet: Feet, plate: CarrierPlate, spot: _MastPlace, centers: FloatArray
) -> list[tuple[float, float, float, tuple[Point, Point]]]:
    """Patterns of four screws that fit the trunk's back and are strong enough, shortest mast first.

    Each is the lower and the upper height, the distance to both sides, and for both heights the
    least and largest distance of the trunk backwards. `centers`: of the wheels [m], a row each.
    """
    mast, mast_screw, height = plate.mast, plate.screw, spot.height
    assert mast is not None, "a plate on arms"
    least = mast_screw.head_diameter / 2.0 + HEAD_TO_FOOT
    most = mast.bore / 2.0 - plate.sleeve_radius
    pairs = _pairs(back, plate.sleeve_radius, least, most, is_formed=spot.formed)
    if pairs is None:
        return []
    low, high = pairs.z.T
    force = 2.0 * feet.mass * SHOCK * len(centers)
    up = np.abs(float(centers[:, 2].mean()) - (low + high) / 2.0)
    half, downhill = ((high - low) / 2.0, pairs.aside), mast_screw.preload * pairs.slope
    use = pattern_use(mast_screw, force, (mast.face + spot.spacer, up), half, downhill)
    bearing = np.flatnonzero(use <= 1.0)
    longer = np.maximum(0.0, height - low) + np.maximum(0.0, high - centers[-1, 2]) + 1e-3 * use
    order = bearing[np.argsort(longer[bearing], kind="stable")[:_PATTERNS]]
    return [
        (z[0], z[1], aside, ((deep[0], far[0]), (deep[1], far[1])))
        for z, aside, deep, far in zip(
            *(columns[order].tolist() for columns in (pairs.z, pairs.aside, pairs.deep, pairs.far)),
            strict=True,
        )
    ]


class _Pairs(NamedTuple):
    """Lower and upper heights of a mast's screws, a row each.

    Attributes:
        aside: distance of the screws to both sides [m], shape (n,).
        z: both heights [m], shape (n, 2).
        deep, far: least and largest distance of the trunk backwards there [m], shape (n, 2).
        slope: mean slope of a formed block under all four, shape (n,); 0: flat.
    """

    aside: FloatArray
    z: FloatArray
    deep: FloatArray
    far: FloatArray
    slope: FloatArray


@lru_cache(maxsize=256)
def _pairs(
    back: HeightMap, radius: float, least: float, most: float, *, is_formed: bool = False
) -> _Pairs | None:
    """Heights at which a trunk's back takes screws on both sides; None: they do not fit the tube.

    Their distances are within the limits for screws, and the trunk is flat under a sleeve on either
    side.

    Args:
        radius: of the sleeves [m].
        least, most: range of the distance of their centres to both sides [m].
        is_formed: whether a block is shaped to the trunk there, which may then be steep.
    """
    down, up = back.x_range
    heights, around = np.arange(down, up, PATTERN_STEP), disc_points((0.0, 0.0), radius)
    # On slopes the height map is off by its step; they are checked again later.
    steep = 2.0 * (radius + back.step) * tan(TILT_MAX)
    rows = []
    for aside in np.arange(least, most, PATTERN_STEP).tolist():
        lands = np.concatenate([disc_points((0.0, side * aside), radius) for side in SENSES])
        behind = back.height(
            heights[:, None] + lands[:, 0], lands[None, :, 1] + 0.0 * heights[:, None]
        )
        top, low = behind.max(axis=1), behind.min(axis=1)
        with np.errstate(invalid="ignore"):
            flat = top - low <= (steep if is_formed else FLATNESS)
            # Slope upwards and to the left, averaged over both sides.
            slope = behind @ np.tile(around, (len(SENSES), 1)) / (around**2).sum(axis=0)
        z, low, top, slope = heights[flat], low[flat], top[flat], slope[flat] / len(SENSES)
        pairs = np.stack(np.triu_indices(len(z), 1), axis=1)
        half = np.diff(z[pairs], axis=1)[:, 0] / 2.0
        allowed = (half >= SPREAD / 2.0) & (half <= SPREAD_MAX / 2.0)
        allowed &= np.ptp(top[pairs], axis=1) <= (DEPTH_MAX if is_formed else SLEEVE_MAX)
        pairs = pairs[allowed]
        steepness = is_formed * np.linalg.norm(slope[pairs].sum(axis=1), axis=1) / 2.0
        rows.append((np.full(len(pairs), aside), z[pairs], low[pairs], top[pairs], steepness))
    return _Pairs(*map(frozen, map(np.concatenate, zip(*rows, strict=True)))) if rows else None
