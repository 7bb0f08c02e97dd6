"""The commands `validate`, `pareto`, `export`, `init` and `doctor`: parse, call, print."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias, TypeVar

import typer

from ocs_design.cli import completion
from ocs_design.cli import options as opt
from ocs_design.cli.options import (
    package_paths_of_command,
    specified_by_command,
    typed_command,
    with_options,
)
from ocs_design.cli.output import Output, with_output
from ocs_design.common.errors import OcsError, UsageError
from ocs_design.export.formats import FORMATS, USUAL_FORMATS

if TYPE_CHECKING:
    from ocs_design.workflows.init import Start


def doctor(as_json: opt.AsJson = False, no_color: opt.NoColor = False) -> None:
    """Show what is installed, and how to get the rest.

    Says what each package is for. Packages are imported and pictures drawn to see that they can
    be. Exit codes: 0 all that is required works, 5 something required does not.
    """
    from ocs_design.report.text.answers import print_examination
    from ocs_design.workflows.doctor import examination_to_json, examine

    output = Output(as_json, no_color)
    with output.steps.step("import every package, draw with OpenGL"):
        examination = examine()
    if as_json:
        sys.stdout.write(examination_to_json(examination))
    else:
        print_examination(output.console, examination)
    raise typer.Exit(examination.exit_code)


Answer = TypeVar("Answer")


ALL = "all"

QUESTIONS: Mapping[str, str] = {
    "flywheel.r_max": "Largest outer radius of a wheel",
    "flywheel.h_max": "Largest height of a wheel",
    "supply.voltage": "Voltage of the battery",
}
"""What is asked besides robot and maneuvers, by the path of its key."""


@with_options(opt.START_OPTIONS)
def init(
    context: typer.Context,
    yes: Annotated[
        bool, typer.Option("-y", "--yes", help="Ask nothing, as without a terminal.")
    ] = False,
    out: Annotated[
        Path | None, opt.option("-o --out", "FILE", "File to write. Default: <name>.toml.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file.")] = False,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    quiet: opt.Quiet = False,
    no_color: opt.NoColor = False,
) -> None:
    """Write a commented specification to start from.

    It has every key, its default and why to change it. On a terminal it asks for the robot, what it
    shall do, the room and the battery; an empty answer takes the default. Options are written as
    stated. With a robot, defaults are scaled to it.
    """
    from ocs_design.export.folder import check_file_target
    from ocs_design.report.text.answers import print_initialized
    from ocs_design.workflows.init import read_start, write_start

    packages, stated = package_paths_of_command(context), specified_by_command(context)
    read = partial(read_start, package_paths=packages, strict=strict)
    asking = not (yes or as_json) and sys.stdin.isatty() and sys.stderr.isatty()
    own = stated.robot
    if asking and all(item is None for item in (own.file, own.mass, own.inertia, own.human)):
        start = _ask(
            "Robot file (URDF, xacro or MJCF), or nothing",
            "",
            lambda file: read(replace(stated, robot=replace(own, file=file.strip() or None))),
        )
    else:
        start = read(stated)
    file = out or start.default_file
    check_file_target(file, force=force)
    chosen: tuple[str, ...] = ()
    if asking:
        start, chosen = _ask_task(start)
    written = write_start(start, file, chosen=chosen, package_paths=packages, force=force)
    Output(as_json, no_color, quiet).give(written, print_initialized)


def _ask_task(start: "Start") -> tuple["Start", tuple[str, ...]]:
    """The start with what was answered, and the maneuvers that were chosen."""
    from ocs_design.requirement.specification import merge, specification_from_options
    from ocs_design.requirement.vocabulary import NO_MOTOR
    from ocs_design.requirement.writing import rounded_text

    def with_key(path: str, default: str, answer: str) -> "Start":
        """The start with an answer as that key; a bare number is in the default's unit."""
        unit = default.partition(" ")[2] if answer.strip()[-1:].isdigit() else ""
        given = {} if answer == default else {path: f"{answer} {unit}".rstrip()}
        return replace(start, stated=merge(start.stated, specification_from_options(given)))

    chosen: tuple[str, ...] = ()
    if start.stated.takes_default_maneuvers:
        known = [maneuver.name for maneuver in start.default.maneuvers]

        def maneuvers(answer: str) -> tuple[str, ...]:
            """Names of maneuvers; none for all, which are the default."""
            named = tuple(name.strip() for name in answer.split(","))
            unknown = [name for name in named if name not in (*known, ALL)]
            if unknown:
                raise UsageError(
                    f"{', '.join(unknown)}: unknown; choose from {', '.join((*known, ALL))}"
                )
            return () if ALL in named else named

        question = f"Maneuvers: {', '.join(known)}, with commas, or {ALL}"
        chosen = _ask(question, ALL, maneuvers)
    for path, question in QUESTIONS.items():
        section, _, name = path.partition(".")
        is_moot = section in {"motor", "supply"} and start.stated.motor.name == NO_MOTOR
        if not is_moot and getattr(getattr(start.stated, section), name) is None:
            default = rounded_text(start.default, path)
            start = _ask(question, default, partial(with_key, path, default))
    return start, chosen


