"""What one change would save: each figure against a whole selection of the changed question."""

from dataclasses import replace
from functools import cache

import pytest
from commands import SOLO12
from designed_devices import design_of, solo12

from ocs_design.requirement.device_sections import (
    FlywheelSection,
    MotorSection,
    OcsSection,
    SupplySection,
)
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.turns import Flip
from ocs_design.sizing.alternatives import (
    alternative_construction,
    find_driving_maneuver,
    start_alternatives,
    variants,
)
from ocs_design.sizing.changes import MORE_TIME
from ocs_design.sizing.design import design_device

ABOUT = 5e-3
"""To which the figures are good: kicks about the centre of mass are settled to a hundredth."""
MOTORS = "MN4014 KV400"
"""One, so that it is quick."""


STATED = Specification(motor=MotorSection(name=MOTORS))


@cache
def compared(specification, change):
    """The task, the device, and what this change alone would save."""
    task, designed = design_of(specification)
    return task, designed, saved(task, designed.choice, change)


def saved(task, choice, text):
    """What the change with this text would save."""
    (variant,) = [each for each in variants(task, choice) if each.text == text]
    return variant.alternative()


def by_hand(task):
    return tuple(
        replace(each, incidence=0.0) if isinstance(each, Flip) else each for each in task.maneuvers
    )


def in_more_time(task):
    return tuple(
        each.slower(1.0 + MORE_TIME / 100.0, task.standing_height) for each in task.maneuvers
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "section", "of"),
    [
        (
            "the incidence of the lightest device",
            "ocs",
            lambda _: OcsSection(alpha_criterion="lightest"),
        ),
        ("any material", "flywheel", lambda _: FlywheelSection(material="auto")),
        ("modules turned to 0 deg by hand for each flip", "maneuvers", by_hand),
        ("a supply of 48 V", "supply", lambda _: SupplySection(voltage=48.0)),
        ("r_max 60 mm in place of 50 mm", "flywheel", lambda _: FlywheelSection(r_max=0.06)),
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
def test_rings_on_a_robot_are_weighed_on_feet_and_a_plate_of_their_own():
    """Solo12's rings would stand on a heavier plate than its discs."""
    motor = MotorSection(name="Antigravity MN5008 KV400")
    specified = Specification(robot=RobotSection(file=SOLO12), motor=motor)
    task = solo12().with_specification(specified)
    (told,) = alternative_construction(task, design_device(task, ranked=False).choice)
    assert told.change == "a ring bonded around each motor's bell in place of the disc"
    ring = task.with_specification(replace(specified, ocs=OcsSection(wheel="ring")))
    whole = design_device(ring, ranked=False).device
    assert told.mass_total == pytest.approx(whole.mass, rel=ABOUT)


def offered(specification):
    """What would be looked for."""
    task, designed = design_of(specification)
    return {each.text for each in variants(task, designed.choice)}


@pytest.mark.slow
def test_nothing_that_is_stated_is_offered_again():
    specified = Specification(
        motor=MotorSection(name=MOTORS),
        flywheel=FlywheelSection(material="auto"),
        ocs=OcsSection(alpha_criterion="lightest"),
        requirement=RequirementSection(fall=(1.0,)),
    )
    found = offered(specified)
    assert found
    assert not {"the incidence of the lightest device", "any material"} & found
    assert not any("any motor" in change for change in found)


def test_without_maneuvers_nobody_offers_more_time_for_them():
    by_rate = Specification(
        motor=MotorSection(name=MOTORS), requirement=RequirementSection(rate_change=1.0)
    )
    assert not any("time" in change or "flip" in change for change in offered(by_rate))


def test_without_a_motor_there_is_nothing_to_choose():
    task, designed = design_of(Specification(motor=MotorSection(name="none")))
    assert start_alternatives(task, designed.choice)() == ((), None)


@pytest.mark.slow
def test_any_motor_says_what_nobody_knows_of_it():
    _, designed, one = compared(Specification(), "any motor of the catalogue")
    assert one.mass_total <= designed.device.mass
    assert one.note == "saves nothing" or "not buildable: " in one.note


@pytest.mark.slow
def test_where_nothing_holds_a_device_a_quick_look_is_told_and_says_so():
    """The look leaves out only the reserve of its own and what a mast asks of the wheels."""
    change = "modules turned to 0 deg by hand for each flip"
    task, designed, whole = compared(STATED, change)
    hanging = replace(designed.choice, lacks_mount=True)
    quick = saved(task, hanging, change)
    assert "by a quick look" in quick.note
    assert "by a quick look" not in whole.note
    assert quick.mass_total == pytest.approx(whole.mass_total, rel=0.02)
    assert alternative_construction(task, hanging) == ()


def test_calls_are_begun_at_once_and_their_answers_told_in_order():
    """As other processes answer them: the last one first, which none may have begun."""
    task, designed = design_of(STATED)
    begun, asked = [], []

    def call(function, *args):
        number = len(begun)
        begun.append(function.__qualname__)
        is_last = function is find_driving_maneuver
        answer = (
            "driving" if is_last else ("rings",) if function is alternative_construction else number
        )
        return lambda: (asked.append(number), answer)[1]

    answers = start_alternatives(task, designed.choice, call)
    assert not asked
    found, driving = answers()
    assert asked == list(range(len(begun)))[::-1]
    assert found == (*range(1, len(begun) - 1), "rings")
    assert driving == "driving"
