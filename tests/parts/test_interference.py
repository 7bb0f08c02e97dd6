"""Gaps and overlaps of parts whose distances are known."""

import numpy as np
import pytest
from made_parts import TWO_PIECES
from part_gaps import overlap_volume, turning_clearance

from ocs_design.parts.shapes import Rectangle
from ocs_design.parts.solids import Part, Prism, hollow_cylinder
from ocs_design.parts.wheel import wheel_parts

BAND = Part("band", 1.0, (hollow_cylinder(0.032, 0.034, -0.01, 0.01),))


def test_rim_and_hub_touch_and_do_not_overlap():
    rim, hub = wheel_parts(TWO_PIECES)
    assert overlap_volume(rim, hub) < 1e-15


def test_overlap_of_two_cylinders():
    one = Part("one", 1.0, (hollow_cylinder(0.0, 0.02, 0.0, 0.02),))
    other = Part("other", 1.0, (hollow_cylinder(0.01, 0.03, 0.015, 0.03),))
    expected = np.pi * (0.02**2 - 0.01**2) * 0.005
    assert overlap_volume(one, other) == pytest.approx(expected, rel=1e-9)


def test_gap_to_a_band_both_ways():
    wheel = wheel_parts(TWO_PIECES)
    # Polygons of 256 sections are 2 um off their circles.
    assert turning_clearance(wheel, [BAND], 0.01) == pytest.approx(0.002, abs=5e-6)


def test_gap_to_a_block_that_the_wheel_only_passes():
    block = Part(
        "block",
        1.0,
        (Prism(Rectangle(0.031, 0.04, -0.001, 0.001), -0.002, 0.002),),
    )
    gap = turning_clearance(wheel_parts(TWO_PIECES), [block], 0.01)
    assert gap == pytest.approx(0.001, abs=5e-6)


def test_gap_beyond_reach():
    far = Part("far", 1.0, (Prism(Rectangle(1.0, 1.1, 0.0, 0.1), 0.0, 0.1),))
    assert turning_clearance(wheel_parts(TWO_PIECES), [far], 0.01) == pytest.approx(0.01)
