"""`size --certify`: flown until it is sure; what falls short is sized anew."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from commands import BOUND, BY_HAND, run
from robots import SOLO12

import ocs_design.workflows.rounds
from ocs_design.monte_carlo.certificate import ROUND, Lesson, certificate

DROP = """[[maneuver]]
kind = "drop"
name = "drop"
height = 1.0
pitch = "20deg"
"""


def certified(stated, *options):
    Path("drop.toml").write_text(stated)
    return run("size", *options, "--spec", "drop.toml", "--certify", "--json", "-o", "ocs")


@pytest.mark.slow
def test_a_certificate_is_in_the_design_in_its_report_and_can_be_flown_again(folder):
    result = certified(DROP, *BY_HAND, *BOUND, "--seed", "3")
    assert result.code == 0
    found = result.document["reliability"]
    assert found == json.loads(Path("ocs/design.json").read_text())["reliability"]
    assert (found["verdict"], found["samples"], found["round"]) == ("certified", 152, 1)
    assert (found["seed"], found["first"]) == (3, ROUND)
    assert "certified for 99 %: 152 of 152 pass" in Path("ocs/report.html").read_text()
    record = json.loads(Path("ocs/certificate/monte_carlo.json").read_text())
    assert record["certificate"] == found
    case = next(Path("ocs/certificate/worst").glob("drop-*.json"))
    again = run("validate", "ocs", "--replay", case, "--json").document
    metrics = json.loads(case.read_text())["metrics"]["drop"]
    assert again["validation"][0]["metrics"] == metrics


def test_wheels_without_a_motor_are_certified_for_what_is_asked(folder):
    """0.9 takes a ninth of the flights that 0.99 does."""
    result = certified(DROP, *BY_HAND, *BOUND, "--reliability", "0.9")
    assert result.code == 0
    found = result.document["reliability"]
    assert (found["asked"], found["samples"]) == (0.9, 17)
    assert "certified for 90 %" in Path("ocs/report.html").read_text()
    # With nothing stated, as before.
    again = run("validate", "ocs", "--certify", "--json").document["monte_carlo"]["certificate"]
    assert again["asked"] == 0.9


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives")
@pytest.mark.parametrize(
    ("factor", "rounds", "robot"),
    [(1.0, 1, BY_HAND), (1.05, 3, (SOLO12,))],
)
def test_what_falls_short_is_sized_anew_and_sees_other_samples(
    folder, monkeypatch, factor, rounds, robot
):
    """At most twice more, and not at all where no reserve helps."""
    rounds_of = ocs_design.workflows.rounds
    monkeypatch.setattr(
        rounds_of,
        "certificate",
        lambda *a, **k: replace(certificate(*a, **k), verdict="falls short"),
    )
    monkeypatch.setattr(rounds_of, "lesson", lambda *_: Lesson(factor, "off level in roll"))
    motor = ("--motor", "AT2814 KV1200")
    result = certified(DROP, *robot, "--ballistic", *motor, "--reliability", "0.5")
    assert result.code == 1
    found = result.document["reliability"]
    assert found["round"] == rounds
    assert found["first"] == rounds * ROUND
    told = [f"round {number}: falls short" for number in (1, 2)[: min(rounds, 2)]]
    assert [each.split(",")[0] for each in found["rounds"]] == told
