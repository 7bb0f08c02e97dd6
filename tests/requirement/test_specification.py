"""The table of keys, and how options override a file."""

from dataclasses import MISSING, fields

import pytest

from ocs_design.requirement.device_sections import LIMIT_OF_KEY, Envelope, FlywheelSection
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys, merge
from ocs_design.requirement.turns import Flip

FLIP = Flip(name="flip", jump_height=1.0, angle=1.0, duration=1.0)


def test_every_key_is_optional_read_and_explained():
    for section in SECTIONS.values():
        assert all(item.default is None for item in fields(section))
    assert all(key.value.takes and key.summary and key.why for key in all_keys().values())


def test_names_of_options_are_unique():
    names = [key.option or path.split(".")[1] for path, key in all_keys().items()]
    assert len(names) == len(set(names))


def test_each_kind_of_maneuver_reads_each_of_its_fields():
    for kind in MANEUVER_KINDS.values():
        # Users cannot specify the ratio of plan to closed form, whether the wheels control yaw, or
        # the robot's height and mass.
        assert set(kind.values) == {item.name for item in fields(kind.maneuver)} - {
            "estimate",
            "standing_height",
            "stretch",
            "direct",
            "body",
        }
        assert set(kind.required) <= set(kind.values)
    assert "pitch" in MANEUVER_KINDS["drop"].required
    assert "roll" not in MANEUVER_KINDS["drop"].required


def test_each_limit_of_the_envelope_has_a_key():
    assert set(LIMIT_OF_KEY.values()) == {item.name for item in fields(Envelope)}
    assert set(LIMIT_OF_KEY) < {item.name for item in fields(FlywheelSection)}
    assert all(item.default is MISSING for item in fields(Envelope))


def test_merging_overrides_only_what_is_specified():
    base = Specification(
        robot=RobotSection(file="a.urdf", joints={"hip": 1.0, "knee": 2.0}),
        flywheel=FlywheelSection(r_max=0.03, h_max=0.01),
        maneuvers=(FLIP,),
    )
    override = Specification(
        robot=RobotSection(joints={"knee": 3.0}), flywheel=FlywheelSection(r_max=0.04)
    )
    merged = merge(base, override)
    assert merged.robot.file == "a.urdf"
    assert merged.robot.joints == {"hip": 1.0, "knee": 3.0}
    assert (merged.flywheel.r_max, merged.flywheel.h_max) == (0.04, 0.01)
    assert merged.maneuvers == (FLIP,)


def test_merging_nothing_changes_nothing():
    base = Specification(requirement=RequirementSection(rate_change=2.0))
    assert merge(base, Specification()) == base
    assert merge(Specification(), base) == base


@pytest.mark.parametrize(
    ("base", "override"),
    [
        (RobotSection(mass=2.0, inertia=(1.0, 1.0, 1.0), name="x"), RobotSection(file="b.urdf")),
        (RobotSection(file="b.urdf", name="x"), RobotSection(mass=2.0, inertia=(1.0, 1.0, 1.0))),
    ],
)
def test_a_robot_by_file_and_one_by_hand_replace_each_other(base, override):
    merged = merge(Specification(robot=base), Specification(robot=override)).robot
    assert (merged.file, merged.mass, merged.inertia) == (
        override.file,
        override.mass,
        override.inertia,
    )
    assert merged.name == "x"


def test_the_mass_of_a_robot_by_hand_can_be_overridden_alone():
    base = Specification(robot=RobotSection(mass=2.0, inertia=(1.0, 1.0, 1.0)))
    merged = merge(base, Specification(robot=RobotSection(mass=3.0))).robot
    assert (merged.mass, merged.inertia) == (3.0, (1.0, 1.0, 1.0))
