"""`ocs-design export`: parse, call, print. No arithmetic."""

import sys
from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from ocs_design.cli import options as opt
from ocs_design.cli.stated import stated_package_paths, typed_command

DesignFile: TypeAlias = Annotated[
    Path, typer.Argument(metavar="DESIGN", help="design.json, or the folder that it lies in.")
]
ExportFolder: TypeAlias = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", help="Output folder. Default: <name>-ocs-export."),
]
Formats: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--formats",
        metavar="NAMES",
        help="stl, bom, drawing, urdf, mjcf, glb, snippets (these are the default), 3mf, step, "
        "printed, pictures, figures, report, with commas between them; or all.",
    ),
]
OtherRobot: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--robot",
        metavar="FILE",
        help="The robot's file, where it has moved or is to be another than was sized for.",
    ),
]


@opt.with_output
def export(
    context: typer.Context,
    design: DesignFile,
    out: ExportFolder = None,
    formats: Formats = None,
    robot: OtherRobot = None,
    package_path: opt.PackagePaths = None,
    *,
    output: opt.Output,
) -> None:
    """Write parts, robot files and snippets again from a design.json.

    They are the files that `ocs-design size` wrote, byte for byte. Files of the whole robot need
    the robot's own file as it was, and its meshes. In the design's own folder, with --force, only
    what is made anew is replaced.
    """
    from ocs_design.answers import to_json
    from ocs_design.export.formats import formats_named
    from ocs_design.exporting import export_order, read_order
    from ocs_design.report.console import Steps, make_console
    from ocs_design.report.export import print_export
    from ocs_design.report.on_request import ON_DESIGN, finishing

    names = [name.strip() for text in formats or () for name in text.split(",")]
    chosen, finish = formats_named(names, ON_DESIGN), finishing(names, typed_command())
    console = make_console(color=not output.no_color)
    steps = Steps(console, quiet=output.quiet or output.as_json)
    with steps.step("read the design and its robot") as step:
        order = read_order(
            design,
            chosen,
            robot_file=robot,
            package_paths=stated_package_paths(context),
            strict=output.strict,
        )
        step.note = order.subject.name
    with steps.step("write " + ", ".join(names or (each.name for each in chosen))):
        exported = export_order(
            order, out or order.default_folder, force=output.force, finish=finish
        )
    if output.as_json:
        sys.stdout.buffer.write(to_json(exported))
    elif not output.quiet:
        print_export(console, exported)
