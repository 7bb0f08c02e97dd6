"""The demo needs no file, and opens its report where there is a screen."""

import pytest
from commands import BOUND, BY_HAND, environment, run, run_process

from ocs_design.device.records.design import read_design


@pytest.mark.slow
def test_the_demo_sizes_solo12_from_any_folder(tmp_path):
    """Without a screen the page's place is said; a second one is not written over it."""
    bare = dict.fromkeys(("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"), "")
    told = run_process("demo", cwd=tmp_path, env=environment(**bare))
    folder = tmp_path / "solo12-ocs"
    assert told.code == 0
    assert f"no browser to open it in: {folder / 'report.html'}" in told.stderr
    design = read_design(folder / "design.json")
    assert design.robot.name == "solo12"
    assert all(flight.passed for flight in design.validation if flight.ocs)
    again = run_process("demo", cwd=tmp_path)
    assert again.code == 3
    assert "solo12-ocs: exists already" in again.said
    assert "--force" in again.said


@pytest.mark.parametrize("asked", [True, False])
def test_the_report_is_opened_if_that_is_asked_for(asked, no_files, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda page: opened.append(page) or True)
    monkeypatch.setenv("DISPLAY", ":7")
    flags = ("--open",) if asked else ()
    done = run("size", *BY_HAND, *BOUND, "--no-validate", "-q", "-o", tmp_path / "o", *flags)
    assert (done.code, done.said.strip()) == (0, "")
    assert opened == ([(tmp_path / "o" / "report.html").as_uri()] if asked else [])
