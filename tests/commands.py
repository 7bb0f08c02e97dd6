"""The command line as users see it: exit code, both streams, and the files written."""

import io
import json
import os
import pty
import re
import subprocess
import sys
import time
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryFile
from unittest import mock

import typer

from ocs_design.cli import errors
from ocs_design.cli.app import app
from ocs_design.export.formats import FORMATS

ROOT = Path(__file__).parents[1]
SOLO12 = str(ROOT / "examples" / "solo12.urdf")
PROGRAM = (sys.executable, "-m", "ocs_design")

# The bound alone is the fastest sizing, for tests that have nothing to do with motors.
BOUND = ("--motor", "none")
BY_HAND = ("--mass", "2.5", "--inertia", "0.032,0.055,0.07")
DROP = """[[maneuver]]
kind = "drop"
name = "drop"
height = 1.0
pitch = "20deg"
"""
"""The fastest maneuver to simulate, as a specification."""
EXPORT_FOLDERS = ("cad", "robot", "snippets")
"""Folders of a design that `export` writes."""

COMMAND_OF = cache(typer.main.get_command)
"""Building the command line takes longer than most commands, so it is cached."""


@dataclass(frozen=True)
class Result:
    """Exit code and streams of one command."""

    code: int
    stdout: str
    stderr: str

    @property
    def document(self):
        """Standard output, which must be one JSON document."""
        return json.loads(self.stdout)

    @property
    def output(self):
        """Both streams as one line, without the frames of panels and their line breaks."""
        return re.sub(r"[│╭╮╰╯─\s]+", " ", f"{self.stderr}\n{self.stdout}")


def run(*arguments, stdin=b"", piped=False):
    """Run a command in this process, since a new process takes seconds to start.

    Lines are broken as on a terminal of 80 columns, or not at all if piped.
    """
    width = {"COLUMNS": os.environ.get("COLUMNS", "80")}
    streams = [io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2)]
    stdin_stream = io.TextIOWrapper(io.BytesIO(stdin), "utf-8")
    with (
        redirect_stdout(streams[0]),
        redirect_stderr(streams[1]),
        mock.patch.object(sys, "stdin", stdin_stream),
        mock.patch.dict(os.environ, width),
        mock.patch.object(typer.main, "get_command", COMMAND_OF),
    ):
        if piped:
            del os.environ["COLUMNS"]
        code = errors.run(app, [str(argument) for argument in arguments])
    out, err = (stream.buffer.getvalue().decode() for stream in streams)
    return Result(code, out, err)


def failure(code, *arguments):
    """Output of a command that must end with this exit code."""
    result = run(*arguments)
    assert result.code == code, result.output
    return result.output


@contextmanager
def writing_only(*names):
    """Within this context `size` writes these formats beside its design, and no report."""
    formats = tuple(each for each in FORMATS if each.name in names)
    with (
        mock.patch("ocs_design.workflows.size.USUAL_FORMATS", formats),
        mock.patch("ocs_design.workflows.size._write_report", lambda design, *_: design),
    ):
        yield


def run_process(*arguments, **options):
    """Run a command in a new process."""
    done = subprocess.run(
        [*PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **options
    )
    return Result(done.returncode, done.stdout, done.stderr)


def run_measured(*arguments, **options):
    """Run a command in a new process: its result, and its peak memory [KiB]."""
    peak, command = 0, [*PROGRAM, *map(str, arguments)]
    with TemporaryFile() as stdout, TemporaryFile() as stderr:
        process = subprocess.Popen(command, stdout=stdout, stderr=stderr, **options)
        # Not ru_maxrss, which a process inherits from its parent.
        while process.poll() is None:
            with suppress(OSError):
                status = Path(f"/proc/{process.pid}/status").read_text()
                match = re.search(r"VmHWM:\s+(\d+) kB", status)
                peak = max(peak, int(match[1]) if match else 0)
            time.sleep(0.05)
        texts = [stream.seek(0) or stream.read().decode() for stream in (stdout, stderr)]
    return Result(process.returncode, *texts), peak


def run_in_terminal(*arguments, answers=(), **variables):
    """Exit code of an interactive command, and all that its terminal shows."""
    child, terminal = pty.fork()
    if child == 0:
        os.execve(PROGRAM[0], [*PROGRAM, *map(str, arguments)], environment(**variables))
    os.write(terminal, "".join(f"{answer}\n" for answer in answers).encode())
    shown = bytearray()
    # Linux reports by an error that the other side has closed.
    with suppress(OSError):
        while chunk := os.read(terminal, 1 << 16):
            shown += chunk
    os.close(terminal)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), shown.decode()


def environment(**changes):
    """The environment without variables for width and colour, with these changes."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if name not in {"COLUMNS", "NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TERM"}
    }
    return {**kept, "TERM": "xterm-256color", **changes}


def all_paths_in(folder):
    """Relative paths of all files and folders, hidden ones too."""
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*"))


def files_in(folder):
    """Contents of all files below `folder`, by relative path."""
    paths = (path for path in Path(folder).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def exported_files(folder):
    """Contents of the files that `export` writes."""
    return {
        name: content
        for name, content in files_in(folder).items()
        if name.startswith(EXPORT_FOLDERS)
    }


def size_to_bound(*arguments, stdin=b""):
    """Size by the bound alone, without flights, into the folder `ocs` of the working directory."""
    result = run("size", *arguments, *BOUND, "--no-validate", "-q", "-o", "ocs", stdin=stdin)
    assert result.code == 0, result.stderr
    return Path("ocs")


def with_value(document, key, value):
    """A JSON document with a new value at a dotted key; a callable computes it from the old one."""
    *path, last = (int(step) if step.isdigit() else step for step in key.split("."))
    parent = document
    for step in path:
        parent = parent[step]
    parent[last] = value(parent[last]) if callable(value) else value
    return document
