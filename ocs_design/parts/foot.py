"""The foot: a turntable with a plate, which holds motor and housing at the incidence angle.

A disc on the trunk, held by two screws through arc slots, with marks along its edge: a line on the
trunk from one foot to the other points to the mark of the angle. On the disc stands a plate behind
the housing's floor: a stem with a disc around the mount's holes. The foot's frame is the one in
which it is printed: origin in the middle of its underside, z up, the wheel's axis along y.

Sizes, which are the rim's outer radius R, its height h and the reach of the mount's holes [m], are
numbers, arrays that broadcast, or CasADi symbols.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi, sqrt
from typing import Generic

import numpy as np

from ocs_design.actuation.fasteners import Fastening
from ocs_design.common.frames import Placement
from ocs_design.parts.cage import Cage
from ocs_design.parts.carrier_plate import SLOT_EDGE
from ocs_design.parts.housing import Housing, housing_outer_radius
from ocs_design.parts.joints import FRICTION, TIGHTENING_FACTOR
from ocs_design.parts.moments import Real
from ocs_design.parts.printed import (
    AROUND_SLOT,
    CLEARANCE,
    FLOOR,
    FLOOR_SHARE,
    PETG,
    PLATE_THICKNESS,
    PRESSURE_SHARE,
    SHOCK,
    STRENGTH_ACROSS,
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
    UPRIGHT,
    WALL,
    WASHER_ACROSS,
    base_thickness,
    screw_lever,
    trunk_screws,
)
from ocs_design.parts.shapes import ArcSlot, Disc, Keyhole, Rectangle
from ocs_design.parts.solids import Part, Prism

PLATE_MARGIN = 3.0e-3
"""Margin of the plate around the mount's holes [m]."""

PLATE_SHARE = 0.5
"""Least radius of the plate's disc over the housing's radius."""

STEM_SHARE = 0.45
"""Least half width of its stem over the housing's radius."""

STEEPEST = sqrt(0.5)
"""Least half width of the stem over the disc's radius: printed upright, the disc grows out of it at
45 degrees at most, which needs no support."""

HALF_SWING = pi / 4.0
"""Angle of each slot to both sides of the wheel's axis [rad], for an incidence of 0..90 degrees.

This puts the trunk's screws at 45 degrees to the lateral direction.
"""

KNEE = 1.0e-3
"""Width of the transition between the two lower bounds of the base's radius, to make it smooth [m].

One bound comes from its slots, the other from its stem.
"""

LONG_MARKS = 12
"""Number of long marks, all around every 30 degrees, each followed by two short ones: left and
right feet are the same part, turned by 180 degrees."""

MARK_WIDTH, MARK_DEPTH, MARK_LENGTH, LONG_MARK_LENGTH = 0.8e-3, 0.4e-3, 2.5e-3, 4.0e-3
"""Sizes of the marks [m]: as wide as two lines of a 0.4 mm nozzle, as deep as two layers of
0.2 mm."""

STANDING = Placement(UPRIGHT, np.zeros(3))
"""The wheel's axes in the foot's frame: x forward in both, z along the wheel's axis, y down."""


def elementwise_max(one: Real, other: Real | float) -> Real:
    """The larger of two, by operators alone."""
    return (one + other + abs(one - other)) / 2.0


@dataclass(frozen=True)
class Foot(Generic[Real]):
    """Bracket that carries a housing on the trunk.

    Attributes:
        housing: carried by it, with the holes that its plate shares.
        thickness: of its plate, stem and disc [m].
    """

    housing: Housing[Real]
    thickness: Real | float = PLATE_THICKNESS

    @property
    def base(self) -> Real:
        """Thickness of its base [m]."""
        return base_thickness(self.thickness)

    @property
    def screws(self) -> Fastening:
        """Screws that hold it on the trunk; its thickness must be a number."""
        return trunk_screws(float(self.thickness))

    @cached_property
    def wheel_height(self) -> Real:
        """Height of the wheel's centre above the underside [m]."""
        rim = self.housing.rim_radius + self.housing.guard_wall
        return housing_outer_radius(rim) + (self.base + CLEARANCE)

    @cached_property
    def half_width(self) -> Real:
        """Radius of the plate's disc [m]."""
        housing = self.housing
        return elementwise_max(PLATE_SHARE * housing.radius, housing.mount.reach + PLATE_MARGIN)

    @cached_property
    def stem(self) -> Real:
        """Half the width of the plate's stem [m]."""
        return elementwise_max(STEM_SHARE * self.housing.radius, STEEPEST * self.half_width)

    @cached_property
    def back(self) -> Real:
        """Distance of the plate's back from the wheel's middle [m]."""
        return self.housing.half_height + self.thickness

    @cached_property
    def slot_radius(self) -> Real:
        """Radius of the slots, such that screw heads at their ends clear the plate [m]."""
        return sqrt(2.0) * (self.back + TRUNK_SCREW.head_diameter / 2.0 + WALL)

    @cached_property
    def corner(self) -> Real:
        """Radius of the stem's corners around the middle of the base [m]."""
        radius: Real = (self.stem**2 + self.back**2) ** 0.5
        return radius

    @cached_property
    def base_radius(self) -> Real:
        """Radius that encloses slots, screw heads and plate, with the marks outside of them [m]."""
        around, corner = self.slot_radius + AROUND_SLOT, self.corner
        apart: Real = ((around - corner) ** 2 + KNEE**2) ** 0.5
        # A smooth maximum, larger by up to half of `KNEE` where both are equal.
        return (around + corner + apart) / 2.0 + (LONG_MARK_LENGTH + WALL)

    @property
    def marks_radius(self) -> Real:
        """Radius of the outer ends of the scale's marks [m]."""
        return self.base_radius - WALL

    @property
    def placement(self) -> Placement:
        """Its frame in the wheel's: x is forward in both, y along the spin axis, z (up) is -y."""
        return Placement(UPRIGHT.T, np.array([0.0, self.wheel_height, 0.0]))

    @property
    def plate(self) -> Keyhole[Real]:
        """The plate from the base up to a disc around the wheel's axis; y points down."""
        return Keyhole(self.half_width, self.stem, -self.wheel_height, -self.base)

    @property
    def slot(self) -> ArcSlot[Real]:
        """The slot facing away from the other module; the other slot is opposite."""
        ends = pi / 2.0 - HALF_SWING, pi / 2.0 + HALF_SWING
        return ArcSlot(self.slot_radius, TRUNK_SCREW.clearance_hole, *ends)


