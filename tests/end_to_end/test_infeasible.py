"""Infeasible requirements: the active limits, and changes that make a device feasible."""

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
ONE_MATERIAL = ("--gear", "direct", "--material", "stainless-304")
WHEELS_ALONE = ("--motor", "none", "--no-validate")
TOO_WEAK = "Antigravity 4004 KV300"
NEEDED_MOTOR = re.compile(
    r"A motor with about [\d.]+ N m peak torque and [\d,]+ rpm no-load speed at \d+ V, "
    r"weighing at most [\d.]+ kg, would do\."
)
RELAXATION = re.compile(
    r"\b(?P<key>[a-z_]+) (?P<figure>[\d.e+]+)(?: (?P<unit>mm|g|rpm))?(?=[;.] ?)"
)


def refused(*arguments):
    """The error document of an infeasible device; nothing else is printed or written."""
    result = run("size", *arguments, "--json")
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
def test_changes_proposed_by_the_hint_work_as_printed(folder, no_files, limits, robot_given):
    error = refused(*robot_given, *limits, *WHEELS_ALONE)
    assert error["binding"]
    assert error["largest_spin_inertia"] < error["required_spin_inertia"]
    proposed = {match["key"]: match for match in RELAXATION.finditer(error["hint"] + " ")}
    assert set(proposed) | {"hoop_stress"} == set(error["relaxations"]) | {"hoop_stress"}
    assert error["relaxations"]
    for key, match in proposed.items():
        option = (f"--{key.replace('_', '-')}", f"{match['figure']}{match['unit'] or ''}")
        result = run("size", *robot_given, *limits, *option, *WHEELS_ALONE, "-o", key)
        assert result.code == 0, (option, result.output)
    assert sorted(path.name for path in folder.iterdir()) == sorted(proposed)


def test_a_missing_control_authority_does_not_depend_on_size(folder):
    error = refused(SOLO12, "--alpha", "0", "--motor", "none")
    assert (error["binding"], error["relaxations"]) == (["incidence"], {})
    assert "roll momentum" in error["message"]


@pytest.mark.slow
def test_no_motor_acts_about_an_axis_perpendicular_to_the_wheels(folder):
    error = refused(SOLO12, "--alpha", "0", "--motor", "R80 KV110", *ONE_MATERIAL)
    assert (error["relaxations"], error["required_spin_inertia"]) == ({}, None)
    assert "axis out of reach" in error["message"]
    # No limit of the dimensions is involved.
    assert "Other incidences are feasible: leave out --alpha" in error["hint"]
    assert "limit" not in error["hint"]


@pytest.mark.slow
def test_two_motors_that_are_both_too_weak(folder):
    """A robot four times as heavy as Solo12: more time or a stronger motor would suffice."""
    robot = ("--mass", "10", "--inertia", "0.3,0.45,0.5")
    error = refused(*robot, "--motor", f"{TOO_WEAK}, MN4014 KV400", *ONE_MATERIAL)
    assert error["binding"] == ["torque"]
    pattern = r"None of 2 motors can do it at 24 V with \d wheels; MN4014 KV400 comes closest"
    assert re.search(pattern, error["message"])
    assert NEEDED_MOTOR.search(error["hint"]), error["hint"]
    assert set(error["relaxations"]) == {"time"}
    for key in ("drop height", "back-flip jump_height", "duration"):
        assert key in error["hint"]


WEAK = ("--motor", TOO_WEAK, "--layout", "pair", *ONE_MATERIAL)


@pytest.fixture
def odd_robot(folder):
    """Solo12 with contradictory limits of a joint."""
    text = re.sub('upper="[^"]*"', 'upper="-99"', Path(SOLO12).read_text(), count=1)
    (folder / "odd.urdf").write_text(text)
    return "odd.urdf"


@pytest.mark.slow
def test_warnings_come_before_the_search_and_assumptions_after_it(odd_robot):
    result = run("size", odd_robot, *WEAK)
    warning, search = result.stderr.index("warning"), result.stderr.index("size the device")
    assert warning < search < result.stderr.index("Assumed") < result.stderr.index("falls from 1 m")
    assert result.stdout == ""
    front = run("pareto", odd_robot, *WEAK, "--points", "2").stderr
    assert front.index("warning") < front.index("choose a device")
    specified = run("size", SOLO12, *WEAK, "--fall", "1m", "--tilt", "30deg", "--json")
    assert specified.document["error"]["warnings"] == []
    assert "defaults" not in specified.document["error"]["hint"]


@pytest.mark.slow
def test_a_refusal_has_warnings_assumptions_and_default_maneuvers(odd_robot):
    error = run("size", odd_robot, *WEAK, "--json").document["error"]
    assert error["warnings"]
    assert "drop: falls from 1 m at roll 0 deg and pitch 30 deg." in error["assumptions"]
    assert error["hint"].startswith(
        "No maneuver was specified, so the defaults apply: disturbance, drop, back-flip. Specify"
    )
    heights = re.findall(r"drop height (\d\.\d+) m", error["hint"])
    assert len(heights) == 1, "said once"
    assert "falls from" not in error["hint"]
    time_given = float(re.search(r"([\d.]+) s given", error["message"])[1]) + 0.0005
    height = 1.0 + (error["relaxations"]["time"] ** 2 - 1.0) * 9.81 / 2.0 * time_given**2
    assert height <= float(heights[0]) <= 1.01 * height, "rounded to the safe side"
