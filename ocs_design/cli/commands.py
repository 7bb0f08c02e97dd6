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
    sample_command,
    specified_by_command,
    typed_command,
    with_options,
)
from ocs_design.cli.output import Output, with_output
from ocs_design.common.errors import OcsError, UsageError
from ocs_design.export.formats import FORMATS, USUAL_FORMATS

if TYPE_CHECKING:
    from ocs_design.workflows.init import StartingPoint


def doctor(as_json: opt.AsJson = False, no_color: opt.NoColor = False) -> None:
    """Show what is installed, and how to get the rest.

    Imports every package, says what each is for, and renders pictures as a test. Exit codes: 0
    everything required works, 5 something required does not.
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
"""Questions besides robot and maneuvers, by path of the key."""


@with_options(opt.START_OPTIONS)
def init(
    context: typer.Context,
    yes: Annotated[bool, opt.flag("-y --yes", "Ask no questions, as without a terminal.")] = False,
    out: Annotated[
        Path | None, opt.option("-o --out", "FILE", "File to write. Default: <name>.toml.")
    ] = None,
    force: Annotated[bool, opt.flag("--force", "Replace a file.")] = False,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    quiet: opt.Quiet = False,
    no_color: opt.NoColor = False,
) -> None:
    """Write a commented specification to start from.

    The file has every key, its default and why to change it. On a terminal, init asks for the
    robot, its maneuvers, the size of the wheels and the battery; an empty answer takes the default.
    Options are written to the file. With a robot, defaults are scaled to it.
    """
    from ocs_design.export.folder import check_file_target
    from ocs_design.report.text.answers import print_initialized
    from ocs_design.workflows.init import read_starting_point, write_specification

    packages, specified = package_paths_of_command(context), specified_by_command(context)
    read = partial(read_starting_point, package_paths=packages, strict=strict)
    asking = not (yes or as_json) and sys.stdin.isatty() and sys.stderr.isatty()
    start = read(specified)
    if asking and start.robot is None:

        def with_robot(file: str) -> "StartingPoint":
            """The start for the robot of a file; without a name as before."""
            robot = replace(specified.robot, file=file.strip() or None)
            return read(replace(specified, robot=robot))

        start = _ask("Robot file (URDF, xacro or MJCF), or nothing", "", with_robot)
    file = out or start.default_file
    check_file_target(file, force=force)
    chosen: tuple[str, ...] = ()
    if asking:
        start, chosen = _ask_task(start)
    written = write_specification(start, file, chosen=chosen, package_paths=packages, force=force)
    Output(as_json, no_color, quiet).give(written, print_initialized)


def _ask_task(start: "StartingPoint") -> tuple["StartingPoint", tuple[str, ...]]:
    """The start with the user's answers, and the maneuvers that were chosen."""
    from ocs_design.requirement.specification import merge, specification_from_options
    from ocs_design.requirement.vocabulary import NO_MOTOR
    from ocs_design.requirement.writing import rounded_text

    def with_key(path: str, default: str, answer: str) -> "StartingPoint":
        """The start with an answer as a key's value; a bare number is in the default's unit."""
        unit = default.partition(" ")[2] if answer.strip()[-1:].isdigit() else ""
        options = {} if answer == default else {path: f"{answer} {unit}".rstrip()}
        return replace(start, specified=merge(start.specified, specification_from_options(options)))

    chosen: tuple[str, ...] = ()
    if start.specified.takes_default_maneuvers:
        names = [maneuver.name for maneuver in start.default.maneuvers]

        def maneuvers(answer: str) -> tuple[str, ...]:
            """Names of maneuvers; empty for all, which is the default."""
            chosen_names = tuple(name.strip() for name in answer.split(","))
            unknown = [name for name in chosen_names if name not in (*names, ALL)]
            if unknown:
                raise UsageError(
                    f"{', '.join(unknown)}: unknown; choose from {', '.join((*names, ALL))}"
                )
            return () if ALL in chosen_names else chosen_names

        question = f"Maneuvers, separated by commas: {', '.join(names)}; or {ALL}"
        chosen = _ask(question, ALL, maneuvers)
    for path, question in QUESTIONS.items():
        section, _, name = path.partition(".")
        is_moot = section in {"motor", "supply"} and start.specified.motor.name == NO_MOTOR
        if not is_moot and getattr(getattr(start.specified, section), name) is None:
            default = rounded_text(start.default, path)
            start = _ask(question, default, partial(with_key, path, default))
    return start, chosen


