"""Changes that make a device lighter by a given mass, and the maneuver that drives its mass."""

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

MOTOR = MotorSection(name="MN4014 KV400")
"""A single motor keeps the selection fast."""
SAVED_MASS = 0.02


@cache
def design_for(**requirement):
    """Task for Solo12's figures, its design, and the maneuver that drives its mass."""
    specification = Specification(motor=MOTOR, requirement=RequirementSection(**requirement))
    task, design = design_of(specification)
    return task, design, find_driving_maneuver(task, design.choice)


def mass_of(task, specification):
    """Mass of the device for another specification [kg]."""
    return design_device(task.with_specification(specification)).device.mass


@pytest.mark.slow
def test_the_driving_maneuver_is_the_one_without_which_the_device_is_lightest():
    task, design, driving = design_for()
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
    assert driving.mass_without < design.device.mass


@pytest.mark.slow
def test_the_only_maneuver_drives_the_mass():
    _, _, driving = design_for(fall=(1.0,))
    assert (driving.maneuver, driving.mass_without) == ("fall", None)


def test_without_maneuvers_none_drives_the_mass():
    assert design_for(rate_change=1.0)[2] is None


@pytest.mark.slow
def test_each_change_reaches_the_mass_and_is_the_smallest_that_does():
    task, design, driving = design_for(fall=(1.0,))
    alternatives = lighter_by(SAVED_MASS, task, design.choice, driving.maneuver)
    target = design.choice.chosen.mass - SAVED_MASS
    assert alternatives
    assert all(each.mass_total <= target for each in alternatives)
    slower = next(each for each in alternatives if each.change.endswith("for every maneuver"))
    percent = int(slower.change.partition("%")[0])

    def mass_if_slower(percent):
        """Mass of the device with this much more time for every maneuver."""
        maneuvers = tuple(each.slower(1.0 + percent / 100.0) for each in task.maneuvers)
        specified = replace(
            task.specification, requirement=RequirementSection(), maneuvers=maneuvers
        )
        return mass_of(task, specified)

    assert mass_if_slower(percent) == pytest.approx(slower.mass_total, rel=1e-3)
    assert mass_if_slower(percent - 2) > target


def test_no_change_saves_more_than_the_whole_mass():
    task, design, _ = design_for()
    assert lighter_by(10.0, task, design.choice, "") == ()


def test_only_motors_rated_for_a_voltage_are_offered_at_it():
    """MN4014 KV400 is rated for 33.6 V; others of the catalogue for more."""
    task, design, _ = design_for()
    task = task.with_specification(replace(task.specification, motor=MotorSection()))

    def offered(voltage):
        change = Change("", task.with_key("supply", "voltage", voltage))
        return Variant.of(change, task, design.choice)

    assert [motor.name for motor in offered(33.0).problem.motors] == [MOTOR.name]
    assert offered(34.0) is None


@pytest.mark.slow
def test_where_single_changes_fail_a_limit_is_changed_with_a_choice(monkeypatch):
    task, design, _ = design_for(fall=(1.0,))
    tried = {}

    def too_heavy(variant, _mass_max):
        tried[variant.text] = variant.task.specification

    monkeypatch.setattr(Variant, "quick_selection", lambda *_: design.choice.chosen)
    monkeypatch.setattr(Variant, "full_design", too_heavy)
    assert lighter_by(SAVED_MASS, task, design.choice, "") == ()
    both = next(each for text, each in tried.items() if "r_max" in text and "incidence" in text)
    assert both.ocs.alpha_criterion == "lightest"
    assert both.flywheel.r_max > task.resolved.envelope.outer_radius_max
