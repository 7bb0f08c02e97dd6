"""Savings of single changes, each compared with a new design for the changed specification."""

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

RELATIVE_TOLERANCE = 5e-3
"""Kicks about the centre of mass converge to 1 %."""

ONE_MOTOR = Specification(motor=MotorSection(name="MN4014 KV400"))
"""A single motor keeps the selection fast."""


@cache
def compared(specification, change):
    """Task, design, and the alternative of one change."""
    task, design = design_of(specification)
    return task, design, alternative_with(task, design.choice, change)


def alternative_with(task, choice, text):
    """The alternative of the change with this text."""
    (variant,) = [each for each in variants(task, choice) if each.text == text]
    return variant.alternative()


def flips_by_hand(task):
    return tuple(
        replace(each, incidence=0.0) if isinstance(each, Flip) else each for each in task.maneuvers
    )


def slower_maneuvers(task):
    return tuple(each.slower(1.0 + MORE_TIME / 100.0) for each in task.maneuvers)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "section", "section_for"),
    [
        (
            "the incidence of the lightest device",
            "ocs",
            lambda _: OcsSection(alpha_criterion="lightest"),
        ),
        ("any material", "flywheel", lambda _: FlywheelSection(material="auto")),
        ("modules turned to 0 deg by hand for each flip", "maneuvers", flips_by_hand),
        ("a supply of 48 V", "supply", lambda _: SupplySection(voltage=48.0)),
        ("r_max 60 mm instead of 50 mm", "flywheel", lambda _: FlywheelSection(r_max=0.06)),
        ("10% more time for every maneuver", "maneuvers", slower_maneuvers),
    ],
)
def test_a_change_saves_as_much_as_a_new_design(change, section, section_for):
    task, design, alternative = compared(ONE_MOTOR, change)
    changed = design_of(replace(ONE_MOTOR, **{section: section_for(task)}))[1]
    # Savings below 0.5 % are not reported.
    assert alternative.mass_total == pytest.approx(changed.device.mass, rel=RELATIVE_TOLERANCE)
    assert alternative.mass_total <= design.device.mass
    if section in {"ocs", "maneuvers"}:
        assert changed.device.mass < design.device.mass
    if section == "ocs" or section_for is flips_by_hand:
        assert alternative.mass_total < design.device.mass
    assert section != "ocs" or alternative.note.startswith("alpha ")
    assert (
        section != "supply"
        or "rated for" in alternative.note
        or alternative.note == "saves nothing"
    )


@pytest.mark.slow
def test_mass_of_a_ring_alternative_includes_its_own_feet_and_plate():
    """Solo12's rings would stand on a heavier plate than its discs."""
    motor = MotorSection(name="Antigravity MN5008 KV400")
    discs = Specification(robot=RobotSection(file=SOLO12), motor=motor)
    task = solo12().with_specification(discs)
    (alternative,) = alternative_construction(task, design_device(task, ranked=False).choice)
    assert alternative.change == "a ring bonded around each motor's bell in place of the disc"
    rings = task.with_specification(replace(discs, ocs=OcsSection(wheel="ring")))
    device = design_device(rings, ranked=False).device
    assert alternative.mass_total == pytest.approx(device.mass, rel=RELATIVE_TOLERANCE)


def offered(specification):
    """Texts of the changes that are tried."""
    task, design = design_of(specification)
    return {each.text for each in variants(task, design.choice)}


@pytest.mark.slow
def test_what_is_specified_is_not_offered():
    specified = replace(
        ONE_MOTOR,
        flywheel=FlywheelSection(material="auto"),
        ocs=OcsSection(alpha_criterion="lightest"),
        requirement=RequirementSection(fall=(1.0,)),
    )
    changes = offered(specified)
    assert changes
    assert not {"the incidence of the lightest device", "any material"} & changes
    assert not any("any motor" in change for change in changes)


def test_without_maneuvers_no_more_time_is_offered():
    rate_only = replace(ONE_MOTOR, requirement=RequirementSection(rate_change=1.0))
    assert not any("time" in change or "flip" in change for change in offered(rate_only))


def test_without_a_motor_there_are_no_alternatives():
    task, design = design_of(Specification(motor=MotorSection(name="none")))
    assert start_alternatives(task, design.choice)() == ((), None)


@pytest.mark.slow
def test_the_alternative_of_any_motor_notes_missing_data():
    _, design, alternative = compared(Specification(), "any motor of the catalogue")
    assert alternative.mass_total <= design.device.mass
    assert alternative.note == "saves nothing" or "not buildable: " in alternative.note


@pytest.mark.slow
def test_without_a_mount_alternatives_are_estimated_and_say_so():
    """The estimate omits only the alternative's own reserve and the effect of its mast."""
    change = "modules turned to 0 deg by hand for each flip"
    task, design, full = compared(ONE_MOTOR, change)
    unmounted = replace(design.choice, lacks_mount=True)
    quick = alternative_with(task, unmounted, change)
    assert "by a quick look" in quick.note
    assert "by a quick look" not in full.note
    assert quick.mass_total == pytest.approx(full.mass_total, rel=0.02)
    assert alternative_construction(task, unmounted) == ()


def test_all_calls_start_before_any_answer_and_answers_keep_their_order():
    """Worker processes take the last answer first, as its call may not have started yet."""
    task, design = design_of(ONE_MOTOR)
    started, awaited = [], []

    def call(function, *args):
        number = len(started)
        started.append(function.__qualname__)
        is_last = function is find_driving_maneuver
        answer = (
            "driving" if is_last else ("rings",) if function is alternative_construction else number
        )
        return lambda: (awaited.append(number), answer)[1]

    answers = start_alternatives(task, design.choice, call)
    assert not awaited
    alternatives, driving = answers()
    assert awaited == list(range(len(started)))[::-1]
    assert alternatives == (*range(1, len(started) - 1), "rings")
    assert driving == "driving"
