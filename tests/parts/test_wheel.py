"""The wheel as one or two pieces, its chamfers, and wheels that cannot be made."""

from dataclasses import replace

import numpy as np
import pytest
from sample_parts import ONE_PIECE, RIM, WEB

from ocs_design.common.errors import PartError
from ocs_design.parts.rim import HoleRing, RimCuts
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import Rim, Wheel, wheel_parts


def test_one_and_two_pieces_have_the_same_mass():
    rim = replace(ONE_PIECE.rim, material="other aluminium")
    pieces = wheel_parts(Wheel(rim, ONE_PIECE.web))
    one_piece = wheel_parts(ONE_PIECE)
    assert [part.name for part in one_piece] == ["wheel"]
    assert [part.name for part in pieces] == ["rim", "hub"]
    assert total(pieces).mass == pytest.approx(total(one_piece).mass, rel=1e-14)
    np.testing.assert_allclose(total(pieces).inertia, total(one_piece).inertia, atol=1e-18)


def test_chamfer_leaves_half_of_each_face():
    thin = Rim(0.02, 0.021, 0.01, "steel", 7860.0, RimCuts(1.0))
    flat = Rim(0.02, 0.03, 0.0006, "steel", 7860.0, RimCuts(0.3e-3))
    assert (thin.chamfer, flat.chamfer) == pytest.approx((0.25e-3, 0.15e-3))


def rim(**cuts):
    return replace(RIM, cuts=replace(RIM.cuts, **cuts))


def web(**sizes):
    return replace(WEB, hub=replace(WEB.hub, **sizes))


@pytest.mark.parametrize(
    ("wheel", "clause"),
    [
        ((replace(RIM, inner_radius=0.03), None), "inner radius"),
        ((replace(RIM, height=0.0, cuts=RimCuts()), None), "no height"),
        ((rim(hole_radius=0.0028), None), "inner edge"),
        ((rim(hole_depth=0.005), None), "meet in the middle"),
        ((rim(hole_depth=0.0), None), "no count, size or depth"),
        ((RIM, web(bore_radius=0.011)), "not narrower"),
        ((RIM, web(radius=0.0215)), "leaves no web"),
        ((RIM, replace(web(height=0.02), thickness=0.0098)), "thicker than the rim"),
        ((RIM, web(height=0.001)), "lower than the web"),
        ((RIM, web(bolt_circle_radius=0.004)), "inner edge"),
        ((RIM, web(bolt_circle_radius=0.008)), "outer edge"),
        ((RIM, web(bolts=12)), "too close to each other"),
        ((RIM, replace(WEB, holes=HoleRing(0, 0.016, 0.003))), "no count"),
        ((RIM, replace(WEB, holes=HoleRing(6, 0.016, 0.0055))), "inner edge"),
    ],
)
def test_wheels_that_cannot_be_made_are_explained(wheel, clause):
    with pytest.raises(PartError, match=clause) as caught:
        Wheel(*wheel)
    assert caught.value.hint
