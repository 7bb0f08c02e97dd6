"""The printed housing by itself, and around the wheel."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_parts import HOUSING, TWO_PIECES
from part_gaps import overlap_volume, turning_clearance

from ocs_design.actuation.fasteners import screw
from ocs_design.actuation.motor import BoltCircle
from ocs_design.common.errors import PartError
from ocs_design.parts.housing import Housing, PlainDrum, housing_parts
from ocs_design.parts.printed import CLEARANCE, DENSITY, PANEL, WALL, MountHoles
from ocs_design.parts.shapes import EAR_COUNT
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import wheel_parts

POLYGONS = 5e-6
"""That the mesh's polygons are off their circles, at most [m]."""


@given(st.floats(0.01, 0.2), st.floats(0.002, 0.1))
def test_without_ears_and_holes_it_is_a_plain_drum(radius, height):
    body = total(housing_parts(Housing(radius, height)))
    assert body.mass == pytest.approx(PlainDrum().mass(radius, height), rel=1e-12)
    np.testing.assert_allclose(body.com, 0.0, atol=1e-15)


def test_ears_and_holes_weigh_what_a_sketch_says():
    plain, made = (total(housing_parts(housing)).mass for housing in (Housing(0.03, 0.01), HOUSING))
    across, m2 = 0.0336, screw("M2")
    side, axis = 0.0012 + WALL, across + 0.0012
    # A rectangle with half a disc at its end, less what of it lies in the band's circle.
    circle = side * np.sqrt(across**2 - side**2) + across**2 * np.arcsin(side / across)
    ear = 2.0 * side * axis + np.pi * side**2 / 2.0 - circle
    inside = 0.01 + 2.0 * CLEARANCE
    ears = EAR_COUNT * ear * (inside + 2.0 * PANEL)
    quarter = np.pi / 4.0
    threads = EAR_COUNT * quarter * m2.tapping_drill**2 * inside
    passages = EAR_COUNT * quarter * m2.clearance_hole**2 * PANEL
    floor = np.pi * PANEL * (0.004**2 + 3 * 0.0017**2)
    assert made - plain == pytest.approx(DENSITY * (ears - threads - passages - floor), rel=1e-11)


@pytest.mark.parametrize("still", housing_parts(HOUSING), ids=["drum", "lid"])
def test_wheel_turns_with_its_clearance(still):
    wheel = wheel_parts(TWO_PIECES)
    assert turning_clearance(wheel, [still], 0.01) == pytest.approx(CLEARANCE, abs=POLYGONS)
    assert all(overlap_volume(part, still) == 0.0 for part in wheel)


def test_drum_and_lid_touch_and_do_not_overlap():
    drum, lid = housing_parts(HOUSING)
    assert overlap_volume(drum, lid) < 1e-15


def test_ears_stand_out_by_a_hole_and_its_wall():
    assert Housing(0.03, 0.01).band.radius == pytest.approx(0.0336)
    assert HOUSING.band.axis + HOUSING.band.side == pytest.approx(0.0336 + 0.0024 + WALL)


def test_holes_that_do_not_fit_the_floor():
    wide = MountHoles(0.004, BoltCircle(0.061, 4, "M3"))
    with pytest.raises(PartError, match=r"32\.2 mm") as caught:
        housing_parts(replace(HOUSING, mount=wide))
    assert "outer radius" in caught.value.hint


@pytest.mark.parametrize(("name", "hole"), [("M2", 2.4), ("M2.5", 2.9), ("M3", 3.4), ("M4", 4.5)])
def test_clearance_holes_of_iso_273_medium(name, hole):
    assert 1e3 * screw(name).clearance_hole == pytest.approx(hole)


def test_unknown_screw_lists_the_known_ones():
    with pytest.raises(PartError, match="'M7'") as caught:
        screw("M7")
    assert "M2, M2.5, M3" in caught.value.hint
