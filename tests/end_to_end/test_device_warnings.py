"""Warnings of a device that is too heavy, above its rated voltage, or not buildable."""

import csv

import pytest
from commands import SOLO12, all_paths_in, failure, run, writing_only

from ocs_design.catalogue.motors import motors

HARD_TO_TURN = ("size", "--mass", "1.2", "--inertia", "0.1,0.15,0.18", "--no-validate")
"""A robot with the inertia of one of three times its mass."""
ONE_MATERIAL = ("--gear", "direct", "--material", "stainless-304")


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
def test_strict_refuses_a_heavy_device(folder):
    result = run(
        *HARD_TO_TURN, "--motor", "Antigravity MN5006 KV450", *ONE_MATERIAL, "--strict", "--json"
    )
    error = result.document["error"]
    assert (result.code, error["kind"]) == (3, "specification")
    assert "of the robot" in error["message"]
    assert all_paths_in(folder) == []


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize(
    ("voltage", "warned"),
    [("24V", True), pytest.param("16.8V", False, marks=pytest.mark.exhaustive)],
)
def test_a_motor_above_its_rated_voltage_raises_a_warning(folder, voltage, warned):
    name = "AT2814 KV1050"
    assert motors()[name].rated_voltage == 16.8
    drive = ("--motor", name, "--bus-voltage", voltage, *ONE_MATERIAL, "--no-validate")
    options = ("--layout", "pair", "--fall", "1m", "-o", "out")
    result = run("size", "--mass", "1.2", "--inertia", "0.02,0.03,0.035", *drive, *options)
    assert result.code == 0, result.output
    words = f"{name} is rated for 16.8 V but runs at 24 V: ask the makers"
    assert (words in result.output) is warned


FILES = (
    *("cad/bill_of_materials.csv", "cad/drilling.pdf", "cad/assembly.pdf", "robot/README.md"),
    *("cad/wheel.pdf", "cad/wheel.svg"),
)


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives")
def test_files_of_a_device_that_cannot_be_built_say_so(folder):
    """Both the files of `size` and those of `export`."""
    options = ("--position", "0,0.09,0.25", "--layout", "pair", "--fall", "2m", "--tilt", "10deg")
    drive = ("--motor", "MN5212 KV340", "--gear", "direct", "--material", "stainless-304")
    with writing_only("bom", "drawing", "assembly", "mjcf"):
        message = failure(1, "size", SOLO12, *options, *drive, "--no-validate", "-o", "out")
    assert "NOT buildable" in message
    page = (folder / "out/robot/README.md").read_text()
    assert page.split("\n\n")[1].startswith(
        "**NOT buildable as it stands. The feet hang in the air"
    )
    with (folder / "out/cad/bill_of_materials.csv").open() as stream:
        assert next(csv.DictReader(stream))["part"] == "NOT buildable as it stands"
    sheet = (folder / "out/cad/wheel.svg").read_text()
    assert sheet.count("NOT buildable as it stands") == 2
    again = run("export", "out", "--formats", "bom,drawing,assembly,mjcf", "-o", "again")
    assert again.code == 0, again.output
    for name in FILES:
        assert (folder / "again" / name).read_bytes() == (folder / "out" / name).read_bytes()
