"""Bad input of every kind: the right exit code, words to act on, nothing left behind."""

import re

import pytest
from bad_input import CASES
from commands import BOUND, all_paths_in, environment, failure, run, run_process
from urdf_text import inertial, link, robot


@pytest.mark.parametrize(("files", "typed", "expected", "words"), CASES.values(), ids=CASES)
def test_bad_input_is_explained(folder, files, typed, expected, words):
    for name, content in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    before = all_paths_in(folder)
    said = run(*typed.split())
    assert (said.code, said.stdout) == (expected[0], "")
    for word in words.split("|"):
        assert re.search(word, said.output), said.stderr
    check_json(run(*typed.split(), "--json"), expected, words)
    assert all_paths_in(folder) == before


def check_json(result, expected, words):
    """One document, which says what the panel says, and nothing beside it."""
    assert (result.code, result.stderr) == (expected[0], "")
    assert set(result.document) == {"schema_version", "error"}
    error = result.document["error"]
    assert error["kind"] == expected[1]
    everything = " ".join([error["message"], *error.get("problems", ()), error["hint"]])
    for word in words.split("|"):
        assert re.search(word, everything, re.DOTALL)


def test_a_xacro_that_cannot_be_expanded(tmp_path, monkeypatch):
    pytest.importorskip("xacro")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><link name="${n}"/></robot>'
    )
    assert "x.xacro: xacro cannot expand the file" in failure(3, "size", "x.xacro")
    assert all_paths_in(tmp_path) == ["x.xacro"]


SHAPED = robot(
    link("trunk", inertial(2.0, "0.02 0.03 0.04"), "<visual><geometry>{}</geometry></visual>")
).decode()


@pytest.mark.parametrize(
    ("content", "warning"),
    [
        (SHAPED.format('<mesh filename="package://gone/trunk.stl"/>').encode(), "gone/trunk.stl"),
        (SHAPED.format('<mesh filename="tr\xfcnk.stl"/>').encode("latin-1"), "not UTF-8"),
    ],
    ids=["a mesh that is not there", "undeclared Latin-1"],
)
def test_what_is_only_odd_works_with_a_warning(folder, content, warning):
    (folder / "rover.urdf").write_bytes(content)
    result = run("size", "rover.urdf", *BOUND, "--no-validate")
    assert result.code == 0
    assert re.search(rf"Warnings.* - .*{warning}", result.output)
    strict = run(
        "size", "rover.urdf", *BOUND, "--no-validate", "--strict", "-o", "strict", "--json"
    )
    assert (strict.code, strict.document["error"]["kind"]) == (3, "robot")
    assert warning in strict.document["error"]["message"]
    assert sorted(path.name for path in folder.iterdir()) == ["rover.urdf", "test-ocs"]


@pytest.mark.parametrize(
    "typed", [pytest.param("size rover.urdf --json", marks=pytest.mark.slow), "siez"]
)
def test_a_process_of_its_own_says_the_same(folder, typed):
    """All else here runs inside the tests' own process."""
    own = run_process(*typed.split(), env=environment(COLUMNS="80"))
    here = run(*typed.split())
    assert (own.code, without_times(own.output)) == (here.code, without_times(here.output))
    assert own.stdout == here.stdout
    assert all_paths_in(folder) == []


def without_times(said):
    return re.sub(r"[0-9.]+ s\b", "", said)
