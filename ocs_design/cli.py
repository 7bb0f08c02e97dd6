"""The command line: parse, call one function, print. No arithmetic.

Heavy modules are imported inside the commands: that costs seconds, and `--help` needs none.
"""

import gc
import os
import signal
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ocs_design import cli_errors
from ocs_design import cli_options as opt

if TYPE_CHECKING:
    from ocs_design.requirement.specification import Specification

app = typer.Typer(
    name="ocs-design",
    help="Size, export and prove a flywheel orientation control system for a legged robot.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=True,
)


def main() -> None:
    """Entry point of `ocs-design`; to be told to end is an interrupt, so that it tidies up."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.exit(cli_errors.run(app, sys.argv[1:]))


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
def size(
    robot: opt.RobotFile = None,
    mass: opt.Mass = None,
    inertia: opt.Inertia = None,
    spec: opt.Spec = None,
    trunk: opt.Trunk = None,
    posture: opt.Posture = None,
    joint: opt.Joints = None,
    package_path: opt.PackagePaths = None,
    rate_change: opt.RateChange = None,
    wheel_speed_max: opt.WheelSpeedMax = None,
    torque_max: opt.TorqueMax = None,
    alpha: opt.Alpha = None,
    alpha_criterion: opt.AlphaCriterion = None,
    position: opt.Position = None,
    r_max: opt.RMax = None,
    r_min: opt.RMin = None,
    h_max: opt.HMax = None,
    h_min: opt.HMin = None,
    wall_min: opt.WallMin = None,
    wheel_mass_max: opt.WheelMassMax = None,
    material: opt.MaterialName = None,
    no_validate: opt.NoValidate = False,
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
    from ocs_design.report.console import Steps, make_console

    specification = _specification(
        spec,
        {
            **_robot(robot, mass, inertia, trunk, posture, joint),
            "requirement.rate_change": rate_change,
            "requirement.wheel_speed_max": wheel_speed_max,
            "motor.torque_max": torque_max,
            "ocs.alpha": alpha,
            "ocs.alpha_criterion": alpha_criterion,
            "ocs.position": position,
            "flywheel.r_max": r_max,
            "flywheel.r_min": r_min,
            "flywheel.h_max": h_max,
            "flywheel.h_min": h_min,
            "flywheel.wall_min": wall_min,
            "flywheel.wheel_mass_max": wheel_mass_max,
            "flywheel.material": material,
            "validation.enabled": False if no_validate else None,
            "validation.seed": seed,
        },
    )
    console = make_console(color=not no_color)
    steps = Steps(console, quiet=quiet or as_json)
    with steps.step("load the solver and the simulator"), _quick_imports():
        from ocs_design.design_file import design_to_json
        from ocs_design.pipeline import design_ocs
        from ocs_design.report.flights import print_outcome
        from ocs_design.report.terminal import print_design, print_solution
        from ocs_design.sizing.rim_program import load_solver

        load_solver()
    outcome = design_ocs(
        specification,
        out=out,
        package_paths=_package_paths(package_path),
        force=force,
        strict=strict,
        steps=steps,
    )
    if as_json:
        sys.stdout.buffer.write(design_to_json(outcome.design))
    elif not quiet:
        print_design(console, outcome.design)
        if verbose:
            print_solution(console, outcome.design)
        print_outcome(console, outcome.design, outcome.folder)
    raise typer.Exit(outcome.exit_code)


@app.command()
def inspect(
    robot: opt.RobotFile = None,
    mass: opt.Mass = None,
    inertia: opt.Inertia = None,
    spec: opt.Spec = None,
    trunk: opt.Trunk = None,
    posture: opt.Posture = None,
    joint: opt.Joints = None,
    package_path: opt.PackagePaths = None,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    no_color: opt.NoColor = False,
) -> None:
    """Show what is read from a robot: mass, inertia, posture, incidence angles, warnings."""
    from ocs_design.inspection import inspect_robot, inspection_to_json
    from ocs_design.report.console import make_console
    from ocs_design.report.inspection import print_inspection

    specification = _specification(
        spec,
        _robot(robot, mass, inertia, trunk, posture, joint),
    )
    inspection = inspect_robot(
        specification, package_paths=_package_paths(package_path), strict=strict
    )
    if as_json:
        sys.stdout.buffer.write(inspection_to_json(inspection))
    else:
        print_inspection(make_console(color=not no_color), inspection)


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
    from ocs_design.bounding import bound_by_hand, bound_to_json
    from ocs_design.report.bound import print_bound
    from ocs_design.report.console import make_console

    answer = bound_by_hand(
        inertia=inertia,
        rate_change=rate_change,
        wheel_speed_max=wheel_speed_max,
        alpha=alpha,
        axis=axis,
    )
    if as_json:
        sys.stdout.buffer.write(bound_to_json(answer))
    else:
        print_bound(make_console(color=not no_color), answer)


@app.command()
def catalogue(
    what: Annotated[str, typer.Argument(metavar="materials", help="What to list.")],
    as_json: opt.AsJson = False,
    no_color: opt.NoColor = False,
) -> None:
    """What can be chosen, with sources."""
    from ocs_design.catalogue.materials import materials, materials_to_json
    from ocs_design.exceptions import UsageError
    from ocs_design.report.catalogue import print_materials
    from ocs_design.report.console import make_console

    if what != "materials":
        raise UsageError(f"there is no catalogue of {what}", hint="try: catalogue materials")
    if as_json:
        sys.stdout.buffer.write(materials_to_json())
    else:
        print_materials(make_console(color=not no_color), list(materials().values()))


def _robot(
    file: opt.Text,
    mass: opt.Text,
    inertia: opt.Text,
    trunk: opt.Text,
    posture: opt.Text,
    joints: list[str] | None,
) -> Mapping[str, object]:
    """Options that say which robot and how it stands, by the key of the specification."""
    return {
        "robot.file": file,
        "robot.mass": mass,
        "robot.inertia": inertia,
        "robot.trunk": trunk,
        "robot.posture": posture,
        "robot.joints": joints or None,
    }


def _specification(file: Path | None, options: Mapping[str, object]) -> "Specification":
    """The specification file with the options over it."""
    from ocs_design.requirement.options import specification_from_options
    from ocs_design.requirement.reading import read_specification
    from ocs_design.requirement.specification import Specification, merge

    base = Specification() if file is None else read_specification(file)
    return merge(base, specification_from_options(options))


def _package_paths(texts: list[str] | None) -> Mapping[str, Path]:
    """`NAME=DIR` pairs of `--package-path`."""
    from ocs_design.exceptions import UsageError

    found = {}
    for text in texts or []:
        name, separator, folder = text.partition("=")
        if not (name and separator and folder):
            raise UsageError(
                f"--package-path {text}: is not NAME=DIR",
                hint="as in --package-path my_robot=/opt/my_robot",
            )
        found[name] = Path(folder)
    return found
