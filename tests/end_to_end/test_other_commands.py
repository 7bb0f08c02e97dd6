"""Other commands than `size`: what they print and open, and films."""

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


@pytest.mark.parametrize(("axis", "share"), [("pitch", np.cos), ("roll", np.sin)])
def test_bound_gives_the_approximate_and_the_exact_inertia(axis, share):
    answer = run(*PAPER, "--alpha", "40deg", "--axis", axis, "--json").document
    assert answer["paper"] == pytest.approx(1.36968e-4, rel=1e-5)
    assert answer["required"] == pytest.approx(0.0515 * 2.0 / 748.0, rel=1e-12)
    per_wheel = answer["required"] / (2.0 * share(np.radians(40.0)))
    assert answer["spin_inertia"] == pytest.approx(per_wheel, rel=1e-12)


def test_the_curve_passes_through_the_bound():
    answer = run(*PAPER, "--json").document
    row = answer["wheel_speeds"].index(answer["wheel_speed_max"])
    column = answer["rate_changes"].index(answer["rate_change"])
    assert answer["curve"][row][column] == pytest.approx(answer["required"] / 0.0515, rel=1e-12)


def test_the_text_of_bound_has_both_inertias():
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
def test_impossible_bounds_are_wrong_usage(options, words):
    assert words in failure(2, *PAPER, *options)


def test_inspect_shows_the_input_of_size():
    document = run("inspect", SOLO12, "--json").document
    robot = document["robot"]
    inertia = np.array(robot["inertia"])
    alpha = equal_rate(inertia)
    assert document["incidence_by_criterion"]["equal-rate"] == pytest.approx(alpha, rel=1e-12)
    nominal = document["incidence_by_posture"][0]
    assert nominal["incidence"] == pytest.approx(alpha, rel=1e-12)
    text = run("inspect", SOLO12).output
    assert "stand, trunk 272 mm over the feet" in text
    assert "FL_FOOT, FR_FOOT, HL_FOOT, HR_FOOT" in text
    assert f"equal-rate {np.degrees(alpha):.3f}" in text
    assert "Joints at stand" not in text
    assert "FL_HFE 0.6435 36.9" in run("inspect", SOLO12, "-v").output


def test_a_missing_solver_is_reported_with_its_extra(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    monkeypatch.chdir(tmp_path)
    assert extra_command("bound") in failure(5, "size", *BY_HAND, *BOUND)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("option", ["-V", "--version"])
def test_the_version_is_printed(option):
    assert run(option).stdout == f"ocs-design {__version__}\n"


def test_json_errors_are_one_document():
    result = run("bound", "--json")
    assert result.code == 2
    assert json.loads(result.stdout)["error"]["kind"] == "usage"


@pytest.mark.slow
@pytest.mark.usefixtures("no_files")
def test_the_demo_sizes_solo12_from_any_folder(folder, monkeypatch):
    """Without a display the path of the report is printed; a second demo does not replace it.

    Wheels alone are quick to size; the notebook tests the defaults.
    """
    original = specification.specification_from_options
    overrides = {"motor.name": "none", "validation.ballistic": True}
    monkeypatch.setattr(
        specification,
        "specification_from_options",
        lambda options: original({**options, **overrides}),
    )
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    result, folder = run("demo"), folder / "solo12-ocs"
    assert result.code == 0
    assert f"no browser to open {folder / 'report.html'}" in result.stderr
    design = read_design(folder / "design.json")
    assert design.robot.name == "solo12"
    assert all(flight.passed for flight in design.validation if flight.ocs)
    second = failure(3, "demo")
    assert "solo12-ocs: exists already" in second
    assert "--force" in second


@pytest.mark.parametrize("open_report", [True, False])
def test_the_report_is_opened_on_request(open_report, no_files, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda page: opened.append(page) or True)
    monkeypatch.setenv("DISPLAY", ":7")
    flags = ("--open",) if open_report else ()
    result = run("size", *BY_HAND, *BOUND, "--no-validate", "-q", "-o", tmp_path / "o", *flags)
    assert (result.code, result.output.strip()) == (0, "")
    assert opened == ([(tmp_path / "o" / "report.html").as_uri()] if open_report else [])


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
def test_video_writes_films_or_says_why_not(tmp_path):
    (tmp_path / "fall.toml").write_text(FALL)
    result = run("size", SOLO12, "--spec", tmp_path / "fall.toml", "-o", tmp_path / "out")
    films = [path.name for path in (tmp_path / "out" / "validation").glob("fall.*")]
    assert result.code in {0, 1}
    assert films in (["fall.mp4"], ["fall.gif"]) or "no video, because" in result.output
