"""Closed forms of a hollow cylinder that spins about its axis (docs/theory.md, The rim).

Radii and heights are in metres, densities in kg/m^3; scalars or arrays that broadcast. Sources:
masses and inertias by integration, as in any handbook; stresses from Budynas and Nisbett,
Shigley's Mechanical Engineering Design, "Stresses in Rotating Rings".
"""

from typing import TypeVar

import numpy as np

from ocs_design.arrays import FloatArray

Real = TypeVar("Real", float, FloatArray)


def cylinder_mass(inner_radius: Real, outer_radius: Real, height: Real, density: float) -> Real:
    """m = pi rho h (R^2 - r^2) [kg]."""
    return np.pi * density * height * (outer_radius**2 - inner_radius**2)


def cylinder_spin_inertia(
    inner_radius: Real, outer_radius: Real, height: Real, density: float
) -> Real:
    """About the axis: m (R^2 + r^2) / 2 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (outer_radius**2 + inner_radius**2) / 2.0


def cylinder_transverse_inertia(
    inner_radius: Real, outer_radius: Real, height: Real, density: float
) -> Real:
    """Across the axis through the centre of mass: m (3 (R^2 + r^2) + h^2) / 12 [kg m^2]."""
    mass = cylinder_mass(inner_radius, outer_radius, height, density)
    return mass * (3.0 * (outer_radius**2 + inner_radius**2) + height**2) / 12.0


def hoop_stress(
    inner_radius: Real,
    outer_radius: Real,
    *,
    density: float,
    poisson_ratio: float,
    wheel_speed: float,
) -> Real:
    """Largest tangential stress, which is at the bore [Pa].

    rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2). With r -> 0 it is that of a disc with a pin hole,
    twice that of a solid one.
    """
    stretch = (3.0 + poisson_ratio) * outer_radius**2 + (1.0 - poisson_ratio) * inner_radius**2
    return density * wheel_speed**2 / 4.0 * stretch


def radial_stress(
    inner_radius: Real,
    outer_radius: Real,
    *,
    density: float,
    poisson_ratio: float,
    wheel_speed: float,
) -> Real:
    """Largest radial stress, at the radius sqrt(r R): rho w^2 (3 + nu) / 8 (R - r)^2 [Pa]."""
    wall = outer_radius - inner_radius
    return density * wheel_speed**2 * (3.0 + poisson_ratio) / 8.0 * wall**2


def stored_energy(spin_inertia: Real, wheel_speed: float) -> Real:
    """I_w w^2 / 2 [J]."""
    return spin_inertia * wheel_speed**2 / 2.0
