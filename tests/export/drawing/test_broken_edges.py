"""What breaking the edges of a rim takes, against Pappus."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_wheels import FLAT
from made_parts import RIM_ALONE, TWO_PIECES

from ocs_design.export.drawing.wheel import BROKEN_EDGE, lost_by_breaking
from ocs_design.export.drawing.wheel_sheet import wheel_sheet


@pytest.mark.parametrize("wheel", [RIM_ALONE, TWO_PIECES])
def test_four_rings_of_triangles_are_lost(wheel):
    """Two legs of c, so c^2 / 2 each, turned about the axis at c / 3 off the edges."""
    rim, c = wheel.rim, BROKEN_EDGE
    rings = np.array([rim.outer_radius - c / 3.0, rim.inner_radius + c / 3.0])
    mass, _ = lost_by_breaking(wheel)
    assert mass == pytest.approx(2.0 * np.pi * c**2 * rim.density * rings.sum(), rel=1e-9)


def test_the_share_is_of_the_whole_wheel():
    rim, c = RIM_ALONE.rim, BROKEN_EDGE
    sharp = np.pi * rim.density * rim.height / 2.0 * (rim.outer_radius**4 - rim.inner_radius**4)
    lost = 2.0 * np.pi * c**2 * rim.density * (rim.outer_radius**3 + rim.inner_radius**3)
    _, share = lost_by_breaking(replace(RIM_ALONE, rim=replace(rim, chamfer=0.0)))
    assert share == pytest.approx(lost / sharp, rel=0.01)
    _, less = lost_by_breaking(TWO_PIECES)
    assert 0.0 < less < share


def test_the_sheet_says_so():
    sharp = replace(FLAT, wheel=replace(FLAT.wheel, rim=replace(FLAT.wheel.rim, chamfer=0.0)))
    words = " ".join(item.text for item in wheel_sheet(sharp) if hasattr(item, "text"))
    mass, share = lost_by_breaking(sharp.wheel)
    assert f"broken 0.2: those of the rim are {1e3 * mass:.2g} g and {100 * share:.2g} %" in words
