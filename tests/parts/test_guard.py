"""The energy of a burst rim's fragments, and the wall that contains them."""

from math import ceil, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.parts.guard import PIECES, Containment, fragment_of, steel_wall
from ocs_design.parts.housing import Housing

RIM = {"inner_radius": 0.040, "outer_radius": 0.044, "height": 0.006}


def fragment(rim_mass=0.05, web_mass=0.0, wheel_speed=1000.0, **sizes):
    return fragment_of(
        **{**RIM, **sizes}, rim_mass=rim_mass, web_mass=web_mass, wheel_speed=wheel_speed
    )


def test_the_wall_agrees_with_the_source_in_its_units():
    """A rod of 8 lb and 1 in at 135 ft/s: 2266 ft lbf, T = 172.5 / 672 = 0.2567 in, times 1.25."""
    energy = 0.5 * 8.0 * 0.45359237 * (135.0 * 0.3048) ** 2
    assert steel_wall(energy, 0.0254) == pytest.approx(1.25 * 0.2567 * 0.0254, rel=2e-4)


@given(st.floats(0.1, 1e4), st.floats(1e-3, 0.1))
def test_a_wall_grows_with_energy_and_shrinks_with_the_missiles_size(energy, size):
    assert steel_wall(8.0 * energy, size) == pytest.approx(4.0 * steel_wall(energy, size))
    assert steel_wall(energy, 2.0 * size) == pytest.approx(0.5 * steel_wall(energy, size))


def test_speed_and_energy_of_a_fragment_by_brute_force():
    """Centre of mass of a sector of 120 degrees of rim and web, from many points."""
    count = 400
    angles = (np.arange(count) + 0.5) / count * 2.0 * pi / PIECES - pi / PIECES
    radii = 0.040 + 0.004 * (np.arange(count) + 0.5) / count
    along = np.average(np.outer(radii, np.cos(angles)), weights=np.outer(radii, np.ones(count)))
    assert fragment().speed == pytest.approx(1000.0 * along, rel=1e-5)
    radii = 0.040 * (np.arange(count) + 0.5) / count
    web = np.average(np.outer(radii, np.cos(angles)), weights=np.outer(radii, np.ones(count)))
    both = fragment(rim_mass=0.03, web_mass=0.01)
    assert both.speed == pytest.approx(1000.0 * (0.75 * along + 0.25 * web), rel=1e-5)
    assert both.mass == pytest.approx(0.04 / 3.0)
    assert both.energy == pytest.approx(0.5 * both.mass * both.speed**2)


def test_no_other_number_of_fragments_has_one_percent_more_energy():
    """Each of n has (1/n) (sin a / a)^2 of the rim's mass and speed squared, a = pi / n."""
    shares = {n: (sin(pi / n) / (pi / n)) ** 2 / n for n in range(2, 50)}
    assert max(shares.values()) <= 1.01 * shares[PIECES]


def test_the_guard_ring_encloses_the_rim():
    """1.9 mm of clearance around a rim of 44 mm, and 2 mm on both sides of its 6 mm."""
    housing = Housing(0.044, 0.006)
    guard = Containment.of(fragment(), housing.guard_radius, housing.guard_height)
    assert guard.inner_radius == pytest.approx(0.0459)
    assert guard.height == pytest.approx(0.010)
    assert guard.aluminium > guard.steel == steel_wall(fragment().energy, fragment().diameter)
    # The wall is rounded up to 0.1 mm.
    assert 0.0 <= guard.built_wall - guard.steel < 1e-4
    assert guard.built_wall / 1e-4 == pytest.approx(round(guard.built_wall / 1e-4))
    outer = 0.0459 + guard.built_wall
    steel, aluminium = guard.masses
    assert steel == pytest.approx(7850.0 * pi * (outer**2 - 0.0459**2) * 0.010)
    wall = 1e-4 * ceil(guard.aluminium / 1e-4)
    assert aluminium == pytest.approx(2710.0 * pi * ((0.0459 + wall) ** 2 - 0.0459**2) * 0.010)
    assert fragment().diameter == pytest.approx(2.0 * (0.004 * 0.006 / pi) ** 0.5)
