"""The command line: parse, call one function, print. No arithmetic.

Heavy modules are imported inside the commands: that costs seconds, and `--help` needs none.
"""

import gc
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer

from ocs_design.cli import errors
from ocs_design.cli import options as opt
from ocs_design.cli.commands import doctor, export, init, pareto, validate
from ocs_design.cli.options import (
    package_paths_of_command,
    specified_by_command,
    typed_command,
    with_options,
)

app = typer.Typer(
    name="ocs-design",
    help="Size, export and prove a flywheel orientation control system for a legged robot.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=True,
)


def main() -> int:
    """Run what was typed; the exit code."""
    return errors.run(app, sys.argv[1:])


@contextmanager
def _quick_imports() -> Iterator[None]:
    """Import without collecting garbage.

    Importing makes some hundred thousand objects and hardly any garbage, and the collector goes
    through all of them again and again. Afterwards it is needed: meshes leave much behind.
    """
    # Nothing is drawn; unless told so, MuJoCo starts processes to look for a window library.
    os.environ.setdefault("MUJOCO_GL", "disabled")
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


@app.callback(invoke_without_command=True)
def _no_command(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if version:
        from ocs_design import __version__

        print(f"ocs-design {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())


@app.command()
@with_options(opt.TASK_OPTIONS)
def size(
    context: typer.Context,
    lighter_by: opt.LighterBy = None,
    co_design: opt.CoDesign = False,
    no_validate: opt.NoValidate = False,
    ballistic: opt.Ballistic = False,
    certify: opt.Certify = False,
    video: opt.Video = False,
    seed: opt.Seed = None,
    out: opt.Out = None,
    force: opt.Force = False,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    quiet: opt.Quiet = False,
    verbose: opt.Verbose = False,
    no_color: opt.NoColor = False,
) -> None:
    """Size a device for a robot, export it and prove it in simulation.

    A quantity is SI, or carries its unit: 30mm, 7200rpm, 40deg, 102g. Exit codes: 0 done, 1 a
    scenario fails, 2 wrong usage, 3 the input cannot be read, 4 no design meets the specification,
    5 an optional tool is missing.
    """
    from ocs_design.report.text.console import Steps, make_console

    specification = specified_by_command(context)
    console = make_console(color=not no_color)
    steps = Steps(make_console(color=not no_color, stderr=True), quiet=quiet or as_json)
    with steps.step("load the solver and the simulator"), _quick_imports():
        from ocs_design.device.records import design_to_json
        from ocs_design.report.text.size import print_design, print_outcome, print_solution
        from ocs_design.report.text.summary import print_summary
        from ocs_design.workflows.size import design_ocs, load_solvers

        load_solvers(specification)
    outcome = design_ocs(
        specification,
        out=out,
        package_paths=package_paths_of_command(context),
        force=force,
        strict=strict,
        steps=steps,
        command=typed_command(),
    )
    if as_json:
        sys.stdout.buffer.write(design_to_json(outcome.design))
    elif verbose:
        print_design(console, outcome.design)
        print_solution(console, outcome.design)
        print_outcome(console, outcome.design, outcome.folder)
    elif not quiet:
        print_summary(console, outcome.design, outcome.runs, outcome.folder)
    raise typer.Exit(outcome.exit_code)


@app.command()
@with_options(opt.ROBOT_OPTIONS)
def inspect(
    context: typer.Context,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    picture: opt.Picture = None,
    verbose: Annotated[
        bool, typer.Option("-v", "--verbose", help="Also print each joint of the posture.")
    ] = False,
    no_color: opt.NoColor = False,
) -> None:
    """Show what is read from a robot: mass, inertia, posture, incidence angles, warnings."""
    from ocs_design.device.answers import to_json
    from ocs_design.report.text.console import make_console
    from ocs_design.report.text.robot import print_inspection
    from ocs_design.workflows.inspect import inspect_robot

    inspection = inspect_robot(
        specified_by_command(context),
        package_paths=package_paths_of_command(context),
        strict=strict,
        picture=picture,
    )
    if as_json:
        sys.stdout.buffer.write(to_json(inspection))
    else:
        print_inspection(make_console(color=not no_color), inspection, verbose=verbose)


@app.command()
def bound(
    inertia: Annotated[
        str,
        typer.Option(metavar="INERTIA", help="Of the robot about the axis, e.g. '0.0515 kg m2'."),
    ],
    rate_change: Annotated[
        str, typer.Option(metavar="RATE", help="Change of the trunk's rate, e.g. 2rad/s.")
    ],
    wheel_speed_max: Annotated[
        str, typer.Option(metavar="SPEED", help="Highest speed of a wheel, relative to the trunk.")
    ] = "7200rpm",
    alpha: Annotated[
        str, typer.Option(metavar="ANGLE", help="Incidence of the wheel axes.")
    ] = "0deg",
    axis: Annotated[str, typer.Option(metavar="AXIS", help="pitch or roll.")] = "pitch",
    as_json: opt.AsJson = False,
    no_color: opt.NoColor = False,
) -> None:
    """The paper's lower bound on the wheels' inertia by hand, and its curve."""
    from ocs_design.device.answers import to_json
    from ocs_design.report.text.answers import print_bound
    from ocs_design.report.text.console import make_console
    from ocs_design.workflows.bound import bound_by_hand

    answer = bound_by_hand(
        inertia=inertia,
        rate_change=rate_change,
        wheel_speed_max=wheel_speed_max,
        alpha=alpha,
        axis=axis,
    )
    if as_json:
        sys.stdout.buffer.write(to_json(answer))
    else:
        print_bound(make_console(color=not no_color), answer)


app.command()(export)
app.command()(validate)
app.command()(pareto)
app.command()(init)
app.command()(doctor)


@app.command()
def catalogue(
    what: Annotated[str, typer.Argument(metavar="motors|gears|materials", help="What to list.")],
    motors: opt.MotorsFile = None,
    gears: opt.GearsFile = None,
    as_json: opt.AsJson = False,
    verbose: Annotated[
        bool, typer.Option("-v", "--verbose", help="Also print each row's source and remark.")
    ] = False,
    no_color: opt.NoColor = False,
) -> None:
    """What can be chosen, with sources."""
    from ocs_design.report.text.catalogue import listing
    from ocs_design.report.text.console import make_console

    listed = listing(what, {"motors": motors, "gears": gears})
    if as_json:
        sys.stdout.buffer.write(listed.to_json())
    else:
        listed.show(make_console(color=not no_color), verbose=verbose)
