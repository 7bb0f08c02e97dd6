"""Chamfers, balancing holes and lightening holes as specified."""

import pytest
from rims import envelope_with

from ocs_design.common.errors import SpecificationError
from ocs_design.parts.rim import NO_CUTS, RimCuts
from ocs_design.requirement.reading import parse_specification
from ocs_design.sizing.specified import specified_cuts, specified_lightenings

ENVELOPE = envelope_with(0.05, 0.01, inner_radius_min=0.01, height_min=0.002, wall_min=0.002)


def cuts_of(text):
    return specified_cuts(parse_specification(f"[flywheel]\n{text}", "x").flywheel, ENVELOPE)


def test_rims_have_a_chamfer_by_default():
    assert cuts_of("").chamfer == 0.2e-3
    assert cuts_of("").holes == 0


def test_without_a_web_rims_have_no_chamfer():
    assert cuts_of('web = "none"') == NO_CUTS


def test_specified_holes():
    text = 'chamfer = "0.3 mm"\nbalancing_holes = 12\nbalancing_hole_diameter = "2 mm"'
    assert cuts_of(text) == RimCuts(0.3e-3, 12, 1.0e-3, 1.0e-3)


@pytest.mark.parametrize(
    ("text", "count"),
    [("", 6), ("lightening = 0", 0), ("lightening = 7", 7), ('web = "aluminium"', 0)],
)
def test_one_piece_webs_are_lightened_by_default(text, count):
    specified = parse_specification(f"[flywheel]\n{text}", "x").flywheel
    assert max(specified_lightenings(specified)) == count


def refusal(text):
    with pytest.raises(SpecificationError) as caught:
        cuts_of(text)
    return " ".join([caught.value.message, *caught.value.problems])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            'balancing_holes = 6\nbalancing_hole_diameter = "39 mm"',
            "the wall must be at least 41.4 mm",
        ),
        ('balancing_holes = 6\nbalancing_hole_depth = "5 mm"', "the height must be at least 11 mm"),
        ('balancing_holes = 90\nbalancing_hole_diameter = "3 mm"', "0 mm is left between"),
    ],
)
def test_holes_that_do_not_fit_are_refused(text, words):
    message = refusal(text)
    assert words in message
    assert "flywheel.balancing_holes" in message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("balancing_holes = 2", "2 is not 3 to 100, or 0"),
        ('web = "none"\nchamfer = "0.1 mm"', "has no effect where flywheel.web is 'none'"),
        ('chamfer = "2 mm"', "above 0.5 mm"),
        ("lightening = 3", "3 is not one of 0, 5, 6, 7, 8"),
        ('lightening = 6\nweb = "aluminium"', "an aluminium web has no holes"),
        ('lightening = 6\nweb = "none"', "has no effect where flywheel.web is 'none'"),
    ],
)
def test_contradictions_are_refused(text, words):
    assert words in refusal(text)
