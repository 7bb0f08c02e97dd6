"""The nearest place on a face of the trunk where modules collide with nothing."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ocs_design.common.arrays import FloatArray, vector
from ocs_design.device.layout import PAIR, Direction, Layout
from ocs_design.parts.motor_mount import Behind
from ocs_design.requirement.device_sections import Envelope
from ocs_design.robot.clearance import nearest_in_landings
from ocs_design.robot.collision import CollisionModel, collision_model
from ocs_design.robot.meshes import trunk_extent, trunk_top
from ocs_design.robot.probe import Ball, Drum
from ocs_design.robot.robot import Robot
from ocs_design.sizing.place import SPACING, Place, Size, module_size, place_around, place_at


def place_on_top(robot: Robot, layout: Layout = PAIR) -> Place:
    """Place on top of the trunk around the centre of mass, symmetric to the sagittal plane.

    Each module may be turned to any incidence without touching the trunk or another one. Other
    parts of the robot are not checked: see `place_free`. A person wears the device on the back.
    """
    if robot.worn_at is not None:
        return place_around(robot.worn_at, layout)
    # To the micrometre, so that no rounding error of the centre of mass reaches the files.
    forward = round(float(robot.com[0]), 6) + 0.0
    return place_around((forward, 0.0, round(trunk_top(robot.tree, robot.trunk), 6)), layout)


FORWARD, LEFT, UP = np.eye(3)

ON_TOP = "on top of"

STEP = 0.5
"""Step between the places tried, relative to the radius of the largest module's sphere."""

STAND_OFF = 2.0
"""Largest distance from a face, in the same unit."""

Spot = tuple[float, float, float]
"""Place on a face: along, across and off it [m]."""


@dataclass(frozen=True, eq=False)
class TrunkSide:
    """A side of the box around the trunk.

    Attributes:
        name: text such as "on top of" the trunk.
        normal, along, across: unit vectors in B: outwards, and two in the face, shape (3,).
        outward: direction in which the left module of a pair moves away as it grows; see `Place`.
        upright: whether they stand on their feet; see `Place`.
        nearest: point of the face that is nearest to the centre of mass, in B [m], shape (3,).
        shifts, offsets: ranges along and across, from `nearest`, that stay on the face [m].
        layout: of the modules; pairs stand in rows one after the other `along` the face, all others
            around a point of the sagittal plane.
    """

    name: str
    normal: FloatArray
    along: FloatArray
    across: FloatArray
    outward: FloatArray
    nearest: FloatArray
    shifts: tuple[float, float]
    offsets: tuple[float, float]
    upright: bool = False
    layout: Layout = PAIR

    def place(self, spot: Spot) -> Place:
        """Place of modules at a spot, to the micrometre."""
        shift, offset, stand_off = spot
        origin = self.nearest + shift * self.along + offset * self.across + stand_off * self.normal
        # A rounding error of the centre of mass must not reach the files.
        x, y, z = (round(float(value), 6) + 0.0 for value in origin)
        if not self.layout.pairs:
            return place_around((x, y, z), self.layout)
        outward: list[Direction] = []
        for row, _, _ in self.layout.ring[::2]:
            out_x, out_y, out_z = vector(self.outward + SPACING * row * self.along)
            outward += [(out_x, out_y, out_z), (out_x, -out_y, out_z)]
        origins = ((x, y, z), (x, -y, z)) * self.layout.pairs
        return Place(origins, tuple(outward), self.upright)

    def spots(self, reach: float) -> Iterator[Spot]:
        """Spots to try for modules that fill a sphere of radius `reach` [m]."""
        step = STEP * reach
        for shift in _steps(self.shifts, step):
            for offset in _steps(self.offsets, step):
                for stand_off in _steps((0.0, STAND_OFF * reach), step):
                    yield shift, offset, stand_off


