"""Specification files, as written and with comments."""

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from specifications import FULL_SPECIFICATION, same_specification

from ocs_design.common.units import Dimension
from ocs_design.requirement.device_sections import OcsSection
from ocs_design.requirement.froude import example_maneuvers
from ocs_design.requirement.keys import keys_of
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.phrases import Person
from ocs_design.requirement.reading import parse_specification, read_specification
from ocs_design.requirement.resolving import default_specification
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys
from ocs_design.requirement.uncertainty import Distribution
from ocs_design.requirement.values import JointValue
from ocs_design.requirement.writing import (
    commented_toml,
    rounded_text,
    specification_to_toml,
    with_absolute_files,
)
from ocs_design.robot.manual import robot_by_hand

KEY_LINE = re.compile(r"^(?:# )?(\w+) = ", re.MULTILINE)
MANEUVER = re.compile(r"^# \[\[maneuver\]\]\n(?:# \w+ = .*\n)+", re.MULTILINE)


@pytest.fixture(scope="module")
def default(solo12):
    return default_specification(solo12, kp=60.0, kd=12.0)


@pytest.fixture(scope="module")
def empty(default):
    """Commented file of an empty specification."""
    return commented_toml(Specification(), default, title="Anything", examples=EXAMPLES)


EXAMPLES = example_maneuvers(robot_by_hand(2.5, (0.03, 0.05, 0.07)))


def read(text):
    return parse_specification(text, "written")


def section_of(text, name):
    """Lines below the heading of one section."""
    return re.split(r"^\[|^# What the device", text.split(f"[{name}]\n", 1)[1], flags=re.MULTILINE)[
        0
    ]


def with_line_uncommented(text, section, key):
    """The text with the line of one key uncommented."""
    head, heading, tail = text.partition(f"[{section}]\n")
    return head + heading + tail.replace(f"\n# {key} = ", f"\n{key} = ", 1)


def test_a_commented_file_specifies_nothing(empty):
    assert read(empty) == Specification()


def test_every_key_has_its_line(empty):
    for name, section in SECTIONS.items():
        assert KEY_LINE.findall(section_of(empty, name)) == list(keys_of(section))


@pytest.mark.parametrize("path", sorted(set(all_keys()) - {"robot.mass", "robot.inertia"}))
def test_each_line_can_be_uncommented_alone(path, empty, default):
    section, key = path.split(".")
    specification = read(with_line_uncommented(empty, section, key))
    value = getattr(getattr(specification, section), key)
    expected = getattr(getattr(default, section), key)
    assert value is not None
    if isinstance(expected, Distribution):
        parts = (0.0, 0.3, 1.0)
        assert list(map(value.at, parts)) == pytest.approx(list(map(expected.at, parts)), rel=1e-3)
    elif expected is not None:
        assert value == (pytest.approx(expected, 1e-3) if isinstance(expected, float) else expected)


def test_a_robot_by_hand_needs_both_of_its_lines(empty):
    both = with_line_uncommented(empty, "robot", "mass")
    both = with_line_uncommented(both, "robot", "inertia")
    assert read(both).robot.mass == 2.5


def test_uncommented_maneuvers_are_the_default_ones(empty, default):
    uncommented = MANEUVER.sub(lambda match: match[0].replace("# ", "", 1), empty)
    uncommented = re.sub(r"^# (?=\w+ = .* # )", "", uncommented, flags=re.MULTILINE)
    uncommented = re.sub(r"^# (?=kind = )", "", uncommented, flags=re.MULTILINE)
    maneuvers = read(uncommented).maneuvers
    assert leaves(maneuvers[:3]) == pytest.approx(leaves(default.maneuvers), nan_ok=True)
    assert leaves(maneuvers[3:]) == near(EXAMPLES, 1e-3)


def test_every_kind_of_maneuver_is_shown(empty):
    assert set(re.findall(r'^# kind = "([\w-]+)"', empty, flags=re.MULTILINE)) == set(
        MANEUVER_KINDS
    )


def test_an_example_is_not_shown_where_one_is_specified(default):
    shove = EXAMPLES[:1]
    text = commented_toml(Specification(maneuvers=shove), default, title="x", examples=shove)
    assert text.count('kind = "shove"') == 1


