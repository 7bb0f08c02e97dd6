"""Commands that end early: by a closed pipe, an interrupt or a closed terminal."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from commands import BOUND, PROGRAM, SOLO12, all_paths_in


@pytest.mark.slow
@pytest.mark.parametrize("arguments", ["inspect --json", "size"])
def test_a_closed_pipe_ends_the_command_silently(folder, arguments):
    """As with `head`: no error message and no unfinished files."""
    command, *options = arguments.split()
    reading, writing = os.pipe()
    os.close(reading)
    streams = {"stdout": writing, "stderr": subprocess.PIPE if options else writing}
    process = subprocess.Popen([*PROGRAM, command, SOLO12, *options], **streams)
    os.close(writing)
    errors = process.communicate()[1]
    assert not errors
    assert process.returncode == 141
    assert all_paths_in(folder) == []


def started(process, folder, stderr):
    """The signal handlers are installed, and no library is imported yet."""
    caught = re.search(r"SigCgt:\s*(\w+)", Path(f"/proc/{process.pid}/status").read_text())[1]
    return int(caught, 16) >> (signal.SIGTERM - 1) & 1


def loaded(process, folder, stderr):
    """The solver is being loaded; the robot is read next."""
    return b"load the solver" in stderr.read_bytes()


def written(process, folder, stderr):
    """Some files are written to the hidden folder."""
    return any(folder.glob(".*/new/robot/*.urdf"))


@pytest.fixture(autouse=True)
def default_handlers():
    """Handle the signals, so that new processes have the default handlers.

    Tests started in the background ignore interrupts, and so would their child processes.
    """
    before = {
        number: signal.signal(number, signal.default_int_handler)
        for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM)
    }
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def interrupted(folder, tmp_path_factory):
    """A function that sends signals to a command at a moment: its exit code and its messages."""

    def end_at(moment, *signals, options=()):
        """Poll until the moment, then send the signals."""
        stderr = tmp_path_factory.mktemp("said") / "stderr"
        command = [*PROGRAM, "size", SOLO12, *BOUND, "--ballistic"]
        with stderr.open("wb") as stream:
            process = subprocess.Popen([*command, *options], stderr=stream)
            deadline = time.monotonic() + 60.0
            while not moment(process, folder, stderr) and time.monotonic() < deadline:
                time.sleep(0.002)
            for number in signals:
                process.send_signal(number)
                time.sleep(0.05)
            return process.wait(), stderr.read_text()

    return end_at


TWO_INTERRUPTS = (signal.SIGINT, signal.SIGINT)


@pytest.mark.parametrize(
    ("moment", "signals"),
    [
        (started, (signal.SIGINT,)),
        (started, (signal.SIGTERM,)),
        pytest.param(loaded, (signal.SIGHUP,), marks=pytest.mark.slow),
    ],
    ids=lambda case: getattr(case, "__name__", None) or "-".join(number.name for number in case),
)
def test_an_interrupt_leaves_no_files(folder, interrupted, moment, signals):
    code, messages = interrupted(moment, *signals)
    assert "Traceback" not in messages
    assert code == 130, messages
    assert messages.endswith("interrupted; no unfinished files are left\n")
    assert all_paths_in(folder) == []


@pytest.mark.slow
def test_an_interrupt_keeps_the_existing_folder(folder, interrupted):
    (folder / "solo12-ocs").mkdir()
    (folder / "solo12-ocs" / "design.json").write_bytes(b"{}")
    code, messages = interrupted(written, *TWO_INTERRUPTS, options=("--force",))
    assert "Traceback" not in messages
    assert code == 130, messages
    assert messages.endswith("interrupted; no unfinished files are left\n")
    assert all_paths_in(folder) == ["solo12-ocs", "solo12-ocs/design.json"]


@pytest.mark.slow
def test_a_closed_terminal_interrupts(folder):
    """Nothing can be printed any more."""
    terminal, writing = os.openpty()
    command = [*PROGRAM, "size", SOLO12, *BOUND]
    process = subprocess.Popen(
        command, stdin=writing, stdout=writing, stderr=writing, start_new_session=True
    )
    os.close(writing)
    while b"read the robot" not in os.read(terminal, 4096):
        pass
    os.close(terminal)
    process.send_signal(signal.SIGHUP)
    assert process.wait() == 130
    assert all_paths_in(folder) == []
