"""The wheel's closed form against sums by hand, and what cannot be made."""

from dataclasses import replace

import numpy as np
import pytest
from made_parts import HUB, ONE_PIECE, RIM

from ocs_design.common.errors import PartError
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import HoleRing, Rim, Wheel, wheel_parts


def test_one_material_is_one_piece_of_the_same_mass():
    rim, hub = replace(ONE_PIECE.rim), ONE_PIECE.hub
    pieces = wheel_parts(Wheel(replace(rim, material="other aluminium"), hub))
    whole = wheel_parts(ONE_PIECE)
    assert [part.name for part in whole] == ["wheel"]
    assert [part.name for part in pieces] == ["rim", "hub"]
    assert total(pieces).mass == pytest.approx(total(whole).mass, rel=1e-14)
    np.testing.assert_allclose(total(pieces).inertia, total(whole).inertia, atol=1e-18)


def test_chamfer_leaves_half_of_each_face():
    assert Rim(0.02, 0.021, 0.01, "steel", 7860.0, chamfer=1.0).made_chamfer == pytest.approx(
        0.25e-3
    )
    assert Rim(0.02, 0.03, 0.0006, "steel", 7860.0, chamfer=0.3e-3).made_chamfer == pytest.approx(
        0.15e-3
    )


@pytest.mark.parametrize(
    ("wheel", "clause"),
    [
        ((replace(RIM, inner_radius=0.03), None), "inner radius"),
        ((replace(RIM, height=0.0, balancing=None), None), "no height"),
        ((replace(RIM, balancing=HoleRing(0.029, 12, 0.001, 0.002)), None), "outer edge"),
        ((replace(RIM, balancing=HoleRing(0.026, 12, 0.001, 0.005)), None), "meet in the middle"),
        ((RIM, replace(HUB, bore_radius=0.011)), "not narrower"),
        ((RIM, replace(HUB, radius=0.0215)), "leaves no web"),
        ((RIM, replace(HUB, web_thickness=0.0098, height=0.02)), "thicker than the rim"),
        ((RIM, replace(HUB, height=0.001)), "lower than the web"),
        ((RIM, replace(HUB, bolts=HoleRing(0.004, 4, 0.00145))), "inner edge"),
        ((RIM, replace(HUB, bolts=HoleRing(0.006, 12, 0.00145))), "too close to each other"),
        ((RIM, replace(HUB, bolts=HoleRing(0.006, 0, 0.00145))), "no count"),
        ((RIM, replace(HUB, lightening=HoleRing(0.016, 6, 0.0055))), "inner edge"),
    ],
)
def test_what_cannot_be_made_says_why(wheel, clause):
    with pytest.raises(PartError, match=clause) as caught:
        Wheel(*wheel)
    assert caught.value.hint
