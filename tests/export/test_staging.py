"""Folders and files appear completely or not at all when a run is killed or interrupted."""

import errno
import re
import subprocess
import sys
import textwrap

import pytest
from commands import all_paths_in

from ocs_design.common.errors import OutputError
from ocs_design.device.records.design import DESIGN_FILE
from ocs_design.export import folder as folders
from ocs_design.export.folder import (
    check_target,
    clear_leftovers,
    remove_unfinished,
    staged_folder,
    write_whole,
)

REPLACE = """
    import ctypes, fcntl, os, signal, sys
    from pathlib import Path
    from ocs_design.export import folder
    def replace(moment):
        seen = 0
        def kill_at(event, arguments):
            nonlocal seen
            if event.startswith(("open", "os.", "shutil.", "ctypes.", "fcntl.")):
                seen += 1
                if seen == moment:
                    os.kill(os.getpid(), signal.SIGKILL)
        sys.addaudithook(kill_at)
        with folder.staged_folder(Path("out"), force=True) as staging:
            for name in ("cad", "design.json"):
                (staging / name).write_text("new")
    if "no exchange" in sys.argv:
        folder.exchange = lambda one, other: False
    for line in sys.stdin:
        if not (child := os.fork()):
            replace(int(line))
            os._exit(0)
        print(os.waitpid(child, 0)[1], flush=True)
"""
"""For each number n that it reads, a process replaces a folder and is killed at its n-th system
call; it prints the status of each, which is 0 for one that completes.
"""


def make_output(folder, text="old"):
    folder.mkdir()
    for name in ("cad", DESIGN_FILE):
        (folder / name).write_text(text)


def texts(folder):
    return {path.name: path.read_text() for path in folder.iterdir()}


OLD, NEW = ({"cad": text, DESIGN_FILE: text} for text in ("old", "new"))


def killed_at_each_call(folder, *arguments):
    """The folder after a kill at each system call, then after clearing up, and all names."""
    command = [sys.executable, "-c", textwrap.dedent(REPLACE), *arguments]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, cwd=folder, **pipes) as process:
        for moment in range(1, 100):
            if not (folder / "out").exists():
                make_output(folder / "out")
            print(moment, file=process.stdin, flush=True)
            status = int(process.stdout.readline())
            at_once = texts(folder / "out") if (folder / "out").exists() else None
            clear_leftovers(folder / "out")
            yield at_once, texts(folder / "out"), all_paths_in(folder)
            if status == 0:
                return
            for path in (folder / "out").iterdir():
                path.write_text("old")


COMPLETE = ["out", "out/cad", f"out/{DESIGN_FILE}"]


@pytest.mark.parametrize(
    ("arguments", "times_without"),
    [((), 0), pytest.param(("no exchange",), 1, marks=pytest.mark.slow)],
)
def test_a_kill_leaves_the_old_folder_or_the_new_one(tmp_path, arguments, times_without):
    """Where two folders cannot be exchanged, the next run restores the old one."""
    outcomes = list(killed_at_each_call(tmp_path, *arguments))
    assert len(outcomes) > 15
    assert all(cleared in (OLD, NEW) and names == COMPLETE for _, cleared, names in outcomes)
    assert (outcomes[0][1], outcomes[-1][1]) == (OLD, NEW)
    assert sum(at_once is None for at_once, _, _ in outcomes) == times_without


class InterruptedAt:
    """Raises an interrupt before the n-th instruction of `export.folder`."""

    FILES = (folders.__file__,)

    def __init__(self, moment):
        self.left = moment

    def __call__(self, frame, event, argument):
        if frame.f_code.co_filename not in self.FILES:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode":
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt
        return self


def replaced(target, trace):
    """Whether the folder was replaced before the interrupt."""
    before = sys.gettrace()
    try:
        sys.settrace(trace)
        with staged_folder(target, force=True) as new:
            for name in ("cad", DESIGN_FILE):
                (new / name).write_text("new")
    except KeyboardInterrupt:
        return False
    finally:
        sys.settrace(before)
    return True


@pytest.fixture(params=[False, True], ids=["exchanged", "moved aside"])
def either_way(request, monkeypatch):
    """The folders are exchanged, or the old one is moved aside where the system cannot do that."""
    if request.param:
        monkeypatch.setattr(folders, "exchange", lambda one, other: False)


@pytest.mark.slow
@pytest.mark.parametrize(
    "either_way",
    [False, pytest.param(True, marks=pytest.mark.slow)],
    ids=["exchanged", "moved aside"],
    indirect=True,
)
@pytest.mark.usefixtures("either_way")
def test_an_interrupt_leaves_the_old_folder_or_the_new_one(tmp_path):
    target, moment, done = tmp_path / "out", 0, False
    make_output(target)
    while not done:
        moment += 1
        done = replaced(target, InterruptedAt(moment))
        remove_unfinished()
        assert texts(target) in (OLD, NEW), moment
        assert all_paths_in(tmp_path) == COMPLETE, moment
        for path in target.iterdir():
            path.write_text("old")
    assert moment > 500