def _ask(question: str, default: str, read: Callable[[str], Answer]) -> Answer:
    """The answer, once it can be read."""
    while True:
        answer = typer.prompt(question, default=default, show_default=bool(default), err=True)
        try:
            return read(answer)
        except OcsError as error:
            typer.echo(f"  {error.message} {error.hint}".rstrip(), err=True)


DesignFile: TypeAlias = Annotated[
    Path,
    typer.Argument(
        autocompletion=completion.files("design.json"),
        metavar="DESIGN",
        help="design.json, or the folder that it lies in.",
    ),
]
OtherRobot: TypeAlias = Annotated[
    Path | None,
    opt.option(
        "--robot",
        "FILE",
        "The robot's file, if it has moved or another one is wanted.",
        completion.files(*completion.ROBOTS),
    ),
]


@with_output
def export(
    context: typer.Context,
    design: DesignFile,
    out: Annotated[
        Path | None, opt.option("-o --out", "DIR", "Output folder. Default: <name>-ocs-export.")
    ] = None,
    formats: Annotated[
        list[str] | None,
        opt.option(
            "--formats",
            "NAMES",
            f"{', '.join(each.name for each in USUAL_FORMATS)} (these are the default), "
            f"{', '.join(each.name for each in FORMATS if each.on_request)}, figures, report, "
            "controller, with commas between them; or all.",
            completion.listed(completion.any_of(completion.formats)),
        ),
    ] = None,
    robot: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: Output,
) -> None:
    """Write the files of a design.json again.

    Parts, robot files and snippets: they are the files that `ocs-design size` wrote, byte for byte.
    Files of the whole robot need the robot's own file as it was, and its meshes. In the design's
    own folder, with --force, only what is made anew is replaced.
    """
    from ocs_design.report.text.answers import print_export
    from ocs_design.requirement.values import names_in
    from ocs_design.workflows.export import export_design

    exported = export_design(
        design,
        [name for text in formats or () for name in names_in(text)],
        out=out,
        robot_file=robot,
        package_paths=package_paths_of_command(context),
        force=output.force,
        strict=output.strict,
        progress=output.steps,
        command=typed_command(),
    )
    output.give(exported, print_export, exported.warnings)


@with_options(opt.TASK_OPTIONS)
@with_output
def pareto(
    context: typer.Context,
    against: Annotated[
        str,
        opt.option(
            "--against",
            "NAME",
            "time, angle, radius, height or voltage is varied.",
            completion.one_of("time", "angle", "radius", "height", "voltage"),
        ),
    ] = "time",
    low: Annotated[str | None, opt.option("--from", "VALUE", "Lowest value, e.g. 300ms.")] = None,
    high: Annotated[
        str | None,
        opt.option(
            "--to", "VALUE", "Highest value. Default of both: around the specification's own."
        ),
    ] = None,
    points: Annotated[int, opt.option("--points", "N", "How many values.")] = 9,
    maneuver: Annotated[
        str,
        opt.option(
            "--maneuver",
            "NAME",
            "Vary the time or angle of this one alone. Default: of all, in one ratio.",
            completion.maneuvers,
        ),
    ] = "",
    out: Annotated[
        Path | None,
        opt.option(
            "-o --out",
            "DIR",
            "Write the front and the specification of each point into this folder.",
        ),
    ] = None,
    *,
    output: Output,
) -> None:
    """Show the lightest device against time, angle or room.

    Every value is a design of its own, not flown yet. To make, export and fly one:
    `ocs-design size --spec DIR/points/NN.toml`. Exit code 4: no value has a device.
    """
    from ocs_design.report.text.front import print_front
    from ocs_design.workflows.pareto import pareto_front

    front = pareto_front(
        specified_by_command(context),
        against,
        low=low,
        high=high,
        points=points,
        maneuver=maneuver,
        package_paths=package_paths_of_command(context),
        out=out,
        force=output.force,
        strict=output.strict,
        progress=output.steps,
    )
    output.give(front, partial(print_front, folder=out))
    raise typer.Exit(front.exit_code)


