"""`ocs-design init`: parse, ask, call, print. No arithmetic."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias, TypeVar

import typer

from ocs_design.cli import options as opt
from ocs_design.cli.signatures import with_options
from ocs_design.cli.stated import stated_package_paths, stated_specification
from ocs_design.exceptions import OcsError, UsageError

if TYPE_CHECKING:
    from ocs_design.initializing import Start
    from ocs_design.requirement.specification import Specification

Answer = TypeVar("Answer")

SpecificationFile: TypeAlias = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="FILE", help="File to write. Default: <name>.toml."),
]
Yes: TypeAlias = Annotated[
    bool, typer.Option("-y", "--yes", help="Ask nothing; as where no terminal is.")
]
ReplaceFile: TypeAlias = Annotated[bool, typer.Option("--force", help="Replace a file.")]

ALL = "all"

QUESTIONS: Mapping[str, str] = {
    "flywheel.r_max": "Largest outer radius of a wheel",
    "flywheel.h_max": "Largest height of a wheel",
    "motor.bus_voltage": "Voltage of the battery",
}
"""What is asked besides robot and maneuvers, by the path of its key."""


@with_options(opt.START_OPTIONS)
def init(
    context: typer.Context,
    yes: Yes = False,
    out: SpecificationFile = None,
    force: ReplaceFile = False,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    quiet: opt.Quiet = False,
    no_color: opt.NoColor = False,
) -> None:
    """Write a commented specification to start from: every key, its default and why to change it.

    On a terminal it asks for the robot, what it shall do, the room and the battery; an empty answer
    takes the default. Options are written as stated. With a robot, defaults are scaled to it.
    """
    from ocs_design.answers import to_json
    from ocs_design.export.single_file import check_file_target
    from ocs_design.initializing import read_start, write_start
    from ocs_design.report.console import make_console
    from ocs_design.report.initialized import print_initialized

    packages = stated_package_paths(context)

    def start_from(specification: "Specification") -> "Start":
        """Read the robot."""
        return read_start(specification, package_paths=packages, strict=strict)

    asking = not (yes or as_json) and sys.stdin.isatty() and sys.stderr.isatty()
    stated = stated_specification(context)
    start = _ask_robot(stated, start_from) if asking else start_from(stated)
    file = out or start.default_file
    check_file_target(file, force=force)
    chosen: tuple[str, ...] = ()
    if asking:
        start, chosen = _ask_task(start)
    written = write_start(start, file, chosen=chosen, package_paths=packages, force=force)
    if as_json:
        sys.stdout.buffer.write(to_json(written))
    elif not quiet:
        print_initialized(make_console(color=not no_color), written)


def _ask_robot(
    stated: "Specification", start_from: Callable[["Specification"], "Start"]
) -> "Start":
    """What is stated, with a robot if the user names one."""
    if any(
        item is not None for item in (stated.robot.file, stated.robot.mass, stated.robot.inertia)
    ):
        return start_from(stated)

    def read(answer: str) -> "Start":
        """The robot in a file, or none."""
        file = answer.strip() or None
        return start_from(replace(stated, robot=replace(stated.robot, file=file)))

    return _ask("Robot file (URDF, xacro or MJCF), or nothing", "", read)


def _ask_task(start: "Start") -> tuple["Start", tuple[str, ...]]:
    """The start with what was answered, and the maneuvers that were chosen."""
    chosen: tuple[str, ...] = ()
    if start.stated.takes_default_maneuvers:
        known = [maneuver.name for maneuver in start.default.maneuvers]
        chosen = _ask(
            f"Maneuvers: {', '.join(known)}, with commas, or {ALL}",
            ALL,
            lambda answer: _maneuvers(answer, known),
        )
    for path, question in QUESTIONS.items():
        start = _ask_key(start, path, question)
    return start, chosen


def _ask_key(start: "Start", path: str, question: str) -> "Start":
    """The start with one key stated, unless it is already or the answer is its default."""
    from ocs_design.requirement.commented import rounded_text
    from ocs_design.requirement.options import specification_from_options
    from ocs_design.requirement.specification import NO_MOTOR, merge

    section, _, name = path.partition(".")
    is_moot = section == "motor" and start.stated.motor.name == NO_MOTOR
    if is_moot or getattr(getattr(start.stated, section), name) is not None:
        return start
    default = rounded_text(start.default, path)

    def read(answer: str) -> "Start":
        """The answer as an option of that key; a bare number is in the unit that was shown."""
        unit = default.partition(" ")[2] if answer.strip()[-1:].isdigit() else ""
        given = {} if answer == default else {path: f"{answer} {unit}".rstrip()}
        return replace(start, stated=merge(start.stated, specification_from_options(given)))

    return _ask(question, default, read)


def _maneuvers(answer: str, known: list[str]) -> tuple[str, ...]:
    """Names of maneuvers; none for all, which are the default.

    Raises:
        UsageError: there is no such maneuver.
    """
    named = tuple(name.strip() for name in answer.split(","))
    unknown = [name for name in named if name not in (*known, ALL)]
    if unknown:
        raise UsageError(f"{', '.join(unknown)}: is none of {', '.join((*known, ALL))}")
    return () if ALL in named else named


def _ask(question: str, default: str, read: Callable[[str], Answer]) -> Answer:
    """The answer, once it can be read."""
    while True:
        answer = typer.prompt(question, default=default, show_default=bool(default), err=True)
        try:
            return read(answer)
        except OcsError as error:
            typer.echo(f"  {error.message} {error.hint}".rstrip(), err=True)
