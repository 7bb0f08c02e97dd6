"""From the records of `design.json` back to live values: the inverse of `design`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ocs_design.arrays import Matrix
from ocs_design.design import Device, Module
from ocs_design.design_file import ManeuverRecord, ModuleRecord, OcsRecord
from ocs_design.device_checks import check_device
from ocs_design.exceptions import OcsError, RobotError
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.maneuver_table import MANEUVER_KINDS
from ocs_design.requirement.values import Quantities, Value
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Format, Mount, Robot
from ocs_design.robot.stance.base_frame import BASE_FRAME
from ocs_design.robot.tree import Placement
from ocs_design.robot_record import MountRecord, RobotRecord

# Figures of a maneuver that its record has by themselves.
_APART = {"name", "gravity", "incidence"}


@dataclass(frozen=True, eq=False)
class RecordedSeat:
    """Where the device sits, as the design says it; see `export.seat.Seat`."""

    trunk: str
    mount: Mount | None


def device_of(record: OcsRecord) -> Device:
    """The device that was designed, to the last digit.

    Raises:
        OcsError: no such device can be: the file was edited.
    """
    left, right = (_module(each) for each in record.modules)
    device = Device(record.incidence, (left, right), record.flywheel, record.motor, record.carrier)
    check_device(device)
    return device


def seat_of(record: RobotRecord) -> RecordedSeat:
    """Where it sits on its robot."""
    return RecordedSeat(record.trunk, None if record.mount is None else _mount(record.mount))


def maneuver_of(record: ManeuverRecord) -> Maneuver:
    """The maneuver that was asked for.

    Raises:
        OcsError: it is of no known kind, or not with these figures.
    """
    kind, stated = MANEUVER_KINDS.get(record.kind), set(record.parameters)
    if kind is None or not set(kind.required) - _APART <= stated <= set(kind.values) - _APART:
        raise OcsError(f"maneuver {record.name!r}: no {record.kind} with these figures is known")
    for name, value in record.parameters.items():
        _check_figure(record, kind.values[name], name, value)
    return kind.maneuver(
        name=record.name,
        gravity=record.gravity,
        incidence=record.incidence,
        **record.parameters,
    )


def _check_figure(record: ManeuverRecord, read: Value[Any], name: str, value: object) -> None:
    """That it is one figure or as many as it must be."""
    count = len(value) if isinstance(value, Sequence) else None
    if count not in (read.counts if isinstance(read, Quantities) else (None,)):
        raise OcsError(f"maneuver {record.name!r}: {name} of a {record.kind} is not {value!r}")


def robot_of(record: RobotRecord, path: Path | str, package_paths: Mapping[str, Path]) -> Robot:
    """The robot read again, in the posture that it was sized in.

    Args:
        record: of the robot. By hand: it is made from the record alone.
        path: of its file.
        package_paths: folder of each package that `package://` addresses name.

    Raises:
        RobotError: the file lacks the trunk or a joint of the record.
    """
    if record.format == Format.MANUAL:
        return robot_by_hand(record.mass, _six(record.inertia), record.com, record.name)
    # A frame that was found, and is no link of the file, is found again.
    trunk = None if record.mount is not None or record.trunk == BASE_FRAME else record.trunk
    robot = read_robot(path, trunk=trunk, posture="zero", package_paths=package_paths)
    missing = [name for name in (*record.posture, record.trunk) if not _has(robot, name)]
    if missing:
        raise RobotError(
            f"{path}: has no joint or link '{missing[0]}', which the design names",
            hint="give the robot that the device was sized for, or size one for this robot",
        )
    return _held(robot, record)


def _held(robot: Robot, record: RobotRecord) -> Robot:
    """The robot in the recorded posture, under the recorded name."""
    values = robot.tree.complete(record.posture)
    return replace(
        robot,
        posture=values,
        posture_name=record.posture_name,
        standing_height=record.standing_height,
        mass_properties=robot.tree.locked_mass_properties(values, robot.trunk),
    )


def _has(robot: Robot, name: str) -> bool:
    return name in robot.tree.joints or name in robot.tree.body_of_link


def _module(record: ModuleRecord) -> Module:
    return Module(record.name, np.array(record.axis), np.array(record.position))


def _mount(record: MountRecord) -> Mount:
    rotation, position = np.array(record.rotation), np.array(record.position)
    return Mount(record.link, Placement(rotation, position))


def _six(inertia: Matrix) -> tuple[float, ...]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertia
    return xx, yy, zz, xy, xz, yz
