"""The shell around a wheel: a drum less its hollow, and slopes against differences."""

import numpy as np
import pytest

from ocs_design.sizing.housing import (
    CLEARANCE,
    DENSITY,
    WALL,
    housing_axial_inertia,
    housing_height,
    housing_mass,
    housing_mass_per_height,
    housing_mass_per_radius,
    housing_outer_radius,
    housing_transverse_inertia,
)

SIZES = [(0.03, 0.01), (0.05, 0.003), (0.012, 0.03)]


def solid(radius, height):
    """Mass and inertias of a full cylinder (any handbook)."""
    mass = np.pi * DENSITY * radius**2 * height
    return np.array([mass, mass * radius**2 / 2.0, mass * (3.0 * radius**2 + height**2) / 12.0])


@pytest.mark.parametrize(("outer_radius", "height"), SIZES)
def test_a_full_drum_less_its_hollow(outer_radius, height):
    radius, tall = outer_radius + CLEARANCE, height + 2.0 * CLEARANCE
    expected = solid(radius + WALL, tall + 2.0 * WALL) - solid(radius, tall)
    own = (housing_mass, housing_axial_inertia, housing_transverse_inertia)
    found = [value(outer_radius, height) for value in own]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_room_for_the_wheel():
    assert housing_outer_radius(0.05) == pytest.approx(0.05 + CLEARANCE + WALL)
    assert housing_height(0.01) == pytest.approx(0.01 + 2.0 * (CLEARANCE + WALL))


@pytest.mark.parametrize(("outer_radius", "height"), SIZES)
def test_slopes(outer_radius, height):
    step = 1e-6
    up, down = housing_mass(outer_radius, height + step), housing_mass(outer_radius, height - step)
    assert housing_mass_per_height(outer_radius) == pytest.approx((up - down) / 2e-6, rel=1e-6)
    up, down = housing_mass(outer_radius + step, height), housing_mass(outer_radius - step, height)
    slope = housing_mass_per_radius(outer_radius, height)
    assert slope == pytest.approx((up - down) / 2e-6, rel=1e-6)


def test_arrays_as_numbers():
    outer, height = np.array(SIZES).T
    masses = [housing_mass(*size) for size in SIZES]
    np.testing.assert_allclose(housing_mass(outer, height), masses, rtol=1e-15)
