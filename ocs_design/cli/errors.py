"""Turns an exception into one panel, one JSON document and an exit code."""

import json
import os
import re
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import TextIO, TypeAlias

import typer

from ocs_design.common.errors import (
    INTERRUPTED,
    Infeasible,
    OcsError,
    OutputError,
    SpecificationError,
    UsageError,
)
from ocs_design.common.units import UNITS

SCHEMA_VERSION = 2
BROKEN_PIPE = 141


def run(app: typer.Typer, arguments: Sequence[str]) -> int:
    """Run the command line and return its exit code; only bugs escape as exceptions."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    as_json, color = "--json" in arguments, "--no-color" not in arguments
    command = typer.main.get_command(app)
    try:
        # File names are bytes to the system, but text in the output: one that is not valid text
        # should fail now rather than in an hour.
        for name in (*arguments, str(Path.cwd())):
            name.encode()
        for before, name in pairwise(("", *arguments)):
            if not name.strip() or re.fullmatch(r"--[\w-]+=", name):
                raise UsageError(
                    f"{before if not name.strip() else name[:-1]}: the value is empty",
                    hint="check that the shell variable is set, or leave the option out",
                )
        result = command.main(list(arguments), prog_name="ocs-design", standalone_mode=False)
        sys.stdout.flush()
    except (typer.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except (BrokenPipeError, SystemExit) as error:
        # Typer and rich turn a broken pipe into a plain exit.
        if not isinstance(error.__context__ or error, BrokenPipeError):
            raise
        # The reader has closed the pipe, as `head` does.
        _discard_output(sys.stdout, sys.stderr)
        return BROKEN_PIPE
    except (OcsError, typer.TyperException, OSError, UnicodeEncodeError) as error:
        # A closing terminal sends an interrupt, and then nothing can be printed on it.
        cause: BaseException | None = error
        while cause is not None and not isinstance(cause, KeyboardInterrupt):
            cause = cause.__context__
        return INTERRUPTED if cause else _report(error, as_json=as_json, color=color)
    return result if isinstance(result, int) else 0


Failure: TypeAlias = OcsError | typer.TyperException | OSError | UnicodeEncodeError


def _as_ocs_error(error: Failure) -> OcsError:
    """The failure as an `OcsError`, with a hint."""
    if isinstance(error, OcsError):
        return error
    if isinstance(error, OSError):
        from ocs_design.export.folder import output_error

        if error.filename is not None:
            return output_error(error, Path())
        return OutputError(
            f"cannot print the output: {error.strerror}",
            hint="free some space there, or send the output elsewhere",
        )
    if isinstance(error, UnicodeEncodeError):
        return OcsError(
            f"{error.object[:200]!a}: this name is not valid {error.encoding}",
            hint="rename the file or folder, or set PYTHONUTF8=1 if the name is UTF-8",
        )
    context = getattr(error, "ctx", None)
    message = error.format_message()
    hint = f"see `{context.command_path} --help`" if context else ""
    extra = re.fullmatch(r"Got unexpected extra argument.* \((.*)\)", message)
    if extra and any(extra[1] in units for units in UNITS.values()):
        hint = f"write a number and its unit as one word, as in 50mm; {hint}"
    elif extra and re.fullmatch(r"[-+\d.,e]+\w*", extra[1]):
        hint = f"an option takes one word, as in --r-max 50mm or --joint FL_KFE=0.5; {hint}"
    elif re.fullmatch(r"No such option: -\w", message):
        hint = f"an option of several letters has two dashes; {hint}"
    return UsageError(message, hint=hint)


def _discard_output(*streams: TextIO) -> None:
    """Discard what streams still hold; Python would complain when it flushes them at exit."""
    null_device = os.open(os.devnull, os.O_WRONLY)
    for stream in streams:
        os.dup2(null_device, stream.fileno())


def _report(error: Failure, *, as_json: bool, color: bool) -> int:
    """Print what went wrong; returns the exit code."""
    reported = _as_ocs_error(error)
    unprinted = isinstance(error, OSError) and error.filename is None
    if unprinted:
        # Output that could not be printed is still in the buffer.
        _discard_output(sys.stdout)
    try:
        if as_json and not unprinted:
            message = {"kind": reported.kind, "message": reported.message, "hint": reported.hint}
            document = {"schema_version": SCHEMA_VERSION, "error": {**message, **reported.data()}}
            print(json.dumps(document, indent=2))
        else:
            from ocs_design.report.text.console import error_panel, make_console

            problems = reported.problems if isinstance(reported, SpecificationError) else ()
            lines = [reported.message, *(f"  - {problem}" for problem in problems)]
            error_panel(lines, reported.hint, color=color)
            if isinstance(reported, Infeasible):
                from ocs_design.report.text.size import print_assumed

                print_assumed(make_console(color=color, stderr=True), reported.assumptions)
    except OSError:
        if not isinstance(error, OSError):
            raise
        _discard_output(sys.stderr)
    return reported.exit_code