def test_the_unfinished_folder_of_another_run_stays(tmp_path):
    target = tmp_path / "out"
    with staged_folder(target, force=False) as folder:
        (folder / DESIGN_FILE).write_text("new")
        clear_leftovers(target)
    assert texts(target) == {DESIGN_FILE: "new"}


@pytest.mark.usefixtures("either_way")
def test_the_last_of_two_runs_with_force_wins(tmp_path):
    target = tmp_path / "out"
    make_output(target)
    with staged_folder(target, force=True) as slow:
        with staged_folder(target, force=True) as quick:
            (quick / DESIGN_FILE).write_text("quick")
        assert texts(target) == {DESIGN_FILE: "quick"}
        (slow / DESIGN_FILE).write_text("slow")
    assert texts(target) == {DESIGN_FILE: "slow"}
    assert all_paths_in(tmp_path) == ["out", f"out/{DESIGN_FILE}"]


def test_the_first_of_two_runs_without_force_wins(tmp_path):
    target = tmp_path / "out"
    with (
        pytest.raises(OutputError, match="exists already"),
        staged_folder(target, force=False) as slow,
    ):
        with staged_folder(target, force=False) as quick:
            (quick / DESIGN_FILE).write_text("quick")
        (slow / DESIGN_FILE).write_text("slow")
    assert texts(target) == {DESIGN_FILE: "quick"}
    assert all_paths_in(tmp_path) == ["out", f"out/{DESIGN_FILE}"]


def test_hidden_folders_of_others_stay(tmp_path):
    names = [".out", ".out-old", ".out.ocs-design-backup", ".other.ocs-design-abcd1234"]
    for name in names:
        (tmp_path / name).mkdir()
    (tmp_path / ".out.ocs-design-abcd1234").mkdir()
    clear_leftovers(tmp_path / "out")
    assert all_paths_in(tmp_path) == sorted(names)


@pytest.mark.parametrize("exists", [False, True], ids=["new", "with force"])
@pytest.mark.parametrize(
    "error", [RuntimeError(), OSError(errno.ENOSPC, "No space left on device", "flywheel.stl")]
)
def test_a_failure_leaves_everything_as_it_was_and_a_full_disk_has_a_hint(tmp_path, exists, error):
    target = tmp_path / "out"
    if exists:
        make_output(target)
    with (
        pytest.raises((RuntimeError, OutputError)) as caught,
        staged_folder(target, force=exists) as folder,
    ):
        (folder / DESIGN_FILE).write_text("half")
        raise error
    assert all_paths_in(tmp_path) == (COMPLETE if exists else [])
    assert not exists or texts(target) == OLD
    if isinstance(caught.value, OutputError):
        assert "No space left" in caught.value.message
        assert "free some space" in caught.value.hint


def test_an_existing_folder_is_kept_without_force(tmp_path):
    target = tmp_path / "robot-ocs"
    make_output(target)
    with (
        pytest.raises(OutputError, match="exists already") as caught,
        staged_folder(target, force=False),
    ):
        pass
    assert "--force" in caught.value.hint
    assert texts(target) == OLD


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("photographs", r"has no design\.json"),
        ("file", "not a folder"),
        ("link", "not a folder"),
        ("nowhere/robot-ocs", r"nowhere: no such folder"),
    ],
)
def test_force_replaces_nothing_but_an_output(tmp_path, name, message):
    make_output(tmp_path / "real")
    (tmp_path / "photographs").mkdir()
    (tmp_path / "photographs" / "one.png").write_text("precious")
    (tmp_path / "file").write_text("a file")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    before = all_paths_in(tmp_path)
    with pytest.raises(OutputError, match=message):
        check_target(tmp_path / name, force=True)
    assert all_paths_in(tmp_path) == before


def test_a_file_is_written_completely_and_replaced_only_with_force(tmp_path):
    file = tmp_path / "a.toml"
    write_whole(file, "ä\n", force=False)
    assert file.read_bytes() == "ä\n".encode()
    with pytest.raises(OutputError, match="exists already"):
        write_whole(file, "new", force=False)
    # A surrogate has no UTF-8; any failure while writing would do.
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half \ud800", force=True)
    assert file.read_bytes() == "ä\n".encode()
    write_whole(file, "new", force=True)
    assert file.read_text() == "new"
    assert all_paths_in(tmp_path) == ["a.toml"]


@pytest.mark.parametrize(
    ("place", "message"),
    [(".", "is not a file"), ("none/a.toml", "no such folder"), (300 * "a", "too long.*shorter")],
)
def test_an_impossible_path_of_a_file_is_refused(tmp_path, place, message):
    with pytest.raises(OutputError) as refused:
        write_whole(tmp_path / place, "new", force=place == ".")
    assert re.search(message, f"{refused.value.message} {refused.value.hint}")
