"""The wheel's closed form against sums by hand, and what cannot be made."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_parts import DISC, HUB, ONE_PIECE, RIM, RIM_ALONE, TWO_PIECES
from part_gaps import overlap_volume
from wheels import PAPER_WHEEL

from ocs_design.common.errors import PartError
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import cylinder_spin_inertia
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import HoleRing, Rim, Wheel, wheel_parts

SHARP = Rim(0.022, 0.03, 0.01, "steel", 7860.0, chamfer=0.0)


def chamfers(inner: float, outer: float, edge: float) -> tuple[float, float]:
    """Volume and its moment r^2 dV of the four edges cut off.

    Rings of a right triangle of legs c at radius R: 2 pi times the integral of r (c - s) and
    r^3 (c - s) over s, with r = R - s outside and r + s at the bore.
    """
    volume = moment = 0.0
    for radius, sign in ((outer, -1.0), (inner, 1.0)):
        c = sign * edge
        volume += 4.0 * np.pi * (radius * c**2 / 2.0 + c**3 / 6.0)
        moment += (
            4.0
            * np.pi
            * np.dot(
                [radius**3, 3.0 * radius**2, 3.0 * radius, 1.0],
                [c**2 / 2.0, c**3 / 6.0, c**4 / 12.0, c**5 / 20.0],
            )
        )
    return volume, moment


def test_rim_without_chamfers_is_the_paper_s():
    (rim,) = wheel_parts(Wheel(SHARP))
    body = rim.mass_properties()
    assert body.mass == pytest.approx(PAPER_WHEEL.mass, rel=1e-14)
    assert body.inertia[2, 2] == pytest.approx(PAPER_WHEEL.spin_inertia, rel=1e-14)
    assert body.inertia[0, 0] == pytest.approx(PAPER_WHEEL.transverse_inertia, rel=1e-14)


@given(st.floats(0.0, 2e-3))
def test_chamfers_cost_what_their_rings_weigh(edge):
    (sharp,), (cut,) = wheel_parts(Wheel(SHARP)), wheel_parts(Wheel(replace(SHARP, chamfer=edge)))
    volume, moment = chamfers(0.022, 0.03, edge)
    lost = sharp.mass_properties().mass - cut.mass_properties().mass
    slower = sharp.mass_properties().inertia[2, 2] - cut.mass_properties().inertia[2, 2]
    assert lost == pytest.approx(7860.0 * volume, abs=1e-15)
    assert slower == pytest.approx(7860.0 * moment, abs=1e-18)


def test_hub_is_the_sum_of_its_cylinders_and_holes():
    hub = wheel_parts(TWO_PIECES)[1].mass_properties()
    masses, inertias = (
        form(HUB.bore_radius, HUB.radius, HUB.height, HUB.density)
        + form(HUB.radius, RIM.inner_radius, HUB.web_thickness, HUB.density)
        for form in (cylinder_mass, cylinder_spin_inertia)
    )
    for ring, thickness in ((HUB.bolts, HUB.height), (HUB.lightening, HUB.web_thickness)):
        holes = ring.count * np.pi * ring.hole_radius**2 * thickness * HUB.density
        masses -= holes
        inertias -= holes * (ring.hole_radius**2 / 2.0 + ring.radius**2)
    volume, moment = chamfers(HUB.bore_radius, HUB.radius, HUB.chamfer)
    assert hub.mass == pytest.approx(masses - HUB.density * volume, rel=1e-13)
    assert hub.inertia[2, 2] == pytest.approx(inertias - HUB.density * moment, rel=1e-13)


@pytest.mark.parametrize("wheel", [TWO_PIECES, ONE_PIECE, RIM_ALONE, DISC])
def test_wheel_is_balanced_and_round(wheel):
    body = total(wheel_parts(wheel))
    np.testing.assert_allclose(body.com, 0.0, atol=1e-16)
    off_diagonal = body.inertia - np.diag(np.diag(body.inertia))
    np.testing.assert_allclose(off_diagonal, 0.0, atol=1e-18)
    assert body.inertia[0, 0] == pytest.approx(body.inertia[1, 1], rel=1e-12)


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
    assert Rim(0.02, 0.03, 0.0006, "steel", 7860.0).made_chamfer == pytest.approx(0.15e-3)


def test_first_hole_is_straight_up():
    first = next(HoleRing(0.01, 4, 0.001).prisms(0.0, 1.0).each())
    np.testing.assert_allclose(first.outline.points.mean(axis=0), [0.0, -0.01], atol=1e-17)


@pytest.mark.parametrize(
    ("wheel", "clause"),
    [
        ((replace(RIM, inner_radius=0.03), None), "inner radius"),
        ((replace(RIM, height=0.0, balancing=None), None), "no height"),
        ((replace(RIM, balancing=HoleRing(0.029, 12, 0.001, 0.002)), None), "edge around"),
        ((replace(RIM, balancing=HoleRing(0.026, 12, 0.001, 0.005)), None), "meet in the middle"),
        ((RIM, replace(HUB, bore_radius=0.011)), "not narrower"),
        ((RIM, replace(HUB, radius=0.0215)), "leaves no web"),
        ((RIM, replace(HUB, web_thickness=0.0098, height=0.02)), "thicker than the rim"),
        ((RIM, replace(HUB, height=0.001)), "lower than the web"),
        ((RIM, replace(HUB, bolts=HoleRing(0.004, 4, 0.00145))), "edge inside"),
        ((RIM, replace(HUB, bolts=HoleRing(0.006, 12, 0.00145))), "reach each other"),
        ((RIM, replace(HUB, bolts=HoleRing(0.006, 0, 0.00145))), "no number"),
        ((RIM, replace(HUB, lightening=HoleRing(0.016, 6, 0.0055))), "edge inside"),
    ],
)
def test_what_cannot_be_made_says_why(wheel, clause):
    with pytest.raises(PartError, match=clause) as caught:
        Wheel(*wheel)
    assert caught.value.hint


def test_rim_and_hub_touch_and_do_not_overlap():
    rim, hub = wheel_parts(TWO_PIECES)
    assert overlap_volume(rim, hub) < 1e-15
