"""Searches that take longest where they fail are not made again for what is harder to hold."""

from dataclasses import replace

import pytest
from commands import SOLO12

from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.footing import mast
from ocs_design.sizing.footing.feet import SENSES, FailedSearches, Feet

FEET = Feet(0.0, (), SENSES, 0.07, 0.04, 0.11, 0.12, 3.0)


@pytest.mark.parametrize("name", ["radius", "slot_radius", "reach", "height", "mass"])
def test_only_what_is_larger_in_all_is_covered(name):
    looked, robot, failed = [], read_robot(SOLO12), FailedSearches()

    def nothing(_robot, feet, _layout):
        looked.append(feet)

    larger, smaller = (replace(FEET, **{name: by * getattr(FEET, name)}) for by in (1.1, 0.9))
    for count, feet in ((1, FEET), (1, larger), (2, smaller), (3, replace(FEET, slopes=(1, 1)))):
        assert failed.found(nothing, robot, feet, PAIR) is None
        assert len(looked) == count


def test_a_mast_that_a_smaller_module_had_not_is_not_looked_for(monkeypatch):
    robot, looked, failed = read_robot(SOLO12), [], FailedSearches()

    def nothing(*asked):
        looked.append(asked)

    monkeypatch.setattr(mast, "_mast_spot", nothing)
    pairs = Layout(LayoutName("double-pair"))
    for mass, layout in ((3.0, PAIR), (4.0, PAIR), (2.0, PAIR), (2.5, PAIR), (4.0, pairs)):
        assert mast.footing_behind(robot, replace(FEET, mass=mass), layout, failed) is None
    # Rounded up by 2 % at most.
    assert [feet.mass for _, feet, *_ in looked] == pytest.approx([3.0, 2.0, 4.0], rel=0.03)
