"""Motors, gears, materials and supply to choose from, as specified."""

from dataclasses import replace
from math import inf
from pathlib import Path

import pytest
from specifications import problems_of

from ocs_design.actuation.controllers import controller_mass_of
from ocs_design.actuation.motor import DIRECT, build_gaps
from ocs_design.catalogue.gears import gears, stages
from ocs_design.catalogue.materials import materials
from ocs_design.catalogue.motors import motor, motors
from ocs_design.common.errors import RobotError, SpecificationError
from ocs_design.requirement.choices import motor_choice
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection, SupplySection
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.resolving import read_specified_robot, resolve
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.values import names_in, several_names
from ocs_design.robot.manual import robot_by_hand

OWN_GEAR = """
[[gear]]
name = "mine"
maker = "me"
source = "bench"
kind = "fixed"
ratios = [2]
efficiency = 0.95
mass_kg = 0.05
inertia_kg_m2 = 1e-6
inertia_at = "wheel"
reverses = "no"
torque_max_nm = 5
motor_speed_max_rpm = 9000
"""

OWN_MOTOR = '[[motor]]\nname = "Own 1"\nmaker = "me"\nsource = "bench"\n'

LIGHT = robot_by_hand(20.0, (0.3, 0.4, 0.5), name="light")
HEAVIEST = robot_by_hand(60.1, (0.3, 0.4, 0.5), name="heaviest")
HEAVY = robot_by_hand(20.1, (0.3, 0.4, 0.5), name="heavy")


def choice_of(robot=LIGHT, material=None, supply=None, **motor):
    specification = Specification(
        motor=MotorSection(**motor),
        flywheel=FlywheelSection(material=material),
        supply=SupplySection(**supply or {}),
    )
    return motor_choice(specification, robot)


def names_of(**motor):
    return [each.name for each in choice_of(**motor).motors]


@pytest.mark.parametrize("word", [None, "auto"])
def test_auto_is_the_default_and_all_buildable_motors_rated_for_the_supply(word):
    choice = choice_of(name=word)
    offered = [replace(each, controller_mass=0.0) for each in choice.motors]
    complete = [each for each in motors().values() if not build_gaps(each)]
    assert offered == [
        each for each in complete if (each.voltage_max or each.rated_voltage) >= 24.0
    ]
    assert 40 < len(offered) < len(complete)
    assert choice.wheel_speed_max is None


def test_a_motor_rated_for_less_than_the_supply_must_be_named():
    weak = motor("AT2814 KV1050")
    assert weak.rated_voltage < 24.0
    assert weak.name not in names_of()
    assert names_of(any=True) == list(motors())
    assert names_of(name=weak.name) == [weak.name]
    with pytest.raises(SpecificationError, match=r"is rated for 500 V; .*, at 160 V"):
        choice_of(supply={"voltage": 500.0})


def test_gears_must_be_requested_or_the_users_own(tmp_path):
    assert choice_of().gears == (DIRECT,)
    catalogue = (DIRECT, *stages(gears().values()))
    assert choice_of(gear="auto").gears == catalogue
    file = tmp_path / "own.toml"
    file.write_text(OWN_GEAR)
    mine = choice_of(gears=str(file)).gears
    assert [gear.name for gear in mine if gear not in catalogue] == ["mine 2:1"]


def test_auto_is_every_material_with_known_strength():
    assert {material.name for material in choice_of(material="auto").materials} == {
        name
        for name, found in materials().items()
        if found.yield_strength is not None and found.poisson_ratio is not None
    }


@pytest.mark.parametrize("word", [None, "steel"])
def test_all_steels_are_the_default(word):
    chosen = choice_of(material=word).materials
    # No other metal is as dense.
    assert {material.name for material in chosen} == {
        "stainless-304",
        "stainless-316",
        "steel-1045-normalized",
        "steel-4140-qt",
        "steel-a36",
    }
    assert all(7800.0 <= material.density <= 8000.0 for material in chosen)


