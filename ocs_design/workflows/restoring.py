"""Restores robot, device and maneuvers from the records of `design.json`.

Writing parts starts here, so nothing below imports a simulator or a solver.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ocs_design.common.errors import OcsError, RobotError
from ocs_design.common.files import AnyPath
from ocs_design.common.frames import Placement
from ocs_design.device.agreement import check_agreement
from ocs_design.device.checks import check_control, check_device, check_requirement
from ocs_design.device.device import Device
from ocs_design.device.records.design import OcsDesign, design_file, read_design
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.export.formats import Base
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.posture import OUTSIDE
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Mount, Robot, RobotFormat
from ocs_design.robot.source import STANDARD_INPUT, read_source


def read_design_and_device(path: AnyPath) -> tuple[OcsDesign, Device]:
    """A design, and its device.

    Raises:
        OcsError: it cannot be read, no such device, requirement or wheel law can exist, or its
            figures contradict each other.
    """
    design = read_design(path)
    try:
        device = Device.of_record(design.ocs, design.supply)
        check_device(device)
        check_requirement(design)
        if design.control is not None:
            check_control(design.control)
        check_agreement(design, device)
    except OcsError as error:
        raise OcsError(f"{design_file(path)}: {error.message}", hint=error.hint) from error
    return design, device


def base_of(record: RobotRecord) -> Base:
    """Base of the device on its robot."""
    mount = record.mount
    if mount is None:
        return Base(record.trunk, None, None if record.sha256 else record.com)
    placement = Placement(np.array(mount.rotation), np.array(mount.position))
    return Base(record.trunk, Mount(mount.link, placement))


def robot_of(record: RobotRecord, path: AnyPath, package_paths: Mapping[str, AnyPath]) -> Robot:
    """The robot read again, in the posture in which it was sized.

    Args:
        record: of the robot. A robot given by hand is made from the record alone.
        path: of its file.
        package_paths: folder of each package, for `package://` addresses.

    Raises:
        RobotError: the file lacks the trunk or a joint of the record.
    """
    if record.format == RobotFormat.MANUAL:
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = record.inertia
        return robot_by_hand(record.mass, (xx, yy, zz, xy, xz, yz), record.com, record.name)
    # A base frame that was found, and is not a link of the file, is found again.
    trunk = None if record.mount is not None or record.trunk == BASE_FRAME else record.trunk
    try:
        robot = read_robot(
            path, trunk=trunk, legs=record.legs, posture="zero", package_paths=package_paths
        )
    except RobotError:
        # Another file than the one used for sizing: what it lacks is reported below.
        robot = read_robot(path, trunk=trunk, posture="zero", package_paths=package_paths)
    names = {*robot.tree.joints, *robot.tree.body_of_link}
    missing = [name for name in (*record.posture, record.trunk) if name not in names]
    if missing:
        raise RobotError(
            f"{path}: has no joint or link '{missing[0]}', which the design names",
            hint="give the robot that the device was sized for, or size one for this robot",
        )
    values = robot.tree.complete(record.posture)
    # Warnings about the file's zero do not apply to the posture used for sizing.
    of_file = (warning for warning in robot.warnings if not warning.startswith(OUTSIDE))
    of_posture = (warning for warning in record.warnings if warning.startswith(OUTSIDE))
    return replace(
        robot,
        warnings=(*of_file, *of_posture),
        posture=values,
        posture_name=record.posture_name,
        standing_height=record.standing_height,
        mass_properties=robot.tree.locked_mass_properties(values, robot.trunk),
    )


_INERTIA_TOLERANCE = 1e-6
"""Tolerance of mass and inertia, over the largest figure, for a robot to be the same."""


@dataclass(frozen=True)
class RobotLocation:
    """Places to look for a robot, and the hint if it is not found.

    Attributes:
        design: path of the `design.json`.
        robot_file: of the robot, in place of the one that the design names. It may differ from the
            file that the device was sized for, which gives a warning.
        package_paths: folders of packages, in addition to those that the design names.
        hint: what a user can do if the robot is not available.
    """

    design: Path
    robot_file: AnyPath | None
    package_paths: Mapping[str, AnyPath]
    hint: str


def read_recorded_robot(
    record: RobotRecord, location: RobotLocation, *, strict: bool
) -> tuple[Robot, tuple[str, ...]]:
    """The robot, and warnings about it that did not occur when the device was sized.

    Raises:
        RobotError: it is not available or has changed; with `strict`, also if there is a warning.
    """
    bases = (Path(), location.design.absolute().parent.parent)
    # Each folder as it was given, relative to the first base that contains it.
    folders = {
        name: next((base / text for base in bases if (base / text).is_dir()), Path(text))
        for name, text in record.package_paths.items()
    }
    source = location.robot_file
    if source is None and record.format == RobotFormat.MANUAL:
        source = Path(record.source)
    elif source is None:
        if record.source == STANDARD_INPUT:
            raise RobotError("the robot was read from standard input", hint=location.hint)
        existing = [base / record.source for base in bases if (base / record.source).is_file()]
        if not existing:
            message = f"{record.source}: the robot's file no longer exists"
            raise RobotError(message, hint=location.hint)
        # The file that the device was sized for, unchanged.
        unchanged = (path for path in existing if read_source(path).sha256 == record.sha256)
        source = next(unchanged, None)
        if source is None:
            raise RobotError(
                f"{existing[0]}: the robot's file has changed since the device was sized for it",
                hint=f"size it again, or use the file as it is now with --robot {existing[0]}",
            )
    robot = robot_of(record, source, {**folders, **location.package_paths})
    warnings = tuple(warning for warning in robot.warnings if warning not in record.warnings)
    inertia = np.array(record.inertia)
    difference = np.abs(robot.inertia - inertia).max() / np.abs(inertia).max()
    masses = f"its mass is {robot.mass:.4g} kg, at sizing it was {record.mass:.4g} kg"
    if robot.sha256 != record.sha256:
        changed = f"{robot.source}: not the file that the device was sized for; {masses}"
        warnings = (changed, *warnings)
    elif max(difference, abs(robot.mass / record.mass - 1.0)) > _INERTIA_TOLERANCE:
        # The hash covers the robot's own file only.
        raise RobotError(
            f"{robot.source}: a file that it includes has changed since the device was sized for "
            f"it, or the posture in {location.design}; {masses}, and its inertia differs by "
            f"{100.0 * difference:.2g} % of the largest",
            hint="size it again, or restore the included file",
        )
    if strict and warnings:
        raise RobotError("--strict: " + "; ".join(warnings), hint="fix the robot's file")
    return robot, warnings
