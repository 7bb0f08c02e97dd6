"""The cage: a bracket for a motor that is screwed on by its back, as outrunners are.

A cup around the motor on the back of the foot's plate. Its floor holds the motor's back; four posts
with ears between floor and plate take the screws that come through the housing's floor and the
plate. The motor reaches through both, so that its rotating front is at the wheel's hub without a
spacer, and the length of the posts depends on the rim's height. Between the posts there is room for
air and wires. Printed on its floor it has no overhangs.

The origin of its frame is the middle of the underside of its floor; the wheel's axis is along z and
up is along -y, as in the wheel's frame.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from typing import Generic

from ocs_design.actuation.fasteners import SCREWS, BoltCircle, Screw, screw
from ocs_design.common.arrays import Table
from ocs_design.parts.moments import MassMoments, Real, round_body
from ocs_design.parts.printed import (
    CLEARANCE,
    FLOOR,
    FLOOR_SHARE,
    LID_SCREW,
    PETG,
    PLATE_THICKNESS,
    SHOCK,
    UPRIGHT,
    WALL,
    MountHoles,
    ear_axis,
    ear_holes,
    ear_radius,
    eared,
    half_height,
)
from ocs_design.parts.shapes import EAR_COUNT, Eared, Post
from ocs_design.parts.solids import Part, Prism

LEAST_POST = 3.0
"""Shortest post over the diameter of the thread that is cut into it."""

HEAVIER = 2.0
"""Mass on the ears' screws over that of the motor, when they are chosen: wheel and cage weigh as
much as a light motor, and a fifth of a heavy one."""

HALF_POST = pi / 8.0
"""Half of each post's angle around the axis [rad]: half of the wall is open. At 20 g, 0.2 kg of
motor and wheel bend each of four posts, 35 mm long, with 9 MPa."""

FIRST_EAR = -pi / 2.0
"""Angle of the first ear from the x axis [rad]: straight up, as the first hole of a ring."""


@dataclass(frozen=True)
class Posts(Table, Generic[Real]):
    """Posts of the cages around motors, whose length depends on the rim; arrays broadcast.

    Attributes:
        area: of all four, minus the holes in their ears [m^2]; 0: there is no cage.
        gyration: radius of gyration of that area about the axis [m].
        seat: from the wheel's middle to the motor's back, where the posts begin [m].
        foot_plate: thickness of the foot's plate, where they end [m].
    """

    area: Real | float = 0.0
    gyration: Real | float = 0.0
    seat: Real | float = 0.0
    foot_plate: Real | float = PLATE_THICKNESS

    def length(self, height: Real) -> Real:
        """Length up to the foot's plate for a rim of this height [m]."""
        return self.seat - (half_height(height) + self.foot_plate)

    def mass(self, height: Real) -> Real:
        """Mass [kg]."""
        return PETG.density * self.area * self.length(height)

    def mass_per_height(self) -> Real | float:
        """Change of the mass with the rim's height [kg/m]."""
        return -PETG.density * self.area / 2.0

    def moments(self, height: Real) -> MassMoments[Real]:
        """Moments in the module's frame."""
        mass, length = self.mass(height), self.length(height)
        across = mass * (self.gyration**2 / 2.0 + length**2 / 12.0)
        body = round_body(mass, mass * self.gyration**2, across)
        return body.shifted(length / 2.0 - self.seat, 0.0 * length)


NO_POSTS: Posts[float] = Posts()
"""Posts of a motor that is not in a cage."""


