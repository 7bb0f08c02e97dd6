"""Closed and full streams, file names that are not text, and output in pipes."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from commands import (
    BOUND,
    BY_HAND,
    PROGRAM,
    SOLO12,
    all_paths_in,
    environment,
    run,
    run_process,
)

import ocs_design.__main__ as program

FULL = Path("/dev/full")
has_full_device = pytest.mark.skipif(not FULL.exists(), reason="no such device here")
SIZE_BY_HAND = ("size", *BY_HAND, *BOUND, "--no-validate", "-o", "out")


def shell(line, *arguments):
    """The result of a shell command in which `"$@"` is the program with the arguments."""
    return subprocess.run(
        ["sh", "-c", line, "sh", *PROGRAM, *arguments], capture_output=True, text=True, check=False
    )


@pytest.mark.slow
def test_closed_streams_do_not_change_the_files(folder):
    """Printed text must not end up in files that are opened with their descriptors."""
    process = shell('"$@" <&- >&- 2>&-', *SIZE_BY_HAND)
    assert (process.returncode, process.stdout, process.stderr) == (0, "", "")
    assert run("size", *SIZE_BY_HAND[1:-1], "open", "-q").code == 0
    for name in ("snippets/ocs.urdf", "cad/bill_of_materials.csv"):
        assert (folder / "out" / name).read_bytes() == (folder / "open" / name).read_bytes()


@has_full_device
def test_a_full_standard_output_is_an_error(folder):
    process = shell(f'"$@" > {FULL}', "inspect", *BY_HAND, "--json")
    assert process.returncode == 3
    assert "No space left on device" in process.stderr
    assert "Traceback" not in process.stderr


@pytest.mark.slow
@has_full_device
def test_a_full_standard_error_is_an_error(folder):
    assert shell(f'"$@" 2> {FULL}', *SIZE_BY_HAND).returncode == 3
    assert all_paths_in(folder) == []


@pytest.mark.skipif(sys.platform == "win32", reason="names are text there")
def test_a_file_name_that_is_not_text_is_refused(folder):
    name = os.fsdecode(b"ro\xffbot.urdf")
    (folder / name).write_bytes(b"")
    result = run("size", name, *BOUND, "--json")
    assert result.code == 3
    assert "'ro\\udcffbot.urdf'" in result.document["error"]["message"]
    assert "rename" in result.document["error"]["hint"]


@pytest.mark.slow
def test_without_home_and_locale(folder):
    """An unknown locale counts as "C", whose text is ASCII."""
    locale = {"LC_ALL": "nowhere.UTF-8", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    inherited = {name: os.environ[name] for name in ("PATH", "PYTHONPATH") if name in os.environ}
    process = subprocess.run(
        [*PROGRAM, "inspect", SOLO12], env=locale | inherited, capture_output=True, check=False
    )
    assert (process.returncode, process.stderr) == (0, b"")
    assert b"2.5" in process.stdout


def test_ignored_signals_stay_ignored(monkeypatch):
    """As under `nohup`."""
    handlers = {signal.SIGHUP: signal.SIG_IGN}
    monkeypatch.setattr(signal, "getsignal", lambda number: handlers.get(number, signal.SIG_DFL))
    monkeypatch.setattr(signal, "signal", handlers.__setitem__)
    program._on_signals(program._Interrupts())
    assert handlers[signal.SIGHUP] is signal.SIG_IGN
    assert set(handlers) == {signal.SIGHUP, signal.SIGINT, signal.SIGTERM}


ONE_MOTOR = ("--motor", "Antigravity MN5008 KV400", "--gear", "direct")
ANSWERS = [
    (("inspect", SOLO12), "locked inertia"),
    (("bound", "--inertia", "0.0515", "--rate-change", "2rad/s"), "one wheel, required"),
    (("catalogue", "materials"), "brass-c360"),
    (("init", "-y", "-o", "task.toml", "--force"), "next"),
    ((*SIZE_BY_HAND, "--force"), "no flight was simulated"),
    (("export", "DESIGN", "-o", "again", "--force", "--formats", "snippets"), "snippets/"),
    (("validate", "DESIGN"), "level 1 of 1"),
    pytest.param(
        ("pareto", SOLO12, "--points", "2", *ONE_MOTOR), "mass", marks=pytest.mark.exhaustive
    ),
    # Its `--json` alone is in `test_examination.py`.
    pytest.param(("doctor",), "numpy", marks=pytest.mark.exhaustive),
]
PROGRESS = re.compile(r" *[\d.]+ s  \S.*|warning: .*")
SEPARATE_PROCESS = ("inspect", "doctor")
"""Commands that run in processes of their own; the others run within the tests."""
FRAMES = re.compile(r"[\u2500-\u259f\u2800-\u28ff\x1b]")


def in_a_pipe(command, *options):
    """Result of a command whose output is a pipe of unknown width."""
    if command in SEPARATE_PROCESS:
        return run_process(command, *options, env=environment())
    return run(command, *options, piped=True)


@pytest.mark.parametrize(("arguments", "word"), ANSWERS)
def test_answers_go_to_standard_output_and_messages_to_standard_error(
    folder, by_hand, arguments, word
):
    """A pipe gets no frames, colours or broken lines, and one document with --json."""
    command = [str(by_hand) if argument == "DESIGN" else argument for argument in arguments]
    piped = in_a_pipe(*command)
    assert piped.code == 0, piped.output
    assert word in piped.stdout
    assert not FRAMES.search(piped.stdout + piped.stderr)
    assert not [line for line in piped.stdout.splitlines() if line != line.rstrip()]
    assert all(PROGRESS.fullmatch(line) for line in piped.stderr.splitlines())
    as_json = run(*command, "--json")
    assert (as_json.code, as_json.stderr) == (0, "")
    assert as_json.document
    if arguments[0] not in {"inspect", "bound", "catalogue", "doctor"}:
        quiet = run(*command, "-q")
        assert (quiet.code, quiet.stdout, quiet.stderr) == (0, "", "")


def test_an_error_in_a_pipe_is_plain_lines(folder):
    result = run_process("inspect", "nowhere.urdf", env=environment())
    assert (result.code, result.stdout) == (3, "")
    assert re.match(r"error: .*nowhere\.urdf", result.stderr)
    assert not FRAMES.search(result.stderr)
