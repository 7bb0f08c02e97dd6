"""Web and hub: closed forms against solids, and the limits that they set to a rim."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rims import STEEL, envelope_with

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.parts.rim import (
    LIGHTENED,
    LIGHTENED_STRESS,
    NO_CUTS,
    SHOULDER,
    SHRUNK_WEB_THICKNESS,
    SMALLEST_LIGHTENING,
    SPOKE,
    STEP,
    WEB_THICKNESS,
    HoleRing,
    Hub,
    RimCuts,
    hoop_stress,
    wheel_body,
)
from ocs_design.parts.solids import total
from ocs_design.parts.turning_rings import Ring, holed_peaks
from ocs_design.parts.wheel import Rim, Web, Wheel, wheel_parts
from ocs_design.requirement.vocabulary import LIGHTENINGS
from ocs_design.sizing.bound.rim_problem import RimProblem, limits_with_web, stretch_beside_holes

BARE = Hub(radius=0.009, height=0.005, bore_radius=0.0015)
BOLTED = replace(BARE, bolts=4, bolt_circle_radius=0.006, bolt_hole_radius=0.0012)

ALUMINIUM = 2710.0
"""Density of an aluminium web [kg/m^3]."""

WEBS = pytest.mark.parametrize("web", [None, ALUMINIUM], ids=["one piece", "aluminium web"])


def solids_of(inner, outer, height, hub, web, cuts=NO_CUTS):
    """Mass properties of a wheel's solids, with a steel rim."""
    rim = Rim(inner, outer, height, "steel", STEEL.density, cuts)
    material = ("steel", STEEL.density) if web is None else ("aluminium", web)
    disc = Web(*material, WEB_THICKNESS, np.nan, hub, hub.holes(inner))
    return total(wheel_parts(Wheel(rim, disc)))


def check_against_solids(sizes, hub, web, cuts=NO_CUTS):
    """Check mass and inertia; also the centre, which holes in one face only would shift."""
    body = wheel_body(*sizes, STEEL.density, hub, cuts=cuts, web_density=web)
    solids = solids_of(*sizes, hub, web, cuts)
    assert body.mass == pytest.approx(solids.mass, rel=1e-12)
    expected = np.diag([body.transverse_inertia] * 2 + [body.axial_inertia])
    np.testing.assert_allclose(solids.inertia, expected, rtol=1e-9, atol=1e-12 * body.axial_inertia)
    np.testing.assert_allclose(solids.com, 0.0, atol=1e-12)


@WEBS
@given(
    bore=st.floats(0.0101, 0.1),
    wall=st.floats(4.01e-3, 0.05),
    height=st.floats(3.01e-3, 0.05),
    chamfer=st.floats(0.0, 0.5e-3),
    holes=st.sampled_from([0, 3, 8]),
)
def test_a_wheel_with_chamfers_and_balancing_holes_agrees_with_its_solids(
    web, bore, wall, height, chamfer, holes
):
    cuts = RimCuts(chamfer, holes, hole_radius=0.5e-3, hole_depth=1e-3)
    hub = replace(BOLTED, chamfer=chamfer)
    assert wall >= cuts.wall_min
    assert height >= cuts.height_min
    check_against_solids((bore, bore + wall, height), hub, web, cuts)


COUNTS = [count for count in LIGHTENED if count]


@WEBS
@pytest.mark.parametrize("count", COUNTS)
@given(
    wider=st.floats(1.0, 3.0),
    wall=st.floats(0.5e-3, 0.05),
    height=st.floats(2.0e-3, 0.05),
    radius=st.floats(8.5e-3, 20e-3),
)
def test_a_lightened_wheel_agrees_with_its_solids(web, count, wider, wall, height, radius):
    """It can be made wherever its web has room for the holes."""
    hub = replace(BOLTED, radius=radius, lightening=count)
    bore = wider * hub.bore_min
    check_against_solids((bore, bore + wall, height), hub, web)


@pytest.mark.parametrize("count", COUNTS)
@given(radius=st.floats(2e-3, 30e-3))
def test_bore_min_is_the_least_bore_with_room_for_holes_and_spokes(count, radius):
    hub = replace(BARE, radius=radius, lightening=count)
    least = hub.bore_min

    def has_room(bore, tolerance):
        holes = HoleRing.lightening(count, radius, bore)
        spoke = holes.spoke(radius, bore)
        return min(spoke / SPOKE, holes.hole_radius / SMALLEST_LIGHTENING) >= tolerance

    assert all(has_room(bore, 1.0 - 1e-9) for bore in least * np.geomspace(1.0, 20.0, 200))
    assert not has_room(least * (1.0 - 1e-6), 1.0)
    assert replace(hub, lightening=0).bore_min == 0.0


def test_six_holes_remove_40_percent_of_a_web():
    """Between a hub of 5 mm and a bore of 37 mm, by their areas."""
    hub = replace(BARE, radius=0.005, lightening=6)
    holes = hub.holes(0.037)
    assert 1e3 * holes.hole_radius == pytest.approx(9.466, abs=1e-3)
    web = 0.037**2 - 0.005**2
    assert 6.0 * holes.hole_radius**2 == pytest.approx(0.4 * web)
    solid = wheel_body(0.037, 0.04, 0.005, STEEL.density, replace(hub, lightening=0))
    lighter = solid.mass - wheel_body(0.037, 0.04, 0.005, STEEL.density, hub).mass
    assert lighter == pytest.approx(0.4 * np.pi * STEEL.density * WEB_THICKNESS * web)
    assert replace(hub, lightening=0).holes(0.037) is None


