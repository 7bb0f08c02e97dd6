"""The foot: a turntable with a plate, which holds motor and housing at the incidence angle.

A disc on the trunk, held by two screws through arc slots, with marks along its edge; on it a plate
behind the housing's floor, half round above the wheel's axis. All functions take the rim's outer
radius R and height h and the reach of the mount's holes [m], scalars or arrays that broadcast, and
are built of operators alone, for CasADi's symbols too. The mount's holes are not in them
(`sizing.mount`).
"""

from math import pi, sqrt

from ocs_design.fasteners import Fastening, screw
from ocs_design.sizing.housing import (
    CLEARANCE,
    DENSITY,
    WALL,
    half_height,
    housing_outer_radius,
)
from ocs_design.sizing.mass_moments import MassMoments, Real, disc, flat_ring

BASE_THICKNESS = 3.0e-3
"""[m]: the trunk's screws press on it."""

PLATE_THICKNESS = 5.0e-3
"""[m]: 20 g on a module of 0.35 kg, 40 mm above the base, bend a plate 30 mm wide with 22 MPa."""

PLATE_MARGIN = 3.0e-3
"""Of the plate around the mount's holes [m]."""

PLATE_SHARE = 0.5
"""Of the plate's half width in the housing's radius, at least."""

TRUNK_SCREW = screw("M3")

TRUNK_SCREW_COUNT = 2
"""Through a slot each."""

TRUNK_SCREWS = Fastening(
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
    BASE_THICKNESS,
    "foot on trunk; longer if its thread begins deeper",
)

MARK_EVERY, LONG_MARK_EVERY = 10, 30
"""Degrees, all around: left and right feet are the same part, turned by 180 degrees."""

MARK_WIDTH, MARK_DEPTH, MARK_LENGTH, LONG_MARK_LENGTH = 0.8e-3, 0.4e-3, 2.5e-3, 4.0e-3
"""[m]: two lines of a 0.4 mm nozzle wide, two layers of 0.2 mm deep."""

_LONG_MARKS = 360 // LONG_MARK_EVERY
_SHORT_MARKS = 360 // MARK_EVERY - _LONG_MARKS


def wheel_height(outer_radius: Real) -> Real:
    """Of the wheel's centre above the foot's underside [m]."""
    return housing_outer_radius(outer_radius) + (BASE_THICKNESS + CLEARANCE)


def plate_back(half: Real) -> Real:
    """Of the plate, from the middle of a housing of that half height [m]."""
    return half + PLATE_THICKNESS


def plate_half_width(outer_radius: Real, mount_reach: Real) -> Real:
    """[m]."""
    return larger(mount_reach + PLATE_MARGIN, PLATE_SHARE * housing_outer_radius(outer_radius))


def slot_radius(height: Real) -> Real:
    """Where heads clear the plate at the ends of the slots [m]."""
    to_head = plate_back(half_height(height)) + TRUNK_SCREW.head_diameter / 2.0
    return sqrt(2.0) * (to_head + WALL)


def base_radius(outer_radius: Real, height: Real, mount_reach: Real) -> Real:
    """Around the marks outside the slots, the heads in them and the plate [m]."""
    width, back = plate_half_width(outer_radius, mount_reach), plate_back(half_height(height))
    corner: Real = (width**2 + back**2) ** 0.5
    return larger(slot_radius(height) + _AROUND_SLOT, corner) + (LONG_MARK_LENGTH + WALL)


_AROUND_SLOT = max(TRUNK_SCREW.head_diameter / 2.0, TRUNK_SCREW.clearance_hole / 2.0 + WALL)
"""Of heads, or of a wall, around the middle of a slot [m]."""


def foot_mass(outer_radius: Real, height: Real, mount_reach: Real) -> Real:
    """Without the mount's holes [kg]."""
    width, slot = plate_half_width(outer_radius, mount_reach), slot_radius(height)
    edge = base_radius(outer_radius, height, mount_reach)
    tall = wheel_height(outer_radius) - BASE_THICKNESS
    plate = PLATE_THICKNESS * (2.0 * width * tall + pi / 2.0 * width**2)
    base = BASE_THICKNESS * (pi * edge**2 - _slots_area(slot))
    return DENSITY * (plate + base - _MARKS_VOLUME)


def foot_mass_per_height(outer_radius: Real, height: Real, mount_reach: Real) -> Real:
    """dm/dh at constant R, of the base [kg/m]."""
    width, back = plate_half_width(outer_radius, mount_reach), plate_back(half_height(height))
    corner: Real = (width**2 + back**2) ** 0.5
    by_slot = 1.0 * (slot_radius(height) + _AROUND_SLOT > corner)
    outward = by_slot * sqrt(0.5) + (1.0 - by_slot) * back / (2.0 * corner)
    edge = base_radius(outer_radius, height, mount_reach)
    slots = pi * TRUNK_SCREW.clearance_hole * sqrt(0.5)
    return DENSITY * BASE_THICKNESS * (2.0 * pi * edge * outward - slots)


