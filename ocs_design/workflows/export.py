"""`ocs-design export`: every file again from `design.json`."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath, safe_name, to_json
from ocs_design.device.answers import Exported, PostureLine, posture_lines
from ocs_design.device.bodies import joint_names
from ocs_design.device.records.design import DESIGN_FILE, OcsDesign, design_file
from ocs_design.export.folder import (
    REPORT_FILE,
    file_hashes,
    keep_others,
    recorded_hashes,
    staged_folder,
)
from ocs_design.export.formats import (
    ALL,
    FORMATS,
    USUAL_FORMATS,
    Subject,
    export_formats,
    formats_named,
)
from ocs_design.report.text.console import ProgressCallback, Steps
from ocs_design.workflows.restoring import (
    RobotLocation,
    base_of,
    read_design_and_device,
    read_recorded_robot,
)

if TYPE_CHECKING:
    from ocs_design.report.story import Story

_WHERE = (
    "say where it is with --robot FILE, or leave out the robot's files: "
    f"--formats {','.join(kind.name for kind in USUAL_FORMATS if not kind.needs_robot)}"
)

FIGURES, REPORT, CONTROLLER = "figures", "report", "controller"

ON_DESIGN = (FIGURES, REPORT, CONTROLLER)
"""Names, for users, of outputs that also depend on the design's other files."""


def export_design(
    design: AnyPath,
    formats: str | Sequence[str] = (),
    *,
    out: AnyPath | None = None,
    robot_file: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    force: bool = False,
    strict: bool = False,
    progress: Steps | ProgressCallback | None = None,
    command: str = "",
) -> Exported:
    """Write the files of a design again, or in other formats.

    The folder also gets a `design.json`, with the hashes of its files. In the design's own folder
    all other files are left as they are.

    Args:
        design: its folder, its `design.json`, or the `Outcome` that made it.
        formats: names as for `ocs-design export --formats`, one or several; empty: the usual ones.
        out: folder to write; None: `<name>-ocs-export` in the working directory.
        robot_file: of the robot, in place of the one that the design names. It may differ from the
            file that the device was sized for, which gives a warning.
        package_paths: folders of packages, in addition to those that the design names.
        force: replace an existing folder, once the new one is complete.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`. command: as typed, for the report.

    Raises:
        OcsError: the design or the robot cannot be read, the robot has changed, or the folder
            cannot be written; nothing is written then.
    """
    steps, named = Steps.of(progress), (formats,) if isinstance(formats, str) else formats
    names = tuple(name.casefold() for name in named)
    chosen = formats_named(names, ON_DESIGN)
    design_outputs = [name for name in ON_DESIGN if name in names or ALL in names]
    with steps.step("read the design and its robot") as step:
        path = design_file(design)
        recorded_design, device = read_design_and_device(path)
        name = safe_name(recorded_design.robot.name)
        location = RobotLocation(path, robot_file, package_paths or {}, _WHERE)
        subject = Subject(name, device, base=base_of(recorded_design.robot))
        warnings: tuple[str, ...] = ()
        if any(file_format.needs_robot for file_format in chosen):
            robot, warnings = read_recorded_robot(recorded_design.robot, location, strict=strict)
            subject = Subject.of(robot, device, name)
        subject = subject.recorded(recorded_design)
        step.note = name
    folder = Path(out or f"{name}-ocs-export")
    with (
        steps.step(f"write {', '.join(names or (kind.name for kind in chosen))}"),
        staged_folder(folder, force=force) as staging,
    ):
        notes, remarks = (
            export_formats(subject, [x for x in chosen if x.needs_robot is needs], staging)
            for needs in (False, True)
        )
        if CONTROLLER in design_outputs:
            try:
                _write_controller(name, location, staging / CONTROLLER)
            except OcsError as error:
                if CONTROLLER in names:
                    raise
                remarks = (*remarks, f"without the controller: {error.message}")
        story = None
        if set(design_outputs) - {CONTROLLER}:
            # They need the simulator's values, which parts and snippets do not.
            from ocs_design.report.charts.figures import FOLDER, all_charts  # noqa: PLC0415
            from ocs_design.report.charts.svg import write_charts  # noqa: PLC0415
            from ocs_design.report.html.page import write_report  # noqa: PLC0415

            story, story_remarks = _read_story(recorded_design, location, staging, command)
            remarks += story_remarks
            if FIGURES in design_outputs:
                remarks += write_charts(tuple(all_charts(story)), staging / FOLDER)
        new = set(file_hashes(staging))
        if folder.exists() and folder.samefile(path.parent):
            # If all usual files are written again, earlier ones may have had other names.
            usual = set(USUAL_FORMATS) <= set(chosen)
            folders = {file_format.folder for file_format in FORMATS} if usual else set()
            old = {file for file in recorded_design.files if file.partition("/")[0] in folders}
            keep_others(path.parent, staging, without=old)
        # All other files exist now: the report, which contains the design, has their hashes.
        updated = replace(recorded_design, files=recorded_hashes(staging))
        if story is not None and REPORT in design_outputs:
            write_report(replace(story, design=updated), staging)
            new.add(REPORT_FILE)
        hashes = {name: value for name, value in file_hashes(staging).items() if name in new}
        (staging / DESIGN_FILE).write_bytes(to_json(updated))
    recorded = recorded_design.robot.warnings
    return Exported(
        folder=str(folder),
        files=hashes,
        warnings=(*warnings, *(remark for remark in remarks if remark not in recorded)),
        notes=notes,
    )


def _read_story(
    design: OcsDesign, location: RobotLocation, folder: Path, command: str
) -> tuple["Story", tuple[str, ...]]:
    """Content of charts and report, and remarks.

    Files that the folder lacks are taken from the design's own folder.
    """
    # It needs the simulator's values, which parts and snippets do not.
    from ocs_design.report.story import read_story  # noqa: PLC0415

    postures: tuple[PostureLine, ...] = ()
    remarks: tuple[str, ...] = ()
    try:
        robot, _ = read_recorded_robot(design.robot, location, strict=False)
        postures = posture_lines(robot)
    except OcsError as error:
        remarks = (f"without the chart of incidence over postures: {error.message}",)
    folders = [folder, location.design.parent]
    return read_story(folders, design, postures=postures, command=command), remarks


def _write_controller(name: str, location: RobotLocation, folder: Path) -> None:
    """Write wheel law and plans of the design's flights in C, in files named after the robot.

    Raises:
        OcsError: the robot is not available, or there is nothing to fly.
    """
    # Flights need these, parts and snippets do not.
    from ocs_design.requirement.sections import ValidationSection  # noqa: PLC0415
    from ocs_design.requirement.specification import Specification  # noqa: PLC0415
    from ocs_design.simulation.firmware import write_controller  # noqa: PLC0415
    from ocs_design.workflows.flying import read_flights  # noqa: PLC0415

    # The wheels' controller does not depend on how the legs push off.
    flights = read_flights(
        location.design,
        Specification(validation=ValidationSection(ballistic=True)),
        robot_file=location.robot_file,
        package_paths=location.package_paths,
    )
    delay = flights.uncertainty.torque_delay
    folder.mkdir()
    write_controller(
        name,
        {maneuver.name: flights.device_world(maneuver) for maneuver in flights.maneuvers},
        folder,
        joints=joint_names(flights.device),
        period=flights.control.period,
        delay=None if delay is None else (delay.at(0.0), delay.at(1.0)),
    )
