"""The pedestal between the trunk and the foot of a leaning module.

A triangular frame, printed on its side: a horizontal base, a seat square to the module, and a brace
from the far end of the seat down to that of the base. Base and seat are equally long, so that one
rule covers every lean from flat to upright. The base extends beyond both ends as flanges, each with
two of the trunk's screws, which are tightened from above before the foot is on the seat. The foot's
screws go into threads cut into the seat.

Its frame: x across, y along the base towards the far end of the seat, z up; its origin is on the
underside, below the line where seat and base meet.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import ceil, cos, hypot, pi, sin, sqrt
from typing import Annotated

import numpy as np

from ocs_design.actuation.fasteners import IN_PLASTIC, BoltedJoint, Fastening
from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.common.ranges import Length, Range, Signed
from ocs_design.parts.joints import SHEAR_SHARE, pattern_use
from ocs_design.parts.printed import (
    AROUND_SLOT,
    BASE_THICKNESS,
    PETG,
    SHOCK,
    STRENGTH_ACROSS,
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
    WALL,
    screw_lever,
)
from ocs_design.parts.shapes import Disc, Polygon
from ocs_design.parts.solids import Part, Prism
from ocs_design.robot.mass import MassProperties, combine

LEAST_SEAT = IN_PLASTIC * TRUNK_SCREW.diameter
"""Least thickness of the seat [m]: the thread depth that holds in plastic."""

ON_ITS_SIDE = Placement(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), np.zeros(3))
"""Placement of a profile in the pedestal's y-z plane, extruded along x."""

_ROUNDS = 50
"""Most steps of 0.1 mm by which a base is thickened, since thickening it raises wheel and load."""


_ROUNDED = 1e-6
"""Angle that counts as rounding [rad]."""


