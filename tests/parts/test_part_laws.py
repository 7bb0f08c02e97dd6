"""Wheels, housings and feet of any size: one closed body with the closed form's mass."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from part_gaps import overlap_volume, thinnest_wall, turning_clearance
from sample_parts import ALUMINIUM, CAGE, FOOT, HOUSING, STEEL

from ocs_design.actuation.fasteners import SCREWS, BoltCircle
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
few_examples = settings(max_examples=25, deadline=None)


def assert_one_body(part: Part, handles: int) -> None:
    """Check for one closed body with a genus of `handles`, its number of through holes."""
    body, exact = part_manifold(part, SECTIONS), part.mass_properties()
    assert len(body.decompose()) == 1
    assert body.genus() == handles
    assert body.volume() * part.density == pytest.approx(exact.mass, rel=1e-9)
    assert physical_defect(exact) is None


@st.composite
def wheels(draw: st.DrawFn) -> Wheel:
    """Wheels with hub and bolts, of one or two materials."""
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
    """Housings for rims of 10 mm to 200 mm."""
    radius = draw(st.floats(0.01, 0.2))
    mount = MountHoles(0.003, BoltCircle(0.014, draw(st.integers(1, 6)), "M2"))
    return Housing(radius, radius * draw(st.floats(0.1, 1.0)), mount, draw(st.sampled_from(SCREWS)))


@few_examples
@given(wheels())
def test_wheel(wheel):
    bolts = wheel.web.hub.bolts
    parts = wheel_parts(wheel)
    assert len(parts) == (1 if wheel.rim.material == "aluminium" else 2)
    for part in parts:
        assert_one_body(part, 1 if part.name == "rim" else 1 + bolts)
    np.testing.assert_allclose(sum(part.mass_properties().com for part in parts), 0.0, atol=1e-15)


@pytest.mark.slow
@few_examples
@given(housings(), st.floats(0.005, 0.015))
def test_housing_and_foot(housing, thickness):
    holes = 1 + housing.mount.screws.bolts
    drum, lid = housing_parts(housing)
    # The threads in the floor's ears are blind holes.
    assert_one_body(drum, holes)
    assert_one_body(lid, EAR_COUNT)
    assert_one_body(foot_part(Foot(housing, thickness)), holes + 2)


@pytest.mark.slow
@few_examples
@given(wheels())
def test_wheel_turns_in_its_housing(wheel):
    parts = housing_parts(Housing(wheel.rim.outer_radius, wheel.rim.height))
    pieces = wheel_parts(wheel)
    polygon_error = 2.0 * wheel.rim.outer_radius * (2.0 * np.pi / SECTIONS) ** 2 / 8.0
    gap = turning_clearance(pieces, parts, 2.0 * CLEARANCE, SECTIONS)
    assert gap == pytest.approx(CLEARANCE, abs=polygon_error)
    assert all(overlap_volume(one, other, SECTIONS) == 0.0 for one in pieces for other in parts)


PRINTED = *housing_parts(HOUSING), foot_part(FOOT), cage_part(CAGE)


@pytest.mark.parametrize("part", PRINTED, ids=lambda part: part.name)
def test_printed_parts_have_the_least_wall(part):
    """To 1 %, the error of polygons with 128 sections."""
    assert thinnest_wall(part) >= 0.99 * (WALL if part.name in {"foot", "cage"} else PANEL)
