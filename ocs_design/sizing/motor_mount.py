"""How a motor is held behind the foot's plate, and with which screws.

By the face that its shaft comes out of, through plate and floor; by its back, in a cage; or, where
its threads are not known or a gear is between, on the plate with nothing but a hole for what turns.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from ocs_design.drive.gear import GearRoom
from ocs_design.drive.mounting import BoltCircle, Face, Mounting
from ocs_design.fasteners import IN_PLASTIC, Fastening, screw
from ocs_design.sizing.cage import FLOOR, FRONT_GAP, Cage, cage_of
from ocs_design.sizing.foot import PLATE_THICKNESS
from ocs_design.sizing.housing import WALL
from ocs_design.sizing.mass_moments import MassMoments
from ocs_design.sizing.mount import (
    MountHoles,
    for_what_turns,
    points,
    screwed_by_face,
)
from ocs_design.sizing.web import HUB_HEIGHT

_DEPTH = "check the depth of the motor's thread"


class HeldMotor(Protocol):
    """As much of a motor as its mount needs."""

    @property
    def mounting(self) -> Mounting | None:
        """Its shaft and threads."""

    @property
    def diameter(self) -> float | None:
        """Of its body [m]."""

    @property
    def length(self) -> float | None:
        """Of its body [m]."""


@dataclass(frozen=True)
class Screwed:
    """Screws at their places.

    Attributes:
        fastening: what they are.
        circle: that they are on.
        along: of the undersides of their heads, from the outside of the housing's floor [m].
        towards: 1: their tips point to the wheel, -1: away from it.
    """

    fastening: Fastening
    circle: BoltCircle
    along: float
    towards: float

    def moments(self) -> MassMoments[float]:
        """As points, about the middle of the outside of the housing's floor.

        A screw's own inertia is 1e-9 kg m^2.
        """
        along = self.along + self.towards * self.fastening.centre
        return points(self.circle, self.fastening.mass).shifted(along, 0.0)


@dataclass(frozen=True)
class MotorMount:
    """Of one motor.

    Attributes:
        holes: in the housing's floor and in the foot's plate.
        cage: around the motor; None: it stands on the plate.
        screwed: that hold it.
        gap: between plate and motor [m]. up: of its axis from the wheel's [m].
    """

    holes: MountHoles = field(default_factory=MountHoles)
    cage: Cage | None = None
    screwed: tuple[Screwed, ...] = ()
    gap: float = 0.0
    up: float = 0.0

    @property
    def head_reach(self) -> float:
        """Radius that the heads in the housing stay within [m]; 0: there are none."""
        found = self.holes.screws
        return 0.0 if found is None else found.radius + screw(found.thread).head_diameter / 2.0

    def behind(self, motor: HeldMotor) -> tuple[float, float]:
        """How far back from the plate and how far to the sides they reach with the motor [m]."""
        if self.cage is not None:
            heads = max(each.fastening.screw.head_height for each in self.screwed)
            return self.cage.length + heads, self.cage.reach
        return self.gap + (motor.length or 0.0), (motor.diameter or 0.0) / 2.0

    def moments(self) -> MassMoments[float]:
        """Cage and screws, less the holes, about the middle of the outside of the floor."""
        walls = self.holes.cut_out(WALL + PLATE_THICKNESS)
        total = walls.shifted((WALL - PLATE_THICKNESS) / 2.0, 0.0)
        if self.cage is not None:
            total += self.cage.moments().shifted(-PLATE_THICKNESS, 0.0)
        return sum((each.moments() for each in self.screwed), total)


def mount_of(motor: HeldMotor, room: GearRoom | None) -> MotorMount:
    """Of a motor, behind a gear that takes some room; None: its wheel is on its shaft or rotor."""
    mounting = motor.mounting
    if room is not None:
        return MotorMount(gap=room.depth, up=room.offset)
    if mounting is None:
        return MotorMount()
    stator, wheel = mounting.stator, tuple(_wheel(mounting))
    if stator is not None and mounting.stator_face is Face.OUTPUT:
        held = _through_walls(stator, f"motor on housing and foot; {_DEPTH}", 1.0)
        return MotorMount(screwed_by_face(mounting, stator), None, (*wheel, held))
    pilot = for_what_turns(mounting)
    cage = None
    if mounting.stator_face is Face.BACK:
        cage = cage_of(mounting, motor.diameter, motor.length)
    if cage is None or stator is None:
        return MotorMount(MountHoles(pilot), None, wheel)
    on_plate = _through_walls(cage.screws, "cage on housing and foot, it is tapped", IN_PLASTIC)
    held = _by_back(stator, cage)
    screwed = (*wheel, held, on_plate)
    return MotorMount(MountHoles(pilot, cage.screws), cage, screwed, gap=FRONT_GAP)


def _through_walls(circle: BoltCircle, purpose: str, depth: float) -> Screwed:
    """With their heads inside the housing."""
    thickness = WALL + PLATE_THICKNESS
    return Screwed(_fastening(circle, thickness, purpose, depth), circle, WALL, -1.0)


def _by_back(stator: BoltCircle, cage: Cage) -> Screwed:
    fastening = _fastening(stator, FLOOR, f"motor in its cage; {_DEPTH}", 1.0)
    return Screwed(fastening, stator, -(PLATE_THICKNESS + cage.length), 1.0)


def _wheel(mounting: Mounting) -> Iterator[Screwed]:
    """Of the wheel on the rotor's front, with the motor: their spin inertia is left out.

    It would be 0.3 % of that of the lightest wheel on such a motor, and on the safe side.
    """
    if mounting.rotor is not None:
        fastening = _fastening(mounting.rotor, HUB_HEIGHT, f"wheel on rotor; {_DEPTH}", 1.0)
        yield Screwed(fastening, mounting.rotor, -PLATE_THICKNESS, -1.0)


def _fastening(circle: BoltCircle, thickness: float, purpose: str, depth: float) -> Fastening:
    return Fastening(screw(circle.thread), circle.bolts, thickness, purpose, depth)
