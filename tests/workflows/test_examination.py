"""`doctor`: the machine and what works on it."""

import json
from dataclasses import replace
from importlib import metadata
from io import StringIO

import pytest
from commands import run
from rich.console import Console
from scripts import HEAVY, modules_loaded_by

from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.device.findings import Examination, Finding, State
from ocs_design.report.text.answers import print_examination
from ocs_design.workflows import doctor
from ocs_design.workflows.doctor import (
    compiler,
    examination_to_json,
    examine,
    film_maker,
    opengl,
    processors,
    python,
    working_folder,
)


def finding(state, *, required):
    return Finding(name="it", state=state, required=required, purpose="all")


@pytest.mark.parametrize(
    ("state", "required", "code"),
    [
        (State.WORKS, True, 0),
        (State.MISSING, False, 0),
        (State.BROKEN, False, 0),
        (State.MISSING, True, 5),
        (State.UNFIT, True, 5),
        (State.BROKEN, True, 5),
    ],
)
def test_only_what_is_required_stands_in_the_way(state, required, code):
    examination = Examination("1.0", (), (finding(state, required=required),))
    assert examination.exit_code == code
    document = json.loads(examination_to_json(examination))
    assert document["healthy"] == (code == 0)
    assert document["packages"][0]["state"] == state.value


def test_it_needs_nothing_of_what_it_looks_for():
    assert modules_loaded_by("import ocs_design.workflows.doctor").isdisjoint(
        {*HEAVY, "msgspec", "rich"}
    )


def test_run_from_its_source_alone_it_says_so(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(doctor.metadata, "requires", missing)
    with pytest.raises(MissingToolError, match="not installed"):
        examine()


@pytest.mark.slow
def test_here_everything_required_works():
    done = run("doctor", "--json")
    assert done.code == 0
    found = {each["name"]: each for each in done.document["machine"] + done.document["packages"]}
    assert found["mujoco"]["state"] == "works"
    assert found["mujoco"]["found"] == metadata.version("mujoco")
    assert {"Python", "this folder", "ffmpeg", "resvg-py"} <= set(found)


def test_what_is_only_optional_is_not_to_be_mended():
    lacking = [
        replace(finding(state, required=required), name=name, cure=f"get {name}", extra=extra)
        for name, state, required, extra in (
            ("needed", State.MISSING, True, ""),
            ("extra", State.MISSING, False, "one"),
            ("further", State.MISSING, False, "two"),
            ("torn", State.BROKEN, False, "three"),
        )
    ]
    console = Console(file=StringIO(), width=80)
    print_examination(console, Examination("1.0", (), tuple(lacking)))
    said = console.file.getvalue()
    mend, add = said.split("To fix")[1].split("To add")
    assert "get needed" in mend and "get torn" in mend
    assert "get extra" in add and "get extra" not in mend
    assert f"all of these: {extra_command('one', 'two')}" in add


def test_this_python_does():
    assert python().state is State.WORKS
    assert python().wanted == ">=3.11"


def test_a_folder_that_can_be_written_to_stays_as_it_was(tmp_path):
    found = working_folder(tmp_path)
    assert found.state is State.WORKS
    assert found.found.endswith("GB free")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot(tmp_path):
    found = working_folder(tmp_path / "none")
    assert found.is_blocking
    assert found.cure
    assert "No such file" in found.reason


def test_processors_are_counted():
    assert int(processors().found) >= 1


@pytest.mark.parametrize(
    ("script", "state", "found"),
    [
        ("echo ffmpeg version 6.1.1-3 Copyright", State.WORKS, "6.1.1"),
        ("exit 1", State.MISSING, ""),
        (None, State.MISSING, ""),
    ],
)
def test_the_film_maker(script, state, found, tmp_path, monkeypatch):
    if script is not None:
        program = tmp_path / "ffmpeg"
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("ocs_design.export.programs.find_spec", lambda name: None)
    assert (film_maker().state, film_maker().found) == (state, found)
    assert bool(film_maker().cure) == (state is State.MISSING)


def test_where_no_way_draws_the_reason_and_the_cure_are_told(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "none such")
    (only,) = opengl()
    assert only.state is State.MISSING
    assert "none such" in only.reason
    assert "apt install" in only.cure
    assert not only.is_blocking


@pytest.mark.parametrize("name", ["cc", "clang", None])
def test_the_compiler(name, tmp_path, monkeypatch):
    if name is not None:
        (tmp_path / name).touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert compiler().found == (name or "")
    assert bool(compiler().cure) == (name is None)
