"""How a motor is held behind the foot's plate, and with which screws.

By the face that its shaft comes out of, through plate and floor; by its back, in a cage; or, where
its threads are not known or a gear is between, on the plate with nothing but a hole for what turns.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import sin
from typing import Protocol

from ocs_design.actuation.fasteners import IN_PLASTIC, Fastening, screw
from ocs_design.actuation.motor import BoltCircle, Face, GearRoom, Mounting
from ocs_design.parts.cage import FLOOR, FRONT_GAP, HALF_POST, Cage
from ocs_design.parts.foot import PLATE_THICKNESS, plate_back
from ocs_design.parts.housing import half_height
from ocs_design.parts.moments import MassMoments, ring
from ocs_design.parts.printed import LID_SCREW, WALL, MountHoles, ear_radius
from ocs_design.parts.rim import HUB_HEIGHT, HUB_WALL

SHAFT_ROOM = 1.0e-3
"""Room around a shaft that turns in a hole of a print [m]: prints are out by 0.2 mm."""

ROTOR_ROOM = HUB_WALL + SHAFT_ROOM
"""Room around the holes of what is screwed to a rotor [m]: its wall, and the same to turn in."""

_LEAST_EDGE = 0.1
"""Least angle of a post's wall beside its ear [rad]."""

_DEPTH = "check the depth of the motor's thread"


class HeldMotor(Protocol):
    """The figures of a motor that its mount needs."""

    @property
    def mounting(self) -> Mounting | None:
        """Its shaft and threads."""

    @property
    def diameter(self) -> float | None:
        """Size of the motor's body [m]."""

    @property
    def length(self) -> float | None:
        """Size of the motor's body [m]."""


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
        """Moments as points, about the middle of the outside of the housing's floor.

        A screw's own inertia is 1e-9 kg m^2.
        """
        along = self.along + self.towards * self.fastening.centre
        heads = ring(self.fastening.mass, self.circle.radius, self.circle.bolts)
        return heads.shifted(along, 0.0)


@dataclass(frozen=True)
class MotorMount:
    """How one motor is held.

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
        """Moments of cage and screws less the holes, about the middle of the floor's outside."""
        walls = self.holes.cut_out(WALL + PLATE_THICKNESS)
        total = walls.shifted((WALL - PLATE_THICKNESS) / 2.0, 0.0)
        if self.cage is not None:
            total += self.cage.moments().shifted(-PLATE_THICKNESS, 0.0)
        return sum((each.moments() for each in self.screwed), total)


def mount_of(motor: HeldMotor, room: GearRoom | None) -> MotorMount:
    """Mount of a motor behind a gear of that room; None: its wheel is on its shaft or rotor."""
    mounting = motor.mounting
    if room is not None:
        return MotorMount(gap=room.depth, up=room.offset)
    if mounting is None:
        return MotorMount()
    stator, rotor = mounting.stator, mounting.rotor
    wheel: tuple[Screwed, ...] = ()
    if rotor is not None:
        # Counted with the motor. Their spin inertia is left out: it would be 0.3 % of that of the
        # lightest wheel on such a motor, and on the safe side.
        fastening = _fastening(rotor, HUB_HEIGHT, f"wheel on rotor; {_DEPTH}", 1.0)
        wheel = (Screwed(fastening, rotor, -PLATE_THICKNESS, -1.0),)
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
    fastening = _fastening(stator, FLOOR, f"motor in its cage; {_DEPTH}", 1.0)
    held = Screwed(fastening, stator, -(PLATE_THICKNESS + cage.length), 1.0)
    screwed = (*wheel, held, on_plate)
    return MotorMount(MountHoles(pilot, cage.screws), cage, screwed, gap=FRONT_GAP)


def cage_of(mounting: Mounting, diameter: float | None, length: float | None) -> Cage | None:
    """The cage of a motor with threads at its back; None where its size is unknown or does not do.

    Args:
        mounting: of the motor.
        diameter, length: of its body [m].
    """
    stator = mounting.stator
    if stator is None or diameter is None or length is None:
        return None
    cage = Cage(diameter / 2.0, length, screwed_by_face(mounting, stator))
    room_for_ears = sin(HALF_POST - _LEAST_EDGE) * cage.across > ear_radius(LID_SCREW)
    inside = for_what_turns(mounting) + WALL <= cage.bore
    return cage if room_for_ears and inside and stator.reach + WALL <= cage.bore else None


def screwed_by_face(mounting: Mounting, stator: BoltCircle) -> MountHoles:
    """Holes for a motor whose threads are in the face that its shaft comes out of.

    The hole in the middle takes any centring collar that fits between the screws.
    """
    shaft = (mounting.shaft_diameter or 0.0) / 2.0
    return MountHoles(max(stator.inside - WALL, (stator.inside + shaft) / 2.0), stator)


def for_what_turns(mounting: Mounting) -> float:
    """Radius of a hole for the shaft, or for what stands between rotor and hub [m]; 0: none."""
    if mounting.rotor is not None:
        return mounting.rotor.reach + ROTOR_ROOM
    if mounting.shaft_diameter is not None:
        return mounting.shaft_diameter / 2.0 + SHAFT_ROOM
    return 0.0


def _through_walls(circle: BoltCircle, purpose: str, depth: float) -> Screwed:
    """Screws through floor and plate, with their heads inside the housing."""
    thickness = WALL + PLATE_THICKNESS
    return Screwed(_fastening(circle, thickness, purpose, depth), circle, WALL, -1.0)


def _fastening(circle: BoltCircle, thickness: float, purpose: str, depth: float) -> Fastening:
    return Fastening(screw(circle.thread), circle.bolts, thickness, purpose, depth)


@dataclass(frozen=True)
class DriveSolid:
    """A cylinder about an axis that is parallel to the wheel's.

    Attributes:
        name: "motor", "gear" or "cage".
        radius: [m].
        low, high: where it begins and ends along the left wheel's axis, from its centre [m].
        up: of its axis above the wheel's [m].
    """

    name: str
    radius: float
    low: float
    high: float
    up: float = 0.0


def drive_cylinders(
    motor: HeldMotor, room: GearRoom | None, mount: MotorMount, height: float
) -> Iterator[DriveSolid]:
    """Gear, motor and cage behind the plate of a rim of that height [m], as far as sizes are known.

    A gear is what turns with the wheel, and beside it what turns with the motor. The cage has the
    heads of the motor's screws behind it.
    """
    back = -plate_back(half_height(height))
    if room is not None and room.depth > 0.0:
        yield DriveSolid("gear", room.wheel_radius, back - room.depth, back)
        if room.offset > 0.0:
            yield DriveSolid("gear", room.motor_radius, back - room.depth, back, room.offset)
    if motor.diameter is not None and motor.length is not None:
        front = back - mount.gap
        yield DriveSolid("motor", motor.diameter / 2.0, front - motor.length, front, mount.up)
    if mount.cage is not None:
        depth, radius = mount.behind(motor)
        yield DriveSolid("cage", radius, back - depth, back)
