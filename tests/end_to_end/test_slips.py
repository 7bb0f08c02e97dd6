"""Slips of the hand: the table of docs/hostile.md is what is typed here and what is said."""

import re
import shlex
from pathlib import Path

import pytest
from commands import ROOT, SOLO12, all_paths_in, run

ROWS = re.findall(
    r"^\| `ocs-design (.+?)` \| (\d) \| (.+) \|$", (ROOT / "docs/hostile.md").read_text(), re.M
)
SOLO12_TEXT = Path(SOLO12).read_text()


def times(factor, pattern):
    """Solo12's file with all numbers of the attributes that match times a factor."""

    def scaled(match):
        numbers = (repr(factor * float(number)) for number in match[2].split())
        return f"{match[1]}{' '.join(numbers)}{match[3]}"

    return re.sub(rf"({pattern})([^\"]+)(\")", scaled, SOLO12_TEXT)


FILES = {
    "solo12.urdf": SOLO12_TEXT,
    "grams.urdf": times(1000.0, '<mass value="'),
    "millimetres.urdf": times(1000.0, '<origin [^>]*xyz="'),
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
def bench(tmp_path, monkeypatch):
    """A folder with a user's files, where nothing can be sized."""

    def computed(*_arguments, **_options):
        raise AssertionError("a slip is recognised before anything is computed")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("ocs_design.workflows.rounds.design_device", computed)
    for name, content in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    (tmp_path / "gone.urdf").symlink_to("moved.urdf")
    return tmp_path


@pytest.mark.parametrize(("typed", "code", "words"), ROWS, ids=[row[0] for row in ROWS])
def test_what_is_said_of_a_slip(bench, typed, code, words):
    if ".xacro" in typed:
        pytest.importorskip("xacro")
    before = all_paths_in(bench)
    result = run(*shlex.split(typed), "--json")
    error = result.document["error"]
    said = " ".join([error["message"], *error.get("problems", ()), error["hint"]]).split()
    assert result.code == int(code)
    for words_together in words.split(" ... "):
        assert words_together in " ".join(said)
    assert all_paths_in(bench) == before


def test_the_table_is_read():
    assert len(ROWS) > 55
