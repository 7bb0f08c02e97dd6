"""The printed housing, alone and around the wheel."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from part_gaps import overlap_volume, turning_clearance
from sample_parts import HOUSING, TWO_PIECES
from subsets import fast_subset

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.common.errors import PartError
from ocs_design.parts.cage import NO_POSTS
from ocs_design.parts.housing import (
    Housing,
    PlainDrum,
    housing_mass_per_height,
    housing_moments,
    housing_parts,
    undrilled,
)
from ocs_design.parts.module import Printed
from ocs_design.parts.printed import CLEARANCE, LID_SCREW, PANEL, PETG, WALL, MountHoles
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import wheel_parts

POLYGON_ERROR = 5e-6
"""Largest deviation of the mesh's polygons from circles [m]."""


@given(st.floats(0.01, 0.2), st.floats(0.002, 0.1))
def test_a_housing_without_ears_and_holes_is_a_plain_drum(radius, height):
    """A cylinder less its cavity."""
    body = total(housing_parts(Housing(radius, height)))
    inside, tall = radius + CLEARANCE, height + 2.0 * CLEARANCE
    full = (inside + WALL) ** 2 * (tall + 2.0 * PANEL)
    assert body.mass == pytest.approx(np.pi * PETG.density * (full - inside**2 * tall), rel=1e-12)
    assert body.mass == pytest.approx(PlainDrum().mass(radius, height), rel=1e-12)
    np.testing.assert_allclose(body.com, 0.0, atol=1e-15)


@pytest.mark.parametrize("part", fast_subset(2, housing_parts(HOUSING)[::-1]), ids=["lid", "drum"])
def test_the_wheel_turns_with_its_clearance(part):
    wheel = wheel_parts(TWO_PIECES)
    assert turning_clearance(wheel, [part], 0.01) == pytest.approx(CLEARANCE, abs=POLYGON_ERROR)
    assert all(overlap_volume(piece, part) == 0.0 for piece in wheel)


@pytest.mark.parametrize(
    "pieces", [housing_parts(HOUSING), wheel_parts(TWO_PIECES)], ids=["housing", "wheel"]
)
def test_two_pieces_touch_and_do_not_overlap(pieces):
    assert overlap_volume(*pieces) < 1e-15


def test_holes_that_do_not_fit_the_floor_are_refused():
    wide = MountHoles(0.004, BoltCircle(0.061, 4, "M3"))
    with pytest.raises(PartError, match=r"32\.2 mm") as caught:
        housing_parts(replace(HOUSING, mount=wide))
    assert "outer radius" in caught.value.hint


SIZES = [(0.03, 0.01), (0.05, 0.003), (0.012, 0.03)]


def housing(outer_radius, height):
    return Housing(outer_radius, height, MountHoles(), LID_SCREW)


def housing_mass(outer_radius, height):
    """Mass of drum and lid without the mount's holes."""
    return sum(part.mass() for part in undrilled(housing(outer_radius, height)))


@pytest.mark.parametrize(
    "shell", [PlainDrum(), Printed(0.0), Printed(0.02, guard_wall=0.002, foot_plate=0.009)]
)
@pytest.mark.parametrize(("outer_radius", "height"), SIZES)
def test_mass_per_height_agrees_with_differences(shell, outer_radius, height):
    up, down = (shell.mass(outer_radius, height + step) for step in (1e-6, -1e-6))
    slope = shell.mass_per_height(outer_radius, height)
    assert slope == pytest.approx((up - down) / 2e-6, rel=1e-6)


@pytest.mark.parametrize(("outer_radius", "height"), SIZES)
def test_masses_are_those_of_the_moments(outer_radius, height):
    assert housing_moments(housing(outer_radius, height)).mass == pytest.approx(
        housing_mass(outer_radius, height), rel=1e-12
    )
    plain = PlainDrum().mass(outer_radius, height)
    assert plain < housing_mass(outer_radius, height) < 1.4 * plain
    for walls in ((0.0, 0.005), (0.002, 0.009)):
        shell = Printed(0.01, NO_POSTS, *walls)
        expected = shell.moments(outer_radius, height).mass
        assert shell.mass(outer_radius, height) == pytest.approx(expected, rel=1e-12)


def test_arrays_and_numbers_agree():
    outer, height = np.array(SIZES).T
    masses = [housing_mass(*size) for size in SIZES]
    np.testing.assert_allclose(housing_mass(outer, height), masses, rtol=1e-15)
    slopes = [housing_mass_per_height(size[0]) for size in SIZES]
    np.testing.assert_allclose(housing_mass_per_height(outer), slopes, rtol=1e-15)
    alone = [Printed(0.01).moments(*size).yz for size in SIZES]
    np.testing.assert_allclose(Printed(0.01).moments(outer, height).yz, alone, rtol=1e-12)
