"""`ocs-design init`, as it is met: its file, its questions, and what `size` makes of it."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from commands import BY_HAND, SOLO12, run, run_in_terminal

from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification

SOLO12_SPECIFICATION = Specification(robot=RobotSection(file=SOLO12))


def test_what_it_writes_means_what_was_stated(folder):
    assert run("init", SOLO12).code == 0
    found = read_specification(folder / "solo12.toml")
    assert Path(found.robot.file).samefile(SOLO12)
    assert replace(found, robot=replace(found.robot, file=SOLO12)) == SOLO12_SPECIFICATION


def test_options_are_stated(folder):
    run("init", SOLO12, "--r-max", "40mm", "--motor", "R80 KV110", "-o", "mine.toml")
    found = read_specification(folder / "mine.toml")
    assert found.flywheel.r_max == 0.04
    assert found.motor.name == "R80 KV110"
    assert found.flywheel.h_max is None


def test_size_reads_it(folder):
    run("init", *BY_HAND, "--motor", "none")
    done = run("size", "--spec", "robot.toml", "--no-validate")
    assert done.code == 0
    assert "robot-ocs" in done.stdout


def test_without_a_robot_it_says_where_the_robot_goes(folder):
    done = run("init", "--json")
    assert done.document == {
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


def asked(*arguments, answers=()):
    """What a command shows that is typed at; it ends well."""
    code, shown = run_in_terminal(*arguments, answers=answers, COLUMNS="200")
    assert code == 0, shown
    return shown


@pytest.mark.slow
def test_on_a_terminal_it_asks(folder):
    answers = ("nowhere.urdf", SOLO12, "jump", "drop, back-flip", "forty", "45", "", "22.2 V")
    shown = asked("init", "-o", "asked.toml", answers=answers)
    for question in ("Robot file", "Maneuvers", "radius", "height", "battery"):
        assert question in shown
    assert "nowhere.urdf does not exist" in shown
    assert "jump: unknown; choose from disturbance, drop, back-flip, all" in shown
    assert re.search(r"r-max: 'forty' is not", shown)
    found = read_specification(folder / "asked.toml")
    assert [maneuver.name for maneuver in found.maneuvers] == ["drop", "back-flip"]
    assert (found.flywheel.r_max, found.flywheel.h_max) == (0.045, None)
    assert found.supply.voltage == 22.2


@pytest.mark.slow
def test_on_a_terminal_it_asks_nothing_if_told_so(folder):
    shown = asked("init", SOLO12, "--yes")
    assert "Robot file" not in shown
    assert (folder / "solo12.toml").exists()
