"""Web and hub: closed forms against the solids made of them, and what they ask of a rim."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rims import STEEL, room

from ocs_design.parts.part import total
from ocs_design.parts.rim import (
    LIGAMENT,
    NO_CUTS,
    SHOULDER,
    WEB_DENSITY,
    WEB_MATERIAL,
    WEB_THICKNESS,
    Hub,
    RimCuts,
    wheel_body,
)
from ocs_design.parts.wheel import HoleRing, Rim, Wheel, wheel_parts
from ocs_design.parts.wheel import Hub as MadeHub
from ocs_design.sizing.bound.rim_problem import RimProblem, limits_with_web

BARE = Hub(radius=0.009, height=0.005, bore_radius=0.0015)
BOLTED = replace(BARE, bolts=4, bolt_circle_radius=0.006, bolt_hole_radius=0.0012)


def made(inner, outer, height, hub, cuts=NO_CUTS):
    """The same wheel as solids, rim of steel."""
    bolts = HoleRing(hub.bolt_circle_radius, hub.bolts, hub.bolt_hole_radius) if hub.bolts else None
    ring = None
    if cuts.holes:
        ring = HoleRing((inner + outer) / 2.0, cuts.holes, cuts.hole_radius, cuts.hole_depth)
    rim = Rim(inner, outer, height, "steel", STEEL.density, cuts.chamfer, ring)
    sizes = (WEB_THICKNESS, hub.radius, hub.height, hub.bore_radius)
    made_hub = MadeHub(*sizes, WEB_MATERIAL, WEB_DENSITY, bolts, chamfer=hub.chamfer)
    return total(wheel_parts(Wheel(rim, made_hub)))


@pytest.mark.parametrize("hub", [BARE, BOLTED], ids=["pilot bore", "bolted"])
@given(
    bore=st.floats(0.0101, 0.1),
    wall=st.floats(0.5e-3, 0.05),
    height=st.floats(2.0e-3, 0.05),
)
def test_a_wheel_weighs_and_turns_like_its_solids(hub, bore, wall, height):
    body = wheel_body(bore, bore + wall, height, STEEL.density, hub)
    solids = made(bore, bore + wall, height, hub)
    assert body.mass == pytest.approx(solids.mass, rel=1e-12)
    expected = np.diag([body.transverse_inertia] * 2 + [body.axial_inertia])
    np.testing.assert_allclose(solids.inertia, expected, rtol=1e-9, atol=1e-12 * body.axial_inertia)
    np.testing.assert_allclose(solids.com, 0.0, atol=1e-12)


@given(
    bore=st.floats(0.0101, 0.1),
    wall=st.floats(4.01e-3, 0.05),
    height=st.floats(3.01e-3, 0.05),
    chamfer=st.floats(0.0, 0.5e-3),
    holes=st.sampled_from([0, 3, 8]),
)
def test_what_is_cut_off_a_wheel_is_what_is_cut_off_its_solids(bore, wall, height, chamfer, holes):
    cuts = RimCuts(chamfer, holes, hole_radius=0.5e-3, hole_depth=1e-3)
    hub = replace(BOLTED, chamfer=chamfer)
    assert wall >= cuts.wall_min
    assert height >= cuts.height_min
    body = wheel_body(bore, bore + wall, height, STEEL.density, hub, cuts=cuts)
    solids = made(bore, bore + wall, height, hub, cuts)
    assert body.mass == pytest.approx(solids.mass, rel=1e-12)
    expected = np.diag([body.transverse_inertia] * 2 + [body.axial_inertia])
    np.testing.assert_allclose(solids.inertia, expected, rtol=1e-9, atol=1e-12 * body.axial_inertia)


def test_slopes_of_what_is_cut_off_are_those_of_its_figures():
    """By an imaginary step, which has all digits."""
    cuts, outer = RimCuts(1e-3, 9, hole_radius=0.5e-3, hole_depth=1e-3), 0.03
    for inner in (0.012, 0.02, 0.024):
        beside = inner + 1e-30j
        assert cuts.area_slope() == pytest.approx(cuts.area(beside, outer).imag / 1e-30)
        slope = cuts.spread(beside, outer).imag / 1e-30
        assert cuts.spread_slope(inner, outer) == pytest.approx(slope, rel=1e-12)


def test_without_a_hub_there_is_the_rim_alone():
    rim = wheel_body(0.02, 0.03, 0.01, STEEL.density, None)
    assert rim.mass == pytest.approx(np.pi * STEEL.density * 0.01 * (0.03**2 - 0.02**2))


@pytest.mark.parametrize("density", [1200.0, 2710.0, 7850.0, 17000.0])
def test_a_rim_is_seated_on_its_web_around_its_hub(density):
    alone = RimProblem(1e-4, room(0.05, 0.02), replace(STEEL, density=density), 1000.0).limits
    seated = limits_with_web(alone, 0.012)
    assert seated.inner_radius_min == pytest.approx(0.012 + LIGAMENT)
    # Taller than the web, and than as much of the rim's own material: what turns is then a rim.
    assert seated.height_min >= WEB_THICKNESS + SHOULDER
    assert seated.height_min >= seated.web + SHOULDER
    assert seated.web * density == pytest.approx(WEB_THICKNESS * WEB_DENSITY)


def test_wider_limits_than_the_webs_stay():
    alone = RimProblem(1e-4, room(0.05, 0.02), STEEL, 1000.0).limits
    wide = replace(alone, inner_radius_min=0.03, height_min=0.01)
    seated = limits_with_web(wide, 0.012)
    assert (seated.inner_radius_min, seated.height_min) == (0.03, 0.01)
