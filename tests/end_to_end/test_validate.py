"""`validate` repeats the flights of a design and samples them; `size --certify` certifies.

A device whose reliability is not certified is sized again.
"""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest
from commands import BOUND, BY_HAND, DROP, failure, run

import ocs_design.workflows.rounds
from ocs_design.monte_carlo.certificate import ROUND_STRIDE, Lesson, certificate
from ocs_design.requirement.uncertainty import spreads


@pytest.mark.slow
def test_flights_are_exactly_those_of_size(product, folder):
    result = run("validate", product.folder, "-o", "again", "--json")
    recorded = json.loads((product.folder / "design.json").read_text())
    assert result.code == product.result.code
    assert result.document["validation"] == recorded["validation"]
    design = json.loads(Path("again/design.json").read_text())
    assert design["ocs"] == recorded["ocs"]
    for name in design["files"]:
        assert (Path("again") / name).read_bytes() == (product.folder / name).read_bytes()


@pytest.mark.slow
def test_samples_are_resumed_and_can_be_repeated(by_hand, folder):
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
    cases = sorted(Path("mc/worst").glob("drop-*.json"))
    case = json.loads(cases[0].read_text())
    options = ("--sample", case["sample"], "--seed", "3")
    for arguments in (("--replay", cases[0]), options):
        document = run("validate", by_hand, *arguments, "--json").document
        assert document["sample"]["values"] == case["values"]
        for flight in document["validation"]:
            assert flight["metrics"] == case["metrics"][flight["scenario"]]


def test_the_text_of_sampled_flights(by_hand, folder):
    output = run("validate", by_hand, "--samples", "2").output
    for part in (
        "touches down at pitch",
        "level 1 of 1",
        "2 sampled robots",
        "95% interval",
        "worst samples ",
        "15.8 .. 100.0 %",
    ):
        assert part in output


def test_uncertainty_is_taken_from_the_specification(by_hand, folder):
    spread_keys = (f"{name} = {int(name == 'contact_friction')}\n" for name in spreads())
    Path("certain.toml").write_text(
        f'[reality]\n{"".join(spread_keys)}[validation]\ncontrol_period = "4ms"\n'
    )
    spec = ("--spec", "certain.toml")
    designed = run("validate", by_hand, *spec, "--json").document["validation"]
    sample = run("validate", by_hand, *spec, "--sample", "1", "--json").document["validation"]
    expected = [flight["metrics"] for flight in designed if flight["ocs"]]
    assert [flight["metrics"] for flight in sample] == expected
    recorded = json.loads((by_hand / "design.json").read_text())["validation"]
    assert expected[0] != recorded[0]["metrics"]


def test_keys_that_do_not_apply_to_a_design_raise_a_warning(by_hand, folder):
    """Once they were ignored without a warning."""
    Path("other.toml").write_text(
        f"{DROP}[motor]\nname = 'auto'\n[flywheel]\nr_max = '30mm'\n"
        "[requirement]\ngravity = 'moon'\n[validation]\nkp = 90\nvideo = false\n"
    )
    (warning,) = run("validate", by_hand, "--spec", "other.toml", "--json").document["warnings"]
    keys = "requirement.gravity, flywheel.r_max, motor.name, validation.video, maneuver 'drop'"
    assert f"not used from the specification: {keys}: " in warning
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
def test_contradictory_options_are_refused(by_hand, folder, options, words):
    result = run("validate", by_hand, *options)
    assert result.code in {2, 3}
    assert words in result.output


def test_a_missing_case_is_an_error_before_any_flight(by_hand, folder):
    result = run("validate", by_hand, "--replay", "nothing.json")
    assert "cannot read the case" in result.output
    assert "plan its flights" not in result.output


def test_quiet_prints_a_failure_as_one_line(by_hand, folder):
    design = json.loads((by_hand / "design.json").read_text())
    for maneuver in design["requirement"]["maneuvers"]:
        maneuver["parameters"]["pitch"] = 1.4
    Path("design.json").write_text(json.dumps(design))
    normal, quiet = (run("validate", "design.json", *flags) for flags in ((), ("-q",)))
    assert (normal.code, quiet.code, quiet.stdout) == (1, 1, "")
    first, second = normal.stdout.splitlines()[-2:]
    assert quiet.stderr == f"{first}  ·  {second}\n"


def test_flights_are_shown_in_real_time(by_hand, folder, monkeypatch):
    """The poses are 15 ms apart: three control steps, the nearest to 60 per second."""
    shown = []
    monkeypatch.setenv("DISPLAY", ":7")
    monkeypatch.setattr(
        "ocs_design.workflows.validate.watch_takes", lambda *arguments: shown.append(arguments)
    )
    assert run("validate", by_hand, "--view").code == 0
    ((takes, seconds),) = shown
    assert len(takes) == 1
    assert seconds == pytest.approx(0.015)


