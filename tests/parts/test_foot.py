"""The foot under the housing, over the full range of incidence."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_parts import FOOT, HOUSING

from ocs_design.export.meshes import part_manifold
from ocs_design.parts.foot import (
    MARK_DEPTH,
    PLATE_THICKNESS,
    Foot,
    foot_part,
    foot_shock,
    plate_thickness,
    stem_frequency,
)
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.printed import BASE_THICKNESS, CLEARANCE, SHOCK, TRUNK_SCREW, WALL, MountHoles
from ocs_design.parts.solids import Prism


def test_the_plate_touches_the_drum_and_the_base_clears_drum_and_lid():
    drum, lid = (part_manifold(part) for part in housing_parts(HOUSING))
    where = np.column_stack([FOOT.placement.rotation, FOOT.placement.position])
    foot = part_manifold(foot_part(FOOT)).transform(where)
    assert (foot ^ drum).volume() < 1e-15
    assert foot.min_gap(drum, 0.01) == pytest.approx(0.0, abs=1e-9)
    # The lowest line of the band is not a vertex of the polygon: a few um higher.
    assert foot.min_gap(lid, 0.01) == pytest.approx(CLEARANCE, abs=5e-6)


@pytest.mark.parametrize("incidence", np.radians([0.0, 40.0, 90.0]))
@pytest.mark.parametrize("side", [1.0, -1.0], ids=["left", "right"])
def test_trunk_screws_fit_the_slots_at_any_incidence(incidence, side):
    # Two holes in the trunk, at 45 degrees to the wheel's axis for incidence 0, seen from the foot.
    radius, shank = FOOT.slot_radius, TRUNK_SCREW.diameter / 2.0
    for opposite in (0.0, np.pi):
        angle = np.pi / 2.0 + side * np.pi / 4.0 - side * incidence + opposite
        centre = radius * np.array([np.cos(angle), np.sin(angle)])
        edge = centre + shank * 1.13 * np.column_stack(
            [np.cos(np.arange(0.0, 6.2, 0.1)), np.sin(np.arange(0.0, 6.2, 0.1))]
        )
        assert any(contains(slot, edge) for slot in foot_part(FOOT).cut[:2])


def contains(slot: Prism, points) -> bool:
    """Whether all points are within half a width of the slot's centre line."""
    half = TRUNK_SCREW.clearance_hole / 2.0
    middle = np.arctan2(*slot.outline.points.mean(axis=0)[::-1])
    path = middle + np.linspace(-np.pi / 4.0, np.pi / 4.0, 2001)
    along = FOOT.slot_radius * np.column_stack([np.cos(path), np.sin(path)])
    distances = np.linalg.norm(points[:, None] - along, axis=2).min(axis=1)
    return bool(distances.max() <= half + 1e-8)


def test_heads_of_screws_clear_the_plate():
    end = FOOT.slot_radius * np.sin(np.pi / 4.0)
    plate = HOUSING.half_height + PLATE_THICKNESS
    assert end - plate - TRUNK_SCREW.head_diameter / 2.0 == pytest.approx(WALL)


def test_the_base_has_a_mark_every_ten_degrees():
    marks = [cut for cut in foot_part(FOOT).cut if cut.low == BASE_THICKNESS - MARK_DEPTH]
    assert len(marks) == 36
    reach = max(np.linalg.norm(mark.outline.points, axis=1).max() for mark in marks)
    assert reach < FOOT.base_radius
    middles = [mark.outline.points.mean(axis=0) for mark in marks]
    turns = sorted(np.mod(np.degrees([np.arctan2(y, x) for x, y in middles]) + 1e-9, 360.0))
    np.testing.assert_allclose(turns, np.arange(0.0, 360.0, 10.0), atol=1e-8)
    long = [mark for mark in marks if np.ptp(mark.outline.turned(0.0).points, axis=0).max() > 3e-3]
    assert len(long) == 12


def test_the_plate_grows_with_the_mount_and_prints_without_support():
    """Above the stem its disc, which is over the base, overhangs by at most 45 degrees."""
    for foot, wide in ((FOOT, 0.022), (replace(FOOT, housing=Housing(0.03, 0.01)), 0.0168)):
        assert foot.half_width == pytest.approx(wide)
        assert foot.half_width >= foot.housing.mount.reach + 3e-3 - 1e-12
        assert foot.wheel_height - foot.half_width > BASE_THICKNESS
        root = np.sqrt(foot.half_width**2 - foot.stem**2)
        assert foot.stem < foot.half_width
        assert np.degrees(np.arctan2(root, foot.stem)) <= 45.0 + 1e-9


def test_a_stem_yields_where_a_cantilever_does():
    """Half of 0.3 kg x a x H x t over w t^3 / 12, H above the base, against 25 MPa."""
    shock = foot_shock(FOOT, 0.3)
    arm, second = FOOT.wheel_height - 0.003, 2.0 * FOOT.stem * 0.005**3 / 12.0
    assert 0.3 * shock * arm * 0.0025 / second == pytest.approx(25e6)
    assert foot_shock(FOOT, 1.2) == pytest.approx(shock / 4.0)


