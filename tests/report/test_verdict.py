"""The line that is read first: buildable, level, stands, and the one thing that matters most."""

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
from ocs_design.device.records.device import Buildable, OpenPoint
from ocs_design.device.records.flights import ValidationRecord
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
    found = design(MOTOR)
    robot = replace(found.robot, sha256=motor.pop("sha256", "12ab"))
    ocs = replace(found.ocs, motor=replace(found.ocs.motor, **motor))
    # As the design stands, no module is turned by hand.
    requirement = replace(found.requirement, demands=())
    return headline(
        replace(
            found,
            robot=robot,
            ocs=ocs,
            requirement=requirement,
            validation=runs,
            buildable=Buildable(yes=yes, open=points),
        )
    )


OFF = {"passed": False, "level": False, "stands": False}
POINT = OpenPoint(what="no source gives the threads", cure="choose another")
VERDICTS = {
    "all is well": (
        (run(), run("flip"), run(ocs=False, **OFF)),
        ("level 2 of 2  ·  stands 2 of 2", Tone.PASS, ""),
    ),
    "a flight that fails is named with its reason": (
        (run(), run("flip", **OFF, reason="turns 200")),
        ("level 1 of 2  ·  stands 1 of 2", Tone.FAIL, "flip: turns 200"),
    ),
    "a turn that falls short is no pass though it lands level": (
        (run(), run("flip", passed=False, reason="turns 0 of -360 deg")),
        ("level 2 of 2  ·  stands 2 of 2  ·  1 of 2 pass", Tone.FAIL, "flip: turns 0 of -360 deg"),
    ),
    "what was not judged is no pass": (
        (run(), run("flip", passed=None, level=None, stands=None, reason="not judged: x")),
        ("level 1 of 2  ·  stands 1 of 1  ·  1 of 2 not judged", Tone.FAIL, "flip: not judged: x"),
    ),
    "nothing was flown": ((), ("no flight was simulated", Tone.OPEN, "")),
}


@pytest.mark.parametrize(("runs", "expected"), VERDICTS.values(), ids=VERDICTS)
def test_the_line_and_what_matters_most(runs, expected):
    line = verdict(*runs)
    assert (line.text.removeprefix("buildable  ·  "), line.tone, line.main_finding) == expected
    assert line.text.startswith("buildable")


def test_what_cannot_be_built_says_why_and_what_would_do():
    line = verdict(run(passed=False, reason="falls"), yes=False, points=(POINT,))
    assert line.text.startswith("NOT buildable")
    assert (line.tone, line.main_finding) == (
        Tone.FAIL,
        "no source gives the threads; choose another",
    )


def test_a_biped_that_lands_level_and_falls_is_told():
    """Its legs bear no landing, so every flight passes, and none of them stands."""
    line = verdict(*(run(name, stands=False) for name in ("drop", "flip")))
    assert line.text == "buildable  ·  level 2 of 2  ·  stands 0 of 2"
    assert line.tone is Tone.OPEN
    assert line.main_finding.startswith("drop, flip: the robot lands level and then falls")


def test_a_robot_that_ends_leaning_is_not_said_to_stand_like_the_others():
    line = verdict(run("flip"), replace(run(), metrics={"final_pitch": radians(18.3)}))
    assert line.text == "buildable  ·  level 2 of 2  ·  stands 2 of 2, 1 leaning"
    assert line.tone is Tone.OPEN
    assert "ends leaning: drop 18.3 deg" in line.main_finding


def test_a_flight_that_fails_is_minded_though_the_verdict_names_one_of_its_letters():
    runs = run("back-flip", **OFF, reason="turns 200"), run("flip", **OFF, reason="turns 9")
    screen = StringIO()
    found = replace(design(MOTOR), validation=runs, buildable=Buildable(yes=True))
    print_summary(Console(file=screen, width=100), found, (), Path("out"))
    assert headline(found).flight == "back-flip"
    _, _, minded = screen.getvalue().partition("Warnings")
    assert "- flip, with: turns 9" in minded
    assert "- back-flip, with:" not in minded


def test_a_robot_without_legs_does_not_stand():
    flown = Validated(design="", robot="", warnings=(), validation=(run(stands=None),))
    assert headline(flown).text == "level 1 of 1"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bus_voltage": None}, "no motor chosen yet"),
        ({"sha256": ""}, "buildable: unknown, because the robot has no geometry"),
        ({}, "buildable: unknown"),
    ],
)
def test_where_it_cannot_be_told_it_says_so(changes, words):
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
