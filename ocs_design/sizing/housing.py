"""The shell around a wheel: what keeps fingers and legs out of it, and carries its motor.

A closed drum, two discs and a band, printed. It is a body of revolution about the wheel's axis and
symmetric to the wheel's middle plane. All functions take the rim's outer radius R and height h [m],
scalars or arrays that broadcast, and are built of operators alone, for CasADi's symbols too.
"""

from math import pi
from typing import TypeVar

from ocs_design.arrays import FloatArray
from ocs_design.sizing.cylinder import (
    cylinder_mass,
    cylinder_spin_inertia,
    cylinder_transverse_inertia,
)

WALL = 1.6e-3
"""[m], four lines of a 0.4 mm nozzle: walls and floors that hold screws without infill."""

CLEARANCE = 2.0e-3
"""[m], between rim and shell on all sides: ten times what a printer is out over 100 mm (0.2 %), and
room for a screw's head."""

DENSITY = 1270.0
"""[kg/m^3], of PETG: tougher than PLA, prints without a heated chamber. Prusament PETG, technical
data sheet, Prusa Polymers, 2020: 1.27 g/cm^3."""

Real = TypeVar("Real", float, FloatArray)


def housing_outer_radius(outer_radius: Real) -> Real:
    """Of the shell around a rim [m]."""
    return outer_radius + (CLEARANCE + WALL)


def housing_height(height: Real) -> Real:
    """Of the shell over both discs [m]."""
    return height + 2.0 * (CLEARANCE + WALL)


def housing_mass(outer_radius: Real, height: Real) -> Real:
    """Of both discs and the band [kg]."""
    across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
    return 2.0 * _disc_mass(across) + cylinder_mass(across - WALL, across, inside, DENSITY)


def housing_axial_inertia(outer_radius: Real, height: Real) -> Real:
    """About the wheel's axis [kg m^2]."""
    across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
    band = cylinder_spin_inertia(across - WALL, across, inside, DENSITY)
    return _disc_mass(across) * across**2 + band


def housing_transverse_inertia(outer_radius: Real, height: Real) -> Real:
    """About any axis across it through the wheel's centre (parallel axes) [kg m^2]."""
    across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
    band = cylinder_transverse_inertia(across - WALL, across, inside, DENSITY)
    own = (3.0 * across**2 + WALL**2) / 12.0
    return 2.0 * _disc_mass(across) * (own + (inside + WALL) ** 2 / 4.0) + band


def housing_mass_per_height(outer_radius: Real) -> Real:
    """dm/dh at constant R, of the band [kg/m]."""
    across = housing_outer_radius(outer_radius)
    return pi * DENSITY * WALL * (2.0 * across - WALL)


def housing_mass_per_radius(outer_radius: Real, height: Real) -> Real:
    """dm/dR at constant h, of discs and band [kg/m]."""
    across = housing_outer_radius(outer_radius)
    return pi * DENSITY * WALL * (4.0 * across + 2.0 * (height + 2.0 * CLEARANCE))


def _disc_mass(across: Real) -> Real:
    return pi * DENSITY * WALL * across**2
