"""Wheels, housings and feet of any size: one closed body, of the mass that the closed form says."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from part_gaps import overlap_volume, thinnest_wall, turning_clearance
from sample_parts import ALUMINIUM, CAGE, FOOT, HOUSING, STEEL

from ocs_design.actuation.fasteners import SCREWS
from ocs_design.actuation.motor import BoltCircle
from ocs_design.common.errors import PartError
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.printed import CLEARANCE, PANEL, WALL, MountHoles
from ocs_design.parts.rim import Hub, RimCuts
from ocs_design.parts.shapes import EAR_COUNT
from ocs_design.parts.solids import Part
from ocs_design.parts.wheel import Rim, Web, Wheel, wheel_parts
from ocs_design.robot.mass import physical_defect

SECTIONS = 48
few = settings(max_examples=25, deadline=None)


def assert_one_body(part: Part, handles: int) -> None:
    """`handles`: through holes, as a topologist counts them."""
    body, exact = part_manifold(part, SECTIONS), part.mass_properties()
    assert len(body.decompose()) == 1
    assert body.genus() == handles
    assert body.volume() * part.density == pytest.approx(exact.mass, rel=1e-9)
    assert physical_defect(exact) is None


@st.composite
def wheels(draw: st.DrawFn) -> Wheel:
    """With hub and bolts, of one material or two."""
    outer = draw(st.floats(0.012, 0.2))
    rim = Rim(
        outer * draw(st.floats(0.3, 0.95)),
        outer,
        outer * draw(st.floats(0.05, 1.0)),
        draw(st.sampled_from(["aluminium", "steel"])),
        draw(st.sampled_from([ALUMINIUM, STEEL])),
        RimCuts(0.3e-3),
    )
    bore = draw(st.floats(0.0005, 0.004))
    bolts = draw(st.sampled_from([(), (4, bore + 0.004, 0.0012)]))
    try:
        thickness = min(1.5e-3, rim.height - 2.0 * rim.chamfer)
        radius = (bolts[1] + bolts[2] if bolts else bore) + 2e-3
        height = max(thickness, min(6e-3, rim.height))
        hub = Hub(radius, height, bore, *bolts)
        return Wheel(rim, Web("aluminium", ALUMINIUM, thickness, np.nan, hub))
    except PartError:
        assume(False)
        raise


@st.composite
def housings(draw: st.DrawFn) -> Housing:
    """From a rim of 10 mm to one of 200."""
    radius = draw(st.floats(0.01, 0.2))
    mount = MountHoles(0.003, BoltCircle(0.014, draw(st.integers(1, 6)), "M2"))
    return Housing(radius, radius * draw(st.floats(0.1, 1.0)), mount, draw(st.sampled_from(SCREWS)))


@few
@given(wheels())
def test_wheel(wheel):
    bolts = wheel.web.hub.bolts
    parts = wheel_parts(wheel)
    assert len(parts) == (1 if wheel.rim.material == "aluminium" else 2)
    for part in parts:
        assert_one_body(part, 1 if part.name == "rim" else 1 + bolts)
    np.testing.assert_allclose(sum(part.mass_properties().com for part in parts), 0.0, atol=1e-15)


@pytest.mark.slow
@few
@given(housings(), st.floats(0.005, 0.015))
def test_housing_and_foot(housing, thickness):
    holes = 1 + housing.mount.screws.bolts
    drum, lid = housing_parts(housing)
    # The threads end on the floor's ears: blind.
    assert_one_body(drum, holes)
    assert_one_body(lid, EAR_COUNT)
    assert_one_body(foot_part(Foot(housing, thickness)), holes + 2)


@pytest.mark.slow
@few
@given(wheels())
def test_wheel_turns_in_its_housing(wheel):
    parts = housing_parts(Housing(wheel.rim.outer_radius, wheel.rim.height))
    made = wheel_parts(wheel)
    polygons = 2.0 * wheel.rim.outer_radius * (2.0 * np.pi / SECTIONS) ** 2 / 8.0
    gap = turning_clearance(made, parts, 2.0 * CLEARANCE, SECTIONS)
    assert gap == pytest.approx(CLEARANCE, abs=polygons)
    assert all(overlap_volume(one, other, SECTIONS) == 0.0 for one in made for other in parts)


PRINTED = *housing_parts(HOUSING), foot_part(FOOT), cage_part(CAGE)


@pytest.mark.parametrize("part", PRINTED, ids=lambda part: part.name)
def test_printed_parts_have_the_stated_wall(part):
    """But for a hundredth, which polygons of 128 sections cost."""
    assert thinnest_wall(part) >= 0.99 * (WALL if part.name in {"foot", "cage"} else PANEL)
