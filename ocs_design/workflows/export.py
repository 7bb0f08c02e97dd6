"""`ocs-design export`: every file again from `design.json`."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath, safe_name, to_json
from ocs_design.device.answers import Exported, PostureLine
from ocs_design.device.bodies import joint_names
from ocs_design.device.records.design import (
    DESIGN_FILE,
    SCHEMA_VERSION,
    OcsDesign,
    design_file,
    read_design,
)
from ocs_design.export.folder import (
    file_hashes,
    keep_others,
    recorded_hashes,
    staged_folder,
)
from ocs_design.export.formats import (
    ALL,
    FORMATS,
    USUAL_FORMATS,
    Format,
    Subject,
    export_formats,
    formats_named,
)
from ocs_design.workflows.inspect import posture_lines
from ocs_design.workflows.restoring import (
    Whereabouts,
    device_of,
    read_recorded_robot,
    seat_of,
)

_WHERE = (
    "say where it is with --robot FILE, or leave out the robot's files: "
    f"--formats {','.join(each.name for each in USUAL_FORMATS if not each.needs_robot)}"
)


@dataclass(frozen=True, eq=False)
class Order:
    """Design to write again.

    Attributes:
        path: of the `design.json`.
        design: that was read from it.
        subject: device and robot.
        formats: to write.
        warnings: about the robot, which were not there when the device was sized.
        where: to look for the robot.
    """

    path: Path
    design: OcsDesign
    subject: Subject
    formats: tuple[Format, ...]
    warnings: tuple[str, ...]
    where: Whereabouts

    @property
    def default_folder(self) -> Path:
        """Folder in the working directory, where no other is named."""
        return Path(f"{self.subject.name}-ocs-export")


Finish = Callable[[Order, Path], tuple[str, ...]]
"""Function that writes into a folder; gives notes for the user, one sentence each."""


def read_order(
    path: AnyPath,
    formats: tuple[Format, ...],
    *,
    robot_file: Path | None = None,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> Order:
    """Read a design, and its robot where a format needs it.

    Args:
        path: of a `design.json`, or of the folder that it lies in.
        formats: that are wanted.
        robot_file: of the robot, in place of the one that the design names. It may be another
            file than the device was sized for, which is told.
        package_paths: folders of packages, over those that the design names.
        strict: warnings about the robot are errors.

    Raises:
        OcsError: the design or the robot cannot be read, or the robot has changed.
    """
    path = design_file(path)
    design = read_design(path)
    device, name = device_of(design.ocs, design.supply), safe_name(design.robot.name)
    where = Whereabouts(path, robot_file, package_paths or {}, _WHERE)
    if not any(each.needs_robot for each in formats):
        subject = Subject(name, device, seat_of(design.robot), None)
        return Order(path, design, subject.recorded(design), formats, (), where)
    robot, warnings = read_recorded_robot(design.robot, where, strict=strict)
    subject = Subject.of(robot, device, name).recorded(design)
    return Order(path, design, subject, formats, warnings, where)


def export_order(
    order: Order, folder: Path, *, force: bool = False, finish: Finish | None = None
) -> Exported:
    """Write the files of a design.

    The folder gets a `design.json` too, with the hashes of its files. In the design's own folder
    everything else stays as it is.

    Args:
        order: see `read_order`.
        folder: to write.
        force: replace an existing folder, once the new one is complete.
        finish: writes what rests on the design and its other files, when those are there.

    Raises:
        OutputError: it cannot be written, or exists already.
    """
    with staged_folder(folder, force=force) as staging:
        alone = [each for each in order.formats if not each.needs_robot]
        notes = export_formats(order.subject, alone, staging)
        whole = [each for each in order.formats if each.needs_robot]
        remarks = export_formats(order.subject, whole, staging)
        if finish is not None:
            remarks += finish(order, staging)
        made = file_hashes(staging)
        source = order.path.parent
        if folder.exists() and folder.samefile(source):
            # If all usual files are made anew, those of before may have had other names.
            usual = set(USUAL_FORMATS) <= set(order.formats)
            folders = {each.folder for each in FORMATS} if usual else set()
            old = {name for name in order.design.files if name.partition("/")[0] in folders}
            keep_others(source, staging, without=old)
        design = replace(order.design, files=recorded_hashes(staging))
        (staging / DESIGN_FILE).write_bytes(to_json(design))
    known = order.design.robot.warnings
    return Exported(
        schema_version=SCHEMA_VERSION,
        folder=str(folder),
        files=made,
        warnings=(*order.warnings, *(remark for remark in remarks if remark not in known)),
        notes=notes,
    )


def export_design(
    design: AnyPath,
    formats: str | Sequence[str] = (),
    *,
    out: AnyPath | None = None,
    robot_file: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    force: bool = False,
    strict: bool = False,
) -> Exported:
    """Write the files of a design again, or in other formats.

    Args:
        design: its folder, its `design.json`, or the `Outcome` that made it.
        formats: names as of `ocs-design export --formats`, one or several; empty: the usual ones.
        out: folder to write; None: `<name>-ocs-export` in the working directory.
        robot_file: of the robot, where it has moved.
        package_paths: folder of each package that `package://` addresses name.
        force: replace an existing folder, once the new one is complete.
        strict: warnings about the robot are errors.

    Raises:
        OcsError: see `read_order` and `export_order`; nothing is written then.
    """
    names = (formats,) if isinstance(formats, str) else tuple(formats)
    order = read_order(
        design,
        formats_named(names, ON_DESIGN),
        robot_file=None if robot_file is None else Path(robot_file),
        package_paths={name: Path(path) for name, path in (package_paths or {}).items()},
        strict=strict,
    )
    folder = order.default_folder if out is None else Path(out)
    return export_order(order, folder, force=force, finish=finishing(names, ""))


FIGURES, REPORT, CONTROLLER = "figures", "report", "controller"

ON_DESIGN = (FIGURES, REPORT, CONTROLLER)
"""Names that users say."""


def finishing(names: Collection[str], command: str) -> Finish | None:
    """Function that writes charts, report and controller where they are asked for; None: none is.

    Args:
        names: as users say them.
        command: that was typed.
    """
    wanted = [name for name in ON_DESIGN if name in names or ALL in names]

    def finish(order: Order, folder: Path) -> tuple[str, ...]:
        """Write into the folder; a file that it lacks is taken from the design's own folder."""
        remarks: tuple[str, ...] = ()
        if CONTROLLER in wanted:
            try:
                _controller(order, folder / CONTROLLER)
            except OcsError as error:
                if CONTROLLER in names:
                    raise
                remarks = (f"without the controller: {error.message}",)
        return remarks if wanted == [CONTROLLER] else remarks + pages(order, folder)

    def pages(order: Order, folder: Path) -> tuple[str, ...]:
        """Write charts and report."""
        # They need the simulator's values, which parts and snippets do without.
        from ocs_design.report.charts.figures import FOLDER, all_charts  # noqa: PLC0415
        from ocs_design.report.charts.svg import write_charts  # noqa: PLC0415
        from ocs_design.report.html.page import write_report  # noqa: PLC0415
        from ocs_design.report.story import story_in  # noqa: PLC0415

        postures: tuple[PostureLine, ...] = ()
        remarks: tuple[str, ...] = ()
        try:
            robot, _ = read_recorded_robot(order.design.robot, order.where, strict=False)
            postures = posture_lines(robot)
        except OcsError as error:
            remarks = (f"without the chart of incidence over postures: {error.message}",)
        story = story_in(
            [folder, order.path.parent], order.design, postures=postures, command=command
        )
        if FIGURES in wanted:
            remarks += write_charts(tuple(all_charts(story)), folder / FOLDER)
        if REPORT in wanted:
            whole = replace(order.design, files=recorded_hashes(folder))
            write_report(replace(story, design=whole), folder)
        return remarks

    return finish if wanted else None


