"""What no device can do: which limits are in the way, and changes that really would do."""

import re
from pathlib import Path

import pytest
from commands import BY_HAND, SOLO12, all_paths_in, run

TOO_TIGHT = {
    "radius": ("--r-max", "20mm"),
    "radius and height": ("--r-max", "20mm", "--h-max", "2.5mm"),
    "height": ("--h-max", "2.1mm"),
    "mass": ("--wheel-mass-max", "20g"),
    "slow wheels": ("--wheel-speed-max", "1000rpm"),
    "stress": ("--wheel-speed-max", "50000rpm", "--r-min", "40mm"),
    "room": ("--wall-min", "40mm", "--r-min", "20mm"),
    "thin room": ("--r-max", "49mm", "--r-min", "48mm"),
    "rate": ("--rate-change", "30rad/s", "--r-max", "30mm"),
}
ONE_KIND = ("--gear", "direct", "--material", "stainless-304")
WHEELS_ALONE = ("--motor", "none", "--no-validate")
TOO_WEAK = "Antigravity 4004 KV300"
NEEDED_MOTOR = re.compile(
    r"A motor with about [\d.]+ N m peak torque and [\d,]+ rpm no-load speed at \d+ V, "
    r"weighing at most [\d.]+ kg, would do\."
)
RELAXATION = re.compile(
    r"\b(?P<key>[a-z_]+) (?P<figure>[\d.e+]+)(?: (?P<unit>mm|g|rpm))?(?=[;.] ?)"
)


def refused(*typed):
    """What the JSON says of a device that cannot be; nothing stands beside it, and none is left."""
    result = run("size", *typed, "--json")
    error = result.document["error"]
    assert (result.code, result.stderr, error["kind"]) == (4, "", "infeasible")
    assert all_paths_in(".") == []
    return error


@pytest.mark.slow
@pytest.mark.parametrize(
    "robot_given",
    [
        pytest.param((SOLO12,), marks=pytest.mark.exhaustive, id="Solo12"),
        pytest.param(BY_HAND, id="by hand"),
    ],
)
@pytest.mark.parametrize(
    "limits",
    [
        pytest.param(limits, id=name, marks=[pytest.mark.exhaustive] * (index % 2))
        for index, (name, limits) in enumerate(TOO_TIGHT.items())
    ],
)
def test_what_the_hint_proposes_works_as_it_is_printed(folder, no_files, limits, robot_given):
    error = refused(*robot_given, *limits, *WHEELS_ALONE)
    assert error["binding"]
    assert error["largest_spin_inertia"] < error["required_spin_inertia"]
    proposed = {match["key"]: match for match in RELAXATION.finditer(error["hint"] + " ")}
    assert set(proposed) | {"hoop_stress"} == set(error["relaxations"]) | {"hoop_stress"}
    assert error["relaxations"]
    for key, match in proposed.items():
        typed = (f"--{key.replace('_', '-')}", f"{match['figure']}{match['unit'] or ''}")
        mended = run("size", *robot_given, *limits, *typed, *WHEELS_ALONE, "-o", key)
        assert mended.code == 0, (typed, mended.output)
    assert sorted(path.name for path in folder.iterdir()) == sorted(proposed)


def test_a_missing_authority_is_no_matter_of_size(folder):
    error = refused(SOLO12, "--alpha", "0", "--motor", "none")
    assert (error["binding"], error["relaxations"]) == (["incidence"], {})
    assert "roll momentum" in error["message"]


@pytest.mark.slow
def test_no_motor_reaches_an_axis_that_the_incidence_leaves_out(folder):
    error = refused(SOLO12, "--alpha", "0", "--motor", "R80 KV110", *ONE_KIND)
    assert (error["relaxations"], error["required_spin_inertia"]) == ({}, None)
    assert "axis out of reach" in error["message"]
    # That is so, and no limit of the room has any part in it.
    assert "Other incidences are feasible: leave out --alpha" in error["hint"]
    assert "limit" not in error["hint"]


@pytest.mark.slow
def test_two_motors_that_are_both_too_weak(folder):
    """Four times Solo12, with motors of its size: more time would do, and so would a third one."""
    weak = ("--mass", "10", "--inertia", "0.3,0.45,0.5", "--motor", f"{TOO_WEAK}, MN4014 KV400")
    error = refused(*weak, *ONE_KIND)
    assert error["binding"] == ["torque"]
    said = r"None of 2 motors can do it at 24 V with \d wheels; MN4014 KV400 comes closest"
    assert re.search(said, error["message"])
    assert NEEDED_MOTOR.search(error["hint"]), error["hint"]
    assert set(error["relaxations"]) == {"time"}
    for key in ("drop height", "back-flip jump_height", "duration"):
        assert key in error["hint"]


WEAK = ("--motor", TOO_WEAK, "--layout", "pair", *ONE_KIND)


@pytest.fixture
def odd(folder):
    """Limits of a joint leave it no room."""
    text = re.sub('upper="[^"]*"', 'upper="-99"', Path(SOLO12).read_text(), count=1)
    (folder / "odd.urdf").write_text(text)
    return "odd.urdf"


@pytest.mark.slow
def test_doubts_are_told_before_the_search_and_assumptions_after_it(odd):
    said = run("size", odd, *WEAK)
    doubt, search = said.stderr.index("warning"), said.stderr.index("size the device")
    assert doubt < search < said.stderr.index("Assumed") < said.stderr.index("falls from 1 m")
    assert said.stdout == ""
    front = run("pareto", odd, *WEAK, "--points", "2").stderr
    assert front.index("warning") < front.index("choose a device")
    specified = run("size", SOLO12, *WEAK, "--fall", "1m", "--tilt", "30deg", "--json")
    assert specified.document["error"]["warnings"] == []
    assert "defaults" not in specified.document["error"]["hint"]


@pytest.mark.slow
def test_a_refusal_tells_what_is_doubted_what_was_assumed_and_what_nobody_asked_for(odd):
    error = run("size", odd, *WEAK, "--json").document["error"]
    assert error["warnings"]
    assert "drop: falls from 1 m at roll 0 deg and pitch 30 deg." in error["assumptions"]
    assert error["hint"].startswith(
        "No maneuver was specified, so the defaults apply: disturbance, drop, back-flip. Specify"
    )
    slower = re.findall(r"drop height (\d\.\d+) m", error["hint"])
    assert len(slower) == 1, "said once"
    assert "falls from" not in error["hint"]
    given = float(re.search(r"([\d.]+) s given", error["message"])[1]) + 0.0005
    longer = (error["relaxations"]["time"] ** 2 - 1.0) * 9.81 / 2.0 * given**2
    assert 1.0 + longer <= float(slower[0]) <= 1.01 * (1.0 + longer), "rounded to the safe side"
