"""The headline: buildable, level, stands, and the most important remark."""

import re
from dataclasses import replace
from io import StringIO
from math import radians
from pathlib import Path

import pytest
from designed_devices import MOTOR
from rich.console import Console
from stories import design

from ocs_design.device.answers import Validated
from ocs_design.device.records.flights import Buildable, OpenPoint, ValidationRecord
from ocs_design.report.table import Tone
from ocs_design.report.text.layout import items, note, wrapped
from ocs_design.report.text.size import print_summary
from ocs_design.report.verdict import headline


def run(scenario="drop", *, passed=True, level=True, stands=True, ocs=True, reason="why"):
    return ValidationRecord(
        scenario=scenario, ocs=ocs, passed=passed, reason=reason, note="", metrics={},
        can_stand=True, level=level, stands=stands,
    )  # fmt: skip


def verdict(*runs, yes=True, points=(), **motor):
    sized = design(MOTOR)
    robot = replace(sized.robot, sha256=motor.pop("sha256", "12ab"))
    ocs = replace(sized.ocs, motor=replace(sized.ocs.motor, **motor))
    # Without demands no module is turned by hand.
    requirement = replace(sized.requirement, demands=())
    return headline(
        replace(
            sized,
            robot=robot,
            ocs=ocs,
            requirement=requirement,
            validation=runs,
            buildable=Buildable(yes=yes, open=points),
        )
    )


FAILED = {"passed": False, "level": False, "stands": False}
POINT = OpenPoint(what="no source gives the threads", cure="choose another")
VERDICTS = {
    "all flights pass": (
        (run(), run("flip"), run(ocs=False, **FAILED)),
        ("level 2 of 2  ·  stands 2 of 2", Tone.PASS, ""),
    ),
    "a failed flight with its reason": (
        (run(), run("flip", **FAILED, reason="turns 200")),
        ("level 1 of 2  ·  stands 1 of 2", Tone.FAIL, "flip: turns 200"),
    ),
    "an incomplete turn fails though it lands level": (
        (run(), run("flip", passed=False, reason="turns 0 of -360 deg")),
        ("level 2 of 2  ·  stands 2 of 2  ·  1 of 2 pass", Tone.FAIL, "flip: turns 0 of -360 deg"),
    ),
    "a flight that is not judged does not pass": (
        (run(), run("flip", passed=None, level=None, stands=None, reason="not judged: x")),
        ("level 1 of 2  ·  stands 1 of 1  ·  1 of 2 not judged", Tone.FAIL, "flip: not judged: x"),
    ),
    "no flights": ((), ("no flight was simulated", Tone.OPEN, "")),
}


@pytest.mark.parametrize(("runs", "expected"), VERDICTS.values(), ids=VERDICTS)
def test_headline_with_its_most_important_remark(runs, expected):
    line = verdict(*runs)
    assert (line.text.removeprefix("buildable  ·  "), line.tone, line.main_finding) == expected
    assert line.text.startswith("buildable")


def test_an_unbuildable_device_has_its_reason_and_cure():
    line = verdict(run(passed=False, reason="falls"), yes=False, points=(POINT,))
    assert line.text.startswith("NOT buildable")
    assert (line.tone, line.main_finding) == (
        Tone.FAIL,
        "no source gives the threads; choose another",
    )


def test_a_biped_that_lands_level_and_falls_has_a_remark():
    """Its legs cannot stand after a landing, so every flight passes, but none stands."""
    line = verdict(*(run(name, stands=False) for name in ("drop", "flip")))
    assert line.text == "buildable  ·  level 2 of 2  ·  stands 0 of 2"
    assert line.tone is Tone.OPEN
    assert line.main_finding.startswith("drop, flip: the robot lands level and then falls")


def test_a_robot_that_ends_leaning_is_counted_separately():
    line = verdict(run("flip"), replace(run(), metrics={"final_pitch": radians(18.3)}))
    assert line.text == "buildable  ·  level 2 of 2  ·  stands 2 of 2, 1 leaning"
    assert line.tone is Tone.OPEN
    assert "ends leaning: drop 18.3 deg" in line.main_finding


def test_warnings_list_the_failed_flights_that_the_headline_does_not_name():
    runs = run("back-flip", **FAILED, reason="turns 200"), run("flip", **FAILED, reason="turns 9")
    stream = StringIO()
    sized = replace(design(MOTOR), validation=runs, buildable=Buildable(yes=True))
    print_summary(Console(file=stream, width=100), sized, (), Path("out"))
    assert headline(sized).flight == "back-flip"
    _, _, warnings = stream.getvalue().partition("Warnings")
    assert "- flip, with: turns 9" in warnings
    assert "- back-flip, with:" not in warnings


def test_a_robot_without_legs_does_not_stand():
    validated = Validated(design="", robot="", warnings=(), validation=(run(stands=None),))
    assert headline(validated).text == "level 1 of 1"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bus_voltage": None}, "no motor chosen yet"),
        ({"sha256": ""}, "buildable: unknown, because the robot has no geometry"),
        ({}, "buildable: unknown"),
    ],
)
def test_unknown_buildability_has_its_reason(changes, words):
    line = verdict(run(), yes=None, **changes)
    assert line.parts[0].text == words
    assert line.tone is Tone.OPEN


@pytest.mark.parametrize("show", [note, lambda console, text: items(console, [text])])
def test_no_line_ends_between_a_number_and_its_unit(show):
    text = "turns by (0.2, 0.8, 0) N m on the trunk for 0.05 s, 0.1 s after 3 kg m2 and 2.4 m/s up."
    for width in range(20, 60):
        console = Console(file=StringIO(), width=width)
        show(console, text)
        lines = console.file.getvalue().splitlines()
        assert max(map(len, lines)) <= width
        for line in lines[:-1]:
            assert not re.fullmatch(r"[\d.]+", line.split()[-1]), line
            assert not line.rstrip().endswith((" N", " kg")), line
        assert " ".join(" ".join(lines).replace("- ", "").split()) == text
        assert wrapped(text, 1000) == text
