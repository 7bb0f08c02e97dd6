"""Mount of a motor behind the foot's plate, its screws, and the wheel's hub on it.

A motor is held by its output face, with screws through plate and floor; or by its back, in a cage,
from which it reaches through plate and floor to the wheel's hub; or, if its threads are not known
or there is a gear, it stands on the plate, which then has only a hole for the rotating part.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import inf, sin
from typing import Generic

from ocs_design.actuation.fasteners import (
    CLASSES,
    IN_PLASTIC,
    LIGAMENT,
    BoltCircle,
    BoltedJoint,
    Fastening,
    longest_within,
    screw,
)
from ocs_design.actuation.motor import AnyMotor, Face, GearRoom, Mounting
from ocs_design.common.arrays import Table
from ocs_design.parts.bell import Bell, bell_of
from ocs_design.parts.cage import HALF_POST, NO_POSTS, Cage, Posts, ear_screws
from ocs_design.parts.moments import MassMoments, Real, point, ring
from ocs_design.parts.printed import (
    CLEARANCE,
    PANEL,
    PLATE_THICKNESS,
    WALL,
    MountHoles,
    ear_radius,
    half_height,
)
from ocs_design.parts.rim import WEB_THICKNESS, Hub

HUB_HEIGHT = 5.0e-3
"""Least height of a hub on a shaft [m]; its bond is as long as the shaft's diameter."""

BOLTED_HUB_HEIGHT = 3.0e-3
"""Height of a hub clamped by screws [m]: M3 heads press on it with 150 MPa."""

HEAD_ROOM = 0.5e-3
"""Least clearance between the heads of a hub's screws and the lid above them [m]."""

HUB_WALL = 2.0e-3
"""Least wall around bore and bolts [m]."""

PILOT_BORE = 3.0e-3
"""Largest bore diameter if the motor's shaft is not in the catalogue [m]: to be bored to fit."""

SHAFT_ROOM = 1.0e-3
"""Clearance of a shaft that turns in a printed hole [m]: prints are off by 0.2 mm."""

ROTOR_ROOM = HUB_WALL + SHAFT_ROOM
"""Room around the holes of a hub on a rotor [m]: its wall, and clearance to turn."""

RIM_HEIGHT_MIN = 2.0e-3
"""Least height of a rim for which a cage must leave room [m]: flatter motors are not held by a
cage."""

_LEAST_EDGE = 0.1
"""Least angle of a post's wall beside its ear [rad]."""


@dataclass(frozen=True)
class Screwed:
    """Screws in position.

    Attributes:
        fastening: the screws.
        circle: their bolt circle.
        along: position of the undersides of their heads, from the outside of the housing's floor
            [m].
        towards: 1: their tips point to the wheel, -1: away from it.
        from_wheel: whether `along` is measured from the wheel's middle instead.
    """

    fastening: Fastening
    circle: BoltCircle
    along: float
    towards: float
    from_wheel: bool = False

    def moments(self) -> MassMoments[float]:
        """Moments as points, about the origin of `along`.

        A screw's own inertia is 1e-9 kg m^2.
        """
        along = self.along + self.towards * self.fastening.centre
        heads = ring(self.fastening.mass, self.circle.radius, self.circle.bolts)
        return heads.shifted(along, 0.0)


@dataclass(frozen=True)
class Behind(Table, Generic[Real]):
    """Extent of a motor and its mount behind the plate.

    Attributes:
        depth: behind the foot's plate, for any rim height [m].
        radius: to the sides [m].
        from_wheel: least extent behind the wheel's middle, for any rim height [m].
    """

    depth: Real | float
    radius: Real | float
    from_wheel: Real | float = 0.0


