"""`validate`: the flights of a design again, and many of them as they might come out.

`size --certify` flies until the reliability is certified or not; what falls short is sized anew.
"""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest
from commands import BOUND, BY_HAND, DROP, failure, run

import ocs_design.workflows.rounds
from ocs_design.monte_carlo.certificate import ROUND, Lesson, certificate
from ocs_design.requirement.uncertainty import spreads


@pytest.mark.slow
def test_the_flights_are_those_of_size_to_the_last_bit(product, folder):
    result = run("validate", product.folder, "-o", "again", "--json")
    recorded = json.loads((product.folder / "design.json").read_text())
    assert result.code == product.result.code
    assert result.document["validation"] == recorded["validation"]
    again = json.loads(Path("again/design.json").read_text())
    assert again["ocs"] == recorded["ocs"]
    for name in again["files"]:
        assert (Path("again") / name).read_bytes() == (product.folder / name).read_bytes()


@pytest.mark.slow
def test_samples_go_on_where_they_were_left_and_can_be_flown_again(by_hand, folder):
    command = ("validate", by_hand, "--samples", "5", "--seed", "3", "-o", "mc", "--json")
    first = run(*command)
    assert first.code == 0
    record = first.document["monte_carlo"]
    assert (record["samples"], record["seed"]) == (5, 3)
    before = Path("mc/samples/0000000.npz").stat().st_mtime_ns
    assert run(*command).document == first.document
    assert Path("mc/samples/0000000.npz").stat().st_mtime_ns == before
    assert json.loads(Path("mc/monte_carlo.json").read_text()) == record
    with Path("mc/samples.csv").open(newline="") as stream:
        assert len(list(csv.DictReader(stream))) == 5
    kept = sorted(Path("mc/worst").glob("drop-*.json"))
    case = json.loads(kept[0].read_text())
    drawn = ("--sample", case["sample"], "--seed", "3")
    for how in (("--replay", kept[0]), drawn):
        again = run("validate", by_hand, *how, "--json").document
        assert again["sample"]["values"] == case["values"]
        for flight in again["validation"]:
            assert flight["metrics"] == case["metrics"][flight["scenario"]]


def test_samples_are_told_in_words(by_hand, folder):
    said = run("validate", by_hand, "--samples", "2").output
    for words in (
        "touches down at pitch",
        "level 1 of 1",
        "2 sampled robots",
        "95% interval",
        "the worst samples are",
        "15.8 .. 100.0 %",
    ):
        assert words in said


def test_reality_is_taken_from_the_specification(by_hand, folder):
    certain = (f"{name} = {int(name == 'contact_friction')}\n" for name in spreads())
    Path("certain.toml").write_text(
        f'[reality]\n{"".join(certain)}[validation]\ncontrol_period = "4ms"\n'
    )
    spec = ("--spec", "certain.toml")
    designed = run("validate", by_hand, *spec, "--json").document["validation"]
    sample = run("validate", by_hand, *spec, "--sample", "1", "--json").document["validation"]
    flown = [flight["metrics"] for flight in designed if flight["ocs"]]
    assert [flight["metrics"] for flight in sample] == flown
    recorded = json.loads((by_hand / "design.json").read_text())["validation"]
    assert flown[0] != recorded[0]["metrics"]


def test_keys_that_do_not_apply_to_a_finished_design_are_named(by_hand, folder):
    """They were dropped without a word."""
    Path("other.toml").write_text(
        f"{DROP}[motor]\nname = 'auto'\n[flywheel]\nr_max = '30mm'\n"
        "[requirement]\ngravity = 'moon'\n[validation]\nkp = 90\nvideo = false\n"
    )
    (told,) = run("validate", by_hand, "--spec", "other.toml", "--json").document["warnings"]
    named = "requirement.gravity, flywheel.r_max, motor.name, validation.video, maneuver 'drop'"
    assert f"not used from the specification: {named}: " in told
    Path("flown.toml").write_text("[validation]\nkp = 90\n[reality]\nair_drag = 1\n")
    assert not run("validate", by_hand, "--spec", "flown.toml", "--json").document["warnings"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--samples", "0"), "must be from 1 to"),
        (("--samples", "2", "--sample", "1"), "exclude each other"),
        (("--sample", "-2"), "must be a whole number from 0"),
        (("--reality", "nothing.toml"), "nothing.toml"),
        (("--until-width", "5%"), "add --samples"),
        (("--certify", "--until-width", "5%"), "exclude each other"),
        (("--certify", "--sample", "2"), "leave --certify out"),
        (("--certify", "--replay", "case.json"), "leave --certify out"),
        (("--samples", "2", "--until-width", "2"), "between 0 and 100 %"),
        (("--samples", "2", "--until-width", "5deg"), "unit of angle"),
        (("--samples", "2", "--engine", "cuda"), "must be mujoco or warp"),
        (("--engine", "warp"), "add --samples"),
        (("--certify", "--engine", "warp"), "exclude each other"),
        (("--samples", "2", "--scheduler", "tcp://no:1", "--engine", "warp"), "exclude each other"),
    ],
)
def test_what_makes_no_sense_is_refused(by_hand, folder, options, words):
    result = run("validate", by_hand, *options)
    assert result.code in {2, 3}
    assert words in result.output


def test_a_case_that_is_not_there_is_told_before_anything_is_flown(by_hand, folder):
    result = run("validate", by_hand, "--replay", "nothing.json")
    assert "cannot read the case" in result.output
    assert "plan its flights" not in result.output


