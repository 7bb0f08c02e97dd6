"""Searches that take longest where they fail are not made again for what is harder to hold."""

from dataclasses import replace

import pytest
from commands import SOLO12

from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.robot.reader import read_robot
from ocs_design.sizing import design
from ocs_design.sizing.footing import mast
from ocs_design.sizing.footing.feet import SENSES, Feet, InVain, in_vain

FEET = Feet(0.0, (), SENSES, 0.07, 0.04, 0.11, 0.12, 3.0)


@pytest.mark.parametrize("name", ["radius", "slot_radius", "reach", "height", "mass"])
def test_only_what_is_larger_in_all_is_covered(name):
    vain = InVain([FEET])
    larger = {name: 1.1 * getattr(FEET, name)}
    assert vain.covers(FEET)
    assert vain.covers(replace(FEET, **larger))
    smaller = replace(FEET, **{name: 0.9 * getattr(FEET, name)})
    assert not vain.covers(smaller)
    assert not vain.covers(replace(FEET, slopes=(1.0, 1.0)))


def test_a_mast_that_a_smaller_module_had_not_is_not_looked_for(monkeypatch):
    robot, looked = read_robot(SOLO12), []

    def nothing(*asked):
        looked.append(asked)

    monkeypatch.setattr(mast, "_mast_spot", nothing)
    pairs = Layout(LayoutName("double-pair"))
    for mass, layout in ((3.0, PAIR), (4.0, PAIR), (2.0, PAIR), (2.5, PAIR), (4.0, pairs)):
        assert mast.footing_behind(robot, replace(FEET, mass=mass), layout) is None
    # Rounded up by 2 % at most.
    assert [feet.mass for _, feet, _ in looked] == pytest.approx([3.0, 2.0, 4.0], rel=0.03)


def test_what_was_not_found_for_one_device_is_looked_for_again_for_the_next(monkeypatch):
    class BegunError(Exception):
        pass

    def begins(*_asked, **_options):
        raise BegunError

    robot = read_robot(SOLO12)
    in_vain(robot, PAIR, "behind").tried.append(FEET)
    assert in_vain(robot, PAIR, "behind").covers(FEET)
    monkeypatch.setattr(design, "_designed", begins)
    with pytest.raises(BegunError):
        design.design_device(None, robot, None)
    assert not in_vain(robot, PAIR, "behind").covers(FEET)
