"""`ocs-design pareto` on the command line."""

import csv
import json
import sys

import pytest
from commands import SOLO12, all_paths_in, failure, run

from ocs_design.requirement.reading import read_specification
from ocs_design.sizing.design import lightest_device
from ocs_design.workflows.pareto import read_task

pytestmark = pytest.mark.slow

ONE_MOTOR = (
    *("--motor", "Antigravity MN6007 II KV320", "--gear", "direct"),
    *("--material", "stainless-304"),
)
"""A single drive and material keep the search fast; the motor is not at its limit."""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Result and folder of a front of Solo12 against time."""
    folder = tmp_path_factory.mktemp("pareto") / "front"
    times = ("--from", "390ms", "--to", "500ms", "--points", "3")
    result = run("pareto", SOLO12, *ONE_MOTOR, *times, "-o", folder, "--json")
    return result, folder


def test_document_and_folder_agree(written):
    result, folder = written
    assert (result.code, result.stderr) == (0, "")
    assert json.loads((folder / "front.json").read_text()) == result.document
    assert all_paths_in(folder) == [
        "front.csv",
        "front.json",
        "front.png",
        "front.svg",
        "points",
        *(f"points/0{index}.toml" for index in (1, 2, 3)),
    ]
    rows = list(csv.DictReader((folder / "front.csv").read_text().splitlines()))
    for row, point in zip(rows, result.document["points"], strict=True):
        assert float(row["time_s"]) == point["value"]
        assert float(row["mass_kg"]) == point["device"]["mass"]


def test_a_missing_tool_is_noted_at_its_step(folder, monkeypatch):
    """The note is at the end of the step that uses it, not among the warnings."""
    monkeypatch.setitem(sys.modules, "resvg_py", None)
    short = ("--from", "390ms", "--to", "400ms", "--points", "2")
    result = run("pareto", SOLO12, *ONE_MOTOR, *short, "-o", "front")
    assert result.code == 0
    assert "warning" not in result.stderr
    assert "write the front figures are not written as PNG, because resvg-py" in result.output


def test_the_specification_of_a_point_gives_its_device(written):
    """At one end; the next test sizes the point in the middle."""
    result, folder = written
    for point in result.document["points"][:1]:
        device = lightest_device(read_task(read_specification(folder / point["file"])))
        assert vars(device) == point["device"]


def test_size_gives_the_device_of_a_point(written, no_alternatives, no_files, tmp_path):
    result, folder = written
    point = result.document["points"][1]
    point_result = run(
        "size", "--spec", folder / point["file"], "--no-validate", "--json", "-o", tmp_path / "ocs"
    )
    assert point_result.code == 0
    design = point_result.document
    assert design["ocs"]["mass_total"] == pytest.approx(point["device"]["mass"], rel=1e-12)
    assert design["ocs"]["incidence"] == point["device"]["incidence"]
    assert design["ocs"]["motor"]["name"] == point["device"]["motor"]
    assert design["ocs"]["flywheel"]["outer_radius"] == point["device"]["outer_radius"]
    first = design["selection"]["ranking"][0]
    assert first["mass"] == point["device"]["mass"]
    parts = ("wheels_mass", "motors_mass", "gears_mass", "housings_mass", "plate_mass")
    assert sum(first[part] for part in parts) == pytest.approx(first["mass"], rel=1e-12)
    # A plate is needed since Solo12's trunk is too narrow for both feet.
    assert first["plate_mass"] > 0.02


def test_the_criterion_for_the_incidence_applies_to_every_point():
    result = run(
        "pareto", SOLO12, *ONE_MOTOR, "--points", "2", "--json", "--alpha-criterion", "pitch-only"
    )
    assert result.code in {0, 4}
    for point in result.document["points"]:
        assert point["device"] is None or point["device"]["incidence"] == 0.0


def test_options_apply_to_every_point(written):
    result, _ = written
    devices = [point["device"] for point in result.document["points"]]
    assert {device["motor"] for device in devices} == {"Antigravity MN6007 II KV320"}
    assert {device["gear"] for device in devices} == {"direct"}


def test_infeasible_values_are_listed_with_exit_code_4():
    short = ("--from", "20ms", "--to", "30ms", "--points", "2")
    message = failure(4, "pareto", SOLO12, *ONE_MOTOR, *short)
    for part in ("No device", "20 ms:", "30 ms:"):
        assert part in message


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--maneuver", "somersault"), 2, "no such maneuver"),
        (("--against", "radius", "--maneuver", "drop"), 2, "is not a figure of a maneuver"),
        (("--from", "2s", "--to", "1s"), 2, "not below"),
        (("--motor", "none"), 2, "needs motors"),
        (("--motor", "no such motor"), 3, "no such motor"),
        (("--r-max", "2mm"), 3, "leaves no room"),
        (("--package-path", "x"), 2, "NAME=DIR"),
    ],
)
def test_impossible_fronts_are_refused(options, code, words):
    assert words in failure(code, "pareto", SOLO12, *options)


def test_without_a_robot_it_is_wrong_usage():
    assert "no robot is given" in failure(2, "pareto")


def test_a_foreign_folder_is_refused_before_the_search(tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    message = failure(3, "pareto", SOLO12, "-o", tmp_path, "--force")
    assert "not an output of ocs-design" in message
    assert "choose a device" not in message