def cage_placement(foot: Foot[float], cage: Cage) -> Placement:
    """Frame of the cage in the wheel's: its floor away from the foot's plate."""
    return Placement(np.eye(3), np.array([0.0, 0.0, -foot.back - cage.length]))


def foot_shock(foot: Foot[float], mass: float, edge: float | None = None) -> float:
    """Acceleration along the wheel's axis at which a foot of PETG breaks [m/s^2].

    `mass` and `edge`: see `screw_pull`.
    """
    stem = float(foot.thickness) / _stem_at_shock(foot, mass)
    # The base as a cantilever as wide as the stem, pulled by the screw on the far side: the same
    # case, but bent along its layers.
    arm, width = foot.slot_radius + foot.housing.half_height, 2.0 * foot.stem
    base = float(foot.base) / sqrt(
        6.0 * screw_pull(foot, mass, edge) * arm / (width * PETG.strength)
    )
    return SHOCK * min(stem, base) ** 2


def plate_thickness(foot: Foot[float], mass: float, floor: float = 0.0) -> float:
    """Plate thickness with which a foot and a cage bear `SHOCK`, rounded up to 0.1 mm [m].

    Stem, base and the cage's floor are as thick as the plate or a share of it. It is at least
    `PLATE_THICKNESS`, and at most half the stem's width, a solid block. The foot tilts as on a
    carrier plate, which may end within its base.

    Args:
        foot: with any plate thickness, which is ignored. mass: of the module above it [kg].
        floor: least thickness of the cage's floor (`floor_at_shock`) [m]; 0: there is no cage.
    """
    asked = max(PLATE_THICKNESS, _stem_at_shock(foot, mass))
    if floor > FLOOR:
        asked = max(asked, floor / FLOOR_SHARE)
    tenths = ceil(round(1e4 * asked, 6))
    # A thicker plate moves the screws outwards, where they pull less at a longer arm.
    while tenths < 1e4 * foot.stem:
        thicker = replace(foot, thickness=tenths / 1e4)
        edge = min(thicker.base_radius, thicker.slot_radius + SLOT_EDGE)
        if foot_shock(thicker, mass, edge) >= SHOCK:
            break
        tenths += 1
    return max(PLATE_THICKNESS, min(tenths / 1e4, foot.stem))


def _stem_at_shock(foot: Foot[float], mass: float) -> float:
    """Thickness at which the stem breaks under `SHOCK` [m].

    M = m a H and sigma = 6 M / (w t^2): Roark's Formulas for Stress and Strain, 7th edition, table
    8.1, case 1a, with the section modulus of a rectangle. Feet are printed upright, so that the
    stem, 2 `stem` wide, is bent across its layers.
    """
    arm, width = foot.wheel_height - foot.base, 2.0 * foot.stem
    return sqrt(6.0 * mass * SHOCK * arm / (width * STRENGTH_ACROSS))


def screw_pull(foot: Foot[float], mass: float, edge: float | None = None) -> float:
    """Largest pull of one of a foot's screws under `SHOCK` along its wheel's axis [N].

    Args:
        foot: of PETG. mass: of the module above it [kg].
        edge: radius of its support, about whose edge it tilts [m]; None: its whole base.
    """
    edge = foot.base_radius if edge is None else edge
    return mass * SHOCK * foot.wheel_height / screw_lever(edge, foot.slot_radius)


