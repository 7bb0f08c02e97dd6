"""`ocs-design init`: its file, its questions, and `size` with its file."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from commands import BY_HAND, SOLO12, run, run_in_terminal

from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification

SOLO12_SPECIFICATION = Specification(robot=RobotSection(file=SOLO12))


def test_the_file_reads_as_the_specification_of_the_robot(folder):
    assert run("init", SOLO12).code == 0
    specification = read_specification(folder / "solo12.toml")
    assert Path(specification.robot.file).samefile(SOLO12)
    solo12 = replace(specification.robot, file=SOLO12)
    assert replace(specification, robot=solo12) == SOLO12_SPECIFICATION


def test_options_are_written_to_the_file(folder):
    run("init", SOLO12, "--r-max", "40mm", "--motor", "R80 KV110", "-o", "mine.toml")
    specification = read_specification(folder / "mine.toml")
    assert specification.flywheel.r_max == 0.04
    assert specification.motor.name == "R80 KV110"
    assert specification.flywheel.h_max is None


def test_size_reads_the_file(folder):
    run("init", *BY_HAND, "--motor", "none")
    result = run("size", "--spec", "robot.toml", "--no-validate")
    assert result.code == 0
    assert "robot-ocs" in result.stdout


def test_without_a_robot_the_next_command_has_a_placeholder(folder):
    result = run("init", "--json")
    assert result.document == {
        "schema_version": 2,
        "file": "ocs.toml",
        "robot": None,
        "next": "ocs-design size ROBOT --spec ocs.toml",
    }
    assert read_specification(folder / "ocs.toml") == Specification()


def test_a_file_stays_without_force(folder):
    (folder / "ocs.toml").write_text("mine")
    assert run("init").code == 3
    assert (folder / "ocs.toml").read_text() == "mine"
    assert run("init", "--force").code == 0
    assert read_specification(folder / "ocs.toml") == Specification()


def shown_by(*arguments, answers=()):
    """Output of a successful command on a terminal with these answers."""
    code, shown = run_in_terminal(*arguments, answers=answers, COLUMNS="200")
    assert code == 0, shown
    return shown


@pytest.mark.slow
def test_on_a_terminal_it_asks(folder):
    answers = ("nowhere.urdf", SOLO12, "jump", "drop, back-flip", "forty", "45", "", "22.2 V")
    shown = shown_by("init", "-o", "asked.toml", answers=answers)
    for question in ("Robot file", "Maneuvers", "radius", "height", "battery"):
        assert question in shown
    assert "nowhere.urdf does not exist" in shown
    assert "jump: unknown; choose from disturbance, drop, back-flip, all" in shown
    assert re.search(r"r-max: 'forty' is not", shown)
    specification = read_specification(folder / "asked.toml")
    assert [maneuver.name for maneuver in specification.maneuvers] == ["drop", "back-flip"]
    assert (specification.flywheel.r_max, specification.flywheel.h_max) == (0.045, None)
    assert specification.supply.voltage == 22.2


@pytest.mark.slow
def test_on_a_terminal_it_does_not_ask_with_yes(folder):
    shown = shown_by("init", SOLO12, "--yes")
    assert "Robot file" not in shown
    assert (folder / "solo12.toml").exists()
