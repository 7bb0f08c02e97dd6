"""Searches that take longest where they fail are not made again for what is harder to hold."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from commands import SOLO12

from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.robot.reader import read_robot
from ocs_design.sizing import design
from ocs_design.sizing.footing import mast
from ocs_design.sizing.footing.feet import SENSES, Feet, in_vain, looked_for

FEET = Feet(0.0, (), SENSES, 0.07, 0.04, 0.11, 0.12, 3.0)


@pytest.mark.parametrize("name", ["radius", "slot_radius", "reach", "height", "mass"])
def test_only_what_is_larger_in_all_is_covered(name):
    in_vain.cache_clear()
    looked, robot = [], read_robot(SOLO12)

    def nothing(_robot, feet, _layout):
        looked.append(feet)

    larger, smaller = (replace(FEET, **{name: by * getattr(FEET, name)}) for by in (1.1, 0.9))
    for count, feet in ((1, FEET), (1, larger), (2, smaller), (3, replace(FEET, slopes=(1, 1)))):
        assert looked_for(nothing, robot, feet, PAIR) is None
        assert len(looked) == count


def test_a_mast_that_a_smaller_module_had_not_is_not_looked_for(monkeypatch):
    robot, looked = read_robot(SOLO12), []

    def nothing(*asked):
        looked.append(asked)

    monkeypatch.setattr(mast, "_mast_spot", nothing)
    pairs = Layout(LayoutName("double-pair"))
    for mass, layout in ((3.0, PAIR), (4.0, PAIR), (2.0, PAIR), (2.5, PAIR), (4.0, pairs)):
        assert mast.footing_behind(robot, replace(FEET, mass=mass), layout) is None
    # Rounded up by 2 % at most.
    assert [feet.mass for _, feet, *_ in looked] == pytest.approx([3.0, 2.0, 4.0], rel=0.03)


def test_what_was_not_found_for_one_device_is_looked_for_again_for_the_next(monkeypatch):
    class BegunError(Exception):
        pass

    def begins(*_asked, **_options):
        raise BegunError

    robot = read_robot(SOLO12)
    in_vain(robot, PAIR, "behind").append(FEET)
    assert in_vain(robot, PAIR, "behind") == [FEET]
    monkeypatch.setattr(design, "_designed", begins)
    with pytest.raises(BegunError):
        design.design_device(SimpleNamespace(robot=robot))
    assert in_vain(robot, PAIR, "behind") == []
