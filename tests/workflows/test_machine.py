"""What the machine has."""

import pytest

from ocs_design.device.findings import State
from ocs_design.workflows.doctor import (
    compiler,
    film_maker,
    opengl,
    processors,
    python,
    working_folder,
)


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
    assert found.stands_in_the_way
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
    assert not only.stands_in_the_way


@pytest.mark.parametrize("name", ["cc", "clang", None])
def test_the_compiler(name, tmp_path, monkeypatch):
    if name is not None:
        (tmp_path / name).touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert compiler().found == (name or "")
    assert bool(compiler().cure) == (name is None)
