"""Places of the modules on the trunk: its faces, and the nearest place without collisions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from ocs_design.actuation.motor import GearRoom
from ocs_design.common.arrays import FloatArray, frozen, vector
from ocs_design.device.device import Device
from ocs_design.device.layout import PAIR, Direction, Layout
from ocs_design.device.solids import motor_mount
from ocs_design.parts.bell import HeldMotor
from ocs_design.parts.foot import base_radius, larger, wheel_height
from ocs_design.parts.housing import half_height, housing_outer_radius, plate_back
from ocs_design.parts.motor_mount import Behind, mount_of
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.requirement.froude import Envelope
from ocs_design.robot.clearance import Ranges, descended, landing_poses, landing_ranges
from ocs_design.robot.collision import CollisionModel, Nearest, Part, collision_model
from ocs_design.robot.meshes import trunk_extent, trunk_top
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Ball, Drum

CLEARANCE = 1.1
"""Room kept around a wheel, over the radius of the sphere that it sweeps at any incidence."""

Real = TypeVar("Real", float, FloatArray)


class Size(NamedTuple, Generic[Real]):
    """How much room a module takes.

    Attributes:
        reach: radius that housing, motor and the foot's base stay within at any incidence [m].
        standing: of the wheel's centre over what it stands on [m].
    """

    reach: Real
    standing: Real


def wheel_size(outer_radius: Real, height: Real) -> Size[Real]:
    """Size of a bare wheel that turns freely over what carries it."""
    reach = sphere_radius(outer_radius, height)
    return Size(reach, CLEARANCE * reach)


def module_size(
    outer_radius: Real,
    height: Real,
    behind: Behind[Real] | Behind[float],
    mount_reach: Real | float,
    guard_wall: float = 0.0,
    *,
    foot_plate: Real | float = PLATE_THICKNESS,
) -> Size[Real]:
    """Size of a housing on its foot, around a wheel of this radius and height, with its motor.

    All in metres; a guard ring in the housing makes that as much wider. What stands behind the
    foot's plate, motor, gear and cage, goes so far back and so far to both sides: how high it
    stands is no matter to a turn about the vertical.
    """
    outer_radius = outer_radius + guard_wall
    half = half_height(height)
    housing = (housing_outer_radius(outer_radius) ** 2 + half**2) ** 0.5
    depth = larger(plate_back(half, foot_plate) + behind.depth, behind.from_wheel)
    motor = (depth**2 + behind.radius**2) ** 0.5
    base = base_radius(outer_radius, height, mount_reach, foot_plate)
    return Size(larger(larger(housing, motor), base), wheel_height(outer_radius))


def motor_size(
    motor: HeldMotor,
    room: GearRoom | None,
    outer_radius: Real,
    height: Real,
    guard_wall: float = 0.0,
    *,
    foot_plate: float = PLATE_THICKNESS,
    on_bell: bool = False,
) -> Size[Real]:
    """Size of a motor behind a gear of this room, as far as it is known."""
    mount = mount_of(motor, room, foot_plate, on_bell=on_bell)
    behind = mount.behind(motor)
    reach, height = mount.holes.reach, larger(height, mount.room)
    return module_size(outer_radius, height, behind, reach, guard_wall, foot_plate=foot_plate)


@dataclass(frozen=True)
class Place:
    """Centres of all modules as their size grows.

    Attributes:
        origins: of each, if it had no size, in B [m].
        outward: how far each stands off, per radius of the sphere that it sweeps, in B.
        upright: whether they stand on what is below them, and so as high as their feet make them.
    """

    origins: tuple[Direction, ...]
    outward: tuple[Direction, ...]
    upright: bool = False

    @property
    def stated(self) -> bool:
        """Whether it is the same for modules of any size, as a stated one is (`place_at`)."""
        return not (any(map(any, self.outward)) or self.upright)

    def __call__(self, outer_radius: float, height: float) -> FloatArray:
        """Centres of bare wheels in B for R and h [m], shape (n, 3)."""
        return frozen(self.centers(wheel_size(outer_radius, height)))

    def centers(self, size: Size[float] | Size[FloatArray]) -> FloatArray:
        """Centres of the modules in B [m], shape (..., n, 3), for sizes of shape (...)."""
        reach, standing = (np.asarray(each)[..., None] for each in size)
        centers = np.array(self.origins) + reach[..., None] * np.array(self.outward)
        if self.upright:
            centers[..., 2] += standing
        return np.asarray(centers)


def device_size(device: Device) -> Size[float]:
    """The room that each module takes."""
    wheel, mount = device.flywheel, motor_mount(device)
    if device.carrier.mass == 0.0:
        return wheel_size(wheel.outer_radius, wheel.height)
    behind = mount.behind(device.motor)
    return module_size(
        wheel.outer_radius,
        max(wheel.height, mount.room),
        behind,
        mount.holes.reach,
        device.guard_wall,
        foot_plate=device.foot_plate,
    )


def sphere_radius(outer_radius: Real, height: Real) -> Real:
    """Radius of the sphere around a cylinder, sqrt(R^2 + h^2 / 4) [m]."""
    # No function of numpy: symbols know only operators.
    square: Real = outer_radius**2 + height**2 / 4.0
    reach: Real = square**0.5
    return reach


def place_on_top(robot: Robot, layout: Layout = PAIR) -> Place:
    """Place on top of the trunk around the centre of mass, symmetric to the sagittal plane.

    Each module may be turned to any incidence without touching the trunk or another one. Other
    parts of the robot are not looked at: see `free_place`. What a person wears is on the back.
    """
    if robot.worn_at is not None:
        return around(robot.worn_at, layout)
    # To the micrometre, so that no rounding error of the centre of mass reaches the files.
    forward = round(float(robot.com[0]), 6) + 0.0
    return around((forward, 0.0, round(trunk_top(robot.tree, robot.trunk), 6)), layout)


def around(middle: Direction, layout: Layout, aside: float = 0.0) -> Place:
    """Upright modules around a point of what they stand on, in B [m].

    Args:
        middle: that point. layout: of the modules.
        aside: how much farther to its side than it must each stands [m].
    """
    x, y, z = middle
    outward = tuple(vector(each) for each in np.array(layout.ring) * CLEARANCE)
    origins = tuple((x, y + float(np.sign(out)) * aside, z) for _, out, _ in outward)
    return Place(origins, outward, upright=True)


def place_at(position: tuple[float, ...], layout: Layout = PAIR) -> Place:
    """Modules at stated places in B [m]: three coordinates of each.

    Of a pair only the left one's are stated, and the right one is mirrored in y.
    """
    places = np.reshape(position, (-1, 3))
    if layout == PAIR:
        places = np.concatenate([places, places * [1.0, -1.0, 1.0]])
    return Place(tuple(vector(each) for each in places), ((0.0, 0.0, 0.0),) * len(places))


FORWARD, LEFT, UP = np.eye(3)

ON_TOP = "on top of"

STEP = 0.5
"""Step between places that are tried, over the radius of the largest module's sphere."""

