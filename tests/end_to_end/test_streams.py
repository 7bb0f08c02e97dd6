"""Streams that are closed or full, and names that are no text."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from commands import BOUND, BY_HAND, PROGRAM, SOLO12, everything_in, run

import ocs_design.__main__ as program

FULL = Path("/dev/full")
has_full_device = pytest.mark.skipif(not FULL.exists(), reason="no such device here")
UNSIZED = ("size", *BY_HAND, *BOUND, "--no-validate", "-o", "out")


def shell(line, *arguments):
    """With the program as `"$@"`."""
    return subprocess.run(
        ["sh", "-c", line, "sh", *PROGRAM, *arguments], capture_output=True, text=True, check=False
    )


@pytest.mark.slow
def test_closed_streams_change_nothing(folder):
    """What is printed to them must not end up in the files that are opened in their place."""
    done = shell('"$@" <&- >&- 2>&-', *UNSIZED)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert run("size", *UNSIZED[1:-1], "open", "-q").code == 0
    for name in ("snippets/ocs.urdf", "cad/bill_of_materials.csv"):
        assert (folder / "out" / name).read_bytes() == (folder / "open" / name).read_bytes()


@has_full_device
def test_a_full_standard_output_is_told(folder):
    done = shell(f'"$@" > {FULL}', "inspect", *BY_HAND, "--json")
    assert done.returncode == 3
    assert "No space left on device" in done.stderr
    assert "Traceback" not in done.stderr


@has_full_device
def test_a_full_standard_error_is_an_error(folder):
    assert shell(f'"$@" 2> {FULL}', *UNSIZED).returncode == 3
    assert everything_in(folder) == []


@pytest.mark.skipif(sys.platform == "win32", reason="names are text there")
def test_a_name_that_is_no_text_is_refused_at_once(folder):
    name = os.fsdecode(b"ro\xffbot.urdf")
    (folder / name).write_bytes(b"")
    result = run("size", name, *BOUND, "--json")
    assert result.code == 3
    assert "'ro\\udcffbot.urdf'" in result.document["error"]["message"]
    assert "rename" in result.document["error"]["hint"]


@pytest.mark.parametrize("locale", ["C", "nowhere.UTF-8"])
def test_without_home_and_locale(folder, locale):
    bare = {"LC_ALL": locale, "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    kept = {name: os.environ[name] for name in ("PATH", "PYTHONPATH") if name in os.environ}
    done = subprocess.run(
        [*PROGRAM, "inspect", SOLO12], env=bare | kept, capture_output=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"2.5" in done.stdout


def test_signals_that_are_ignored_stay_so(monkeypatch):
    """As under `nohup`."""
    handlers = {signal.SIGHUP: signal.SIG_IGN}
    monkeypatch.setattr(signal, "getsignal", lambda number: handlers.get(number, signal.SIG_DFL))
    monkeypatch.setattr(signal, "signal", handlers.__setitem__)
    program._on_signals(program._Interrupts())
    assert handlers[signal.SIGHUP] is signal.SIG_IGN
    assert set(handlers) == {signal.SIGHUP, signal.SIGINT, signal.SIGTERM}