@pytest.mark.parametrize(
    ("stands", "pull", "thick"), [(None, 129.9, 5.47), (63.26e-3, 135.1, 5.58)]
)
def test_a_base_yields_where_a_screw_bends_it(stands, pull, thick):
    """1.38 kg at 20 g and 61 mm tilt the foot by 16.5 N m, about the edge of its base.

    Its screws, 58.8 mm on either side of the middle, are 8.9 and 126.4 mm from that edge, with a
    tension proportional to the distance: 130 N, 87.0 mm from a stem 48.2 mm wide, for which 5.47 mm
    of 47 MPa suffice. About the edge of a plate of 63.3 mm, 4.5 and 122.0 mm: 135 N and 5.58 mm.
    """
    foot = Foot(Housing(0.05, 0.05, MountHoles(0.0195)), 0.009)
    edge, slot = foot.base_radius, foot.slot_radius
    assert (1e3 * edge, 1e3 * slot) == pytest.approx((67.67, 58.76), abs=0.01)
    moment = 1.38 * 20.0 * 9.80665 * foot.wheel_height
    near, far = (stands or edge) - slot, (stands or edge) + slot
    tension = moment * far / (near**2 + far**2)
    assert (moment, tension) == pytest.approx((16.51, pull), rel=2e-3)
    arm, width = slot + foot.housing.half_height, 2.0 * foot.stem
    needed = np.sqrt(6.0 * tension * arm / (width * 47e6))
    assert 1e3 * needed == pytest.approx(thick, abs=0.01)
    assert foot_shock(foot, 1.38, stands) == pytest.approx(SHOCK * (foot.base / needed) ** 2)


def shock_on_plate(foot: Foot, mass: float) -> float:
    """Shock that a foot withstands on a carrier plate, whose edge is 4.5 mm outside its slots."""
    return foot_shock(foot, mass, min(foot.base_radius, foot.slot_radius + 4.5e-3))


def test_a_foot_is_as_thick_as_its_load_requires():
    """Go2's module, 1.35 kg: stem and base withstand 20 g, and not with 0.1 mm less."""
    housing = Housing(0.0765, 0.0153, MountHoles(0.0495))
    thickness = plate_thickness(Foot(housing), 1.35)
    assert thickness == 0.0084
    assert shock_on_plate(Foot(housing, thickness), 1.35) >= SHOCK
    assert shock_on_plate(Foot(housing, thickness - 1e-4), 1.35) < SHOCK
    assert 1e3 * Foot(housing, thickness).base == pytest.approx(0.6 * 8.4)
    assert Foot(housing).base == BASE_THICKNESS
    assert type(Foot(housing, thickness).wheel_height) is float


@given(st.floats(0.01, 0.2), st.floats(0.1, 1.0), st.floats(0.01, 50.0))
def test_a_foot_withstands_the_shock_or_is_a_solid_block(radius, share, mass):
    housing = Housing(radius, radius * share)
    thickness = plate_thickness(Foot(housing), mass)
    foot = Foot(housing, thickness)
    block = max(PLATE_THICKNESS, foot.stem)
    assert PLATE_THICKNESS <= thickness <= block
    assert shock_on_plate(foot, mass) >= SHOCK or thickness == block
    if thickness > PLATE_THICKNESS:
        assert shock_on_plate(Foot(housing, thickness - 1e-4), mass) < SHOCK
    assert plate_thickness(foot, mass) == thickness <= plate_thickness(foot, 1.1 * mass)


def test_frequency_of_a_stem_is_that_of_a_cantilever():
    """Without load 3 % above the exact 0.5596 sqrt(E I / m L^3); else sqrt(3 E I / m L^3)."""
    arm, width = FOOT.wheel_height - 0.003, 2.0 * FOOT.stem
    bending = 1.8e9 * width * 0.005**3 / 12.0
    stem_mass = 1270.0 * width * 0.005 * arm
    exact = 0.5596 * np.sqrt(bending / (stem_mass * arm**3))
    assert exact < stem_frequency(FOOT, 0.0, 0.0) < 1.03 * exact
    heavy = np.sqrt(3.0 * bending / (100.0 * arm**3)) / (2.0 * np.pi)
    assert stem_frequency(FOOT, 100.0, 0.0) == pytest.approx(heavy, rel=1e-3)
    assert stem_frequency(FOOT, 0.3, 1e-4) < stem_frequency(FOOT, 0.3, 0.0)
    twice = stem_frequency(replace(FOOT, thickness=0.01), 100.0, 0.0)
    assert twice == pytest.approx(np.sqrt(8.0) * heavy, rel=1e-3)