def test_named_motors_are_offered_even_with_missing_data():
    names = "R80 KV110, MN5212 KV340"
    assert names_of(name=names) == names.split(", ")
    assert build_gaps(motors()["R80 KV110"])


def test_named_motor_gear_and_material_are_the_only_choice():
    gear = next(name for name, sheet in gears().items() if sheet.stages())
    choice = choice_of(name="R80 KV110", gear=gear, material="brass-c360")
    assert [motor.name for motor in choice.motors] == ["R80 KV110"]
    assert choice.gears == stages([gears()[gear]])
    assert [material.name for material in choice.materials] == ["brass-c360"]
    assert choice_of(gear="direct").gears == (DIRECT,)


def test_the_default_voltage_follows_the_mass():
    assert [choice_of(robot).supply.voltage for robot in (LIGHT, HEAVY, HEAVIEST)] == [24, 48, 72]
    assert choice_of(HEAVY, supply={"voltage": 12.0}).supply.voltage == 12.0


def test_the_default_power_is_400_watts_per_kg_of_robot():
    assert choice_of(LIGHT).supply.power == 8000.0
    assert choice_of(supply={"power_max": 100.0}).supply.power == 100.0
    assert choice_of(supply={"current_max": 10.0}).supply.power == 240.0


def test_a_specified_torque_limits_every_stage():
    free, limited = choice_of(), choice_of(torque_max=0.5)
    assert DIRECT.torque_max == inf
    for before, after in zip(free.gears, limited.gears, strict=True):
        assert after.torque_max == min(before.torque_max, 0.5)


@pytest.mark.parametrize("sheet", [sheet for sheet in gears().values() if sheet.stages()])
def test_a_gear_is_named_with_or_without_its_ratio(sheet):
    stages = sheet.stages()
    assert choice_of(gear=sheet.name).gears == stages
    for stage in (stages[0], stages[-1]):
        assert choice_of(gear=stage.name).gears == (stage,)


def test_a_belt_with_one_pulley_is_refused(tmp_path):
    file = tmp_path / "own.toml"
    row = {"pitch_m": 0.002, "width_m": 0.006, "belt_mass_kg_per_m": 0.01, "mass_kg": 0.02}
    row |= {"working_tension_n": 40, "belt_speed_max_m_s": 40, "pulley_density_kg_m3": 2700}
    figures = "\n".join(f"{column} = {figure}" for column, figure in row.items())
    named = 'name = "mine"\nmaker = "me"\nsource = "bench"\nkind = "belt"\nefficiency = 0.95'
    for teeth, offered in (("[20]", 0), ("[20, 40]", 2)):
        file.write_text(f"[[gear]]\n{named}\nteeth = {teeth}\n{figures}\n")
        if offered:
            assert len(choice_of(gears=str(file), gear="mine").gears) == offered
        else:
            with pytest.raises(SpecificationError, match="lacks teeth of a second pulley"):
                choice_of(gears=str(file), gear="mine")


@pytest.mark.parametrize(
    ("raw", "names"),
    [
        ("R80 KV110", ("R80 KV110",)),
        ("a , b,,c", ("a", "b", "c")),
        (["a", "b,c"], ("a", "b", "c")),
        (["none", "none"], ("none",)),
        *((raw, None) for raw in ("", " ", 3, ["a", 3], [["a"]])),
    ],
)
def test_names_are_a_list_or_separated_by_commas(raw, names):
    if names is None:
        with pytest.raises(SpecificationError, match=r"motor\.name"):
            several_names.read(raw, "motor.name")
    else:
        assert names_in(several_names.read(raw, "motor.name")) == names


