"""`ocs-design pareto`: parse, call, print. No arithmetic."""

import sys
from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from ocs_design.cli import options as opt
from ocs_design.cli.signatures import with_options
from ocs_design.cli.stated import stated_package_paths, stated_specification

Against: TypeAlias = Annotated[
    str,
    typer.Option(
        "--against", metavar="NAME", help="time, angle, radius, height or voltage is varied."
    ),
]
Low: TypeAlias = Annotated[
    str | None, typer.Option("--from", metavar="VALUE", help="Lowest value, e.g. 300ms.")
]
High: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--to",
        metavar="VALUE",
        help="Highest value. Default of both: around the specification's own.",
    ),
]
Points: TypeAlias = Annotated[int, typer.Option("--points", metavar="N", help="How many values.")]
ManeuverName: TypeAlias = Annotated[
    str,
    typer.Option(
        "--maneuver",
        metavar="NAME",
        help="Vary the time or angle of this one alone. Default: of all, in one ratio.",
    ),
]
FrontFolder: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--out",
        metavar="DIR",
        help="Write the front and the specification of each point into this folder.",
    ),
]


@with_options(opt.TASK_OPTIONS)
@opt.with_output
def pareto(
    context: typer.Context,
    against: Against = "time",
    low: Low = None,
    high: High = None,
    points: Points = 9,
    maneuver: ManeuverName = "",
    out: FrontFolder = None,
    *,
    output: opt.Output,
) -> None:
    """Show what the lightest device weighs against time, angle or room.

    Every value is a design of its own, without its proof by simulation: `ocs-design size --spec
    DIR/points/NN.toml` makes, exports and flies it. Exit code 4: no value has a device.
    """
    from ocs_design.answers import to_json
    from ocs_design.export.folder import check_target
    from ocs_design.pareto import draw_front, front_values, lightest_device, read_task
    from ocs_design.report.console import Steps, make_console
    from ocs_design.report.front_files import write_front
    from ocs_design.report.pareto import print_front, print_written
    from ocs_design.requirement.sweeps import sweep_of

    sweep = sweep_of(against, maneuver)
    if out is not None:
        check_target(out, force=output.force)
    console = make_console(color=not output.no_color)
    steps = Steps(console, quiet=output.quiet or output.as_json)
    specification, paths = stated_specification(context), stated_package_paths(context)
    with steps.step("read the robot") as step:
        task = read_task(specification, package_paths=paths, strict=output.strict)
        step.note = task.robot.name
    values = front_values(sweep, task, low=low, high=high, points=points)
    with steps.step(f"choose a device for each of {points} values") as step:
        front = draw_front(task, sweep, values, lightest_device, step.update)
    remarks = () if out is None else write_front(front, out, force=output.force)
    if output.as_json:
        sys.stdout.buffer.write(to_json(front))
    elif not output.quiet:
        print_front(console, front)
        print_written(console, front, out, remarks)
    raise typer.Exit(front.exit_code)
