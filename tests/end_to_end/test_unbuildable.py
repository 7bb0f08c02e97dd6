"""A device that cannot be built says so first in everything that goes to the workshop."""

import csv

import pytest
from commands import SOLO12, run

TOLD = (
    *("cad/bill_of_materials.csv", "cad/drilling.pdf", "cad/assembly.pdf", "robot/README.md"),
    *("cad/wheel.pdf", "cad/wheel.svg"),
)


@pytest.mark.usefixtures("no_alternatives")
def test_files_of_a_device_that_cannot_be_built_say_so(folder):
    """As `size` writes them, and `export` again."""
    high = ("--position", "0,0.09,0.25", "--layout", "pair", "--fall", "2m", "--tilt", "10deg")
    drive = ("--motor", "MN5212 KV340", "--gear", "direct", "--material", "stainless-304")
    result = run("size", SOLO12, *high, *drive, "--no-validate", "-o", "out")
    assert result.code == 1, result.said
    assert "NOT buildable" in result.said
    page = (folder / "out/robot/README.md").read_text()
    assert page.split("\n\n")[1].startswith(
        "**NOT buildable as it stands. The feet hang in the air"
    )
    with (folder / "out/cad/bill_of_materials.csv").open() as stream:
        assert next(csv.DictReader(stream))["part"] == "NOT buildable as it stands"
    sheet = (folder / "out/cad/wheel.svg").read_text()
    assert sheet.count("NOT buildable as it stands") == 2
    again = run("export", "out", "--formats", "bom,drawing,assembly,mjcf", "-o", "again")
    assert again.code == 0, again.said
    for name in TOLD:
        assert (folder / "again" / name).read_bytes() == (folder / "out" / name).read_bytes()
