"""What may be chosen from, as it is stated."""

from math import inf

import pytest

from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.gears import gears, stages
from ocs_design.catalogue.materials import materials
from ocs_design.catalogue.motors import motors
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.choices import motor_choice
from ocs_design.requirement.resolving import resolve
from ocs_design.requirement.specification import (
    FlywheelSection,
    MotorSection,
    OcsSection,
    RequirementSection,
    Specification,
)
from ocs_design.robot.manual import robot_by_hand

LIGHT = robot_by_hand(20.0, (0.3, 0.4, 0.5), name="light")
HEAVY = robot_by_hand(20.1, (0.3, 0.4, 0.5), name="heavy")


def choice_of(robot=LIGHT, material=None, **motor):
    flywheel = FlywheelSection(material=material)
    return motor_choice(Specification(motor=MotorSection(**motor), flywheel=flywheel), robot)


@pytest.mark.parametrize("word", [None, "auto"])
def test_auto_is_everything_and_the_default(word):
    choice = choice_of(name=word, gear=word, material=word)
    assert choice.motors == tuple(motors().values())
    assert choice.gears == (DIRECT, *stages(gears().values()))
    assert {material.name for material in choice.materials} == {
        name
        for name, found in materials().items()
        if found.yield_strength is not None and found.poisson_ratio is not None
    }
    assert choice.wheel_speed_max is None


def test_none_is_no_choice_at_all():
    assert choice_of(name="none") is None


def test_names_are_taken_alone():
    gear = next(iter(gears()))
    choice = choice_of(name="R80 KV110", gear=gear, material="brass-c360")
    assert [motor.name for motor in choice.motors] == ["R80 KV110"]
    assert choice.gears == stages([gears()[gear]])
    assert [material.name for material in choice.materials] == ["brass-c360"]
    assert choice_of(gear="direct").gears == (DIRECT,)


def test_the_bus_goes_with_the_mass_unless_stated():
    assert (choice_of(LIGHT).bus_voltage, choice_of(HEAVY).bus_voltage) == (24.0, 48.0)
    assert choice_of(HEAVY, bus_voltage=12.0).bus_voltage == 12.0


def test_a_stated_torque_limits_every_stage():
    free, limited = choice_of(), choice_of(torque_max=0.5)
    assert DIRECT.torque_max == inf
    for before, after in zip(free.gears, limited.gears, strict=True):
        assert after.torque_max == min(before.torque_max, 0.5)


@pytest.mark.parametrize("sheet", [sheet for sheet in gears().values() if sheet.stages()])
def test_a_gear_is_meant_with_any_ratio_or_with_the_one_that_is_printed(sheet):
    stages = sheet.stages()
    assert choice_of(gear=sheet.name).gears == stages
    for stage in (stages[0], stages[-1]):
        assert choice_of(gear=stage.name).gears == (stage,)


def test_own_motors_join_the_catalogue(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text('[[motor]]\nname = "Own 1"\nmaker = "me"\nsource = "bench"\n')
    assert "Own 1" in {motor.name for motor in choice_of(motors=str(file)).motors}


@pytest.mark.parametrize(
    ("specification", "words"),
    [
        (
            Specification(motor=MotorSection(name="R80")),
            ("motor.name", "Did you mean", "R80 KV110"),
        ),
        (Specification(motor=MotorSection(name="%%%")), ("motor.name", "catalogue motors")),
        (Specification(motor=MotorSection(gear="no gear")), ("motor.gear", "no gear")),
        (
            Specification(motor=MotorSection(name="none", bus_voltage=24.0)),
            ("motor.bus_voltage", "says nothing"),
        ),
        (
            Specification(
                motor=MotorSection(name="none"), ocs=OcsSection(alpha_criterion="lightest")
            ),
            ("ocs.alpha_criterion", "needs a motor"),
        ),
        (
            Specification(motor=MotorSection(name="none"), ocs=OcsSection(co_design=True)),
            ("ocs.co_design", "needs a motor"),
        ),
    ],
)
def test_what_cannot_be_meant_is_said(specification, words):
    with pytest.raises(SpecificationError) as caught:
        resolve(specification, LIGHT, 1.0)
    told = str(caught.value)
    assert all(word in told for word in words)


def test_a_stated_wheel_speed_is_handed_on():
    stated = Specification(requirement=RequirementSection(wheel_speed_max=500.0))
    assert motor_choice(stated, LIGHT).wheel_speed_max == 500.0