def _controller(order: Order, folder: Path) -> None:
    """Law and plans of the design's flights in C.

    Raises:
        OcsError: the robot cannot be had, or there is nothing to fly.
    """
    # They fly it, which parts and snippets do without.
    from ocs_design.requirement.sections import ValidationSection  # noqa: PLC0415
    from ocs_design.requirement.specification import Specification  # noqa: PLC0415
    from ocs_design.simulation.firmware import write_controller  # noqa: PLC0415
    from ocs_design.simulation.scenario import world_builder  # noqa: PLC0415
    from ocs_design.simulation.scene import Wheels  # noqa: PLC0415
    from ocs_design.workflows.flying import flight_options, read_task  # noqa: PLC0415

    # How the legs make the flight is not the wheels' business.
    task = read_task(
        order.path,
        Specification(validation=ValidationSection(ballistic=True)),
        robot_file=order.where.robot_file,
        package_paths=order.where.package_paths,
    )
    builder = world_builder(task.robot, task.device, flight_options(task.control))
    delay = task.uncertainty.torque_delay
    folder.mkdir()
    write_controller(
        order.subject.name,
        {
            each.name: builder.flight(each, Wheels.ACTIVE, task.references.get(each.name))
            for each in task.maneuvers
        },
        folder,
        joints=joint_names(task.device),
        period=task.control.period,
        delay=None if delay is None else (delay.at(0.0), delay.at(1.0)),
    )
