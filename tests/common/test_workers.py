"""Tables of columns, plain files, hints for extras, and calls in another process."""

import math
import os
import signal
import sys
import time
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from ocs_design.common import errors, workers
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.common.errors import extra_command
from ocs_design.common.files import read_plain_file, safe_name
from ocs_design.common.workers import WorkerPool


def own_process(caller):
    """Number of the calling process; any other process exits."""
    if os.getpid() != caller:
        sys.exit(1)
    return caller


@pytest.fixture(autouse=True)
def two_processors(monkeypatch):
    monkeypatch.setattr(workers, "processors", lambda: 2)


def test_calls_run_in_another_process():
    with WorkerPool("os") as other:
        assert other.call(os.getpid)() != os.getpid()


def test_arguments_and_results_may_exceed_the_pipe_buffer():
    with WorkerPool("ocs_design.common.files") as other:
        assert len(other.call(safe_name, "a" * 1_000_000)()) == 1_000_000


def test_errors_are_raised_in_the_caller():
    with WorkerPool("math") as other, pytest.raises(ValueError, match="math domain error"):
        other.call(math.sqrt, -1.0)()


@pytest.mark.parametrize(
    ("module", "processors", "python"),
    [
        (None, 2, sys.executable),
        ("no.such.module", 2, sys.executable),
        ("os", 1, sys.executable),
        ("os", 2, "/no/such/python"),
    ],
    ids=["no module", "none of that name", "one processor", "no process can be started"],
)
def test_without_another_process_calls_run_in_the_caller(monkeypatch, module, processors, python):
    monkeypatch.setattr(workers, "processors", lambda: processors)
    monkeypatch.setattr(workers.sys, "executable", python)
    with WorkerPool(module) as other:
        assert other.call(os.getpid)() == os.getpid()


def test_a_call_is_repeated_here_if_its_process_ends():
    with WorkerPool("os") as other:
        assert other.call(own_process, os.getpid())() == os.getpid()


def test_processes_end_with_the_context():
    with WorkerPool("time") as other:
        other.call(time.sleep, 600.0)
        (process,) = other._processes
    assert process.returncode == -signal.SIGKILL


def test_one_process_answers_calls_in_turn():
    with WorkerPool("os") as other:
        answers = [other.call(os.getpid) for _ in range(3)]
        (first,) = other._processes
        assert answers[0]() == first.pid
        assert {answer() for answer in answers} <= {first.pid, os.getpid()}


def test_a_waiting_call_runs_in_the_caller():
    with WorkerPool("time") as other:
        other.call(time.sleep, 600.0)
        assert other.call(os.getpid)() == os.getpid()


@pytest.mark.parametrize(("usable", "most", "started"), [(2, 3, 1), (4, 2, 2), (8, 3, 3)])
def test_one_processor_is_left_for_this_process(monkeypatch, usable, most, started):
    monkeypatch.setattr(workers, "processors", lambda: usable)
    with WorkerPool("math", most) as other:
        answers = [other.call(math.sqrt, float(value)) for value in range(6)]
        assert [answer() for answer in answers] == [math.sqrt(value) for value in range(6)]
        assert len(other._processes) == started


@dataclass(frozen=True, eq=False)
class Inner(Table):
    inertia: FloatArray


@dataclass(frozen=True, eq=False)
class Outer(Table):
    mass: FloatArray
    axes: FloatArray
    inner: Inner
    name: str = "shared"


def table(seed, rows=5):
    rng = np.random.default_rng(seed)
    return Outer(rng.random(rows), rng.random((rows, 3)), Inner(rng.random(rows)))


def columns(value):
    return value.mass, value.axes, value.inner.inertia


def test_take_is_indexing_every_column():
    original = table(0)
    for rows in (np.array([4, 0, 0]), np.array([True, False, False, True, False])):
        for taken, column in zip(columns(original.take(rows)), columns(original), strict=True):
            assert_array_equal(taken, column[rows])
    assert original.take(np.array([1])).name == "shared"


def test_repeat_keeps_copies_of_a_row_together():
    for repeated, column in zip(columns(table(1).repeat(3)), columns(table(1)), strict=True):
        assert_array_equal(repeated, column[np.repeat(np.arange(5), 3)])


def test_put_replaces_rows_and_leaves_the_original_alone():
    original, rows = table(2), np.array([3, 1])
    before = [column.copy() for column in columns(original)]
    put = original.put(rows, table(3, rows=2))
    for after, new, column, old in zip(
        columns(put), columns(table(3, rows=2)), columns(original), before, strict=True
    ):
        assert_array_equal(after[rows], new)
        assert_array_equal(after[[0, 2, 4]], old[[0, 2, 4]])
        assert_array_equal(column, old)


def test_a_plain_file_is_read_up_to_its_limit(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"1234")
    assert read_plain_file(path, 4) == b"1234"
    with pytest.raises(OSError, match="larger than"):
        read_plain_file(path, 3)


def test_pipes_devices_and_folders_are_not_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero"):
        with pytest.raises(OSError, match="not a plain file"):
            read_plain_file(path, 1 << 20)
    with pytest.raises(IsADirectoryError):
        read_plain_file(tmp_path, 1)
    with pytest.raises(FileNotFoundError):
        read_plain_file(tmp_path / "gone", 1)


@pytest.mark.parametrize(
    ("receipt", "has_pip", "command"),
    [
        ("", True, "pip install 'ocs-design[dxf,step]'"),
        ("pipx_metadata.json", False, "pipx runpip {name} install 'ocs-design[dxf,step]'"),
        ("", False, "uv pip install --python {python} 'ocs-design[dxf,step]'"),
    ],
)
def test_the_command_for_an_extra_fits_the_environment(
    receipt, has_pip, command, tmp_path, monkeypatch
):
    if receipt:
        (tmp_path / receipt).touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(errors, "find_spec", lambda name: has_pip or None)
    expected = command.format(name=tmp_path.name, python=sys.executable)
    assert extra_command("dxf", "step") == expected
