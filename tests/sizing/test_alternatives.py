"""What one change would save: each figure against a whole selection of the changed question."""

from dataclasses import replace
from functools import cache

import pytest
from commands import SOLO12
from designed import design_of, solo12

import ocs_design.sizing.alternatives
from ocs_design.requirement.device_sections import (
    FlywheelSection,
    MotorSection,
    OcsSection,
    SupplySection,
)
from ocs_design.requirement.kinds import slower
from ocs_design.requirement.maneuver import Flip
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.sizing.alternatives import MORE_TIME, alternatives, built_otherwise
from ocs_design.sizing.design import design_device

ABOUT = 5e-3
"""To which the figures are good: kicks about the centre of mass are settled to a hundredth."""
MOTORS = "MN4014 KV400"
"""One, so that it is quick."""


STATED = Specification(motor=MotorSection(name=MOTORS))


def told_of(task, designed):
    """All that would be lighter, the other construction last."""
    asked = task, designed.choice
    return (*alternatives(*asked), *built_otherwise(*asked))


@cache
def compared(specification, change):
    """The task, the device, and what this change alone would save."""
    task, designed = design_of(specification)
    with pytest.MonkeyPatch.context() as patch:
        look_for(patch, change)
        (found,) = alternatives(task, designed.choice)
    return task, designed, found


def look_for(monkeypatch, text):
    """Of all changes this one alone is looked for."""
    changes = ocs_design.sizing.alternatives._changes
    monkeypatch.setattr(
        "ocs_design.sizing.alternatives._changes",
        lambda *asked: (each for each in changes(*asked) if each.text == text),
    )


def by_hand(task):
    return tuple(
        replace(each, incidence=0.0) if isinstance(each, Flip) else each for each in task.maneuvers
    )


def in_more_time(task):
    return tuple(slower(each, MORE_TIME, task.standing_height) for each in task.maneuvers)


@pytest.mark.parametrize(
    ("change", "section", "of"),
    [
        pytest.param(
            "the incidence with which it is lightest",
            "ocs",
            lambda _: OcsSection(alpha_criterion="lightest"),
            marks=pytest.mark.slow,
        ),
        ("any material", "flywheel", lambda _: FlywheelSection(material="auto")),
        ("modules turned to 0 deg by hand for each flip", "maneuvers", by_hand),
        ("a supply of 48 V", "supply", lambda _: SupplySection(voltage=48.0)),
        ("r_max 60 mm, 20% more", "flywheel", lambda _: FlywheelSection(r_max=0.06)),
        ("10% more time for every maneuver", "maneuvers", in_more_time),
    ],
)
def test_a_change_saves_what_designing_anew_saves(change, section, of):
    task, designed, one = compared(STATED, change)
    asked = design_of(replace(STATED, **{section: of(task)}))[1]
    # What is lighter by less than half a percent is not told.
    assert one.mass_total == pytest.approx(asked.device.mass, rel=ABOUT)
    assert one.mass_total <= designed.device.mass
    if section in {"ocs", "maneuvers"}:
        assert asked.device.mass < designed.device.mass
    if section == "ocs" or of is by_hand:
        assert one.mass_total < designed.device.mass
    assert section != "ocs" or one.note.startswith("alpha ")
    assert section != "supply" or "rated for" in one.note or one.note == "saves nothing"


@pytest.mark.slow
def test_rings_on_a_robot_are_weighed_on_feet_and_a_plate_of_their_own(monkeypatch):
    """Solo12's rings would stand on a heavier plate than its discs."""
    motor = MotorSection(name="Antigravity MN5008 KV400")
    stated = Specification(robot=RobotSection(file=SOLO12), motor=motor)
    task, slow = solo12().with_specification(stated), "10% more time for every maneuver"
    look_for(monkeypatch, slow)
    designed = design_device(task, ranked=False)
    found = told_of(task, designed)
    told = {each.change: each.mass_total for each in found}
    ring = replace(stated, ocs=OcsSection(wheel="ring"))
    longer = replace(stated, maneuvers=in_more_time(task))
    others = {"a ring bonded around each motor's bell in place of the disc": ring, slow: longer}
    for change, asked in others.items():
        whole = design_device(task.with_specification(asked), ranked=False)
        assert told[change] == pytest.approx(whole.device.mass, rel=ABOUT)


def offered(specification):
    """What would be looked for, nothing of it found."""
    task, designed = design_of(specification)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ocs_design.sizing.alternatives.lightest_below", lambda *_: None)
        found = alternatives(task, designed.choice)
    return {each.change for each in found}


def test_nothing_that_is_stated_is_offered_again():
    stated = Specification(
        motor=MotorSection(name=MOTORS),
        flywheel=FlywheelSection(material="auto"),
        ocs=OcsSection(alpha_criterion="lightest"),
        requirement=RequirementSection(fall=(1.0,)),
    )
    found = offered(stated)
    assert found
    assert not {"the incidence with which it is lightest", "any material"} & found
    assert not any("any motor" in change for change in found)


def test_without_maneuvers_nobody_offers_more_time_for_them():
    by_rate = Specification(
        motor=MotorSection(name=MOTORS), requirement=RequirementSection(rate_change=1.0)
    )
    assert not any("time" in change or "flip" in change for change in offered(by_rate))


def test_without_a_motor_there_is_nothing_to_choose():
    assert offered(Specification(motor=MotorSection(name="none"))) == set()


@pytest.mark.slow
def test_any_motor_says_what_nobody_knows_of_it():
    _, designed, one = compared(Specification(), "any motor of the catalogue")
    assert one.mass_total <= designed.device.mass
    assert one.note == "saves nothing" or "not buildable: " in one.note


def test_where_nothing_holds_a_device_a_quick_look_is_told_and_says_so(monkeypatch):
    """The look leaves out only the reserve of its own and what a mast asks of the wheels."""
    change = "modules turned to 0 deg by hand for each flip"
    task, designed, whole = compared(STATED, change)
    look_for(monkeypatch, change)
    # Nothing is told of rings.
    (quick,) = told_of(task, replace(designed, choice=replace(designed.choice, hangs=True)))
    assert quick.change == change
    assert "by a quick look" in quick.note
    assert "by a quick look" not in whole.note
    assert quick.mass_total == pytest.approx(whole.mass_total, rel=0.02)