def faces(robot: Robot, layout: Layout = PAIR) -> tuple[TrunkSide, ...]:
    """Top, back and flanks of the trunk; only pairs stand behind or beside it.

    Nothing is put beneath it, where a robot lands that falls short, or in front, where legs fold up
    and cameras look. Modules beside it are one on each side.
    """
    if not layout.pairs:
        top = _sagittal_face(robot, ON_TOP, UP, FORWARD)
        return (replace(top, offsets=(0.0, 0.0), layout=layout),)
    forward, shifts = _range(robot, FORWARD)
    up, offsets = _range(robot, UP)
    half_width = max(_plane(robot, LEFT), _plane(robot, -LEFT))
    flank = half_width * LEFT + forward * FORWARD + up * UP
    sides = (
        _sagittal_face(robot, ON_TOP, UP, FORWARD),
        _sagittal_face(robot, "behind", -FORWARD, UP),
        TrunkSide("beside", LEFT, FORWARD, UP, SPACING * LEFT, flank, shifts, offsets),
    )
    return tuple(replace(face, layout=layout) for face in sides)


def _sagittal_face(robot: Robot, name: str, normal: FloatArray, along: FloatArray) -> TrunkSide:
    """Face with both modules side by side, at most as far apart as the trunk is wide."""
    shift, shifts = _range(robot, along)
    upright = name == ON_TOP
    return TrunkSide(
        name,
        normal,
        along,
        LEFT,
        SPACING * (LEFT if upright else normal + LEFT),
        _plane(robot, normal) * normal + shift * along,
        shifts,
        (0.0, max(_plane(robot, LEFT), _plane(robot, -LEFT))),
        upright,
    )


def _plane(robot: Robot, normal: FloatArray) -> float:
    return trunk_extent(robot.tree, robot.trunk, normal)


def _range(robot: Robot, direction: FloatArray) -> tuple[float, tuple[float, float]]:
    """Coordinate on the trunk nearest to the centre of mass, and the extent on either side."""
    low, high = -_plane(robot, -direction), _plane(robot, direction)
    start = float(np.clip(direction @ robot.com, low, high))
    return start, (low - start, high - start)


