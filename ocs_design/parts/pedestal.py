"""The pedestal: what a foot stands on whose module leans, between it and the trunk.

A triangular frame, printed lying on its side: a base that is horizontal, a seat square to the
module, and a brace from the seat's far end down to the base's. Base and seat are equally long, so
that one rule makes every lean from flat to upright. The base goes on beyond both ends as flanges,
each with two of the trunk's screws; they are tightened from above before the foot is on the seat.
The foot's screws go into threads that are cut into the seat.

Its own frame: x across, y along the base towards the far end of the seat, z up; its origin is
below the line where seat and base meet, on the underside. Sizes may be arrays that broadcast.
"""

from dataclasses import dataclass
from math import ceil, cos, pi, sin, sqrt
from typing import Any, Generic

import numpy as np

from ocs_design.actuation.fasteners import IN_PLASTIC, Fastening
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.carrier_plate import pattern_use
from ocs_design.parts.foot import AROUND_SLOT, BASE_THICKNESS, TRUNK_SCREW, Foot, larger
from ocs_design.parts.moments import Real
from ocs_design.parts.part import Part
from ocs_design.parts.printed import DENSITY, SHOCK, STRENGTH_ACROSS, WALL
from ocs_design.parts.shapes import Disc, Polygon
from ocs_design.parts.solids import Prism
from ocs_design.robot.tree import Placement

LEAST_SEAT = IN_PLASTIC * TRUNK_SCREW.diameter
"""Least thickness of the seat [m]: that of a thread that holds in plastic."""

FLANGE_SCREW = BASE_THICKNESS + TRUNK_SCREW.head_diameter / 2.0 + WALL
"""Distance of the trunk's screws from the ends of the triangle [m]: their heads clear a foot whose
base stands upright on the near end."""

FLANGE = FLANGE_SCREW + AROUND_SLOT
"""Length of each flange [m]."""

HEAD_TOP = BASE_THICKNESS + TRUNK_SCREW.head_height
"""Height of the heads of the trunk's screws [m]."""

BASE_SCREWS = Fastening(TRUNK_SCREW, 4, BASE_THICKNESS, "pedestal on trunk")
SEAT_SCREWS = Fastening(
    TRUNK_SCREW, 2, BASE_THICKNESS, "foot on pedestal, which is tapped", IN_PLASTIC
)

SHEAR = 0.577
"""Shear strength over tensile strength: von Mises."""

ON_ITS_SIDE = Placement(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), np.zeros(3))
"""Of the profile, y and z of the pedestal, pushed along x."""


@dataclass(frozen=True)
class Pedestal(Generic[Real]):
    """Frame under one leaning foot.

    Attributes:
        foot: that stands on it.
        lean: angle of the seat over the horizontal, more than 0 and up to pi/2 [rad].
        middle: of the foot's base along the seat, from its near end [m].
        thickness: of seat and brace [m].
    """

    foot: Foot[Real]
    lean: float
    middle: Real
    thickness: Real | float = LEAST_SEAT

    @property
    def length(self) -> Real:
        """Length of the seat, and of the base without its flanges [m]."""
        return self.middle + self.foot.base_radius

    @property
    def off(self) -> Real:
        """How far across and along the seat its screws are from the foot's middle [m]."""
        return self.foot.slot_radius * sqrt(0.5)

    @property
    def width(self) -> Real:
        """Width across, with room around the foot's screws [m]."""
        return 2.0 * (self.off + AROUND_SLOT)

    @property
    def height(self) -> Real:
        """Height of the seat's far end [m]."""
        return BASE_THICKNESS + self.length * sin(self.lean)

    @property
    def seat(self) -> Placement:
        """Frame of the foot on it: z square to the seat. Of numbers."""
        along, up = self._directions
        rotation = np.stack([[1.0, 0.0, 0.0], along, up], axis=1)
        return Placement(rotation, np.array([0.0, 0.0, BASE_THICKNESS]) + self.middle * along)

    @property
    def _directions(self) -> tuple[FloatArray, FloatArray]:
        s, c = sin(self.lean), cos(self.lean)
        return np.array([0.0, c, s]), np.array([0.0, -s, c])

    @property
    def profile(self) -> Polygon[Real]:
        """Outline from the side."""
        end, base = self.length, BASE_THICKNESS
        far = end * cos(self.lean), base + end * sin(self.lean)
        low: tuple[Any, ...] = (
            (-FLANGE, 0.0),
            (end + FLANGE, 0.0),
            (end + FLANGE, base),
            (end, base),
        )
        return Polygon((*low, far, (0.0, base), (-FLANGE, base)))

    @property
    def window(self) -> Polygon[Real]:
        """What the frame leaves open; nothing where the lean is too small for it."""
        near = self.thickness / sin(self.lean)
        beyond = self.thickness / cos(self.lean / 2.0)
        size = larger(self.length - near - beyond, 0.0)
        base = BASE_THICKNESS
        apex = near + size * cos(self.lean), base + size * sin(self.lean)
        return Polygon(((near, base), (near + size, base), apex))


