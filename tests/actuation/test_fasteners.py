"""Screws by name, and how long they must be."""

import pytest

from ocs_design.actuation.fasteners import IN_PLASTIC, SCREWS, screw
from ocs_design.common.errors import PartError


@pytest.mark.parametrize(
    ("name", "thickness", "designation"),
    [
        ("M3", 0.005, "ISO 4762 M3 x 8"),
        ("M4", 0.005, "ISO 4762 M4 x 10"),
        ("M3", 0.0051, "ISO 4762 M3 x 10"),
        ("M2.5", 0.0066, "ISO 4762 M2.5 x 10"),
        ("M4", 0.016, "ISO 4762 M4 x 20"),
        ("M4", 0.0161, "ISO 4762 M4 x 25"),
        ("M6", 0.029, "ISO 4762 M6 x 35"),
    ],
)
def test_a_screw_reaches_as_deep_as_it_is_thick(name, thickness, designation):
    found = screw(name)
    assert found.designation(found.length_through(thickness)) == designation


def test_threads_in_plastic_are_twice_as_deep():
    assert screw("M2").length_through(0.0016, IN_PLASTIC) == 0.006


# kg per 1000, Fuller Metric, weight chart of DIN 912 (the weights of ISO 4762 are the same).
MASSES = {
    ("M2", 6): 0.215,
    ("M2.5", 8): 0.465,
    ("M3", 8): 0.8,
    ("M3", 10): 0.9,
    ("M3", 16): 1.2,
    ("M4", 10): 1.8,
    ("M4", 20): 2.7,
    ("M5", 12): 3.0,
    ("M6", 12): 5.1,
    ("M6", 20): 6.5,
}


@pytest.mark.parametrize(("name", "length"), MASSES)
def test_screws_weigh_what_a_maker_says(name, length):
    """Heads are of their largest size here, so that light ones come out heavier by 30 mg."""
    stated = MASSES[name, length] * 1e-3
    assert screw(name).mass(1e-3 * length) == pytest.approx(stated, rel=0.1, abs=5e-5)


def test_every_screw_passes_its_clearance_hole_and_is_cut_into_the_other():
    for found in SCREWS:
        assert found.tapping_drill < found.diameter < found.clearance_hole < found.head_diameter
        assert found.head_height == pytest.approx(found.diameter)


def test_an_unknown_name_gets_those_that_there_are():
    with pytest.raises(PartError, match="M7") as caught:
        screw("M7")
    assert "M2.5" in caught.value.hint