@dataclass(frozen=True)
class MotorMount:
    """Mount of one motor.

    Attributes:
        holes: in the housing's floor and in the foot's plate.
        cage: around the motor; None: it stands on the plate.
        screwed: screws that hold it.
        gap: between plate and motor [m]; below 0 if it stands in the housing.
        up: height of its axis above the wheel's [m].
        foot_plate: thickness of the foot's plate [m].
        bell: of the motor, with a ring around it; None: its wheel is in front of it.
        shaft_rim: largest height of a rim behind which the motor's shaft still goes through the
            hub [m]; inf: any rim, or none.
    """

    holes: MountHoles = field(default_factory=MountHoles)
    cage: Cage | None = None
    screwed: tuple[Screwed, ...] = ()
    gap: float = 0.0
    up: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    bell: Bell | None = None
    shaft_rim: float = inf

    def around(self, rim_height: float) -> "MotorMount":
        """The mount behind a rim of this height [m]."""
        if self.cage is None:
            return self
        return replace(self, cage=replace(self.cage, rim_height=rim_height))

    @property
    def posts(self) -> Posts[float]:
        """Posts of its cage."""
        return NO_POSTS if self.cage is None else self.cage.posts

    @property
    def rim_height_max(self) -> float:
        """Largest height of a rim for which it leaves room [m]; inf: any."""
        if self.bell is not None:
            return self.bell.straight
        return self.shaft_rim if self.cage is None else self.cage.rim_height_max

    @property
    def room(self) -> float:
        """Least rim height that its housing is made for [m]; 0: any."""
        return 0.0 if self.bell is None else self.bell.room

    @property
    def head_reach(self) -> float:
        """Radius within which the heads in the housing stay [m]; 0: there are none."""
        circle = self.holes.screws
        return 0.0 if circle is None else circle.radius + screw(circle.thread).head_diameter / 2.0

    @property
    def heads_rim_height(self) -> float:
        """Least height of a rim whose web clears the heads in the housing [m]; 0: any."""
        found = self.holes.screws
        if found is None:
            return 0.0
        room = screw(found.thread).head_height + HEAD_ROOM + WEB_THICKNESS / 2.0 - CLEARANCE
        return max(2.0 * room, 0.0)

    def behind(self, motor: AnyMotor) -> Behind[float]:
        """Extent behind the plate, with the motor."""
        if self.bell is not None:
            return Behind(max(screws.fastening.screw.head_height for screws in self.screwed), 0.0)
        if self.cage is not None:
            heads = max(screws.fastening.screw.head_height for screws in self.screwed)
            return Behind(0.0, self.cage.reach, self.cage.back + heads)
        return Behind(self.gap + (motor.length or 0.0), (motor.diameter or 0.0) / 2.0)

    def moments_at_floor(self) -> MassMoments[float]:
        """Moments of screws minus holes, about the middle of the outside of the floor."""
        walls = self.holes.cut_out(PANEL + self.foot_plate)
        total = walls.shifted((PANEL - self.foot_plate) / 2.0, 0.0)
        return sum((screws.moments() for screws in self.screwed if not screws.from_wheel), total)

    def moments_at_wheel(self) -> MassMoments[float]:
        """Moments of screws and of the cage's floor about the wheel's middle, without `posts`."""
        total = point(0.0) if self.cage is None else self.cage.floor_moments()
        return sum((screws.moments() for screws in self.screwed if screws.from_wheel), total)


def mount_of(
    motor: AnyMotor,
    room: GearRoom | None,
    foot_plate: float = PLATE_THICKNESS,
    *,
    on_bell: bool = False,
) -> MotorMount:
    """Mount of a motor on a foot's plate.

    Args:
        motor: with its mounting and size.
        room: of the gear between motor and wheel; None: the wheel is on the motor's shaft or rotor.
        foot_plate: thickness of the foot's plate [m].
        on_bell: whether the wheel is a ring around the motor's bell.
    """
    mounting = motor.mounting
    bell = bell_of(motor) if on_bell and room is None else None
    if bell is not None and mounting is not None and mounting.stator is not None:
        # On the housing's floor, with screws from behind the foot's plate.
        thick, backed = PANEL + foot_plate, mounting.stator
        fastening = _fastening(backed, thick, BoltedJoint.MOTOR, 1.0)
        screwed = (Screwed(fastening, backed, -foot_plate, 1.0),)
        holes, gap = screwed_by_face(mounting, backed), -(thick + (motor.length or 0.0))
        return MotorMount(holes, None, screwed, gap=gap, foot_plate=foot_plate, bell=bell)
    if room is not None:
        return MotorMount(gap=room.depth, up=room.offset, foot_plate=foot_plate)
    if mounting is None:
        return MotorMount(foot_plate=foot_plate)
    stator, rotor = mounting.stator, mounting.rotor
    wheel: tuple[Screwed, ...] = ()
    if rotor is not None:
        # These screws count as stationary. Their spin inertia, which would add 0.3 % to that of the
        # lightest wheel on such a motor, is left out, which is conservative.
        depth = CLASSES[rotor.screws].depth
        # Their thread counts in the joint, all of it.
        fastening = _fastening(rotor, BOLTED_HUB_HEIGHT, BoltedJoint.WHEEL, depth, deepest=True)
        wheel = (Screwed(fastening, rotor, BOLTED_HUB_HEIGHT / 2.0, -1.0, from_wheel=True),)
    if stator is not None and mounting.stator_face is Face.OUTPUT:
        motor_screws = _through_walls(stator, foot_plate, BoltedJoint.MOTOR, 1.0)
        holes, through = screwed_by_face(mounting, stator), inf
        if rotor is None and mounting.shaft_length is not None:
            beside = foot_plate + half_height(0.0) + hub_height(mounting) / 2.0
            through = 2.0 * (mounting.shaft_length - beside)
        return MotorMount(
            holes,
            None,
            (*wheel, motor_screws),
            foot_plate=foot_plate,
            # A shaft too short behind any rim is reported as a fault of its joint.
            shaft_rim=through if through >= RIM_HEIGHT_MIN else inf,
        )
    cage = cage_of(motor, mounting, foot_plate) if mounting.stator_face is Face.BACK else None
    if cage is None or stator is None:
        # A hole for the shaft, or for the hub on the rotor.
        pilot = 0.0
        if rotor is not None:
            pilot = rotor.reach + ROTOR_ROOM
        elif mounting.shaft_diameter is not None:
            pilot = mounting.shaft_diameter / 2.0 + SHAFT_ROOM
        return MotorMount(MountHoles(pilot), None, wheel, foot_plate=foot_plate)
    passage = cage.passage
    assert passage.screws is not None
    on_plate = _through_walls(passage.screws, foot_plate, BoltedJoint.CAGE, IN_PLASTIC)
    fastening = _fastening(stator, cage.floor, BoltedJoint.MOTOR_IN_CAGE, 1.0)
    motor_screws = Screwed(fastening, stator, -cage.back, 1.0, from_wheel=True)
    return MotorMount(passage, cage, (*wheel, motor_screws, on_plate), foot_plate=foot_plate)


