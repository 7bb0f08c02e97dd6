"""Searches that failed are not repeated for devices that are harder to hold."""

from dataclasses import replace

import pytest
from commands import SOLO12

from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.footing import mast
from ocs_design.sizing.footing.feet import SENSES, FailedSearches, Feet

FEET = Feet(0.0, (), SENSES, 0.07, 0.04, 0.11, 0.12, 3.0)


@pytest.mark.parametrize("name", ["radius", "slot_radius", "reach", "height", "mass"])
def test_a_failed_search_covers_only_feet_that_are_larger_in_every_way(name):
    searched, robot, failed = [], read_robot(SOLO12), FailedSearches()

    def search(_robot, feet, _layout):
        searched.append(feet)

    larger, smaller = (replace(FEET, **{name: by * getattr(FEET, name)}) for by in (1.1, 0.9))
    for count, feet in ((1, FEET), (1, larger), (2, smaller), (3, replace(FEET, slopes=(1, 1)))):
        assert failed.run(search, robot, feet, PAIR) is None
        assert len(searched) == count


def test_no_mast_is_searched_where_a_smaller_module_had_none(monkeypatch):
    robot, searched, failed = read_robot(SOLO12), [], FailedSearches()

    def search(*arguments):
        searched.append(arguments)

    monkeypatch.setattr(mast, "_mast_place", search)
    pairs = Layout(LayoutName("double-pair"))
    for mass, layout in ((3.0, PAIR), (4.0, PAIR), (2.0, PAIR), (2.5, PAIR), (4.0, pairs)):
        assert mast.footing_behind(robot, replace(FEET, mass=mass), layout, failed) is None
    # Masses are rounded up by at most 2 %.
    assert [feet.mass for _, feet, *_ in searched] == pytest.approx([3.0, 2.0, 4.0], rel=0.03)