STAND_OFF = 2.0
"""Farthest from a face, in the same unit."""

Spot = tuple[float, float, float]
"""Place on a face: along, across and off it [m]."""


@dataclass(frozen=True, eq=False)
class Face:
    """A side of the box around the trunk.

    Attributes:
        name: for people, as in "on top of the trunk".
        normal, along, across: unit vectors in B: outwards, and two in the face, shape (3,).
        outward: how the left module of a pair stands off as it grows; see `Place`.
        upright: whether they stand on their feet; see `Place`.
        nearest: point of the face that is nearest to the centre of mass, in B [m], shape (3,).
        shifts, offsets: ranges along and across, from `nearest`, that stay on the face [m].
        layout: of the modules; all but pairs stand around a point of the sagittal plane, and
            pairs in rows one after the other `along` the face.
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
            return around((x, y, z), self.layout)
        outward: list[Direction] = []
        for row, _, _ in self.layout.ring[::2]:
            out_x, out_y, out_z = vector(self.outward + CLEARANCE * row * self.along)
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


def faces(robot: Robot, layout: Layout = PAIR) -> tuple[Face, ...]:
    """Top, back and flanks of the trunk; only pairs stand behind or beside it.

    Nothing is put beneath it, where a robot lands that falls short, or in front, where legs fold
    up and cameras look. Beside it, each module is on its own side.
    """
    if not layout.pairs:
        top = _sagittal_face(robot, ON_TOP, UP, FORWARD)
        return (replace(top, offsets=(0.0, 0.0), layout=layout),)
    forward, shifts = _range(robot, FORWARD)
    up, offsets = _range(robot, UP)
    half_width = max(_plane(robot, LEFT), _plane(robot, -LEFT))
    flank = half_width * LEFT + forward * FORWARD + up * UP
    found = (
        _sagittal_face(robot, ON_TOP, UP, FORWARD),
        _sagittal_face(robot, "behind", -FORWARD, UP),
        Face("beside", LEFT, FORWARD, UP, CLEARANCE * LEFT, flank, shifts, offsets),
    )
    return tuple(replace(face, layout=layout) for face in found)


def _sagittal_face(robot: Robot, name: str, normal: FloatArray, along: FloatArray) -> Face:
    """Face with both modules side by side, as far apart as the trunk is wide or less."""
    shift, shifts = _range(robot, along)
    upright = name == ON_TOP
    return Face(
        name,
        normal,
        along,
        LEFT,
        CLEARANCE * (LEFT if upright else normal + LEFT),
        _plane(robot, normal) * normal + shift * along,
        shifts,
        (0.0, max(_plane(robot, LEFT), _plane(robot, -LEFT))),
        upright,
    )


def _plane(robot: Robot, normal: FloatArray) -> float:
    return trunk_extent(robot.tree, robot.trunk, normal)


def _range(robot: Robot, direction: FloatArray) -> tuple[float, tuple[float, float]]:
    """Coordinate on the trunk nearest to the centre of mass, and how far the trunk goes from it."""
    low, high = -_plane(robot, -direction), _plane(robot, direction)
    start = float(np.clip(direction @ robot.com, low, high))
    return start, (low - start, high - start)


def _steps(limits: tuple[float, float], step: float) -> list[float]:
    """Multiples of `step` between two limits that have 0 between them."""
    low, high = limits
    return [count * step for count in range(int(np.ceil(low / step)), int(high // step) + 1)]


_ROUNDING = 2e-6
"""Places are rounded to the micrometre [m]."""

_NEAR = 0.5
"""Gap over a ball's or a module's radius below which it is looked at more closely."""

_SIZES = 5
"""Number of sizes of a module that are tried."""

_HALVINGS = 5


@dataclass(frozen=True)
class Sizes:
    """The smallest and the largest housing on its foot, whatever motor is behind it."""

    smallest: Size[float]
    largest: Size[float]

    @classmethod
    def of(cls, envelope: Envelope) -> "Sizes":
        """Sizes of modules in their housings around rims that an envelope allows."""
        least_radius = envelope.inner_radius_min + envelope.wall_min
        return cls(
            _housing(least_radius, envelope.height_min),
            _housing(envelope.outer_radius_max, envelope.height_max),
        )

    def all(self) -> Iterator[Size[float]]:
        """Radii from the largest down, so close that balls at them cover all between."""
        for share in np.linspace(1.0, 0.0, 1 if self.smallest == self.largest else _SIZES).tolist():
            pairs = zip(self.smallest, self.largest, strict=True)
            yield Size(*((1.0 - share) * small + share * large for small, large in pairs))


@dataclass(frozen=True)
class FreePlace:
    """Place of the modules, and why it is that one.

    Attributes:
        place: of both, for every size.
        face: where on the trunk, as in "behind the trunk".
        blocked_by: the part that keeps them from standing on top over the centre of mass; empty if
            they do.
        free: whether nothing is hit there; False: no place that was tried is free.
    """

    place: Place
    face: str
    blocked_by: str
    free: bool


def specified_place(
    position: tuple[float, ...] | None, robot: Robot, envelope: Envelope, layout: Layout = PAIR
) -> Place:
    """Places as stated in B [m] (`place_at`); None: the free place nearest to the robot's."""
    if position is None:
        return place_free(robot, envelope, layout).place
    return place_at(position, layout)