def is_held(motor: AnyMotor, room: GearRoom | None) -> bool:
    """True if known screws hold the motor: through plate and floor, or in a cage.

    False behind any gear: the catalogue does not say how gear and motor are fixed to each other.
    """
    return mount_of(motor, room).holes.screws is not None


def cage_of(motor: AnyMotor, mounting: Mounting, foot_plate: float) -> Cage | None:
    """Cage of a motor with threads at its back; None if its size is unknown or unsuitable.

    `foot_plate` is the thickness of the foot's plate [m].
    """
    stator, diameter, length = mounting.stator, motor.diameter, motor.length
    if stator is None or diameter is None or length is None:
        return None
    # Behind the hub on its rotor's threads, or clear of a hub on its shaft.
    front = hub_height(mounting) / 2.0 + (SHAFT_ROOM if mounting.rotor is None else 0.0)
    holes = screwed_by_face(mounting, stator)
    for ears in ear_screws(motor.mass):
        cage = Cage(diameter / 2.0, length, holes, front, foot_plate=foot_plate, screw=ears)
        room_for_ears = sin(HALF_POST - _LEAST_EDGE) * cage.across > ear_radius(ears)
        fits = stator.reach + WALL <= cage.bore and cage.rim_height_max >= RIM_HEIGHT_MIN
        if room_for_ears and fits:
            return cage
    return None


def screwed_by_face(mounting: Mounting, stator: BoltCircle) -> MountHoles:
    """Holes for the screws into a motor's face, and for its shaft.

    The hole in the middle takes any centring collar that fits between the screws.
    """
    shaft = (mounting.shaft_diameter or 0.0) / 2.0
    return MountHoles(max(stator.inside - WALL, (stator.inside + shaft) / 2.0), stator)


def _through_walls(
    circle: BoltCircle, foot_plate: float, joint: BoltedJoint, depth: float
) -> Screwed:
    """Screws through floor and plate, with heads inside the housing."""
    thickness = PANEL + foot_plate
    return Screwed(_fastening(circle, thickness, joint, depth), circle, PANEL, -1.0)


def _fastening(
    circle: BoltCircle,
    thickness: float,
    joint: BoltedJoint,
    depth: float,
    *,
    deepest: bool = False,
) -> Fastening:
    """Screws into a motor's threads, within the depth that is known to exist.

    Args:
        circle: of the threads. thickness: clamped by the screws [m]. joint: that they make.
        depth: wanted engagement over the thread's diameter, as far as the thread is deep enough.
        deepest: use the full depth: cut screws that are too long instead of taking a shorter size.
    """
    kind, least, most = screw(circle.thread), circle.depth, circle.deepest
    reach = min(depth * kind.diameter, most) / kind.diameter
    known = reach, circle.screws, least or 0.0, most
    fastening = Fastening(kind, circle.bolts, thickness, joint, *known)
    if least is None and not deepest and fastening.length > thickness + most:
        thread = longest_within(thickness + most) - thickness
        if thread >= kind.least_thread:
            return replace(fastening, depth=thread / kind.diameter)
    return fastening


