"""The shell around a wheel: what keeps fingers and legs out of it, and carries its motor.

A drum with a floor and a lid, printed, with four ears around the band for the lid's screws. All
functions take the rim's outer radius R and height h [m], scalars or arrays that broadcast, and are
built of operators alone, for CasADi's symbols too. The holes of the motor's mount are not in them
(`sizing.mount`).
"""

from dataclasses import dataclass
from math import pi
from typing import cast

import numpy as np

from ocs_design.fasteners import IN_PLASTIC, Fastening, screw
from ocs_design.sizing.cylinder import cylinder_mass
from ocs_design.sizing.mass_moments import MassMoments, Real, cylinder, ring

WALL = 1.6e-3
"""[m], four lines of a 0.4 mm nozzle: walls and floors that hold screws without infill."""

CLEARANCE = 2.0e-3
"""[m], between rim and shell on all sides: ten times what a printer is out over 100 mm (0.2 %), and
room for a screw's head."""

DENSITY = 1270.0
"""[kg/m^3], of PETG: tougher than PLA, prints without a heated chamber. Prusament PETG, technical
data sheet, Prusa Polymers, 2020: 1.27 g/cm^3."""

LID_SCREW = screw("M2")

EAR_COUNT = 4
"""Between below, above, before and behind, where nothing stands out."""

EAR_RADIUS = LID_SCREW.clearance_hole / 2.0 + WALL
"""Of an ear's round end: a wall around the widest hole [m]."""


LID_SCREWS = Fastening(LID_SCREW, EAR_COUNT, WALL, "lid on drum, which is tapped", IN_PLASTIC)


@dataclass(frozen=True)
class PlainDrum:
    """A closed drum without ears, holes and foot: less than any housing."""

    def mass(self, outer_radius: Real, height: Real) -> Real:
        """Of both discs and the band [kg]."""
        across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
        discs = 2.0 * pi * DENSITY * WALL * across**2
        return discs + cylinder_mass(across - WALL, across, inside, DENSITY)

    def mass_per_height(self, outer_radius: Real, height: Real) -> Real:
        """dm/dh at constant R, of the band [kg/m]."""
        across = housing_outer_radius(outer_radius) + 0.0 * height
        return pi * DENSITY * WALL * (2.0 * across - WALL)


def housing_outer_radius(outer_radius: Real) -> Real:
    """Of the band around a rim [m]."""
    return outer_radius + (CLEARANCE + WALL)


def housing_height(height: Real) -> Real:
    """Of the shell over floor and lid [m]."""
    return height + 2.0 * (CLEARANCE + WALL)


def half_height(height: Real) -> Real:
    """From the wheel's middle to the outside of floor and lid [m]."""
    return height / 2.0 + (CLEARANCE + WALL)


def ear_axis(across: Real) -> Real:
    """Of the lid's screws, whose holes stay outside a band of that radius [m]."""
    return across + LID_SCREW.clearance_hole / 2.0


def housing_mass(outer_radius: Real, height: Real) -> Real:
    """Of drum and lid [kg]."""
    across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
    walls = eared_area(across) * housing_height(height)
    room = pi * (across - WALL) ** 2 * inside
    return DENSITY * (walls - room - EAR_COUNT * (_THREAD * inside + _CLEAR * WALL))


def housing_mass_per_height(outer_radius: Real) -> Real:
    """dm/dh at constant R, of band and ears [kg/m]."""
    across = housing_outer_radius(outer_radius)
    return DENSITY * (eared_area(across) - pi * (across - WALL) ** 2 - EAR_COUNT * _THREAD)


def housing_moments(outer_radius: Real, height: Real) -> MassMoments[Real]:
    """Of drum and lid about the wheel's centre, the floor towards the other module."""
    across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
    room = cylinder(across - WALL, inside, DENSITY)
    walls = eared(across, housing_height(height))
    threads = ear_holes(across, LID_SCREW.tapping_drill / 2.0, inside)
    holes = ear_holes(across, LID_SCREW.clearance_hole / 2.0, WALL + 0.0 * inside)
    lid = holes.shifted(half_height(height) - WALL / 2.0, 0.0 * inside)
    return walls + (room + threads + lid).times(-1.0)


_THREAD, _CLEAR = (
    pi * diameter**2 / 4.0 for diameter in (LID_SCREW.tapping_drill, LID_SCREW.clearance_hole)
)


def lid_screw_moments(outer_radius: Real, height: Real) -> MassMoments[Real]:
    """Of the lid's screws about the wheel's centre, their heads on the lid, as points."""
    radius = ear_axis(housing_outer_radius(outer_radius))
    along = half_height(height) - LID_SCREWS.centre
    return ring(LID_SCREWS.mass + 0.0 * along, radius).shifted(along, 0.0 * along)


def eared_area(across: Real) -> Real:
    """Of a band with its ears: sectors, triangles under the ears, rectangles, half circles [m^2].

    Args:
        across: radius of the band, outside [m].
    """
    side, end = EAR_RADIUS, ear_axis(across)
    root: Real = (across**2 - side**2) ** 0.5
    sectors = across**2 * (pi - EAR_COUNT * _arcsine(side / across))
    return sectors + EAR_COUNT * (side * (2.0 * end - root) + pi / 2.0 * side**2)


def eared(across: Real, length: Real) -> MassMoments[Real]:
    """A band with its ears, solid, its middle at the origin [m]."""
    side, end = EAR_RADIUS, ear_axis(across)
    root: Real = (across**2 - side**2) ** 0.5
    mass = DENSITY * length * eared_area(across)
    sectors = across**4 * (pi - EAR_COUNT * _arcsine(side / across)) / 2.0
    triangle = side * root * (root**2 / 2.0 + side**2 / 6.0)
    rectangle = 2.0 / 3.0 * side * (end**3 - root**3 + side**2 * (end - root))
    tip = side**2 * (pi / 2.0 * end**2 + 4.0 / 3.0 * end * side + pi / 4.0 * side**2)
    polar = sectors + EAR_COUNT * (triangle + rectangle + tip)
    # Four ears have the same about every axis across.
    across_axis, zero = DENSITY * length * polar / 2.0, 0.0 * mass
    return MassMoments(mass, zero, zero, across_axis, mass * length**2 / 12.0, across_axis, zero)


def ear_holes(across: Real, radius: float, length: Real) -> MassMoments[Real]:
    """All of them, their middle at the origin [m]."""
    mass = EAR_COUNT * DENSITY * pi * radius**2 * length
    zero, polar = 0.0 * mass * across, mass * (ear_axis(across) ** 2 + radius**2 / 2.0)
    along = mass * length**2 / 12.0
    return MassMoments(mass, zero, zero, polar / 2.0, along, polar / 2.0, zero)


def _arcsine(sine: Real) -> Real:
    """Of numbers, arrays and CasADi's symbols, which have their own."""
    own = getattr(sine, "arcsin", None)
    return cast(Real, np.arcsin(sine) if own is None else own())
