"""Ends that come early: the reader leaves, the user has enough."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from commands import BOUND, PROGRAM, SOLO12, all_paths_in


@pytest.mark.slow
@pytest.mark.parametrize("typed", ["inspect --json", "size"])
def test_the_reader_of_the_output_may_leave(folder, typed):
    """As `head` does: no complaint, and nothing half done is left."""
    command, *options = typed.split()
    reading, writing = os.pipe()
    os.close(reading)
    streams = {"stdout": writing, "stderr": subprocess.PIPE if options else writing}
    process = subprocess.Popen([*PROGRAM, command, SOLO12, *options], **streams)
    os.close(writing)
    complaint = process.communicate()[1]
    assert not complaint
    assert process.returncode == 141
    assert all_paths_in(folder) == []


def started(process, folder, said):
    """Its own handlers stand, and nothing is imported yet."""
    caught = re.search(r"SigCgt:\s*(\w+)", Path(f"/proc/{process.pid}/status").read_text())[1]
    return int(caught, 16) >> (signal.SIGTERM - 1) & 1


def loaded(process, folder, said):
    """The solver is, and the robot is read next."""
    return b"load the solver" in said.read_bytes()


def written(process, folder, said):
    """Some files stand in a hidden folder."""
    return any(folder.glob(".*/new/robot/*.urdf"))


@pytest.fixture(autouse=True)
def heeded():
    """Who starts the tests in the background ignores interrupts, and so would all that they start.

    What is caught here is at its default in a new process.
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
    """Sends signals to a process at a moment; its exit code and what it said."""

    def end_at(moment, *signals, options=()):
        """Poll until the moment, as nothing tells of it."""
        said = tmp_path_factory.mktemp("said") / "stderr"
        command = [*PROGRAM, "size", SOLO12, *BOUND, "--ballistic"]
        with said.open("wb") as stream:
            process = subprocess.Popen([*command, *options], stderr=stream)
            deadline = time.monotonic() + 60.0
            while not moment(process, folder, said) and time.monotonic() < deadline:
                time.sleep(0.002)
            for number in signals:
                process.send_signal(number)
                time.sleep(0.05)
            return process.wait(), said.read_text()

    return end_at


TWICE = (signal.SIGINT, signal.SIGINT)


@pytest.mark.parametrize(
    ("moment", "signals"),
    [
        (started, (signal.SIGINT,)),
        (started, (signal.SIGTERM,)),
        pytest.param(loaded, (signal.SIGHUP,), marks=pytest.mark.slow),
    ],
    ids=lambda each: getattr(each, "__name__", None) or "-".join(number.name for number in each),
)
def test_an_interrupt_leaves_nothing(folder, interrupted, moment, signals):
    code, said = interrupted(moment, *signals)
    assert "Traceback" not in said
    assert code == 130, said
    assert said.endswith("interrupted; no unfinished files are left\n")
    assert all_paths_in(folder) == []


@pytest.mark.slow
def test_an_interrupt_keeps_what_was_to_be_replaced(folder, interrupted):
    (folder / "solo12-ocs").mkdir()
    (folder / "solo12-ocs" / "design.json").write_bytes(b"{}")
    code, said = interrupted(written, *TWICE, options=("--force",))
    assert "Traceback" not in said
    assert code == 130, said
    assert said.endswith("interrupted; no unfinished files are left\n")
    assert all_paths_in(folder) == ["solo12-ocs", "solo12-ocs/design.json"]


@pytest.mark.slow
def test_a_terminal_that_closes_interrupts(folder):
    """What is to be printed then cannot be."""
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