@dataclass(frozen=True)
class DriveSolid:
    """A cylinder about an axis parallel to the wheel's.

    Attributes:
        name: "motor", "gear" or "cage".
        radius: [m].
        low, high: its ends along the left wheel's axis, from the wheel's centre [m].
        up: height of its axis above the wheel's [m].
    """

    name: str
    radius: float
    low: float
    high: float
    up: float = 0.0


def motor_front(mount: MotorMount, height: float) -> float:
    """Position of a motor's front along the left wheel's axis, for a rim of this height [m]."""
    if mount.cage is not None:
        return -mount.cage.front
    return -(half_height(height) + mount.foot_plate + mount.gap)


def hub_height(mounting: Mounting) -> float:
    """Height of a hub: 3 mm on a rotor; on a shaft its diameter, at least `HUB_HEIGHT` [m]."""
    if mounting.rotor is not None:
        return BOLTED_HUB_HEIGHT
    return max(HUB_HEIGHT, mounting.shaft_diameter or 0.0)


def hub_of(
    mounting: Mounting | None,
    motor_diameter: float | None,
    *,
    chamfer: float = 0.0,
    web_thickness: float = WEB_THICKNESS,
    lightening: int = 0,
) -> Hub:
    """Hub of a wheel on a motor, with the bore of its shaft and holes for its screws.

    On a shaft its diameter is twice the shaft's, as usual for hubs of steel (Roloff/Matek
    Maschinenelemente, table 12-1: 1.8 to 2). If the catalogue has neither shaft nor screws, it has
    a pilot bore and is as wide as the bolt circles of motors of this diameter.

    Args:
        mounting: of the motor; None: unknown, or the wheel is behind a gear.
        motor_diameter: [m]. chamfer: of the hub's edges [m].
        web_thickness, lightening: of its web, see `Hub`.
    """
    mounting = mounting or Mounting()
    rotor, bore = mounting.rotor, PILOT_BORE / 2.0
    if mounting.shaft_diameter is not None:
        bore = mounting.shaft_diameter / 2.0
    elif rotor is not None:
        # A pilot bore stays clear of the screws.
        bore = min(bore, rotor.inside - LIGAMENT)
    on_shaft = mounting.shaft_diameter is not None
    wide = 2.0 * bore if on_shaft else 5.5e-3 + 0.15 * (motor_diameter or 0.03)
    radius = max(wide, bore + HUB_WALL) if rotor is None else rotor.reach + HUB_WALL
    bolts = (0, 0.0, 0.0) if rotor is None else (rotor.bolts, rotor.radius, rotor.hole_radius)
    head = 0.0 if rotor is None else screw(rotor.thread).head_height
    hub = Hub(radius, hub_height(mounting), bore, *bolts, chamfer=chamfer, bolt_head=head)
    return replace(hub, web_thickness=web_thickness, lightening=lightening)


def rim_height_min(hub: Hub) -> float:
    """Least height of a rim whose lid leaves room for hub and heads [m]; 0: any."""
    return max(hub.height + 2.0 * (hub.bolt_head + HEAD_ROOM - CLEARANCE), 0.0)


def bond_length(mounting: Mounting, hub_height: float, chamfer: float, front: float) -> float:
    """Length of a hub's bore between its chamfers that the motor's shaft fills [m].

    The whole bore if the shaft's length is not known.

    Args:
        mounting: of the motor. hub_height: of the hub, centred on the wheel's middle [m].
        chamfer: of its bore at both ends [m].
        front: of the motor, behind the wheel's middle and so below 0 [m].
    """
    low, high = -hub_height / 2.0 + chamfer, hub_height / 2.0 - chamfer
    if mounting.shaft_length is not None:
        high = min(high, front + mounting.shaft_length)
    return max(high - low, 0.0)


def drive_cylinders(
    motor: AnyMotor, room: GearRoom | None, mount: MotorMount, height: float
) -> Iterator[DriveSolid]:
    """Gear, motor and cage of a wheel with this rim height [m], as far as sizes are known.

    A gear has one cylinder that turns with the wheel and, if offset, one that turns with the motor.
    The cage includes the heads of the motor's screws behind it.
    """
    back = -(half_height(height) + mount.foot_plate)
    if room is not None and room.depth > 0.0:
        yield DriveSolid("gear", room.wheel_radius, back - room.depth, back)
        if room.offset > 0.0:
            yield DriveSolid("gear", room.motor_radius, back - room.depth, back, room.offset)
    if motor.diameter is not None and motor.length is not None:
        front = motor_front(mount, height)
        yield DriveSolid("motor", motor.diameter / 2.0, front - motor.length, front, mount.up)
    if mount.cage is not None:
        behind = mount.behind(motor)
        yield DriveSolid("cage", mount.cage.reach, -behind.from_wheel, back)
