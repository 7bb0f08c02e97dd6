"""Bad input of every kind: the right exit code, a helpful message, no files left behind."""

import re

import pytest
from bad_input import CASES
from commands import BOUND, all_paths_in, environment, failure, run, run_process
from urdf_text import inertial, link, robot


@pytest.mark.parametrize(("files", "command", "expected", "words"), CASES.values(), ids=CASES)
def test_bad_input_is_explained(folder, files, command, expected, words):
    for name, content in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    before = all_paths_in(folder)
    result = run(*command.split())
    assert (result.code, result.stdout) == (expected[0], "")
    for word in words.split("|"):
        assert re.search(word, result.output), result.stderr
    check_json(run(*command.split(), "--json"), expected, words)
    assert all_paths_in(folder) == before


def check_json(result, expected, words):
    """The output is one document with the contents of the panel, and nothing else."""
    assert (result.code, result.stderr) == (expected[0], "")
    assert set(result.document) == {"schema_version", "error"}
    error = result.document["error"]
    assert error["kind"] == expected[1]
    text = " ".join([error["message"], *error.get("problems", ()), error["hint"]])
    for word in words.split("|"):
        assert re.search(word, text, re.DOTALL)


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
def test_odd_but_usable_files_only_raise_a_warning(folder, content, warning):
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
    "command", [pytest.param("size rover.urdf --json", marks=pytest.mark.slow), "siez"]
)
def test_a_separate_process_gives_the_same_output(folder, command):
    """All other commands here run within the process of the tests."""
    separate = run_process(*command.split(), env=environment(COLUMNS="80"))
    within = run(*command.split())
    assert (separate.code, separate.stdout) == (within.code, within.stdout)
    assert without_times(separate.output) == without_times(within.output)
    assert all_paths_in(folder) == []


def without_times(text):
    return re.sub(r"[0-9.]+ s\b", "", text)