def foot_moments(outer_radius: Real, height: Real, mount_reach: Real) -> MassMoments[Real]:
    """Without the mount's holes, about the wheel's centre."""
    edge, bottom = base_radius(outer_radius, height, mount_reach), -wheel_height(outer_radius)
    middle, top = bottom + BASE_THICKNESS / 2.0, bottom + BASE_THICKNESS
    base = disc(edge, BASE_THICKNESS, DENSITY) + _slots(slot_radius(height)).times(-1.0)
    marks = _marks(edge, MARK_LENGTH, _SHORT_MARKS) + _marks(edge, LONG_MARK_LENGTH, _LONG_MARKS)
    plate = _plate(plate_half_width(outer_radius, mount_reach), top)
    along = PLATE_THICKNESS / 2.0 - plate_back(half_height(height))
    return (
        base.shifted(0.0 * edge, middle)
        + marks.times(-1.0).shifted(0.0 * edge, top - MARK_DEPTH / 2.0)
        + plate.shifted(along, 0.0 * along)
    )


def larger(one: Real, other: Real) -> Real:
    """Of two, by operators alone."""
    return (one + other + abs(one - other)) / 2.0


def _plate(width: Real, bottom: Real) -> MassMoments[Real]:
    """A rectangle from `bottom` up to the wheel's axis and half a circle above it."""
    tall, thick = -bottom, PLATE_THICKNESS
    lower, upper = 2.0 * width * tall, pi / 2.0 * width**2
    mass = DENSITY * thick * (lower + upper)
    zero = 0.0 * mass
    return MassMoments(
        mass=mass,
        y=zero,
        z=DENSITY * thick * (2.0 / 3.0 * width**3 - width * tall**2),
        xx=DENSITY * thick * (lower * width**2 / 3.0 + upper * width**2 / 4.0),
        yy=mass * thick**2 / 12.0,
        zz=DENSITY * thick * (lower * tall**2 / 3.0 + upper * width**2 / 4.0),
        yz=zero,
    )


def trunk_screw_moments(outer_radius: Real, height: Real) -> MassMoments[Real]:
    """Of the trunk's screws about the wheel's centre, their heads on the base, as points.

    They stay at 45 degrees to the lateral direction while the foot turns under them, opposite each
    other: as much forward as sideways. Their product of both is the left one's against the right
    one's, and is left out.
    """
    up = BASE_THICKNESS - TRUNK_SCREWS.centre - wheel_height(outer_radius)
    return flat_ring(TRUNK_SCREWS.mass + 0.0 * up, slot_radius(height)).shifted(0.0 * up, up)


def _slots_area(radius: Real) -> Real:
    width = TRUNK_SCREW.clearance_hole
    return pi * radius * width + pi / 2.0 * width**2


def _slots(radius: Real) -> MassMoments[Real]:
    """Both, 45 degrees to either side of the wheel's axis, their middle at the origin.

    Sectors of a ring: int r^3 dr (pi / 4 +- 1 / 2), and half discs at their four ends, each with
    its centroid 4 q / (3 pi) from its flat, away from the wheel's axis.
    """
    half = TRUNK_SCREW.clearance_hole / 2.0
    ring = ((radius + half) ** 4 - (radius - half) ** 4) / 2.0
    ends = pi * half**2 * radius**2 + pi * half**4 / 2.0
    outward = 8.0 / 3.0 * half**3 * radius
    mass = DENSITY * BASE_THICKNESS * _slots_area(radius)
    zero, layer = 0.0 * mass, DENSITY * BASE_THICKNESS
    return MassMoments(
        mass=mass,
        y=zero,
        z=zero,
        xx=layer * (ring * (pi / 4.0 - 0.5) + ends + outward),
        yy=layer * (ring * (pi / 4.0 + 0.5) + ends - outward),
        zz=mass * BASE_THICKNESS**2 / 12.0,
        yz=zero,
    )


def _marks(edge: Real, length: float, count: int) -> MassMoments[Real]:
    """Grooves around a base of that radius, in the plane through their middles."""
    middle = edge - (WALL + length / 2.0)
    mass = DENSITY * count * length * MARK_WIDTH * MARK_DEPTH + 0.0 * edge
    across = mass * (middle**2 + (length**2 + MARK_WIDTH**2) / 12.0) / 2.0
    zero = 0.0 * mass
    return MassMoments(mass, zero, zero, across, across, mass * MARK_DEPTH**2 / 12.0, zero)


_MARKS_VOLUME = (
    MARK_WIDTH * MARK_DEPTH * (_SHORT_MARKS * MARK_LENGTH + _LONG_MARKS * LONG_MARK_LENGTH)
)
