"""`size` with names that are HTML, formulas, markup, paths or terminal commands."""

import csv
import json
import re
from pathlib import Path
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

import mujoco
import pytest
from commands import SOLO12, run

from ocs_design.robot.reader import read_robot

HOSTILE = '=<b onload="x()">&\'[bold]x[/nope]../../a\x9b31m\u202ez'
CONTROL = set("\x9b\u202e\x1b")


@pytest.fixture(scope="module")
def sized(tmp_path_factory):
    """Result and folder of `size` for Solo12 with its robot, trunk and a joint of that name."""
    folder = tmp_path_factory.mktemp("hostile")
    text = Path(SOLO12).read_text()
    text = re.sub(
        '<robot name="[^"]*"', lambda _: f"<robot name={quoteattr('../../' + HOSTILE)}", text
    )
    for name in ("base_link", "FL_HAA"):
        text = text.replace(f'"{name}"', quoteattr(HOSTILE))
    (folder / "robot.urdf").write_text(text)
    result = run(
        *("size", folder / "robot.urdf", "--motor", "none", "--no-validate"),
        *("-o", folder / "out"),
    )
    return result, folder


def test_it_is_sized_without_files_elsewhere(sized):
    result, folder = sized
    assert result.code == 0
    assert sorted(path.name for path in folder.iterdir()) == ["out", "robot.urdf"]
    for path in (folder / "out").rglob("*"):
        assert re.fullmatch(r"[\w.-]+", path.name), path


def test_the_terminal_gets_no_control_characters(sized):
    result, folder = sized
    output = result.stdout + run("inspect", folder / "robot.urdf").stdout
    assert "[bold]x[/nope]" in output
    assert not CONTROL & set(output)


def test_every_file_is_well_formed_and_keeps_the_name(sized):
    out = sized[1] / "out"
    for suffix in ("urdf", "xml", "xacro", "sdf", "svg"):
        assert [ET.parse(path) for path in out.rglob(f"*.{suffix}")]
    urdf = next((out / "robot").glob("*.urdf"))
    assert read_robot(urdf).tree.bodies[0].name == HOSTILE
    model = mujoco.MjModel.from_xml_path(str(next((out / "robot").glob("*_ocs.xml"))))
    assert model.body(HOSTILE).id > 0
    assert json.loads((out / "design.json").read_bytes())["robot"]["trunk"] == HOSTILE


def test_names_are_escaped_in_html(sized):
    pages = [path.read_text() for path in (sized[1] / "out").rglob("*.html")]
    assert pages
    assert not [page for page in pages if "<b onload" in page.lower()]


def test_no_cell_of_the_bill_is_a_formula(sized, tmp_path):
    with (sized[1] / "out" / "cad" / "bill_of_materials.csv").open(newline="") as stream:
        cells = [cell for row in csv.reader(stream) for cell in row]
    assert cells
    assert not [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]


def test_a_catalogue_of_the_user_is_shown_without_control_characters(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text('name,maker,source\n"\x1b[2J[/nope]<b>","=cmd()","x"\n')
    result = run("catalogue", "motors", "--motors", path)
    assert result.code == 0
    assert "[/nope]<b>" in result.stdout
    assert not CONTROL & set(result.stdout)
