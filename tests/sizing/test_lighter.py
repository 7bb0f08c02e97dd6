"""What would have to give for a lighter device, and which maneuver its mass is owed to."""

from dataclasses import replace
from functools import cache

import pytest
from designed_devices import design_of

from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.specification import Specification
from ocs_design.sizing.alternatives import Variant, find_driving_maneuver, lighter_by
from ocs_design.sizing.changes import Change
from ocs_design.sizing.design import design_device

MOTORS = MotorSection(name="MN4014 KV400")
"""One, so that it is quick."""
LESS = 0.02


@cache
def designed_with(**asked):
    """The task for Solo12's figures, its device, and what its mass is owed to."""
    specification = Specification(motor=MOTORS, requirement=RequirementSection(**asked))
    task, designed = design_of(specification)
    return task, designed, find_driving_maneuver(task, designed.choice)


def mass_of(task, specification):
    """Of the device of another question [kg]."""
    return design_device(task.with_specification(specification)).device.mass


@pytest.mark.slow
def test_the_mass_is_owed_to_the_maneuver_without_which_it_is_lightest():
    task, designed, driving = designed_with()
    without = {
        maneuver.name: mass_of(
            task,
            replace(
                task.specification,
                maneuvers=tuple(each for each in task.maneuvers if each is not maneuver),
            ),
        )
        for maneuver in task.maneuvers
    }
    assert driving.maneuver == min(without, key=without.get)
    assert driving.mass_without == pytest.approx(without[driving.maneuver], rel=0.01)
    assert driving.mass_without < designed.device.mass


@pytest.mark.slow
def test_the_mass_is_owed_to_the_only_maneuver():
    _, _, driving = designed_with(fall=(1.0,))
    assert (driving.maneuver, driving.mass_without) == ("fall", None)


def test_a_rate_change_alone_owes_nothing_to_a_maneuver():
    assert designed_with(rate_change=1.0)[2] is None


@pytest.mark.slow
def test_every_answer_is_light_enough_and_the_smallest_change_that_is():
    task, designed, driving = designed_with(fall=(1.0,))
    answers = lighter_by(LESS, task, designed.choice, driving.maneuver)
    target = designed.choice.chosen.mass - LESS
    assert answers
    assert all(each.mass_total <= target for each in answers)
    of_time = next(each for each in answers if each.change.endswith("for every maneuver"))
    percent = int(of_time.change.partition("%")[0])

    def slower_by(percent):
        """Mass with so much more time."""
        maneuvers = tuple(
            each.slower(1.0 + percent / 100.0, task.standing_height) for each in task.maneuvers
        )
        specified = replace(
            task.specification, requirement=RequirementSection(), maneuvers=maneuvers
        )
        return mass_of(task, specified)

    assert slower_by(percent) == pytest.approx(of_time.mass_total, rel=1e-3)
    assert slower_by(percent - 2) > target


def test_nothing_makes_it_lighter_than_nothing():
    task, designed, _ = designed_with()
    assert lighter_by(10.0, task, designed.choice, "") == ()


def test_no_motor_is_told_at_a_voltage_that_it_is_not_rated_for():
    """MN4014 KV400 is rated for 33.6 V; others of the catalogue for more."""
    task, designed, _ = designed_with()
    task = task.with_specification(replace(task.specification, motor=MotorSection()))

    def offered(voltage):
        change = Change("", task.with_key("supply", "voltage", voltage))
        return Variant.of(change, task, designed.choice)

    assert [motor.name for motor in offered(33.0).problem.motors] == [MOTORS.name]
    assert offered(34.0) is None


@pytest.mark.slow
def test_where_neither_does_alone_a_figure_is_tried_with_a_choice(monkeypatch):
    task, designed, _ = designed_with(fall=(1.0,))
    asked = {}

    def too_heavy(variant, _most):
        asked[variant.text] = variant.task.specification

    monkeypatch.setattr(Variant, "quick_selection", lambda *_: designed.choice.chosen)
    monkeypatch.setattr(Variant, "full_design", too_heavy)
    assert lighter_by(LESS, task, designed.choice, "") == ()
    both = next(each for text, each in asked.items() if "r_max" in text and "incidence" in text)
    assert both.ocs.alpha_criterion == "lightest"
    assert both.flywheel.r_max > task.resolved.envelope.outer_radius_max