def _ask(question: str, default: str, read: Callable[[str], Answer]) -> Answer:
    """The answer; asks again until it can be parsed."""
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
        help="design.json, or its folder.",
    ),
]
OtherRobot: TypeAlias = Annotated[
    Path | None,
    opt.option(
        "--robot",
        "FILE",
        "The robot's file, if it has moved or you want to use another.",
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
            f"{', '.join(kind.name for kind in USUAL_FORMATS)} (the default), "
            f"{', '.join(kind.name for kind in FORMATS if kind.on_request)}, figures, report, "
            "controller, separated by commas; or all.",
            completion.listed(completion.any_of(completion.formats)),
        ),
    ] = None,
    robot: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: Output,
) -> None:
    """Write the files of a design.json again.

    Parts, robot files and snippets, byte for byte as `ocs-design size` wrote them. Files of the
    whole robot need the robot's own file, unchanged, and its meshes. In the design's own folder,
    with --force, only files that are written again are replaced.
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
            "Figure to vary: time, angle, radius, height or voltage.",
            completion.one_of("time", "angle", "radius", "height", "voltage"),
        ),
    ] = "time",
    low: Annotated[
        str | None,
        opt.option(
            "--from", "VALUE", "Lowest value, e.g. 300ms. Default: below the specified one."
        ),
    ] = None,
    high: Annotated[
        str | None,
        opt.option("--to", "VALUE", "Highest value, e.g. 600ms. Default: above the specified one."),
    ] = None,
    points: Annotated[int, opt.option("--points", "N", "Number of values.")] = 9,
    maneuver: Annotated[
        str,
        opt.option(
            "--maneuver",
            "NAME",
            "Vary the time or angle of this maneuver only. Default: of all, in proportion.",
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
    """Show mass against time, angle, radius, height or voltage.

    Each point is the lightest device at that value, sized but not flown. To make, export and fly
    one: `ocs-design size --spec DIR/points/NN.toml`. Exit code 4: no value has a device.
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
    samples: Annotated[int | None, opt.option("--samples", "N", "Fly N sampled robots.")] = None,
    seed: opt.Seed = None,
    until_width: Annotated[
        str | None,
        opt.option(
            "--until-width",
            "SHARE",
            "Stop once the 95 % interval of each success rate is no wider than this, e.g. 5%.",
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
            "Physics engine for the samples: mujoco on the processors, or warp on an NVIDIA GPU, "
            "in single precision.",
            completion.one_of("mujoco", "warp"),
        ),
    ] = "mujoco",
    sample: Annotated[
        int | None, opt.option("--sample", "K", "Fly only sample K of --seed.")
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
        bool, opt.flag("--desaturate", "Brake the wheels while the robot stands.")
    ] = False,
    view: Annotated[
        bool, opt.flag("--view", "Show the flights in MuJoCo's viewer; closing it shows the next.")
    ] = False,
    out: Annotated[
        Path | None,
        opt.option(
            "-o --out",
            "DIR",
            "Write time series into this folder; with --samples, every sample. An interrupted run "
            "resumes there.",
        ),
    ] = None,
    robot_file: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: Output,
) -> None:
    """Fly the maneuvers of a design.json again.

    Each is flown with and without the device. --samples N also flies N robots with real-world
    errors, sampled from [reality] of the specification: sensors, delay, friction, and a robot,
    device and motors that deviate from the design. The same seed gives the same samples on any
    machine. --certify flies as many as it takes to decide on the specified reliability; with
    --survives one a drive fails in flight. Exit code 1: a scenario fails as designed, a landing
    with a failed drive is out of tolerance, or the reliability is not certified.
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
    record, replay_command = answer.record.monte_carlo, ""
    if record is not None:
        # Engines other than MuJoCo fly many samples only.
        engine_text = "" if engine == "mujoco" else " with MuJoCo"
        command = sample_command(context, answer.record.design, record.seed)
        replay_command = f"Fly one again{engine_text}: {command}"
    show = partial(
        print_validated, folder=answer.folder, files=answer.files, replay_hint=replay_command
    )
    output.give(answer.record, show, answer.record.warnings)
    if view:
        watch(answer)
    output.end(answer.exit_code, answer.record)
