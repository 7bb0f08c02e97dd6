"""The place for both modules that is nearest to the centre of mass and where they hit nothing."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ocs_design.requirement.envelope import Envelope
from ocs_design.robot.obstacles.descent import descended
from ocs_design.robot.obstacles.motion import Ranges, landing_poses, landing_ranges
from ocs_design.robot.obstacles.obstacles import Nearest, Obstacles, obstacles_of
from ocs_design.robot.obstacles.parts import Part
from ocs_design.robot.obstacles.probes import Ball
from ocs_design.robot.robot import Robot
from ocs_design.sizing.faces import ON_TOP, STEP, Face, Spot, faces
from ocs_design.sizing.placement import (
    CLEARANCE,
    Place,
    Size,
    module_size,
    place_at,
    place_on_top,
)

_ROUNDING = 2e-6
"""Places are rounded to the micrometre [m]."""

_NEAR = 0.5
"""What comes nearer than this, over a ball's radius, is looked at more closely."""

_SIZES = 5
"""Of a module that are tried."""

_HALVINGS = 5


@dataclass(frozen=True)
class Sizes:
    """The smallest and the largest housing on its foot, whatever motor is behind it."""

    smallest: Size[float]
    largest: Size[float]

    @classmethod
    def of(cls, envelope: Envelope) -> "Sizes":
        """Of modules in their housings around rims that an envelope allows."""
        least_radius = envelope.inner_radius_min + envelope.wall_min
        return cls(
            _housing(least_radius, envelope.height_min),
            _housing(envelope.outer_radius_max, envelope.height_max),
        )

    def all(self) -> Iterator[Size[float]]:
        """From the largest down; balls of these overlap so far that all between is covered."""
        for share in np.linspace(1.0, 0.0, _SIZES).tolist():
            pairs = zip(self.smallest, self.largest, strict=True)
            yield Size(*((1.0 - share) * small + share * large for small, large in pairs))


@dataclass(frozen=True)
class FreePlace:
    """Where the modules stand, and why there.

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


def stated_place(position: tuple[float, ...] | None, robot: Robot, envelope: Envelope) -> Place:
    """The left module's centre as stated in B [m]; None: the free place nearest to the robot's."""
    return place_free(robot, envelope).place if position is None else place_at(position)


@lru_cache(maxsize=1)
def place_free(robot: Robot, envelope: Envelope) -> FreePlace:
    """On top over the centre of mass if that is free, else the free place nearest to it.

    Free is what no other part of the robot comes near, in the nominal posture and while its legs
    give way (`landing_ranges`), whatever the module's size and incidence. Nearest is where a module
    adds least to the robot's inertia about roll and pitch, each over the robot's own.
    """
    search = _Search(obstacles_of(robot), Sizes.of(envelope))
    on_top = place_on_top(robot)
    blocker = search.blocker(on_top)
    if blocker is None:
        return FreePlace(on_top, ON_TOP, "", free=True)
    for face, spot in search.spots():
        if search.is_free(face.place(spot)):
            place = face.place(search.drawn_in(face, spot))
            return FreePlace(place, face.name, blocker.name, free=True)
    return FreePlace(on_top, ON_TOP, blocker.name, free=False)


@dataclass(frozen=True, eq=False)
class _Search:
    """Attributes: see `Obstacles` and `Sizes`."""

    obstacles: Obstacles
    sizes: Sizes

    def spots(self) -> list[tuple[Face, Spot]]:
        """Of all faces, the nearest first."""
        found = [
            (face, spot)
            for face in faces(self.obstacles.robot)
            for spot in face.spots(self.sizes.largest.reach)
        ]
        return sorted(found, key=lambda each: self._cost(each[0].place(each[1])))

    def is_free(self, place: Place) -> bool:
        """In the nominal posture, which is quick to tell, and then in all."""
        largest = self._balls(place, self.sizes.largest)
        if any(map(self._touches, largest)):
            return False
        return self.blocker(place) is None

    def blocker(self, place: Place) -> Part | None:
        """What of the robot comes too near."""
        for size in self.sizes.all():
            hits = [self._hit(ball) for ball in self._balls(place, size)]
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

    def _hit(self, ball: Ball) -> Nearest | None:
        """What a ball touches, or would in some posture between those that were drawn."""
        near = self.obstacles.nearest(
            ball, landing_poses(self.obstacles), self._others, within=_NEAR * ball.radius
        )
        if near is None:
            return None
        nearest = descended(self.obstacles, ball, near, self._ranges)
        return nearest if nearest.distance < -_ROUNDING else None

    def _touches(self, ball: Ball) -> bool:
        """In the nominal posture."""
        hit = self.obstacles.nearest(ball, self.obstacles.nominal, self._others, within=-_ROUNDING)
        return hit is not None

    @cached_property
    def _ranges(self) -> Ranges:
        return landing_ranges(self.obstacles.robot)

    def _balls(self, place: Place, size: Size[float]) -> tuple[Ball, Ball]:
        """Both modules of one size, with the room around them."""
        x, y, z = place.left(size)
        radius = CLEARANCE * size.reach
        return Ball(np.array([x, y, z]), radius), Ball(np.array([x, -y, z]), radius)

    @cached_property
    def _others(self) -> list[Part]:
        """All but the trunk, whose box ends at the face that the modules stand on."""
        return [part for part in self.obstacles.parts if part.limb]

    def _cost(self, place: Place) -> float:
        """What the largest module adds to the inertia about roll and pitch, over the robot's."""
        robot = self.obstacles.robot
        x, y, z = np.array(place.left(self.sizes.largest)) - robot.com
        return float((y**2 + z**2) / robot.inertia[0, 0] + (x**2 + z**2) / robot.inertia[1, 1])


def _housing(outer_radius: float, height: float) -> Size[float]:
    return module_size(outer_radius, height, 0.0, 0.0, 0.0)