def pedestal_part(pedestal: Pedestal[Real]) -> Part[Real]:
    """The pedestal in its own frame without its holes for screws, to be weighed over arrays."""
    half = pedestal.width / 2.0
    frame = Prism(pedestal.profile, -half, half, ON_ITS_SIDE)
    opened = Prism(pedestal.window, -half, half, ON_ITS_SIDE)
    return Part("pedestal", DENSITY, (frame,), (opened,))


def drilled(pedestal: Pedestal[float]) -> Part[float]:
    """The pedestal in its own frame, with its holes."""
    blank, off = pedestal_part(pedestal), pedestal.off
    through = TRUNK_SCREW.clearance_hole / 2.0
    base = [
        Prism(Disc(through, (x, y)), 0.0, BASE_THICKNESS)
        for x in (-off, off)
        for y in (-FLANGE_SCREW, pedestal.length + FLANGE_SCREW)
    ]
    # Left on the near side, right on the far one: opposite each other, as the foot's slots.
    seat = [
        Prism(
            Disc(TRUNK_SCREW.tapping_drill / 2.0, (x, x)), -pedestal.thickness, 0.0, pedestal.seat
        )
        for x in (-off, off)
    ]
    return Part(blank.name, DENSITY, blank.solids, (*blank.holes, *base, *seat))


def pedestal_mass(pedestal: Pedestal[float]) -> float:
    """Mass with the screws in base and seat, less those that hold a foot without it [kg]."""
    feet = TRUNK_SCREW.mass(TRUNK_SCREW.length_through(BASE_THICKNESS)) * SEAT_SCREWS.count
    return drilled(pedestal).mass() + BASE_SCREWS.mass + SEAT_SCREWS.mass - feet


def seat_thickness(pedestal: Pedestal[float], mass: float) -> float:
    """Thickness with which the seat bears `SHOCK`, to the next 0.1 mm [m].

    Args:
        pedestal: whose seat may have another thickness. mass: of the module on it [kg].
    """
    return max(LEAST_SEAT, ceil(1e4 * _seat_needed(pedestal, mass)) / 1e4)


def _seat_needed(pedestal: Pedestal[float], mass: float) -> float:
    """Thickness at which the seat breaks under `SHOCK` [m].

    A beam whose ends are held simply, under a force F at the wheel in any direction of the frame's
    plane: it bends the seat by `F L / 4`, square to it, and along it by no more than the couple
    `F H`, wherever the foot is.
    `sigma = 6 M / (w t^2)`: Roark's Formulas for Stress and Strain, 7th edition, table 8.1, cases
    1e and 3e, with the section modulus of a rectangle.
    """
    arm = float(np.hypot(pedestal.length / 4.0, pedestal.foot.wheel_height))
    return sqrt(6.0 * mass * SHOCK * arm / (pedestal.width * STRENGTH_ACROSS))


def pedestal_use(pedestal: Pedestal[float], mass: float) -> float:
    """Largest share of strength that `SHOCK` takes of what holds a module on its pedestal.

    The trunk's screws (`pattern_use`), the flanges that they press on as cantilevers, the seat
    (`seat_thickness`), and the threads in it, which pull out as a cylinder of plastic is sheared: a
    force at the wheel turns the foot about its edge, and two screws hold it as far as they are from
    there.

    Args:
        mass: of the module [kg].
    """
    foot, force = pedestal.foot, mass * SHOCK
    wheel = pedestal.seat @ Placement(np.eye(3), np.array([0.0, 0.0, foot.wheel_height]))
    half = pedestal.length / 2.0 + FLANGE_SCREW, pedestal.off
    aside, above = abs(wheel.position[1] - pedestal.length / 2.0), wheel.position[2]
    arms, pattern = (above, np.asarray(aside)), (np.asarray(half[0]), np.asarray(half[1]))
    screws = float(pattern_use(TRUNK_SCREW, force, arms, pattern))
    pulled = force / 4.0 * (1.0 + max((above + aside) / half[0], above / half[1]))
    flange = 6.0 * pulled * FLANGE_SCREW / (pedestal.width / 2.0 * BASE_THICKNESS**2)
    seat = (_seat_needed(pedestal, mass) / pedestal.thickness) ** 2
    edge, out = foot.base_radius, foot.slot_radius
    lever = min(2.0 * edge, 2.0 * (edge**2 + out**2) / (edge + out))
    thread = pi * TRUNK_SCREW.diameter * IN_PLASTIC * TRUNK_SCREW.diameter
    pulled_out = force * (foot.wheel_height / lever + 0.5) / (thread * SHEAR * STRENGTH_ACROSS)
    return float(max(screws, flange / STRENGTH_ACROSS, seat, pulled_out))
