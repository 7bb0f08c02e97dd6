"""What is written is read back, to the last bit."""

from dataclasses import fields, replace
from math import pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.requirement.maneuver import Disturbance, Drop, Flip
from ocs_design.requirement.maneuver_table import MANEUVER_KINDS
from ocs_design.requirement.reading import parse_specification, read_specification
from ocs_design.requirement.specification import (
    SECTIONS,
    FlywheelSection,
    MotorSection,
    OcsSection,
    RequirementSection,
    RobotSection,
    Specification,
    ValidationSection,
)
from ocs_design.requirement.writing import specification_to_toml, with_absolute_files

MANEUVERS = (
    Disturbance(
        name="push",
        takeoff_velocity=(0.5, 2.4),
        torque=(0.2, -0.8, 0.1),
        onset=0.1,
        duration=0.05,
    ),
    Drop(name="drop", height=1.0, pitch=radians(30.0), roll=-0.1, incidence=0.0),
    Flip(name="back-flip", gravity=1.62, jump_height=1.0, angle=-2 * pi, duration=2.0),
)

FULL = Specification(
    robot=RobotSection(
        file='a "quoted" \\ path/ä\x7f.urdf',
        name="r",
        trunk="t",
        posture="stand",
        joints={"a b": 1 / 3},
    ),
    requirement=RequirementSection(
        rate_change=0.1, wheel_speed_max=31415.926, spin_inertia=7.11e-5, gravity=9.81
    ),
    ocs=OcsSection(
        alpha=radians(40.0), alpha_criterion="lightest", position=(0.1, 0.2, 1e-17), co_design=True
    ),
    flywheel=FlywheelSection(
        r_max=0.05,
        r_min=0.005,
        h_max=0.01,
        h_min=0.002,
        wall_min=0.002,
        wheel_mass_max=0.25,
        material="auto",
        stress_safety=2.5,
        web="none",
    ),
    motor=MotorSection(
        name="auto", bus_voltage=24.0, gear="direct", motors="m.csv", gears="g.toml", torque_max=1.1
    ),
    validation=ValidationSection(enabled=False, projection="transpose", kp=60.0, kd=12.0, seed=7),
    maneuvers=MANEUVERS,
)


def same(one, other):
    """Maneuvers compare by identity."""
    plain = replace(one, maneuvers=()) == replace(other, maneuvers=())
    return plain and [vars(m) for m in one.maneuvers] == [vars(m) for m in other.maneuvers]


def test_everything_that_can_be_stated_is_read_back():
    assert same(parse_specification(specification_to_toml(FULL), "written"), FULL)


def test_the_full_specification_states_every_key_but_the_ones_that_exclude_others():
    excluded = {"mass", "inertia", "maneuvers"}
    for name, section in SECTIONS.items():
        stated = getattr(FULL, name)
        missing = {item.name for item in fields(section) if getattr(stated, item.name) is None}
        assert missing <= excluded
    assert {type(maneuver) for maneuver in FULL.maneuvers} == {
        kind.maneuver for kind in MANEUVER_KINDS.values()
    }


def test_a_robot_by_hand():
    by_hand = Specification(
        robot=RobotSection(mass=2.5, inertia=(0.03, 0.05, 0.07, 0.0, -1e-7, 0.0)),
        requirement=RequirementSection(maneuvers="none", rate_change=2.0),
    )
    assert same(parse_specification(specification_to_toml(by_hand), "written"), by_hand)


def test_nothing_is_written_of_nothing():
    assert specification_to_toml(Specification()) == "\n"


def test_a_comment_stands_at_the_top():
    text = specification_to_toml(FULL, "one\n\ntwo")
    assert text.startswith("# one\n#\n# two\n\n[robot]\n")
    assert same(parse_specification(text, "written"), FULL)


@given(
    st.floats(1e-12, 1.5), st.floats(1e-12, 1e9), st.text(min_size=1).filter(lambda t: t.strip())
)
def test_any_number_and_any_text(angle, speed, text):
    text = text.encode(errors="ignore").decode().replace("\0", "") or "x"
    stated = Specification(
        robot=RobotSection(name=text if text.strip() else "x"),
        requirement=RequirementSection(wheel_speed_max=speed),
        ocs=OcsSection(alpha=angle),
    )
    assert same(parse_specification(specification_to_toml(stated), "written"), stated)


def test_files_are_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    absolute = with_absolute_files(FULL)
    assert absolute.robot.file == str(tmp_path / FULL.robot.file)
    assert absolute.motor.motors == str(tmp_path / "m.csv")
    elsewhere = tmp_path / "points"
    elsewhere.mkdir()
    (elsewhere / "01.toml").write_text(specification_to_toml(absolute))
    assert same(read_specification(elsewhere / "01.toml"), absolute)


@pytest.mark.parametrize("file", [None, "-"])
def test_standard_input_stays(file):
    assert with_absolute_files(Specification(robot=RobotSection(file=file))).robot.file == file