@lru_cache(maxsize=1)
def place_free(robot: Robot, envelope: Envelope, layout: Layout = PAIR) -> FreePlace:
    """Place on top over the centre of mass if that is free, else the free place nearest to it.

    Free is what no other part of the robot comes near, in the nominal posture and while its legs
    give way (`landing_ranges`), whatever the module's size and incidence. Nearest is where a module
    adds least to the robot's inertia about roll and pitch, each over the robot's own.
    """
    search = Search(collision_model(robot), Sizes.of(envelope), layout)
    on_top = place_on_top(robot, layout)
    blocker = search.blocker(on_top)
    if blocker is None:
        return FreePlace(on_top, ON_TOP, "", free=True)
    for face, spot in search.spots():
        if search.is_free(face.place(spot)):
            place = face.place(search.drawn_in(face, spot))
            return FreePlace(place, face.name, blocker.name, free=True)
    return FreePlace(on_top, ON_TOP, blocker.name, free=False)


@dataclass(frozen=True, eq=False)
class Search:
    """Looks for places that no limb comes near.

    Attributes: see `CollisionModel`, `Sizes` and `Layout`.
    """

    collision: CollisionModel
    sizes: Sizes
    layout: Layout = PAIR

    def spots(self) -> list[tuple[Face, Spot]]:
        """Spots of all faces, the nearest first."""
        found = [
            (face, spot)
            for face in faces(self.collision.robot, self.layout)
            for spot in face.spots(self.sizes.largest.reach)
        ]
        return sorted(found, key=lambda each: self.cost(each[0].place(each[1])))

    def is_free(self, place: Place) -> bool:
        """Whether the place is free, first in the nominal posture, which is quick, then in all."""
        return self.is_clear(place) and not any(
            self.touches(ball) for size in self.sizes.all() for ball in self._balls(place, size)
        )

    def is_clear(self, place: Place) -> bool:
        """Whether the largest modules hit nothing in the nominal posture."""
        return self.is_off(self._balls(place, self.sizes.largest))

    def is_off(self, solids: Sequence[Ball | Drum]) -> bool:
        """Whether solids hit no limb in the nominal posture."""
        collision, pose, others = self.collision, self.collision.nominal, self._others
        return all(
            collision.nearest(solid, pose, others, within=-_ROUNDING) is None
            for solid in collision.near(solids, pose, others, -_ROUNDING)
        )

    def blocker(self, place: Place) -> Part | None:
        """What of the robot comes too near."""
        for size in self.sizes.all():
            hits = [self.hit(ball) for ball in self._balls(place, size)]
            found = [hit for hit in hits if hit is not None]
            if found:
                return min(found, key=lambda hit: hit.distance).part
        return None

    def drawn_in(self, face: Face, spot: Spot) -> Spot:
        """Nearer than the grid of spots has it: to the face, to the middle, to the trunk's own."""
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

    def hit(self, solid: Ball | Drum) -> Nearest | None:
        """What a solid touches, or would in some posture between those that were drawn."""
        nearest = self._nearest(solid)
        return nearest if nearest is not None and nearest.distance < -_ROUNDING else None

    def touches(self, solid: Ball | Drum) -> bool:
        """Whether a solid touches anything; see `hit`, which also looks for the nearest."""
        nearest = self._nearest(solid, enough=-_ROUNDING)
        return nearest is not None and nearest.distance < -_ROUNDING

    def _nearest(self, solid: Ball | Drum, *, enough: float = -np.inf) -> Nearest | None:
        """What comes nearest to a solid in landings, or nearer than `enough` [m]; None: far off."""
        # Thin tubes are looked at as closely as the modules on them.
        gap = _NEAR * max(solid.radius, CLEARANCE * self.sizes.smallest.reach)
        poses = landing_poses(self.collision)
        near = self.collision.nearest(solid, poses, self._others, within=gap, enough=enough)
        if near is None:
            return None
        return descended(self.collision, solid, near, self._ranges, enough=enough)

    @cached_property
    def _ranges(self) -> Ranges:
        return landing_ranges(self.collision.robot)

    def _balls(self, place: Place, size: Size[float]) -> list[Ball]:
        """Balls around all modules of one size, with the room that they need."""
        return [Ball(center, CLEARANCE * size.reach) for center in place.centers(size)]

    @cached_property
    def _others(self) -> tuple[Part, ...]:
        """All but the trunk, whose box ends at the face that the modules stand on."""
        return tuple(part for part in self.collision.parts if part.limb)

    def cost(self, place: Place) -> float:
        """What the largest module adds to the inertia about roll and pitch, over the robot's."""
        robot = self.collision.robot
        x, y, z = (place.centers(self.sizes.largest) - robot.com).T
        roll, pitch = y**2 + z**2, x**2 + z**2
        return float((roll / robot.inertia[0, 0] + pitch / robot.inertia[1, 1]).mean())


def _housing(outer_radius: float, height: float) -> Size[float]:
    return module_size(outer_radius, height, Behind(0.0, 0.0), 0.0)