def _steps(limits: tuple[float, float], step: float) -> list[float]:
    """Multiples of `step` between two limits on either side of 0."""
    low, high = limits
    return [count * step for count in range(int(np.ceil(low / step)), int(high // step) + 1)]


_ROUNDING = 2e-6
"""Places are rounded to the micrometre [m]."""

_CLOSE_GAP = 0.5
"""Gap, relative to a ball's or a module's radius, below which it is checked more closely."""

_SIZES = 5
"""Number of module sizes tried."""

_HALVINGS = 5


@dataclass(frozen=True)
class Sizes:
    """The smallest and the largest housing on its foot, whatever motor is behind it."""

    smallest: Size[float]
    largest: Size[float]

    @classmethod
    def of(cls, envelope: Envelope) -> "Sizes":
        """Sizes of modules in their housings around rims that an envelope allows."""
        nothing, least_radius = Behind(0.0, 0.0), envelope.inner_radius_min + envelope.wall_min
        return cls(
            module_size(least_radius, envelope.height_min, nothing, 0.0),
            module_size(envelope.outer_radius_max, envelope.height_max, nothing, 0.0),
        )

    def all(self) -> Iterator[Size[float]]:
        """Sizes from the largest down, so close that their balls cover all sizes between."""
        for share in np.linspace(1.0, 0.0, 1 if self.smallest == self.largest else _SIZES).tolist():
            pairs = zip(self.smallest, self.largest, strict=True)
            yield Size(*((1.0 - share) * small + share * large for small, large in pairs))


@dataclass(frozen=True)
class FreePlace:
    """Place of the modules, with the face it is on and whether it is free.

    Attributes:
        place: of the modules, for every size.
        face: where on the trunk, such as "behind" the trunk.
        free: whether the modules hit nothing there; False: none of the places tried is free.
    """

    place: Place
    face: str
    free: bool


def specified_place(position: tuple[float, ...] | None, robot: Robot, envelope: Envelope) -> Place:
    """Place of a pair as specified in B [m] (`place_at`); None: the nearest free place."""
    return place_free(robot, envelope, PAIR).place if position is None else place_at(position)


@lru_cache(maxsize=1)
def place_free(robot: Robot, envelope: Envelope, layout: Layout = PAIR) -> FreePlace:
    """Place on top over the centre of mass if that is free, else the free place nearest to it.

    A place is free if no other part of the robot comes near it, in the nominal posture and while
    the legs give way (`landing_ranges`), whatever the module's size and incidence. Nearest means
    adding least to the robot's inertia about roll and pitch, each relative to the robot's own.
    """
    search = Search(collision_model(robot), Sizes.of(envelope), layout)
    on_top = place_on_top(robot, layout)
    if search.is_free(on_top):
        return FreePlace(on_top, ON_TOP, free=True)
    for face, spot in search.spots():
        if search.is_free(face.place(spot)):
            place = face.place(search.moved_closer(face, spot))
            return FreePlace(place, face.name, free=True)
    return FreePlace(on_top, ON_TOP, free=False)


@dataclass(frozen=True, eq=False)
class Search:
    """Search for places that no limb comes near.

    Attributes:
        collision, sizes, layout: see `CollisionModel`, `Sizes` and `Layout`.
        on_feet: whether legs that give way stand on their feet: see `landing_poses`.
    """

    collision: CollisionModel
    sizes: Sizes
    layout: Layout = PAIR
    on_feet: bool = False

    @classmethod
    def of(
        cls, robot: Robot, size: Size[float], layout: Layout, *, on_feet: bool = False
    ) -> "Search":
        """Search for modules of this size alone."""
        return cls(collision_model(robot), Sizes(size, size), layout, on_feet)

    def spots(self) -> list[tuple[TrunkSide, Spot]]:
        """Spots of all faces, the nearest first."""
        spots = [
            (face, spot)
            for face in faces(self.collision.robot, self.layout)
            for spot in face.spots(self.sizes.largest.reach)
        ]
        return sorted(
            spots,
            key=lambda spot: self.added_inertia(spot[0].place(spot[1])),
        )

    def is_free(self, place: Place) -> bool:
        """Whether the place is free, first in the nominal posture, which is quick, then in all."""
        return self.is_clear_at_rest(place) and not any(
            self.touches(ball) for size in self.sizes.all() for ball in self._balls(place, size)
        )

    def is_clear_at_rest(self, place: Place) -> bool:
        """Whether the largest modules hit nothing in the nominal posture."""
        return self.clears_limbs(self._balls(place, self.sizes.largest))

    def clears_limbs(self, solids: Sequence[Ball | Drum]) -> bool:
        """Whether solids hit no limb in the nominal posture."""
        collision, pose = self.collision, self.collision.nominal
        # The trunk's box ends at the face that the modules stand on.
        others = collision.limbs
        return all(
            collision.nearest(solid, pose, others, within=-_ROUNDING) is None
            for solid in collision.near(solids, pose, others, -_ROUNDING)
        )

    def moved_closer(self, face: TrunkSide, spot: Spot) -> Spot:
        """Free spot refined between grid points, nearer to the face and the trunk's centre."""
        for axis in (2, 1, 0):
            step = np.sign(spot[axis]) * min(STEP * self.sizes.largest.reach, abs(spot[axis]))
            for _ in range(_HALVINGS):
                step /= 2.0
                nearer = [*spot]
                nearer[axis] -= step
                candidate = (nearer[0], nearer[1], nearer[2])
                if step and self.is_free(face.place(candidate)):
                    spot = candidate
        return spot

    def touches(self, solid: Ball | Drum) -> bool:
        """Whether a solid touches anything during landings, or between the sampled postures."""
        # Thin tubes are checked as closely as the modules on them.
        gap = _CLOSE_GAP * max(solid.radius, SPACING * self.sizes.smallest.reach)
        near = nearest_in_landings(
            self.collision, solid, within=gap, enough=-_ROUNDING, on_feet=self.on_feet
        )
        return near is not None and near.distance < -_ROUNDING

    def _balls(self, place: Place, size: Size[float]) -> list[Ball]:
        """Balls around all modules of one size, with the room that they need."""
        return [Ball(center, SPACING * size.reach) for center in place.centers(size)]

    def added_inertia(self, place: Place) -> float:
        """Inertia about roll and pitch that the largest module adds, relative to the robot's."""
        robot = self.collision.robot
        x, y, z = (place.centers(self.sizes.largest) - robot.com).T
        roll, pitch = y**2 + z**2, x**2 + z**2
        return float((roll / robot.inertia[0, 0] + pitch / robot.inertia[1, 1]).mean())