def test_a_failure_in_quiet_is_one_line_with_the_verdict(by_hand, folder):
    design = json.loads((by_hand / "design.json").read_text())
    for maneuver in design["requirement"]["maneuvers"]:
        maneuver["parameters"]["pitch"] = 1.4
    Path("design.json").write_text(json.dumps(design))
    loud, quiet = (run("validate", "design.json", *flags) for flags in ((), ("-q",)))
    assert (loud.code, quiet.code, quiet.stdout) == (1, 1, "")
    first, second = loud.stdout.splitlines()[-2:]
    assert quiet.stderr == f"{first}  ·  {second}\n"


def test_flights_are_shown_in_real_time(by_hand, folder, monkeypatch):
    """Poses are three control steps of 5 ms apart, the nearest to 60 a second."""
    shown = []
    monkeypatch.setenv("DISPLAY", ":7")
    monkeypatch.setattr(
        "ocs_design.workflows.validate.watch_takes", lambda *asked: shown.append(asked)
    )
    assert run("validate", by_hand, "--view").code == 0
    ((takes, seconds),) = shown
    assert len(takes) == 1
    assert seconds == pytest.approx(0.015)


@pytest.mark.slow
def test_flights_by_another_law_are_recorded_with_it(by_hand, folder):
    """Flown again from there they are the same, and a case of theirs is known."""
    law = ("--spec", "law.toml", "--survives", "one")
    Path("law.toml").write_text("[validation]\nkp = 90.0\n")
    first = run("validate", by_hand, *law, "-o", "first", "--json")
    design = json.loads(Path("first/design.json").read_text())
    assert design["control"]["kp"] == 90.0
    assert design["requirement"]["detection"] > 0.0
    again = run("validate", "first", "--json")
    assert again.document["validation"] == first.document["validation"]
    assert again.document["survival"] == first.document["survival"]
    run("validate", by_hand, *law, "--samples", "1", "-o", "mc", "-q")
    case = next(Path("mc/worst").iterdir())
    assert run("validate", "first", "--replay", case, "-q").code in {0, 1}
    assert "belongs to another design" in run("validate", by_hand, "--replay", case).output


@pytest.mark.slow
def test_a_case_of_another_design_is_refused(by_hand, folder):
    assert run("validate", by_hand, "--samples", "1", "-o", "mc", "-q").code == 0
    Path("drop.toml").write_text(DROP)
    spec = ("--spec", "drop.toml", "--alpha", "20deg", "--no-validate")
    other = ("size", *BY_HAND, *BOUND, *spec, "-q", "-o", "other")
    assert run(*other).code == 0
    case = next(Path("mc/worst").iterdir())
    assert "another design" in failure(3, "validate", "other", "--replay", case)


def test_a_design_without_maneuvers_has_nothing_to_fly(folder):
    sized = ("size", *BY_HAND, *BOUND, "--rate-change", "6rad/s", "-q", "-o", "ocs")
    Path("none.toml").write_text('[requirement]\nmaneuvers = "none"\n')
    assert run(*sized, "--spec", "none.toml").code == 0
    assert "nothing to fly" in failure(3, "validate", "ocs")


@pytest.mark.slow
def test_what_too_few_flights_say_is_undecided(by_hand):
    """152 of 152 are enough for 99 %: see below, and `test_certificate`.

    A script that asked for a certificate did not get one.
    """
    result = run("validate", by_hand, "--certify", "--samples", "40", "--json")
    assert result.code == 1
    record = result.document["monte_carlo"]
    found = record["certificate"]
    assert (found["verdict"], found["whole"], found["samples"]) == ("undecided", 40, 40)
    assert found["passed"] == {"drop": 40}
    assert found["interval"]["drop"] == pytest.approx([0.025 ** (1 / 40), 1.0])
    assert (record["samples"], record["asked"]) == (40, 40)


def certified(specified, *options):
    Path("drop.toml").write_text(specified)
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


def test_without_a_maneuver_nothing_is_certified(folder):
    asked = ("--rate-change", "1rad/s", "--certify", "-o", "none")
    said = failure(2, "size", *BY_HAND, *BOUND, *asked)
    assert "--certify repeats maneuvers, but none is specified" in said
    assert not (folder / "none").exists()


@pytest.mark.slow
def test_wheels_without_a_motor_are_certified_for_what_is_asked(folder):
    """0.9 takes a ninth of the flights that 0.99 does."""
    result = certified(DROP, *BY_HAND, *BOUND, "--reliability", "0.9")
    assert result.code == 0
    found = result.document["reliability"]
    assert (found["asked"], found["samples"]) == (0.9, 17)
    assert "certified for 90 %" in Path("ocs/report.html").read_text()
    # With nothing specified, as before.
    again = run("validate", "ocs", "--certify", "--json").document["monte_carlo"]["certificate"]
    assert again["asked"] == 0.9


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize(("factor", "rounds"), [(1.0, 1), (1.05, 3)])
def test_what_falls_short_is_sized_anew_and_sees_other_samples(folder, monkeypatch, factor, rounds):
    """At most twice more, and not at all where no reserve helps."""
    rounds_of = ocs_design.workflows.rounds
    monkeypatch.setattr(
        rounds_of,
        "certificate",
        lambda *a, **k: replace(certificate(*a, **k), verdict="falls short"),
    )
    monkeypatch.setattr(rounds_of, "lesson", lambda *_: Lesson(factor, "off level in roll"))
    motor = ("--motor", "AT2814 KV1200", "--gear", "direct")
    result = certified(DROP, *BY_HAND, "--ballistic", *motor, "--reliability", "0.5")
    assert result.code == 1
    found = result.document["reliability"]
    assert found["round"] == rounds
    assert found["first"] == rounds * ROUND
    told = [f"round {number}: falls short" for number in (1, 2)[: min(rounds, 2)]]
    assert [each.split(",")[0] for each in found["rounds"]] == told