@dataclass(frozen=True)
class Pedestal:
    """Frame under one leaning foot.

    Attributes:
        base_radius, slot_radius: of the foot's base, and of the circle of its screws [m].
        wheel_height: of the wheel's middle above the foot's underside [m].
        lean: angle of the seat over the horizontal, more than 0 and up to pi/2 [rad].
        middle: position of the foot's middle along the seat, from its near end [m].
        thickness: of seat and brace [m].
        base: thickness of base and flanges [m]. foot_base: thickness of the base of the foot [m].
        module: name of the module on it.
        position: of its origin in B [m].
        heading: of its y axis in B, from x to y [rad].
    """

    base_radius: Length
    slot_radius: Length
    wheel_height: Length
    lean: Annotated[float, Range(_ROUNDED, pi / 2.0 + _ROUNDED)]
    middle: Length
    thickness: Length = LEAST_SEAT
    base: Length = BASE_THICKNESS
    foot_base: Length = BASE_THICKNESS
    module: str = ""
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading: Signed = pi / 2.0

    @property
    def length(self) -> float:
        """Length of the seat, and of the base without its flanges [m]."""
        return self.middle + self.base_radius

    @property
    def flange_screw(self) -> float:
        """Distance of the trunk's screws from the ends of the triangle [m].

        Their heads clear a foot whose base stands upright on the near end.
        """
        return self.foot_base + TRUNK_SCREW.head_diameter / 2.0 + WALL

    @property
    def flange(self) -> float:
        """Length of each flange [m]."""
        return self.flange_screw + AROUND_SLOT

    @property
    def seat_screws(self) -> Fastening:
        """Screws of the foot on it."""
        joint = BoltedJoint.FOOT_ON_PEDESTAL
        return Fastening(TRUNK_SCREW, TRUNK_SCREW_COUNT, self.foot_base, joint, IN_PLASTIC)

    @property
    def off(self) -> float:
        """Distance of the seat's screws from the foot's middle, both across and along it [m]."""
        return self.slot_radius * sqrt(0.5)

    @property
    def width(self) -> float:
        """Width across, with room around the foot's screws [m]."""
        return 2.0 * (self.off + AROUND_SLOT)

    @property
    def height(self) -> float:
        """Height of the seat's far end [m]."""
        return self.base + self.length * sin(self.lean)

    @property
    def sizes(self) -> tuple[float, float, float]:
        """Length with its flanges, width and height [m]."""
        return self.length + 2.0 * self.flange, self.width, self.height

    @property
    def seat(self) -> Placement:
        """Frame of the foot on it: z square to the seat."""
        along, up = self._directions
        rotation = np.stack([[1.0, 0.0, 0.0], along, up], axis=1)
        return Placement(rotation, np.array([0.0, 0.0, self.base]) + self.middle * along)

    @property
    def wheel(self) -> FloatArray:
        """Middle of the wheel [m], shape (3,)."""
        return self.seat.rotation[:, 2] * self.wheel_height + self.seat.position

    @property
    def holes(self) -> tuple[tuple[float, float], ...]:
        """Positions of the trunk's screws, x and y [m]."""
        ends = -self.flange_screw, self.length + self.flange_screw
        return tuple((x, y) for x in (-self.off, self.off) for y in ends)

    @property
    def placement(self) -> Placement:
        """Its frame in B."""
        along, across = cos(self.heading), sin(self.heading)
        rotation = [[across, along, 0.0], [-along, across, 0.0], [0.0, 0.0, 1.0]]
        return Placement(np.array(rotation), np.array(self.position))

    def in_base(self, places: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
        """Positions on its underside, transformed to B, x and y [m]."""
        turned = (self.placement.point([x, y, 0.0]) for x, y in places)
        return tuple((float(x), float(y)) for x, y, _ in turned)

    @property
    def base_screws(self) -> Fastening:
        """Screws of its flanges."""
        return Fastening(TRUNK_SCREW, 4, self.base, BoltedJoint.PEDESTAL)

    @property
    def _directions(self) -> tuple[FloatArray, FloatArray]:
        s, c = sin(self.lean), cos(self.lean)
        return np.array([0.0, c, s]), np.array([0.0, -s, c])

    @property
    def profile(self) -> Polygon[float]:
        """Outline from the side."""
        end, base, flange = self.length, self.base, self.flange
        far = end * cos(self.lean), base + end * sin(self.lean)
        low = ((-flange, 0.0), (end + flange, 0.0), (end + flange, base), (end, base))
        return Polygon((*low, far, (0.0, base), (-flange, base)))

    @property
    def window(self) -> Polygon[float]:
        """Opening of the frame; it has no area if the lean is too small."""
        near = self.thickness / sin(self.lean)
        beyond = self.thickness / cos(self.lean / 2.0)
        size = max(self.length - near - beyond, 0.0)
        apex = near + size * cos(self.lean), self.base + size * sin(self.lean)
        return Polygon(((near, self.base), (near + size, self.base), apex))

    @property
    def mass(self) -> float:
        """Mass with the screws in base and seat, minus those of a foot without a pedestal [kg]."""
        return sum(body.mass for body in self._bodies())

    def mass_properties(self) -> MassProperties:
        """Mass properties in B of everything in `mass`, with screws as points."""
        place = self.placement
        return combine(self._bodies()).moved(place.rotation, place.position)

    def _bodies(self) -> tuple[MassProperties, ...]:
        held, seated, none = self.base_screws, self.seat_screws, np.zeros((3, 3))
        screw_mass, head = held.mass / held.count, self.base - held.centre
        screws = (MassProperties(screw_mass, np.array([x, y, head]), none) for x, y in self.holes)
        seat = self.seat.position + (self.foot_base - seated.centre) * self._directions[1]
        # A foot's own screws, the same for any plate of that base, are counted with its module.
        longer = MassProperties(seated.mass - replace(seated, depth=1.0).mass, seat, none)
        return (pedestal_part(self).mass_properties(), *screws, longer)


def pedestal_part(pedestal: Pedestal) -> Part[float]:
    """The pedestal in its own frame, with its holes; the first of them is its window."""
    half, off = pedestal.width / 2.0, pedestal.off
    frame, window = (
        Prism(shape, -half, half, ON_ITS_SIDE) for shape in (pedestal.profile, pedestal.window)
    )
    through = TRUNK_SCREW.clearance_hole / 2.0
    base = [Prism(Disc(through, place), 0.0, pedestal.base) for place in pedestal.holes]
    # Left on the near side, right on the far side: opposite each other, like the foot's slots.
    threads = (Disc(TRUNK_SCREW.tapping_drill / 2.0, (x, x)) for x in (-off, off))
    seat = [Prism(thread, -pedestal.thickness, 0.0, pedestal.seat) for thread in threads]
    return Part("pedestal", PETG.density, (frame,), (window, *base, *seat))


def strengthened(pedestal: Pedestal, mass: float, above: float | None = None) -> Pedestal:
    """Pedestal with the thicknesses of seat and flanges that `SHOCK` requires, in 0.1 mm steps.

    Args:
        pedestal: with any thicknesses, which are ignored. mass: of the module on it [kg].
        above: required height of the wheel's middle above the underside, to which the foot is moved
            along the seat [m]; None: the foot stays where it is.
    """
    stronger = replace(pedestal, base=BASE_THICKNESS)
    for _ in range(_ROUNDS):
        if above is not None:
            up = above - stronger.base - stronger.wheel_height * cos(stronger.lean)
            stronger = replace(stronger, middle=up / sin(stronger.lean))
        if stronger.base >= _flange_needed(stronger, mass):
            break
        stronger = replace(stronger, base=stronger.base + 1e-4)
    return replace(
        stronger, thickness=max(LEAST_SEAT, ceil(1e4 * _seat_needed(stronger, mass)) / 1e4)
    )


def _seat_needed(pedestal: Pedestal, mass: float) -> float:
    """Thickness at which the seat breaks under `SHOCK` [m].

    A simply supported beam under a force F at the wheel in any direction of the frame's plane:
    normal to the seat it bends it by `F L / 4`, along the seat by at most the couple `F H`,
    wherever the foot is. `sigma = 6 M / (w t^2)`: Roark's Formulas for Stress and Strain, 7th
    edition, table 8.1, cases 1e and 3e, with the section modulus of a rectangle.
    """
    arm = hypot(pedestal.length / 4.0, pedestal.wheel_height)
    return sqrt(6.0 * mass * SHOCK * arm / (pedestal.width * STRENGTH_ACROSS))


def _arms(pedestal: Pedestal) -> tuple[float, float, float, float]:
    """Wheel beside and above the middle of the trunk's screws, and half their spacings [m]."""
    _, y, above = pedestal.wheel.tolist()
    half = pedestal.length / 2.0
    return abs(y - half), above, half + pedestal.flange_screw, pedestal.off


def _flange_needed(pedestal: Pedestal, mass: float) -> float:
    """Thickness at which a flange breaks under `SHOCK` [m].

    A cantilever of half the width, loaded by one screw: Roark, case 1a of the same table.
    """
    aside, above, along, across = _arms(pedestal)
    pulled = mass * SHOCK / 4.0 * (1.0 + max((above + aside) / along, above / across))
    return sqrt(6.0 * pulled * pedestal.flange_screw / (pedestal.width / 2.0 * STRENGTH_ACROSS))


def seat_compliance(pedestal: Pedestal) -> tuple[float, float]:
    """Displacement of the wheel over the force on it, normal to the seat and along it [m/N].

    A simply supported beam, with a and b from its ends to the foot's middle: a force there deflects
    it by a^2 b^2 / (3 E I L), and a couple turns it by (a^3 + b^3) / (3 E I L^2): Roark, table 8.1,
    cases 1e and 3e. Base, brace and the foot on it count as rigid.
    """
    a, b, whole = pedestal.middle, pedestal.base_radius, pedestal.length
    stiffness = 3.0 * PETG.modulus * pedestal.width * pedestal.thickness**3 / 12.0
    turns = (a**3 + b**3) / (stiffness * whole**2)
    return (a * b) ** 2 / (stiffness * whole), turns * pedestal.wheel_height**2


def pedestal_use(pedestal: Pedestal, mass: float) -> float:
    """Largest share of strength that `SHOCK` uses in pedestal and screws.

    These are the trunk's screws (`pattern_use`), the flanges as cantilevers loaded by them, the
    seat, and the threads in it, which pull out by shearing a cylinder of plastic: a force at the
    wheel turns the foot about its edge, and two screws resist in proportion to their distance from
    it.

    Args:
        mass: of the module [kg].
    """
    force = mass * SHOCK
    aside, above, along, across = _arms(pedestal)
    arms, pattern = (above, np.asarray(aside)), (np.asarray(along), np.asarray(across))
    screws = float(pattern_use(TRUNK_SCREW, force, arms, pattern))
    flange = (_flange_needed(pedestal, mass) / pedestal.base) ** 2
    seat = (_seat_needed(pedestal, mass) / pedestal.thickness) ** 2
    lever = screw_lever(pedestal.base_radius, pedestal.slot_radius)
    thread = pi * TRUNK_SCREW.diameter * IN_PLASTIC * TRUNK_SCREW.diameter
    pulls = force * (pedestal.wheel_height / lever + 0.5)
    pulled_out = pulls / (thread * SHEAR_SHARE * STRENGTH_ACROSS)
    return float(max(screws, flange, seat, pulled_out))
