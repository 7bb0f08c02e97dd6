"""Which ffmpeg makes the films."""

import subprocess

import imageio_ffmpeg
import pytest

from ocs_design.export import programs
from ocs_design.export.programs import ffmpeg_program


@pytest.fixture
def no_system(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


def test_the_systems_own_comes_first(no_system):
    program = no_system / "ffmpeg"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    assert ffmpeg_program() == str(program)


def test_else_that_of_the_extra_which_runs(no_system):
    said = subprocess.run([ffmpeg_program(), "-version"], capture_output=True, check=True).stdout
    assert said.startswith(b"ffmpeg version")


@pytest.mark.parametrize("why", ["not installed", "no binary"])
def test_else_none(no_system, monkeypatch, why):
    def refuse():
        raise RuntimeError("No ffmpeg exe could be found")

    if why == "not installed":
        monkeypatch.setattr(programs, "find_spec", lambda name: None)
    monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", refuse)
    assert ffmpeg_program() is None
