"""The command line: parse, call one function, print. No arithmetic.

Heavy modules are imported inside the commands: that takes seconds, and `--help` needs none.
"""

import gc
import os
import sys
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand

from ocs_design.cli import completion, errors
from ocs_design.cli import options as opt
from ocs_design.cli.commands import doctor, export, init, pareto, validate
from ocs_design.cli.options import (
    package_paths_of_command,
    specified_by_command,
    typed_command,
    with_options,
)
from ocs_design.cli.output import Output, with_output
from ocs_design.common.errors import UsageError

if TYPE_CHECKING:
    from rich.console import Console

    from ocs_design.device.records.design import OcsDesign
    from ocs_design.requirement.specification import Specification

app = typer.Typer(
    name="ocs-design",
    help="Size, export and validate a flywheel orientation control system for a legged robot.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

EXAMPLES: Mapping[str, tuple[str, ...]] = {
    "size": (
        "ocs-design size robot.urdf",
        "ocs-design size robot.urdf --jump-height 0.4m --kick '12 N s at 0.1,0,0.2'",
        "ocs-design size robot.urdf --bus-voltage 36V --r-max 40mm -o wheels --open",
        "ocs-design size robot.urdf --motor MN4012-KV480 --motor G60-KV55",
        "ocs-design size --mass 2.5 --inertia 0.030,0.0515,0.068",
    ),
    "demo": ("ocs-design demo", "ocs-design demo -o /tmp/solo12-ocs --no-open"),
    "inspect": (
        "ocs-design inspect robot.urdf --picture robot.svg",
        "ocs-design inspect robot.xml --posture home --json",
    ),
    "bound": (
        "ocs-design bound --inertia '0.0515 kg m2' --rate-change 2rad/s",
        "ocs-design bound --inertia 0.0515 --rate-change 2 --alpha 40deg",
    ),
    "export": (
        "ocs-design export robot-ocs --formats 3mf,step,dxf",
        "ocs-design export robot-ocs --formats all --robot elsewhere/robot.urdf",
    ),
    "validate": (
        "ocs-design validate robot-ocs --samples 1000 --until-width 5% -o flights",
        "ocs-design validate robot-ocs --certify",
        "ocs-design validate robot-ocs --replay flights/worst/drop-1.json --view",
    ),
    "pareto": (
        "ocs-design pareto robot.urdf --against time -o front",
        "ocs-design pareto robot.urdf --against angle --maneuver drop --to 40deg",
    ),
    "init": (
        "ocs-design init robot.urdf",
        "ocs-design init robot.urdf --r-max 40mm -y -o dog.toml",
    ),
    "doctor": ("ocs-design doctor", "ocs-design doctor --json"),
    "catalogue": ("ocs-design catalogue motors -v", "ocs-design catalogue gears --json"),
}
"""Example commands for the end of each command's help."""


def _examples(command: str) -> str:
    """Paragraph with examples; the backspace keeps it from being wrapped."""
    return "\b\n" + "\n".join(["Examples:", *(f"  {line}" for line in EXAMPLES[command])])


class _DesignCommand(TyperCommand):
    """A command on a design, whose usage shows DESIGN without the braces of a choice."""

    def collect_usage_pieces(self, ctx: Any) -> list[str]:  # noqa: ANN401  # typer hides its type
        """Pieces of the usage line."""
        return [piece.strip("{}") for piece in super().collect_usage_pieces(ctx)]


def main() -> int:
    """Run the command line; returns the exit code."""
    return errors.run(app, sys.argv[1:])


@app.callback(invoke_without_command=True)
def _no_command(
    context: typer.Context,
    version: Annotated[bool, opt.flag("-V --version", "Print the version and exit.")] = False,
) -> None:
    if version:
        from ocs_design import __version__

        print(f"ocs-design {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())


@app.command(epilog=_examples("size"))
@with_options(opt.SIZE_OPTIONS)
@with_output
def size(
    context: typer.Context,
    open_report: Annotated[
        bool, opt.flag("--open", "Open the report in the browser, if there is a screen.")
    ] = False,
    seed: opt.Seed = None,
    out: Annotated[
        Path | None, opt.option("-o --out", "DIR", "Output folder. Default: <name>-ocs.")
    ] = None,
    verbose: Annotated[
        bool, opt.flag("-v --verbose", "Print all figures instead of the one-screen summary.")
    ] = False,
    *,
    output: Output,
) -> None:
    """Size a device for a robot, export it and fly it.

    A quantity is in SI, or has its unit: 30mm, 7200rpm, 40deg, 102g. Exit codes: 0 done, 1 a
    scenario fails or the device cannot be built, 2 wrong usage, 3 the input cannot be read, 4 no
    design meets the specification, 5 an optional tool is missing.
    """
    _design(
        specified_by_command(context),
        package_paths_of_command(context),
        out,
        output,
        verbose=verbose,
        open_report=open_report,
    )


@app.command(epilog=_examples("demo"))
def demo(
    no_open: Annotated[
        bool, opt.flag("--no-open", "Do not open the report in the browser.")
    ] = False,
    out: Annotated[Path, opt.option("-o --out", "DIR", "Output folder.")] = Path("solo12-ocs"),
    force: opt.Force = False,
    quiet: opt.Quiet = False,
    no_color: opt.NoColor = False,
) -> None:
    """Size a device for Solo12; needs no file.

    The robot comes with this program. Runs `size` with its defaults, which takes less than a
    minute, and opens the report.
    """
    from ocs_design.common.files import packaged_folder
    from ocs_design.requirement.specification import specification_from_options

    robot = packaged_folder("examples") / "solo12.urdf"
    _design(
        specification_from_options({"robot.file": str(robot)}),
        {},
        out,
        Output(no_color=no_color, quiet=quiet, force=force),
        verbose=False,
        open_report=not no_open,
    )


def _design(
    specification: "Specification",
    package_paths: Mapping[str, Path],
    out: Path | None,
    output: Output,
    *,
    verbose: bool,
    open_report: bool,
) -> None:
    """Size, print and end with the outcome's exit code."""
    from ocs_design.report.text.console import open_page
    from ocs_design.requirement.vocabulary import ALL_LAYOUTS

    steps = output.steps
    if specification.ocs.layout == ALL_LAYOUTS:
        if out is not None:
            raise UsageError(
                "a comparison of layouts writes no folder",
                hint="leave out -o, or choose one layout, as in --layout triad",
            )
        from ocs_design.report.text.answers import print_layouts
        from ocs_design.workflows.layouts import compare_layouts

        answer = compare_layouts(
            specification, package_paths=package_paths, strict=output.strict, progress=steps
        )
        output.give(answer, print_layouts)
        raise typer.Exit(answer.exit_code)
    from ocs_design.common.workers import WorkerPool
    from ocs_design.requirement.vocabulary import NO_MOTOR

    # Nothing is rendered; without this setting, MuJoCo starts processes to look for a window
    # library, here and in each worker.
    os.environ.setdefault("MUJOCO_GL", "disabled")
    chosen = specification.motor.name != NO_MOTOR
    # They import while this process does; more processes would have nothing to do.
    with WorkerPool("ocs_design.sizing.alternatives" if chosen else None, most=3) as workers:
        with steps.step("load the solver and the simulator"):
            # Importing creates some hundred thousand objects and hardly any garbage, and the
            # collector scans all of them again and again. Later it is needed: meshes leave a lot
            # of garbage.
            gc.disable()
            try:
                from ocs_design.report.text.size import (
                    print_design,
                    print_outcome,
                    print_solution,
                    print_summary,
                )
                from ocs_design.workflows.size import design_ocs, load_solvers

                load_solvers(specification)
            finally:
                gc.enable()
        outcome = design_ocs(
            specification,
            out=out,
            package_paths=package_paths,
            force=output.force,
            strict=output.strict,
            progress=steps,
            command=typed_command(),
            workers=workers,
        )

    def show(console: "Console", design: "OcsDesign") -> None:
        """Print all figures, or the summary on one screen."""
        if verbose:
            print_design(console, design)
            print_solution(console, design)
            print_outcome(console, design, outcome.folder)
        else:
            print_summary(console, design, outcome.runs, outcome.folder)

    output.give(outcome.design, show)
    if open_report:
        from ocs_design.export.folder import REPORT_FILE

        open_page(output.stderr_console, outcome.folder / REPORT_FILE)
    output.end(outcome.exit_code, outcome.design)


@app.command(epilog=_examples("inspect"))
@with_options(opt.ROBOT_OPTIONS)
def inspect(
    context: typer.Context,
    as_json: opt.AsJson = False,
    strict: opt.Strict = False,
    picture: Annotated[
        Path | None,
        opt.option(
            "--picture", "FILE", "Draw trunk, legs and feet from three sides (.svg or .png)."
        ),
    ] = None,
    verbose: Annotated[
        bool, opt.flag("-v --verbose", "Also print each joint of the posture.")
    ] = False,
    no_color: opt.NoColor = False,
) -> None:
    """Show a robot as the program reads it, with warnings.

    Prints mass, inertia, posture, legs, and the incidence angle by each criterion and over
    postures. Writes nothing but --picture.
    """
    from ocs_design.report.text.robot import print_inspection
    from ocs_design.workflows.inspect import inspect_robot

    inspection = inspect_robot(
        specified_by_command(context),
        package_paths=package_paths_of_command(context),
        strict=strict,
        picture=picture,
    )
    Output(as_json, no_color).give(inspection, partial(print_inspection, verbose=verbose))


@app.command(epilog=_examples("bound"))
def bound(
    inertia: Annotated[
        str, opt.option("", "INERTIA", "Inertia of the robot about the axis, e.g. '0.0515 kg m2'.")
    ],
    rate_change: Annotated[str, opt.option("", "RATE", "Change of the trunk's rate, e.g. 2rad/s.")],
    wheel_speed_max: Annotated[
        str, opt.option("", "SPEED", "Highest speed of a wheel, relative to the trunk.")
    ] = "7200rpm",
    alpha: Annotated[str, opt.option("", "ANGLE", "Incidence of the wheel axes.")] = "0deg",
    axis: Annotated[
        str, opt.option("", "AXIS", "pitch or roll.", completion.one_of("pitch", "roll"))
    ] = "pitch",
    as_json: opt.AsJson = False,
    no_color: opt.NoColor = False,
) -> None:
    """Show the paper's lower bound for given figures of a robot.

    Least inertia of the wheels, and its curve over rate change and wheel speed.
    """
    from ocs_design.report.text.answers import print_bound
    from ocs_design.workflows.bound import bound_by_hand

    answer = bound_by_hand(
        inertia=inertia,
        rate_change=rate_change,
        wheel_speed_max=wheel_speed_max,
        alpha=alpha,
        axis=axis,
    )
    Output(as_json, no_color).give(answer, print_bound)


for command in (export, validate):
    app.command(cls=_DesignCommand, epilog=_examples(command.__name__))(command)
for command in (pareto, init, doctor):
    app.command(epilog=_examples(command.__name__))(command)


@app.command(epilog=_examples("catalogue"))
def catalogue(
    what: Annotated[
        str,
        typer.Argument(
            autocompletion=completion.one_of("motors", "gears", "materials"),
            metavar="motors|gears|materials",
            help="Catalogue to list.",
        ),
    ],
    motors: Annotated[
        str | None,
        opt.option(
            "--motors",
            "FILE",
            "Also list the motors in this file, CSV or TOML.",
            completion.files(".csv", ".toml"),
        ),
    ] = None,
    gears: opt.GearsFile = None,
    as_json: opt.AsJson = False,
    verbose: Annotated[
        bool, opt.flag("-v --verbose", "Also print each row's source and remark.")
    ] = False,
    no_color: opt.NoColor = False,
) -> None:
    """List motors, gears and materials, with sources.

    A motor of your own is a [[motor]] of a TOML file or a row of a CSV file for --motors: name,
    maker, source, mass_kg, kv_rpm_per_v or kt_nm_per_a, resistance_ohm, resistance_between
    ("line-line"), peak_current_a, rated_voltage_v. The list shows which data a motor lacks to be
    built with.
    """
    from ocs_design.report.text.catalogue import listing
    from ocs_design.report.text.layout import warn

    listed, output = listing(what, {"motors": motors, "gears": gears}), Output(no_color=no_color)
    if as_json:
        sys.stdout.buffer.write(listed.json)
    else:
        warn(output.stderr_console, listed.warnings)
        listed.show(output.console, verbose=verbose)