@with_output
def validate(
    context: typer.Context,
    design: DesignFile,
    samples: Annotated[
        int | None, opt.option("--samples", "N", "Fly N robots as they might be built.")
    ] = None,
    seed: opt.Seed = None,
    until_width: Annotated[
        str | None,
        opt.option(
            "--until-width",
            "SHARE",
            "Stop earlier: as soon as each success rate is known to within this, e.g. 5%.",
        ),
    ] = None,
    certify: opt.Certify = False,
    survives: opt.Survives = None,
    detection: opt.Detection = None,
    scheduler: Annotated[
        str | None, opt.option("--scheduler", "ADDRESS", "Fly the samples on this Dask cluster.")
    ] = None,
    engine: Annotated[
        str,
        opt.option(
            "--engine",
            "NAME",
            "Fly the samples by this: mujoco on the processors, or warp on an NVIDIA GPU, in "
            "single precision.",
            completion.one_of("mujoco", "warp"),
        ),
    ] = "mujoco",
    sample: Annotated[
        int | None, opt.option("--sample", "K", "Fly sample K of --seed alone.")
    ] = None,
    replay: Annotated[
        Path | None,
        opt.option(
            "--replay",
            "FILE",
            "Fly a case from the folder worst/ again.",
            completion.files(".json"),
        ),
    ] = None,
    spec: opt.Spec = None,
    reality: opt.Reality = None,
    ballistic: opt.Ballistic = False,
    desaturate: Annotated[
        bool, typer.Option("--desaturate", help="Brake the wheels while the robot stands.")
    ] = False,
    view: Annotated[
        bool,
        typer.Option("--view", help="Show the runs in MuJoCo's viewer, each until it is closed."),
    ] = False,
    out: Annotated[
        Path | None,
        opt.option(
            "-o --out",
            "DIR",
            "Write time series into this folder; with --samples, every sample. There a run that "
            "was interrupted goes on.",
        ),
    ] = None,
    robot_file: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: Output,
) -> None:
    """Fly the maneuvers of a design.json again.

    Each is flown with the device and without. With --samples also many times over with what reality
    adds: sensors, delay, friction, and a robot, device and motors that are not quite as designed,
    drawn from [reality] of the specification. The same seed gives the same samples wherever they
    are flown. With --certify no more of them than it takes to be sure of the reliability that was
    asked for. With --survives one a drive stops on the way. Exit code 1: a scenario fails as
    designed, a landing with a drive stopped is beyond the allowance, or the certificate falls
    short.
    """
    with output.steps.step("load the simulator"):
        from ocs_design.common.units import Dimension, parse_quantity
        from ocs_design.report.text.validation import print_validated
        from ocs_design.workflows.validate import validate_design, watch
    width = None
    if until_width is not None:
        width = parse_quantity(until_width, Dimension.RATIO, "--until-width")
    answer = validate_design(
        design,
        samples=samples,
        until_width=width,
        sample=sample,
        replay=replay,
        specification=specified_by_command(context),
        robot_file=robot_file,
        package_paths=package_paths_of_command(context),
        scheduler=scheduler,
        engine=engine,
        out=out,
        force=output.force,
        strict=output.strict,
        view=view,
        progress=output.steps,
    )
    show = partial(print_validated, folder=answer.folder, files=answer.files)
    output.give(answer.found, show, answer.found.warnings)
    if view:
        watch(answer)
    output.end(answer.exit_code, answer.found)