@pytest.mark.slow
@pytest.mark.parametrize("count", COUNTS)
def test_the_stress_beside_holes_is_bounded_relative_to_the_rim(count):
    """By a factor of the rim's hoop stress, for any size."""
    rng, largest = np.random.default_rng(count), 0.0
    for _ in range(150):
        hub = replace(BARE, radius=rng.uniform(3e-3, 16e-3), lightening=count)
        hub = replace(hub, bore_radius=0.4 * hub.radius)
        bore, wall = hub.bore_min * rng.uniform(1.0, 2.0), rng.uniform(0.5e-3, 0.02)
        holes, steel = hub.holes(bore), (7850.0, 205e9, 0.29)
        rings = [
            Ring(hub.bore_radius, hub.radius, hub.height, *steel),
            Ring(hub.radius, bore, WEB_THICKNESS, *steel),
            Ring(bore, bore + wall, rng.uniform(1.6e-3, 0.02), *steel),
        ]
        sizes = (holes.count, holes.circle_radius, holes.hole_radius)
        hoop = hoop_stress(bore, bore + wall, density=7850.0, poisson_ratio=0.29, wheel_speed=1e3)
        largest = max(largest, max(holed_peaks(rings, 1e3, *sizes)) / hoop)
    assert 0.6 * LIGHTENED_STRESS[count] < largest <= LIGHTENED_STRESS[count]


def test_holes_reduce_the_permitted_stress_of_the_rim():
    alone = RimProblem(1e-4, envelope_with(0.05, 0.02), STEEL, 1000.0).limits
    share = stretch_beside_holes(6.5, 2.0)
    assert share == pytest.approx(2.0 / 6.5)
    assert (stretch_beside_holes(6.5, 8.0), stretch_beside_holes(0.0, 2.0)) == (1.0, 1.0)
    holed = limits_with_web(alone, 0.012, lightened=0.4, lightened_bore=0.03, stretch_left=share)
    solid = limits_with_web(alone, 0.012)
    assert holed.stretch_max == pytest.approx(share * solid.stretch_max)
    assert holed.inner_radius_min == 0.03
    # The same share of a disc as the holes leave of a web.
    hub = replace(BARE, lightening=6)
    web = hub.web(0.03, STEEL.density)
    disc = np.pi * STEEL.density * 0.03**2
    assert disc * holed.heavy_web == pytest.approx(web.mass)
    assert disc * holed.web * 0.03**2 / 2.0 == pytest.approx(web.axial_inertia)


def test_all_known_numbers_of_holes_can_be_specified():
    assert set(LIGHTENINGS) == set(LIGHTENED) == set(LIGHTENED_STRESS)


def test_slopes_of_cuts_are_derivatives():
    """By a complex step, without rounding."""
    cuts, outer = RimCuts(1e-3, 9, hole_radius=0.5e-3, hole_depth=1e-3), 0.03
    for inner in (0.012, 0.02, 0.024):
        beside = inner + 1e-30j
        assert cuts.area_slope() == pytest.approx(cuts.area(beside, outer).imag / 1e-30)
        slope = cuts.spread(beside, outer).imag / 1e-30
        assert cuts.spread_slope(inner, outer) == pytest.approx(slope, rel=1e-12)


@pytest.mark.parametrize("density", [1200.0, 2710.0, 7850.0, 17000.0])
def test_limits_with_a_one_piece_or_a_shrunk_aluminium_web(density):
    alone = RimProblem(
        1e-4, envelope_with(0.05, 0.02), replace(STEEL, density=density), 1000.0
    ).limits
    one_piece = limits_with_web(alone, 0.012, RimCuts(chamfer=0.3e-3))
    assert one_piece.inner_radius_min == pytest.approx(0.012 + LIGAMENT)
    assert one_piece.height_min == pytest.approx(WEB_THICKNESS + 0.6e-3 + STEP)
    assert one_piece.web == one_piece.heavy_web == WEB_THICKNESS
    assert one_piece.stretch_max == alone.stretch_max
    seated = limits_with_web(alone, 0.012, web_density=ALUMINIUM)
    assert seated.inner_radius_min == pytest.approx(0.012 + LIGAMENT)
    # Taller than the web, and than its equivalent in the rim's material.
    assert seated.height_min >= SHRUNK_WEB_THICKNESS + SHOULDER
    assert seated.height_min >= seated.web + SHOULDER
    assert seated.web * density == pytest.approx(SHRUNK_WEB_THICKNESS * ALUMINIUM)


def test_tighter_limits_than_the_webs_are_kept():
    alone = RimProblem(1e-4, envelope_with(0.05, 0.02), STEEL, 1000.0).limits
    wide = replace(alone, inner_radius_min=0.03, height_min=0.01)
    seated = limits_with_web(wide, 0.012)
    assert (seated.inner_radius_min, seated.height_min) == (0.03, 0.01)
