"""The robot that a `design.json` names, found and read again."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from ocs_design.exceptions import RobotError
from ocs_design.recording.restored import robot_of
from ocs_design.robot.files.source import STANDARD_INPUT, read_source
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot_record import RobotRecord


@dataclass(frozen=True)
class Whereabouts:
    """Where to look for a robot, and what to say if it is not there.

    Attributes:
        design: path of the `design.json`.
        robot_file: of the robot, in place of the one that the design names. It may be another
            file than the device was sized for, which is told.
        package_paths: folders of packages, over those that the design names.
        hint: what a user can do where the robot cannot be had.
    """

    design: Path
    robot_file: Path | None
    package_paths: Mapping[str, Path]
    hint: str


def read_recorded_robot(
    record: RobotRecord, where: Whereabouts, *, strict: bool
) -> tuple[Robot, tuple[str, ...]]:
    """The robot, and warnings about it that were not there when the device was sized.

    Raises:
        RobotError: it cannot be had or has changed; with `strict`, also if there is any warning.
    """
    bases = (Path(), where.design.absolute().parent.parent)
    folders = {name: _first(text, bases) for name, text in record.package_paths.items()}
    source = where.robot_file or _source(record, bases, where.hint)
    robot = robot_of(record, source, {**folders, **where.package_paths})
    warnings = _new_warnings(robot, record)
    if strict and warnings:
        raise RobotError("--strict: " + "; ".join(warnings), hint="mend the robot's file")
    return robot, warnings


def _source(record: RobotRecord, bases: Collection[Path], hint: str) -> Path:
    """The file that the device was sized for, as it was then.

    Raises:
        RobotError: it is gone, has changed, or was no file.
    """
    if record.format == Format.MANUAL:
        return Path(record.source)
    if record.source == STANDARD_INPUT:
        raise RobotError("the robot was read from standard input", hint=hint)
    found = [base / record.source for base in bases if (base / record.source).is_file()]
    if not found:
        raise RobotError(f"{record.source}: the robot's file is not there any more", hint=hint)
    for path in found:
        if read_source(path).sha256 == record.sha256:
            return path
    raise RobotError(
        f"{found[0]}: the robot's file has changed since the device was sized for it",
        hint=f"size it again, or put the device on it as it is with --robot {found[0]}",
    )


def _first(text: str, bases: Collection[Path]) -> Path:
    """A folder as it was given, against the first base that has it."""
    return next((base / text for base in bases if (base / text).is_dir()), Path(text))


def _new_warnings(robot: Robot, record: RobotRecord) -> tuple[str, ...]:
    """What the robot has otherwise than the one that the device was sized for."""
    told = tuple(warning for warning in robot.warnings if warning not in record.warnings)
    if robot.sha256 == record.sha256:
        return told
    return (
        f"{robot.source}: not the file that the device was sized for; mass {robot.mass:.4g} kg, "
        f"then {record.mass:.4g} kg",
        *told,
    )
