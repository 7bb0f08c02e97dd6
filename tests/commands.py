"""The command line as its users meet it: exit code, both streams, and what it leaves behind."""

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

# Bound alone: the quickest way to size, where what is tested has nothing to do with motors.
BOUND = ("--motor", "none")
BY_HAND = ("--mass", "2.5", "--inertia", "0.032,0.055,0.07")
DROP = """[[maneuver]]
kind = "drop"
name = "drop"
height = 1.0
pitch = "20deg"
"""
"""The quickest maneuver to fly, as a specification."""
EXPORT_FOLDERS = ("cad", "robot", "snippets")
"""Folders of a design that `export` answers for."""

COMMAND_OF = cache(typer.main.get_command)
"""The command line is made once: that takes longer than most of what is asked of it."""


@dataclass(frozen=True)
class Result:
    """Of one command."""

    code: int
    stdout: str
    stderr: str

    @property
    def document(self):
        """Standard output as the one JSON document that it must be."""
        return json.loads(self.stdout)

    @property
    def output(self):
        """Both streams as one line, panels' frames taken off and their words joined again."""
        return re.sub(r"[│╭╮╰╯─\s]+", " ", f"{self.stderr}\n{self.stdout}")


def run(*arguments, stdin=b"", piped=False):
    """In this process, for a process of its own takes seconds to start.

    Lines are those of a terminal of 80 columns, or of a pipe, which breaks none.
    """
    width = {"COLUMNS": os.environ.get("COLUMNS", "80")}
    streams = [io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2)]
    given = io.TextIOWrapper(io.BytesIO(stdin), "utf-8")
    with (
        redirect_stdout(streams[0]),
        redirect_stderr(streams[1]),
        mock.patch.object(sys, "stdin", given),
        mock.patch.dict(os.environ, width),
        mock.patch.object(typer.main, "get_command", COMMAND_OF),
    ):
        if piped:
            del os.environ["COLUMNS"]
        code = errors.run(app, [str(argument) for argument in arguments])
    out, err = (stream.buffer.getvalue().decode() for stream in streams)
    return Result(code, out, err)


def failure(code, *arguments):
    """What a command says that ends with this exit code."""
    result = run(*arguments)
    assert result.code == code, result.output
    return result.output


@contextmanager
def writing_only(*names):
    """`size` writes files of these formats beside its design, and no report."""
    usual = tuple(each for each in FORMATS if each.name in names)
    with (
        mock.patch("ocs_design.workflows.size.USUAL_FORMATS", usual),
        mock.patch("ocs_design.workflows.size._write_report", lambda design, *_: design),
    ):
        yield


def run_process(*arguments, **options):
    """In a process of its own."""
    done = subprocess.run(
        [*PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **options
    )
    return Result(done.returncode, done.stdout, done.stderr)


def run_measured(*arguments, **options):
    """In a process of its own: its result, and the most memory that it has had [KiB]."""
    peak, command = 0, [*PROGRAM, *map(str, arguments)]
    with TemporaryFile() as stdout, TemporaryFile() as stderr:
        process = subprocess.Popen(command, stdout=stdout, stderr=stderr, **options)
        # Not ru_maxrss, which a process inherits from the one that starts it.
        while process.poll() is None:
            with suppress(OSError):
                status = Path(f"/proc/{process.pid}/status").read_text()
                found = re.search(r"VmHWM:\s+(\d+) kB", status)
                peak = max(peak, int(found[1]) if found else 0)
            time.sleep(0.05)
        said = [stream.seek(0) or stream.read().decode() for stream in (stdout, stderr)]
    return Result(process.returncode, *said), peak


def run_in_terminal(*arguments, answers=(), **variables):
    """Exit code of a command that is typed at, and all that its terminal gets to see."""
    child, terminal = pty.fork()
    if child == 0:
        os.execve(PROGRAM[0], [*PROGRAM, *map(str, arguments)], environment(**variables))
    os.write(terminal, "".join(f"{answer}\n" for answer in answers).encode())
    seen = bytearray()
    # Linux says by an error that the other side has closed.
    with suppress(OSError):
        while chunk := os.read(terminal, 1 << 16):
            seen += chunk
    os.close(terminal)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), seen.decode()


def environment(**changes):
    """The environment without what decides on width and colour, with these changes."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if name not in {"COLUMNS", "NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TERM"}
    }
    return {**kept, "TERM": "xterm-256color", **changes}


def all_paths_in(folder):
    """Relative path of every file and folder, hidden ones too."""
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*"))


def files_in(folder):
    """Content of every file below `folder`, by its path."""
    paths = (path for path in Path(folder).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def exported_files(folder):
    """What `export` answers for."""
    return {
        name: content
        for name, content in files_in(folder).items()
        if name.startswith(EXPORT_FOLDERS)
    }


def size_to_bound(*arguments, stdin=b""):
    """A design in the folder `ocs` of the working directory, by the bound alone and not flown."""
    result = run("size", *arguments, *BOUND, "--no-validate", "-q", "-o", "ocs", stdin=stdin)
    assert result.code == 0, result.stderr
    return Path("ocs")


def with_value(document, key, value):
    """A JSON document with another value at a key; a callable makes it of the one before."""
    *path, last = (int(step) if step.isdigit() else step for step in key.split("."))
    place = document
    for step in path:
        place = place[step]
    place[last] = value(place[last]) if callable(value) else value
    return document
