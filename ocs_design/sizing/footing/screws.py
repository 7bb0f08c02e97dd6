"""Patterns of the screws that hold a plate on the trunk.

Two in each arm, as far from its middle line on either side. Of three arms and more each may share
its screws with the next ones. Heads stay clear of the feet and of the next arm's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.fasteners import Screw, screw
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.carrier_plate import EDGE, CarrierPlate, Point
from ocs_design.parts.dog_bone import directions
from ocs_design.robot.surface import Surface
from ocs_design.sizing.footing.feet import SAME, SENSES, Feet
from ocs_design.sizing.footing.lands import FLATNESS, PROUD, disc_points

HEAD_ROOM = 0.5e-3
"""Room between a screw's head and a foot's base [m]."""

PLATE_SCREW, POST_SCREW = screw("M3"), screw("M8")
"""Screws that hold a plate on the trunk: through sleeves at the most, and through posts."""

SPREAD = 0.02
"""Least distance of a plate's screws, forward and sideways [m]: four heads of M5 and a key."""

SLEEVE_MAX = 0.03
"""Longest sleeve under a plate [m]: four times as long as wide, for M3."""

POST_WALL, POST_MAX = 4e-3, 0.17
"""Wall of a post, and longest one [m]: with M8 x 200."""

PATTERN_STEP = 2e-3
"""Step between patterns of screws [m], or a fortieth of a module's reach."""


@dataclass(frozen=True, eq=False)
class Patterns:
    """Patterns of screws that are flat on the trunk under every screw.

    Attributes:
        along, across: of a screw from the middle line of its arm and from the plate's middle [m],
            shape (n,).
        shared: whether neighbouring arms share it, shape (n,).
        widest: number of the plate at whose neck's edge it is; -1: of the grid that all have.
        most: largest of `along` of each plate [m].
        places: of the screws over the plate's middle [m], shape (n, m, 2).
        top, low: of the trunk under each screw in B [m], shape (n, m).
    """

    along: FloatArray
    across: FloatArray
    shared: NDArray[np.bool_]
    widest: NDArray[np.int64]
    most: FloatArray
    places: FloatArray
    top: FloatArray
    low: FloatArray

    def __len__(self) -> int:
        return len(self.along)

    def where(self, chosen: NDArray[np.bool_]) -> "Patterns":
        """Those that are chosen."""
        return Patterns(
            self.along[chosen],
            self.across[chosen],
            self.shared[chosen],
            self.widest[chosen],
            self.most,
            self.places[chosen],
            self.top[chosen],
            self.low[chosen],
        )

    def of(self, index: int) -> "Patterns":
        """Those of the plate with this number."""
        inside = (self.widest < 0) & (self.along < self.most[index])
        return self.where(inside | (self.widest == index))


