"""`ocs-design export`: every file again from `design.json`."""

import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ocs_design.answers import Exported
from ocs_design.design_file import OcsDesign, design_to_json, read_design
from ocs_design.export.folder import DESIGN_FILE, file_hashes, recorded_hashes, staged_folder
from ocs_design.export.formats import FORMATS, USUAL_FORMATS, Format, Subject, export_formats
from ocs_design.recording.restored import device_of, seat_of
from ocs_design.recording.robot import Whereabouts, read_recorded_robot
from ocs_design.text_files import safe_name

SCHEMA_VERSION = 1

_WHERE = (
    "say where it is with --robot FILE, or leave out the robot's files: "
    f"--formats {','.join(each.name for each in USUAL_FORMATS if not each.needs_robot)}"
)


@dataclass(frozen=True, eq=False)
class Order:
    """What to write.

    Attributes:
        path: of the `design.json`. design: what is in it.
        subject: to write. formats: to write it in.
        warnings: about the robot, which were not there when the device was sized.
    """

    path: Path
    design: OcsDesign
    subject: Subject
    formats: tuple[Format, ...]
    warnings: tuple[str, ...]

    @property
    def default_folder(self) -> Path:
        """Where it is written if nothing else is said, in the working directory."""
        return Path(f"{self.subject.name}-ocs-export")


Finish = Callable[[Order, Path], tuple[str, ...]]
"""Writes into a folder; gives what is to be told of it, one sentence each."""


def read_order(
    path: Path,
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
    path = path / DESIGN_FILE if path.is_dir() else path
    design = read_design(path)
    device, name = device_of(design.ocs), safe_name(design.robot.name)
    if not any(each.needs_robot for each in formats):
        return Order(path, design, Subject(name, device, seat_of(design.robot), None), formats, ())
    where = Whereabouts(path, robot_file, package_paths or {}, _WHERE)
    robot, warnings = read_recorded_robot(design.robot, where, strict=strict)
    return Order(path, design, Subject.of(robot, device, name), formats, warnings)


def export_order(
    order: Order, folder: Path, *, force: bool = False, finish: Finish | None = None
) -> Exported:
    """Write it.

    The folder gets a `design.json` too, with the hashes of what is there. In the design's own
    folder everything else stays as it is.

    Args:
        order: see `read_order`.
        folder: to write.
        force: replace an existing folder, once the new one is complete.
        finish: writes what rests on the design and its other files, when those are there.

    Raises:
        OutputError: it cannot be written, or exists already.
    """
    with staged_folder(folder, force=force) as staging:
        notes = export_formats(order.subject, _formats(order, needs_robot=False), staging)
        remarks = export_formats(order.subject, _formats(order, needs_robot=True), staging)
        if finish is not None:
            remarks += finish(order, staging)
        made = file_hashes(staging)
        if _same(folder, order.path.parent):
            _keep(order, staging)
        design = replace(order.design, files=recorded_hashes(staging))
        (staging / DESIGN_FILE).write_bytes(design_to_json(design))
    known = order.design.robot.warnings
    return Exported(
        schema_version=SCHEMA_VERSION,
        folder=str(folder),
        files=made,
        warnings=(*order.warnings, *(remark for remark in remarks if remark not in known)),
        notes=notes,
    )


def _formats(order: Order, *, needs_robot: bool) -> tuple[Format, ...]:
    return tuple(each for each in order.formats if each.needs_robot is needs_robot)


def _keep(order: Order, staging: Path) -> None:
    """Bring along what the design's folder has else, but no file of a format made anew."""
    whole = set(USUAL_FORMATS) <= set(order.formats)
    outdated = set(order.design.files) if whole else set()
    folders = {each.folder for each in FORMATS}
    source = order.path.parent
    for path in sorted(source.rglob("*")):
        place = path.relative_to(source)
        is_outdated = place.as_posix() in outdated and place.parts[0] in folders
        if path.is_file() and place.name != DESIGN_FILE and not is_outdated:
            target = staging / place
            target.parent.mkdir(parents=True, exist_ok=True)
            if not target.exists():
                shutil.copy2(path, target, follow_symlinks=False)


def _same(folder: Path, other: Path) -> bool:
    return folder.exists() and folder.samefile(other)