@dataclass(frozen=True)
class Cage:
    """The cage around one motor.

    Attributes:
        motor_radius, motor_length: [m].
        holes: in its floor, for the motor's screws and for anything protruding from its back.
        front: from the wheel's middle to the motor's turning front [m].
        rim_height: of the wheel that its motor turns [m].
        foot_plate: thickness of the foot's plate [m].
        screw: in its ears.
    """

    motor_radius: float
    motor_length: float
    holes: MountHoles
    front: float
    rim_height: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    screw: Screw = LID_SCREW

    @property
    def bore(self) -> float:
        """Radius of its room, in which the motor's bell turns [m]."""
        return self.motor_radius + CLEARANCE

    @property
    def across(self) -> float:
        """Radius of its wall, outside [m]."""
        return self.bore + WALL

    @property
    def floor(self) -> float:
        """Thickness of its floor [m]."""
        return max(FLOOR, FLOOR_SHARE * self.foot_plate)

    @property
    def seat(self) -> float:
        """Distance of the motor's back from the wheel's middle [m]."""
        return self.front + self.motor_length

    @property
    def back(self) -> float:
        """Distance of its floor's back from the wheel's middle [m]."""
        return self.seat + self.floor

    @property
    def length(self) -> float:
        """Length from the foot's plate to the back of its floor [m]."""
        return self.posts.length(self.rim_height) + self.floor

    @property
    def least_post(self) -> float:
        """Least length of its posts [m]."""
        return LEAST_POST * self.screw.diameter

    @property
    def rim_height_max(self) -> float:
        """Height of a rim at which posts have their least length [m]."""
        room = self.seat - self.foot_plate - self.least_post - half_height(0.0)
        return 2.0 * room

    @property
    def reach(self) -> float:
        """Radius within which its ears stay [m]."""
        return ear_axis(self.across, self.screw) + ear_radius(self.screw)

    @property
    def passage(self) -> MountHoles:
        """Holes in housing floor and foot plate, for the motor and the screws into the posts' ears.

        The first ear is straight up.
        """
        axis = 2.0 * ear_axis(self.across, self.screw)
        return MountHoles(self.bore, BoltCircle(axis, EAR_COUNT, self.screw.name))

    @property
    def band(self) -> Eared[float]:
        """Outline of its floor."""
        return eared(self.across, self.screw, FIRST_EAR)

    @cached_property
    def posts(self) -> Posts[float]:
        """Its posts, for a rim of any height."""
        unit = _posts(self, 0.0, 1.0)
        whole = Part("posts", 1.0, (unit[0],), (unit[1],)).moments()
        gyration = ((whole.xx + whole.yy) / whole.mass) ** 0.5
        return Posts(whole.mass, gyration, self.seat, self.foot_plate)

    def floor_moments(self) -> MassMoments[float]:
        """Moments of its floor in the module's frame."""
        floor = Part("floor", PETG.density, (Prism(self.band, 0.0, self.floor),), self._drilled)
        return floor.moments().turned(UPRIGHT).shifted(-self.back, 0.0)

    @property
    def _drilled(self) -> tuple[Prism[float], ...]:
        return tuple(self.holes.prisms(0.0, self.floor))


def ear_screws(motor: float | None) -> tuple[Screw, ...]:
    """Screws for the ears of a cage around a motor of that mass [kg], the best first.

    It is the smallest, from the lid's up, whose four heads bear `SHOCK` (see `HEAVIER`); smaller
    ones follow, for cages that have no room for it.
    """
    pull = HEAVIER * (motor or 0.0) * SHOCK / EAR_COUNT
    sizes = SCREWS[SCREWS.index(LID_SCREW) :]
    fit = (at for at, size in enumerate(sizes) if PETG.strength * size.head_area >= pull)
    return sizes[next(fit, len(sizes) - 1) :: -1]


def floor_at_shock(cage: Cage, motor: float, wheel: float) -> float:
    """Thickness at which a cage's floor breaks under `SHOCK` [m].

    Motor and wheel on it apply a tilting moment M, as does a rigid centre of radius b, around the
    heads of the motor's screws, in a plate that is clamped at radius a. Kirchhoff's plate with
    w = (A r + B / r + C r^3 + D r log r) cos(theta) has at b the stress

        3 M (a^2 - b^2) / (pi b t^2 (a^2 + b^2)).

    Posts clamp only half of the edge, so this stress is doubled.

    Args:
        cage: with the holes of the motor's screws. motor, wheel: mass of each [kg].
    """
    circle = cage.holes.screws
    assert circle is not None, "a motor in a cage is screwed on"
    tilting = SHOCK * (motor * cage.motor_length / 2.0 + wheel * cage.seat)
    held, clamped = circle.radius + screw(circle.thread).head_diameter / 2.0, cage.bore
    ring = (clamped**2 - held**2) / (clamped**2 + held**2)
    return sqrt(2.0 * 3.0 * tilting * max(ring, 0.0) / (pi * held * PETG.strength))


def heads_at_shock(cage: Cage, motor: float, wheel: float) -> float:
    """Acceleration along the axis at which the heads of a cage's screws sink into PETG [m/s^2].

    They press on the housing's floor, and hold motor, wheel (masses in kg) and cage on the foot.
    """
    mass = motor + wheel + float(cage_part(cage).mass())
    return EAR_COUNT * PETG.strength * cage.screw.head_area / mass


def _posts(cage: Cage, low: float, high: float) -> tuple[Prism[float], Prism[float]]:
    """The posts between two heights, and the holes in them [m]."""
    post = Post(cage.band, cage.bore, HALF_POST)
    solid = Prism(post, low, high, count=EAR_COUNT, first=FIRST_EAR)
    return solid, ear_holes(cage.band, cage.screw.tapping_drill, low, high)


def cage_part(cage: Cage) -> Part[float]:
    """The cage in its own frame."""
    posts, tapped = _posts(cage, cage.floor, cage.length)
    return Part(
        "cage", PETG.density, (Prism(cage.band, 0.0, cage.floor), posts), (*cage._drilled, tapped)
    )