def flat_patterns(
    surface: Surface, feet: Feet, row: float, plates: Sequence[CarrierPlate]
) -> Patterns:
    """Patterns of screws at which the trunk is flat, whatever its height.

    Two screws in each arm, as far from its middle line on either side. Of three arms and more each
    may share its screws with the next ones. Heads stay clear of the feet and of the next arm's.

    Args:
        surface: of the trunk. feet: on it. row: of the plates' middle before that of the feet [m].
        plates: that differ in their necks alone, the narrowest first.
    """
    grid = _pattern_grid(
        feet.y,
        max(PATTERN_STEP, feet.reach / 40.0),
        room_to_foot(feet, plates[0].screw),
        tuple(plate.neck - EDGE * plate.screw.clearance_hole for plate in plates),
        feet.arms,
    )
    lands, middle = disc_points((0.0, 0.0), plates[0].sleeve_radius), np.array([feet.x + row, 0.0])
    some, kept = lands[:: max(1, len(lands) // 8)], np.arange(len(grid))
    # Most patterns fail at a few points of their first screw already.
    for screw_places in grid.places.swapaxes(0, 1):
        top, low = _top_and_low(surface, screw_places[kept, None] + some + middle)
        with np.errstate(invalid="ignore"):
            kept = kept[top - low <= FLATNESS]
        if not len(kept):
            break
    within = np.zeros(len(grid), dtype=bool)
    within[kept] = True
    found = grid.where(within)
    top, low = _top_and_low(surface, found.places[:, :, None] + lands + middle)
    with np.errstate(invalid="ignore"):
        flat = np.asarray((top - low <= FLATNESS).all(axis=1))
    return replace(found, top=top, low=low).where(flat)


def _top_and_low(surface: Surface, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Largest and least height of a trunk at the points of each disc [m], shape (..., m, 2)."""
    heights = surface.height(points[..., 0], points[..., 1])
    return heights.max(axis=-1), heights.min(axis=-1)


@lru_cache(maxsize=8)
def _pattern_grid(
    aside: float, step: float, apart: float, most: tuple[float, ...], arms: int
) -> Patterns:
    """Patterns of screws that stand clear of the feet, whatever is below them.

    Args:
        aside: of a foot's middle from that of its plate [m]. step: between patterns [m].
        apart: least distance of a screw from the middle of a foot [m].
        most: farthest of a screw from the middle line of its arm, for each plate [m].
        arms: of each plate.
    """
    steps = np.concatenate([np.arange(SPREAD / 2.0, max(most), step), most])
    widest = np.concatenate([np.full(len(steps) - len(most), -1), np.arange(len(most))])
    order = np.argsort(steps, kind="stable")
    steps, widest = steps[order], widest[order]
    out = np.append(np.arange(SPREAD / 2.0, aside, step), aside)
    along, across = (each.ravel() for each in np.meshgrid(steps, out, indexing="ij"))
    half, edges = pi / arms, np.repeat(widest, len(out))
    shared = np.zeros(len(along), dtype=bool)
    clear = across * sin(half) - along * cos(half) >= SPREAD / 2.0 - SAME
    if arms > len(SENSES):
        between = steps / np.tan(half)
        along, across = np.append(along, steps), np.append(across, between)
        shared = np.append(shared, np.ones(len(between), dtype=bool))
        clear, edges = np.append(clear, shared[shared]), np.append(edges, widest)
    clear &= np.hypot(along, aside - across) >= apart
    places = np.stack(
        [
            np.stack([y * side * along + x * across, y * across - x * side * along], axis=1)
            for sense in SENSES
            for x, y in directions(arms)
            # Of both arms of a pair the same side: forward.
            for side in (sense * y if arms == len(SENSES) else sense,)
        ],
        axis=1,
    )
    none = np.empty(places.shape[:2])
    found = Patterns(along, across, shared, edges, np.array(most), places, none, none)
    return found.where(clear)


def screwed(plate: CarrierPlate, patterns: Sequence[Patterns]) -> CarrierPlate | None:
    """The plate with the widest pattern of screws that the trunk holds; None: there is none.

    Patterns without sleeves come first.

    Args:
        plate: in its place. patterns: that are flat on the trunk, of each row.
    """
    z, longest = plate.position[2], POST_MAX if on_posts(plate) else SLEEVE_MAX
    trunk: list[Point] = []
    sleeves: list[float] = []
    for ahead, each in zip(plate.rows, patterns, strict=True):
        reached = ((each.top <= z + PROUD) & (z - each.top <= longest)).all(axis=1)
        if not reached.any():
            return None
        direct = (z - each.low <= FLATNESS).all(axis=1)
        spread = np.minimum(each.along, each.across) + 0.1 * (each.along + each.across)
        best = int(np.where(reached, spread + direct, -1.0).argmax())
        top, low = each.top[best], each.low[best]
        gaps = np.where(z - low <= FLATNESS, 0.0, np.round(z - top, 5))
        count = plate.arms if each.shared[best] else len(gaps)
        trunk += [
            (ahead + round(float(x), 6), round(float(y), 6)) for x, y in each.places[best][:count]
        ]
        sleeves += gaps[:count].tolist()
    return replace(plate, trunk=tuple(trunk), sleeves=tuple(sleeves))


def on_posts(plate: CarrierPlate) -> bool:
    """Whether a plate stands on posts, not on sleeves."""
    return plate.thread == POST_SCREW.name


def room_to_foot(feet: Feet, held_by: Screw) -> float:
    """Least distance of a plate's screws from the middle of a foot [m]."""
    return feet.radius + held_by.head_diameter / 2.0 + HEAD_ROOM