def leaves(value, path=""):
    """All values of a specification or of its maneuvers, by path."""
    if is_dataclass(value):
        value = vars(value)
    if isinstance(value, tuple):
        value = dict(enumerate(value))
    if not isinstance(value, Mapping):
        return {path: value}
    return {
        leaf: content
        for name, entry in value.items()
        for leaf, content in leaves(entry, f"{path}.{name}").items()
    }


def near(value, rel):
    """Leaves of a value, numbers with a relative tolerance."""
    return {
        path: pytest.approx(each, rel=rel, nan_ok=True) if isinstance(each, float) else each
        for path, each in leaves(value).items()
    }


def test_a_full_specification_is_read_back_from_a_commented_file(default):
    """To rounding, since angles are written in degrees."""
    values = leaves(read(commented_toml(FULL_SPECIFICATION, default, title="x")))
    assert values == near(FULL_SPECIFICATION, 1e-12)
    assert len(values) > len(all_keys())


def test_the_comment_of_each_key_names_its_units(empty):
    for path, key in all_keys().items():
        assert f"# {key.summary} [{key.value.takes}]" in section_of(empty, path.split(".")[0])


def test_rounded_texts(default):
    assert rounded_text(default, "flywheel.r_max") == "50 mm"
    assert rounded_text(default, "supply.voltage") == "24 V"
    assert rounded_text(default, "supply.controllers") == "auto"
    third = replace(default, requirement=RequirementSection(rate_change=1 / 3))
    assert rounded_text(third, "requirement.rate_change") == "19.1 deg/s"
    fast = replace(default, requirement=RequirementSection(wheel_speed_max=40.0 * np.pi))
    assert rounded_text(fast, "requirement.wheel_speed_max") == "1200 rpm"


SPECIFICATIONS = {
    "everything": FULL_SPECIFICATION,
    # Such a large number without a unit would be taken for degrees.
    "a joint beyond a turn": Specification(
        robot=RobotSection(joints={"wheel": 4.0 * np.pi, "knee": 1.5})
    ),
    "a slide": Specification(
        robot=RobotSection(joints={"rail": JointValue(7.0, Dimension.LENGTH)})
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


def check_read_back(specified):
    assert same_specification(
        parse_specification(specification_to_toml(specified), "written"), specified
    )


@pytest.mark.parametrize("specified", SPECIFICATIONS.values(), ids=SPECIFICATIONS)
def test_a_written_specification_is_read_back(specified):
    check_read_back(specified)


def test_the_full_specification_has_every_key_that_does_not_exclude_others():
    excluded = {"mass", "inertia", "human", "maneuvers", "axes"}
    for name, section in SECTIONS.items():
        specified = getattr(FULL_SPECIFICATION, name)
        missing = {item.name for item in fields(section) if getattr(specified, item.name) is None}
        assert missing <= excluded
    assert {type(maneuver) for maneuver in FULL_SPECIFICATION.maneuvers} == {
        kind.maneuver for kind in MANEUVER_KINDS.values()
    }


def test_a_title_is_a_comment_at_the_top():
    text = specification_to_toml(FULL_SPECIFICATION, "one\n\ntwo")
    assert text.startswith("# one\n#\n# two\n\n[robot]\n")
    assert same_specification(parse_specification(text, "written"), FULL_SPECIFICATION)


@given(
    st.floats(1e-12, 1.5), st.floats(1e-12, 1e9), st.text(min_size=1).filter(lambda t: t.strip())
)
def test_any_number_and_text_is_read_back(angle, speed, text):
    text = text.encode(errors="ignore").decode().replace("\0", "") or "x"
    specified = Specification(
        robot=RobotSection(name=text if text.strip() else "x"),
        requirement=RequirementSection(wheel_speed_max=speed),
        ocs=OcsSection(alpha=angle),
    )
    check_read_back(specified)


def test_files_are_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    absolute = with_absolute_files(FULL_SPECIFICATION)
    assert absolute.robot.file == str(tmp_path / FULL_SPECIFICATION.robot.file)
    assert absolute.motor.motors == str(tmp_path / "m.csv")
    elsewhere = tmp_path / "points"
    elsewhere.mkdir()
    (elsewhere / "01.toml").write_text(specification_to_toml(absolute))
    assert same_specification(read_specification(elsewhere / "01.toml"), absolute)


@pytest.mark.parametrize("file", [None, "-"])
def test_standard_input_stays(file):
    assert with_absolute_files(Specification(robot=RobotSection(file=file))).robot.file == file
