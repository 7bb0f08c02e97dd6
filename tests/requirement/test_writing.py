"""What is written is read back, to the last bit."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from specifications import FULL, same

from ocs_design.requirement.device_sections import OcsSection
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.phrases import Person
from ocs_design.requirement.reading import parse_specification, read_specification
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import SECTIONS, Specification
from ocs_design.requirement.writing import specification_to_toml, with_absolute_files

STATED = {
    "everything": FULL,
    # A bare number so large would be taken for degrees.
    "a joint beyond a turn": Specification(
        robot=RobotSection(joints={"wheel": 4.0 * np.pi, "knee": 1.5})
    ),
    "axes by hand": Specification(ocs=OcsSection(axes=(0.0, 1.0, 0.0, 0.6, 0.0, -0.8))),
    "a robot by hand": Specification(
        robot=RobotSection(mass=2.5, inertia=(0.03, 0.05, 0.07, 0.0, -1e-7, 0.0)),
        requirement=RequirementSection(maneuvers="none", rate_change=2.0),
    ),
    "a person": Specification(robot=RobotSection(human=Person(75.0, 1.75, 10.0))),
    "numbers of numpy": Specification(
        robot=RobotSection(mass=np.float64(2.5), inertia=tuple(np.array([0.03, 0.05, 0.07]))),
        ocs=OcsSection(alpha=np.radians(40.0)),
        validation=ValidationSection(kp=np.float64(60.0)),
    ),
}


def check_read_back(stated):
    assert same(parse_specification(specification_to_toml(stated), "written"), stated)


@pytest.mark.parametrize("stated", STATED.values(), ids=STATED)
def test_what_is_stated_is_read_back(stated):
    check_read_back(stated)


def test_the_full_specification_states_every_key_but_the_ones_that_exclude_others():
    excluded = {"mass", "inertia", "human", "maneuvers", "axes"}
    for name, section in SECTIONS.items():
        stated = getattr(FULL, name)
        missing = {item.name for item in fields(section) if getattr(stated, item.name) is None}
        assert missing <= excluded
    assert {type(maneuver) for maneuver in FULL.maneuvers} == {
        kind.maneuver for kind in MANEUVER_KINDS.values()
    }


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
    check_read_back(stated)


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
