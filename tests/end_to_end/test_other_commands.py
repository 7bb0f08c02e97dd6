"""Commands beside `size`: what they print and open, and films."""

import json
import sys

import numpy as np
import pytest
from commands import BOUND, BY_HAND, SOLO12, failure, run
from products import equal_rate

from ocs_design import __version__
from ocs_design.common.errors import extra_command
from ocs_design.device.records.design import read_design
from ocs_design.requirement import specification

PAPER = ("bound", "--inertia", "0.0515", "--rate-change", "2", "--wheel-speed-max", "750rad/s")


def test_bound_gives_the_worked_example_and_the_exact_one():
    answer = run(*PAPER, "--alpha", "40deg", "--json").document
    assert answer["paper"] == pytest.approx(1.36968e-4, rel=1e-5)
    assert answer["required"] == pytest.approx(0.0515 * 2.0 / 748.0, rel=1e-12)
    per_wheel = answer["required"] / (2.0 * np.cos(np.radians(40.0)))
    assert answer["spin_inertia"] == pytest.approx(per_wheel, rel=1e-12)


def test_bound_on_roll_takes_the_sine():
    answer = run(*PAPER, "--alpha", "40deg", "--axis", "roll", "--json").document
    per_wheel = answer["required"] / (2.0 * np.sin(np.radians(40.0)))
    assert answer["spin_inertia"] == pytest.approx(per_wheel, rel=1e-12)


def test_the_curve_of_a_bound_passes_through_it():
    answer = run(*PAPER, "--json").document
    row = answer["wheel_speeds"].index(answer["wheel_speed_max"])
    column = answer["rate_changes"].index(answer["rate_change"])
    assert answer["curve"][row][column] == pytest.approx(answer["required"] / 0.0515, rel=1e-12)


def test_bound_in_words_names_both_forms():
    result = run(*PAPER)
    assert (result.code, result.stderr) == (0, "")
    assert "137.701 kg mm2" in result.output
    assert "136.968 kg mm2" in result.output


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--axis", "yaw"), "must be pitch or roll"),
        (("--alpha", "90deg"), "infinitely large"),
        (("--alpha", "91deg"), "above 90 deg"),
        (("--rate-change", "0"), "must be positive"),
        (("--rate-change", "800rad/s"), "infinitely large"),
        (("--inertia", "5kg"), "--inertia"),
    ],
)
def test_a_bound_that_makes_no_sense_is_wrong_usage(options, words):
    assert words in failure(2, *PAPER, *options)


def test_inspect_says_what_size_goes_by():
    found = run("inspect", SOLO12, "--json").document
    robot = found["robot"]
    inertia = np.array(robot["inertia"])
    alpha = equal_rate(inertia)
    assert found["incidence_by_criterion"]["equal-rate"] == pytest.approx(alpha, rel=1e-12)
    nominal = found["incidence_by_posture"][0]
    assert nominal["incidence"] == pytest.approx(alpha, rel=1e-12)
    text = run("inspect", SOLO12).output
    assert "stand, trunk 272 mm over the feet" in text
    assert "FL_FOOT, FR_FOOT, HL_FOOT, HR_FOOT" in text
    assert f"equal-rate {np.degrees(alpha):.3f}" in text
    assert "Joints at stand" not in text
    assert "FL_HFE 0.6435 36.9" in run("inspect", SOLO12, "-v").output


def test_the_bound_alone_names_the_extra_that_it_needs(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    monkeypatch.chdir(tmp_path)
    assert extra_command("bound") in failure(5, "size", *BY_HAND, *BOUND)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("option", ["-V", "--version"])
def test_the_version_is_told(option):
    assert run(option).stdout == f"ocs-design {__version__}\n"


def test_json_errors_are_one_document():
    result = run("bound", "--json")
    assert result.code == 2
    assert json.loads(result.stdout)["error"]["kind"] == "usage"


@pytest.mark.slow
@pytest.mark.usefixtures("no_files")
def test_the_demo_sizes_solo12_from_any_folder(folder, monkeypatch):
    """Without a screen the page's place is said; a second one is not written over it.

    Of wheels alone, which is quick: with all its defaults the notebook sizes it.
    """
    asked = specification.specification_from_options
    quick = {"motor.name": "none", "validation.ballistic": True}
    monkeypatch.setattr(
        specification, "specification_from_options", lambda options: asked({**options, **quick})
    )
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    told, folder = run("demo"), folder / "solo12-ocs"
    assert told.code == 0
    assert f"no browser to open {folder / 'report.html'}" in told.stderr
    design = read_design(folder / "design.json")
    assert design.robot.name == "solo12"
    assert all(flight.passed for flight in design.validation if flight.ocs)
    again = failure(3, "demo")
    assert "solo12-ocs: exists already" in again
    assert "--force" in again


@pytest.mark.parametrize("asked", [True, False])
def test_the_report_is_opened_if_that_is_asked_for(asked, no_files, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda page: opened.append(page) or True)
    monkeypatch.setenv("DISPLAY", ":7")
    flags = ("--open",) if asked else ()
    done = run("size", *BY_HAND, *BOUND, "--no-validate", "-q", "-o", tmp_path / "o", *flags)
    assert (done.code, done.output.strip()) == (0, "")
    assert opened == ([(tmp_path / "o" / "report.html").as_uri()] if asked else [])


FALL = """[motor]
name = "none"
[validation]
video = true
[[maneuver]]
kind = "drop"
name = "fall"
height = "0.4 m"
pitch = "10 deg"
"""


@pytest.mark.slow
def test_a_film_of_each_maneuver_or_the_reason_why_not(tmp_path):
    (tmp_path / "fall.toml").write_text(FALL)
    done = run("size", SOLO12, "--spec", tmp_path / "fall.toml", "-o", tmp_path / "out")
    films = [path.name for path in (tmp_path / "out" / "validation").glob("fall.*")]
    assert done.code in {0, 1}
    assert films in (["fall.mp4"], ["fall.gif"]) or "no video, because" in done.output
