"""Screws by name, and how long they must be."""

import pytest

from ocs_design.exceptions import PartError
from ocs_design.fasteners import SCREWS, screw


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
    assert screw(name).through(thickness) == designation


def test_every_screw_passes_its_clearance_hole_and_is_cut_into_the_other():
    for found in SCREWS:
        assert found.tapping_drill < found.diameter < found.clearance_hole < found.head_diameter
        assert found.head_height == pytest.approx(found.diameter)


def test_an_unknown_name_gets_those_that_there_are():
    with pytest.raises(PartError, match="M7") as caught:
        screw("M7")
    assert "M2.5" in caught.value.hint
