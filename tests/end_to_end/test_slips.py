"""Typing mistakes: commands and messages of the table in docs/hostile.md."""

import re
import shlex
from pathlib import Path

import pytest
from commands import ROOT, SOLO12, all_paths_in, run

ROWS = re.findall(
    r"^\| `ocs-design (.+?)` \| (\d) \| (.+) \|$", (ROOT / "docs/hostile.md").read_text(), re.M
)
SOLO12_TEXT = Path(SOLO12).read_text()


def scaled_file(factor, pattern):
    """Solo12's file with the numbers of matching attributes multiplied by a factor."""

    def scaled(match):
        numbers = (repr(factor * float(number)) for number in match[2].split())
        return f"{match[1]}{' '.join(numbers)}{match[3]}"

    return re.sub(rf"({pattern})([^\"]+)(\")", scaled, SOLO12_TEXT)


FILES = {
    "solo12.urdf": SOLO12_TEXT,
    "grams.urdf": scaled_file(1000.0, '<mass value="'),
    "millimetres.urdf": scaled_file(1000.0, '<origin [^>]*xyz="'),
    "cut.urdf": SOLO12_TEXT[:3000],
    "trunk.stl": "solid trunk\nendsolid",
    "solo12.srdf": '<robot name="solo12"/>',
    "solo12.toml": '[flywheel]\nrmax = "50mm"\n',
    "side.urdf.xacro": '<robot name="r"><link name="$(arg side)"/></robot>',
    "done/design.json": "{}",
    "newer/design.json": '{"schema_version": 9}',
    "mine/notes.txt": "mine",
    "none.toml": "",
}


@pytest.fixture
def user_folder(tmp_path, monkeypatch):
    """A folder with files of a user, where any sizing fails the test."""

    def must_not_run(*_arguments, **_options):
        raise AssertionError("a mistake is recognised before anything is computed")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("ocs_design.workflows.rounds.design_device", must_not_run)
    for name, content in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    (tmp_path / "gone.urdf").symlink_to("moved.urdf")
    return tmp_path


@pytest.mark.parametrize(("arguments", "code", "words"), ROWS, ids=[row[0] for row in ROWS])
def test_a_mistake_gives_the_message_of_the_page(user_folder, arguments, code, words):
    if ".xacro" in arguments:
        pytest.importorskip("xacro")
    before = all_paths_in(user_folder)
    result = run(*shlex.split(arguments), "--json")
    error = result.document["error"]
    text = " ".join([error["message"], *error.get("problems", ()), error["hint"]])
    assert result.code == int(code)
    for part in words.split(" ... "):
        assert part in " ".join(text.split())
    assert all_paths_in(user_folder) == before


def test_the_table_has_all_its_rows():
    assert len(ROWS) > 55