@pytest.fixture
def own(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(OWN_MOTOR)
    return str(file)


def test_own_motors_replace_or_extend_the_catalogue(own):
    assert names_of(motors=own, any=True) == ["Own 1"]
    assert set(names_of(motors=own, with_catalogue=True, any=True)) == {"Own 1", *motors()}
    assert names_of(motors=own, name="Own 1") == ["Own 1"]


@pytest.mark.parametrize(
    ("rows", "fault"),
    [
        ("", "has no motors"),
        (OWN_MOTOR, "every motor lacks data needed to build: Own 1 lacks kind (outrunner"),
    ],
)
def test_a_file_without_a_buildable_motor_is_refused_under_its_key(tmp_path, rows, fault):
    file = tmp_path / "own.toml"
    file.write_text(rows)
    (problem,) = problems_of(parse_specification(f"motor.motors = '{file}'", "x"), LIGHT, 1.0)
    assert problem.startswith("motor.motors: ")
    assert fault in problem


def test_a_supply_is_compared_with_the_highest_permitted_voltage(own):
    """A voltage above that of every known motor is probably a typing error."""
    with pytest.raises(SpecificationError, match="no known motor takes more than 160 V"):
        resolve(parse_specification("supply.voltage = 300", "x"), LIGHT, 1.0)
    with Path(own).open("a") as rows:
        rows.write("rated_voltage_v = 48\nvoltage_max_v = 400\n")
    specified = parse_specification(
        f"supply.voltage = 300\nmotor.name = 'Own 1'\nmotor.motors = '{own}'", "x"
    )
    choice = resolve(specified, LIGHT, 1.0).choice
    assert [each.voltage_max for each in choice.motors] == [400.0]
    assert choice.supply.voltage == 300.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("motor.name = 'R80'", ("motor.name", "Did you mean", "R80 KV110")),
        ("motor.name = '%%%'", ("motor.name", "catalogue motors")),
        ("motor.gear = 'no gear'", ("motor.gear", "no gear")),
        ("motor.gears = 'gone.csv'", ("motor.gears: cannot read the catalogue gone.csv",)),
        (
            "motor.gear = 'gp42c 203115'",
            (
                "motor.gear: no stage of the gear 'GP 42 C 203115'",
                "lacks inertia_kg_m2, inertia_at, motor_speed_max_rpm",
                "--gears",
            ),
        ),
        ("motor.name = 'none'\nsupply.voltage = 24", ("supply.voltage", "has no effect")),
        (
            "motor.name = 'none'\nocs.alpha_criterion = 'lightest'",
            ("ocs.alpha_criterion", "needs a motor"),
        ),
        ("motor.name = 'none'\nocs.co_design = true", ("ocs.co_design", "needs a motor")),
    ],
)
def test_contradictions_are_explained(text, words):
    with pytest.raises(SpecificationError) as caught:
        resolve(parse_specification(text, "x"), LIGHT, 1.0)
    message = str(caught.value)
    assert all(word in message for word in words)


def test_mass_of_controllers_is_specified_or_estimated():
    auto = choice_of(name="R80 KV110").motors[0]
    assert auto.controller_mass == controller_mass_of(motors()["R80 KV110"]) > 0.008
    for specified, mass in ((0.035, 0.035), ("none", 0.0), ("auto", auto.controller_mass)):
        choice = choice_of(name="R80 KV110", supply={"controllers": specified})
        assert choice.motors[0].controller_mass == mass


def test_warnings_about_a_motor_are_given_with_those_about_the_robot(tmp_path):
    """They come before any sizing, and are errors with --strict."""
    file = tmp_path / "own.toml"
    file.write_text(
        '[[motor]]\nname = "Own"\nmaker = "me"\nsource = "bench"\nkv_rpm_per_v = 450000\n'
    )
    by_hand = RobotSection(mass=2.5, inertia=(0.032, 0.055, 0.07, 0.0, 0.0, 0.0))
    specification = Specification(robot=by_hand, motor=MotorSection(motors=str(file)))
    (warning,) = read_specified_robot(specification).warnings
    assert "Own: kv_rpm_per_v is 450000 rpm/V" in warning
    with pytest.raises(RobotError, match=r"--strict: .* did you mean 450 rpm/V"):
        read_specified_robot(specification, strict=True)
    without_motor = replace(specification, motor=MotorSection(motors=str(file), name="none"))
    assert read_specified_robot(without_motor).warnings == ()