@dataclass(frozen=True)
class FootHold:
    """Hold of a foot by its two screws: heads on slots, and their friction.

    Attributes:
        pull: largest on one screw under `SHOCK` along the wheel's axis [N].
        washers: whether washers go under the heads: without them the preload that the print allows
            would be less than that pull.
        area: pressed by a head, or its washer, beside its slot [m^2].
        prints_bear: acceleration at which stem or base break [m/s^2].
        slot_radius: of the circle of the screws [m].
    """

    pull: float
    washers: bool
    area: float
    prints_bear: float
    slot_radius: float

    @property
    def heads_bear(self) -> float:
        """Acceleration at which the heads, or their washers, sink into the base [m/s^2]."""
        return SHOCK * PETG.strength * self.area / self.pull

    @property
    def preload(self) -> float:
        """Preload of a screw, limited by the print under it [N]."""
        return PRESSURE_SHARE * PETG.strength * self.area

    @property
    def turning(self) -> float:
        """Moment about the vertical that friction resists at the least preload [N m]."""
        least = self.preload / TIGHTENING_FACTOR
        return FRICTION * TRUNK_SCREW_COUNT * least * self.slot_radius

    @classmethod
    def of(cls, foot: Foot[float], mass: float, edge: float) -> "FootHold":
        """Hold of a foot under a module of this mass [kg]; `edge`: see `screw_pull` [m]."""
        pull = screw_pull(foot, mass, edge)
        bare = TRUNK_SCREW.slot_area(TRUNK_SCREW.head_diameter)
        washers = pull > PRESSURE_SHARE * PETG.strength * bare
        area = TRUNK_SCREW.slot_area(WASHER_ACROSS) if washers else bare
        return cls(pull, washers, area, foot_shock(foot, mass, edge), foot.slot_radius)


def stem_frequency(
    foot: Foot[float],
    mass: float,
    inertia: float,
    modulus: float = PETG.modulus,
    *,
    in_plane: bool = False,
) -> float:
    """First bending mode of the stem along the wheel's axis, with its base fixed [Hz].

    Rayleigh's quotient with the shape of a cantilever under a force at its end, v = y^2 (3 L - y) /
    2 L^3: 3 E I / L^3 over m + 33/140 m_stem + J (3 / 2 L)^2.

    Args:
        foot: of the stem.
        mass: at the wheel's middle [kg]. inertia: about the axis that the mass rotates about in
            this mode, the forward one [kg m^2].
        modulus: of the foot's material [Pa]; its density is always that of PETG.
        in_plane: bending forward, across the wheel's axis, instead: width and thickness of the stem
            swap roles, and `inertia` is that about the wheel's axis.
    """
    arm, width = foot.wheel_height - foot.base, 2.0 * foot.stem
    thickness = float(foot.thickness)
    deep, wide = (width, thickness) if in_plane else (thickness, width)
    stiffness = modulus * wide * deep**3 / (4.0 * arm**3)
    stem = PETG.density * width * thickness * arm
    return sqrt(stiffness / (mass + 33.0 / 140.0 * stem + 2.25 * inertia / arm**2)) / (2.0 * pi)


def foot_part(foot: Foot[float]) -> Part[float]:
    """The foot in its own frame, with the mount's holes."""
    blank, axis = undrilled(foot), np.array([0.0, 0.0, foot.wheel_height])
    around = Placement(UPRIGHT, axis)
    holes = foot.housing.mount.prisms(-foot.back, -foot.housing.half_height, around)
    return Part("foot", PETG.density, blank.solids, (*blank.holes, *holes))


def undrilled(foot: Foot[Real]) -> Part[Real]:
    """The foot in its own frame without the mount's holes; see the module for sizes."""
    base = Prism(Disc(foot.base_radius), 0.0, foot.base)
    plate = Prism(foot.plate, -foot.back, -foot.housing.half_height, STANDING)
    cut = [Prism(foot.slot, 0.0, foot.base, count=TRUNK_SCREW_COUNT)]
    end, low = foot.marks_radius, foot.base - MARK_DEPTH
    for third, length in enumerate((LONG_MARK_LENGTH, MARK_LENGTH, MARK_LENGTH)):
        groove = Rectangle(end - length, end, -MARK_WIDTH / 2.0, MARK_WIDTH / 2.0)
        first = 2.0 * pi / LONG_MARKS * third / 3.0
        cut.append(Prism(groove, low, foot.base, count=LONG_MARKS, first=first))
    return Part("foot", PETG.density, (base, plate), tuple(cut))


def foot_mass_per_height(foot: Foot[Real]) -> Real:
    """Change of the base's mass with the rim's height at constant R [kg/m]."""
    corner = foot.corner
    beyond = foot.slot_radius + AROUND_SLOT - corner
    by_slot = (1.0 + beyond / (beyond**2 + KNEE**2) ** 0.5) / 2.0
    outward = by_slot * sqrt(0.5) + (1.0 - by_slot) * foot.back / (2.0 * corner)
    slots = pi * TRUNK_SCREW.clearance_hole * sqrt(0.5)
    slope: Real = PETG.density * foot.base * (2.0 * pi * foot.base_radius * outward - slots)
    return slope
