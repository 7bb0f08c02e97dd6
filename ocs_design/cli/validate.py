"""`ocs-design validate`: parse, call, print. No arithmetic."""

import sys
from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from ocs_design.cli import options as opt
from ocs_design.cli.export import DesignFile, OtherRobot
from ocs_design.cli.stated import stated_package_paths, stated_specification

FlightsFolder: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--out",
        metavar="DIR",
        help="Write time series into this folder; with --samples, every sample. There a run that "
        "was interrupted goes on.",
    ),
]
Samples: TypeAlias = Annotated[
    int | None,
    typer.Option("--samples", metavar="N", help="Fly N robots as they might be built."),
]
UntilWidth: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--until-width",
        metavar="SHARE",
        help="Stop earlier: as soon as each success rate is known to within this, e.g. 5%.",
    ),
]
Scheduler: TypeAlias = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="Fly the samples on this Dask cluster."),
]
OneSample: TypeAlias = Annotated[
    int | None, typer.Option("--sample", metavar="K", help="Fly sample K of --seed alone.")
]
CaseFile: TypeAlias = Annotated[
    Path | None,
    typer.Option("--replay", metavar="FILE", help="Fly a case from the folder worst/ again."),
]
View: TypeAlias = Annotated[
    bool, typer.Option("--view", help="Show the runs in MuJoCo's viewer, each until it is closed.")
]
Desaturate: TypeAlias = Annotated[
    bool, typer.Option("--desaturate", help="Brake the wheels while the robot stands.")
]


@opt.with_output
def validate(
    context: typer.Context,
    design: DesignFile,
    samples: Samples = None,
    seed: opt.Seed = None,
    until_width: UntilWidth = None,
    scheduler: Scheduler = None,
    sample: OneSample = None,
    replay: CaseFile = None,
    spec: opt.Spec = None,
    ballistic: opt.Ballistic = False,
    desaturate: Desaturate = False,
    view: View = False,
    out: FlightsFolder = None,
    robot_file: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: opt.Output,
) -> None:
    """Fly the maneuvers of a design.json again, with the device and without.

    With --samples also many times over with what reality adds: sensors, delay, friction, and a
    robot, device and motors that are not quite as designed, drawn from [reality] of the
    specification. The same seed gives the same samples wherever they are flown. Exit code 1: a
    scenario fails as designed.
    """
    from ocs_design.report.console import Steps, make_console

    console = make_console(color=not output.no_color)
    steps = Steps(console, quiet=output.quiet or output.as_json)
    with steps.step("load the simulator"):
        from ocs_design.answers import to_json
        from ocs_design.report.validation import print_validated
        from ocs_design.validation import Request, validate_design, watch
    request = Request(
        design=design,
        stated=stated_specification(context),
        robot_file=robot_file,
        package_paths=stated_package_paths(context),
        samples=samples,
        until_width=_share(until_width),
        scheduler=scheduler,
        sample=sample,
        replay=replay,
        out=out,
        force=output.force,
        strict=output.strict,
        view=view,
    )
    answer = validate_design(request, steps)
    if output.as_json:
        sys.stdout.buffer.write(to_json(answer.found))
    elif not output.quiet:
        print_validated(console, answer.found, answer.folder, answer.files)
    if view:
        watch(answer)
    raise typer.Exit(answer.exit_code)


def _share(text: str | None) -> float | None:
    """Of `--until-width`."""
    from ocs_design.units import Dimension, parse_quantity

    return None if text is None else parse_quantity(text, Dimension.RATIO, "--until-width")
