"""`doctor`: findings about the machine and the installation."""

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
    compiler_finding,
    examination_to_json,
    examine,
    ffmpeg_finding,
    folder_finding,
    opengl_findings,
    processors_finding,
    python_finding,
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
def test_only_required_findings_affect_the_exit_code(state, required, code):
    examination = Examination("1.0", (), (finding(state, required=required),))
    assert examination.exit_code == code
    document = json.loads(examination_to_json(examination))
    assert document["healthy"] == (code == 0)
    assert document["packages"][0]["state"] == state.value


def test_doctor_imports_no_optional_packages():
    assert modules_loaded_by("import ocs_design.workflows.doctor").isdisjoint(
        {*HEAVY, "msgspec", "rich"}
    )


def test_a_source_tree_without_installation_is_reported(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(doctor.metadata, "requires", missing)
    with pytest.raises(MissingToolError, match="not installed"):
        examine()


@pytest.mark.slow
def test_everything_required_works_here():
    result = run("doctor", "--json")
    assert result.code == 0
    listed = result.document["machine"] + result.document["packages"]
    findings = {finding["name"]: finding for finding in listed}
    assert findings["mujoco"]["state"] == "works"
    assert findings["mujoco"]["found"] == metadata.version("mujoco")
    assert {"Python", "this folder", "ffmpeg", "resvg-py"} <= set(findings)


def test_optional_packages_are_additions_not_fixes():
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
    text = console.file.getvalue()
    fixes, additions = text.split("To fix")[1].split("To add")
    assert "get needed" in fixes and "get torn" in fixes
    assert "get extra" in additions and "get extra" not in fixes
    assert f"all of these: {extra_command('one', 'two')}" in additions


def test_this_python_is_accepted():
    assert python_finding().state is State.WORKS
    assert python_finding().wanted == ">=3.11"


def test_a_writable_folder_stays_unchanged(tmp_path):
    folder = folder_finding(tmp_path)
    assert folder.state is State.WORKS
    assert folder.found.endswith("GB free")
    assert list(tmp_path.iterdir()) == []


def test_a_missing_folder_is_reported(tmp_path):
    folder = folder_finding(tmp_path / "none")
    assert folder.is_blocking
    assert folder.cure
    assert "No such file" in folder.reason


def test_processors_are_counted():
    assert int(processors_finding().found) >= 1


@pytest.mark.parametrize(
    ("script", "state", "found"),
    [
        ("echo ffmpeg version 6.1.1-3 Copyright", State.WORKS, "6.1.1"),
        ("exit 1", State.MISSING, ""),
        (None, State.MISSING, ""),
    ],
)
def test_the_video_encoder(script, state, found, tmp_path, monkeypatch):
    if script is not None:
        program = tmp_path / "ffmpeg"
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("ocs_design.export.programs.find_spec", lambda name: None)
    assert (ffmpeg_finding().state, ffmpeg_finding().found) == (state, found)
    assert bool(ffmpeg_finding().cure) == (state is State.MISSING)


def test_missing_opengl_has_reason_and_cure(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "none such")
    (only,) = opengl_findings()
    assert only.state is State.MISSING
    assert "none such" in only.reason
    assert "apt install" in only.cure
    assert not only.is_blocking


@pytest.mark.parametrize("name", ["cc", "clang", None])
def test_the_compiler(name, tmp_path, monkeypatch):
    if name is not None:
        (tmp_path / name).touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert compiler_finding().found == (name or "")
    assert bool(compiler_finding().cure) == (name is None)