@pytest.mark.slow
def test_a_changed_control_law_is_recorded(by_hand, folder):
    """Repeated flights of the new design are the same, and it accepts cases of these flights."""
    options = ("--spec", "law.toml", "--survives", "one")
    Path("law.toml").write_text("[validation]\nkp = 90.0\n")
    first = run("validate", by_hand, *options, "-o", "first", "--json")
    design = json.loads(Path("first/design.json").read_text())
    assert design["control"]["kp"] == 90.0
    assert design["requirement"]["detection"] > 0.0
    repeated = run("validate", "first", "--json")
    assert repeated.document["validation"] == first.document["validation"]
    assert repeated.document["survival"] == first.document["survival"]
    run("validate", by_hand, *options, "--samples", "1", "-o", "mc", "-q")
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
    command = ("size", *BY_HAND, *BOUND, "--rate-change", "6rad/s", "-q", "-o", "ocs")
    Path("none.toml").write_text('[requirement]\nmaneuvers = "none"\n')
    assert run(*command, "--spec", "none.toml").code == 0
    assert "nothing to fly" in failure(3, "validate", "ocs")


@pytest.mark.slow
def test_too_few_flights_leave_the_certificate_undecided(by_hand):
    """152 of 152 are enough for 99 %: see below, and `test_certificate`.

    The exit code is 1, since the requested certificate is missing.
    """
    result = run("validate", by_hand, "--certify", "--samples", "40", "--json")
    assert result.code == 1
    record = result.document["monte_carlo"]
    outcome = record["certificate"]
    assert (outcome["verdict"], outcome["whole"], outcome["samples"]) == ("undecided", 40, 40)
    assert outcome["passed"] == {"drop": 40}
    assert outcome["interval"]["drop"] == pytest.approx([0.025 ** (1 / 40), 1.0])
    assert (record["samples"], record["asked"]) == (40, 40)


def certified(specification, *options):
    Path("drop.toml").write_text(specification)
    return run("size", *options, "--spec", "drop.toml", "--certify", "--json", "-o", "ocs")


@pytest.mark.slow
def test_a_certificate_is_in_design_and_report_and_can_be_repeated(folder):
    result = certified(DROP, *BY_HAND, *BOUND, "--seed", "3")
    assert result.code == 0
    outcome = result.document["reliability"]
    assert outcome == json.loads(Path("ocs/design.json").read_text())["reliability"]
    assert (outcome["verdict"], outcome["samples"], outcome["round"]) == ("certified", 152, 1)
    assert (outcome["seed"], outcome["first"]) == (3, ROUND_STRIDE)
    assert "certified for 99 %: 152 of 152 pass" in Path("ocs/report.html").read_text()
    record = json.loads(Path("ocs/certificate/monte_carlo.json").read_text())
    assert record["certificate"] == outcome
    case = next(Path("ocs/certificate/worst").glob("drop-*.json"))
    repeated = run("validate", "ocs", "--replay", case, "--json").document
    metrics = json.loads(case.read_text())["metrics"]["drop"]
    assert repeated["validation"][0]["metrics"] == metrics


def test_certification_needs_a_maneuver(folder):
    options = ("--rate-change", "1rad/s", "--certify", "-o", "none")
    message = failure(2, "size", *BY_HAND, *BOUND, *options)
    assert "--certify repeats maneuvers, but none is specified" in message
    assert not (folder / "none").exists()


@pytest.mark.slow
def test_wheels_without_a_motor_are_certified_for_the_reliability(folder):
    """A reliability of 0.9 needs a ninth of the flights of 0.99."""
    result = certified(DROP, *BY_HAND, *BOUND, "--reliability", "0.9")
    assert result.code == 0
    reliability = result.document["reliability"]
    assert (reliability["asked"], reliability["samples"]) == (0.9, 17)
    assert "certified for 90 %" in Path("ocs/report.html").read_text()
    # Without options the reliability of the design applies.
    repeated = run("validate", "ocs", "--certify", "--json").document["monte_carlo"]["certificate"]
    assert repeated["asked"] == 0.9


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize(
    ("factor", "rounds"), [(1.0, 1), pytest.param(1.05, 3, marks=pytest.mark.exhaustive)]
)
def test_an_uncertified_device_is_sized_again_with_new_samples(folder, monkeypatch, factor, rounds):
    """At most twice, and not at all where no reserve helps."""
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
    reliability = result.document["reliability"]
    assert reliability["round"] == rounds
    assert reliability["first"] == rounds * ROUND_STRIDE
    expected = [f"round {number}: falls short" for number in (1, 2)[: min(rounds, 2)]]
    assert [text.split(",")[0] for text in reliability["rounds"]] == expected
