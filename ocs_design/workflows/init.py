"""Output of `init`: a specification to start from, with every key."""

import shlex
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from ocs_design.common.files import safe_name
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.device.answers import Initialized
from ocs_design.export.folder import write_whole
from ocs_design.requirement.froude import (
    SOLO12_GYRATION_RADIUS,
    SOLO12_PITCH_INERTIA,
    SOLO12_ROLL_INERTIA,
    example_maneuvers,
    wheel_gains,
)
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.resolving import default_specification, read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.writing import commented_toml, with_files_from
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.robot import Robot

SOLO12_MASS = 2.5
"""Mass of Solo12 [kg], as in the paper."""


@dataclass(frozen=True, eq=False)
class StartingPoint:
    """The robot and the defaults from which a specification starts.

    Attributes:
        specified: what is already specified.
        robot: to specify for; None: not known yet.
        default: the defaults; Solo12's if the robot is not known.
        examples: maneuvers that are not defaults, scaled in the same way.
    """

    specified: Specification
    robot: Robot | None
    default: Specification
    examples: tuple[Maneuver, ...]

    @property
    def default_file(self) -> Path:
        """File in the working directory, named after the robot."""
        return Path("ocs.toml" if self.robot is None else f"{safe_name(self.robot.name)}.toml")


def read_starting_point(
    specified: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> StartingPoint:
    """Read the robot, if one is specified, and scale the defaults to it.

    Raises:
        OcsError: see `read_specified_robot`.
    """
    robot_section = specified.robot
    sources = (robot_section.file, robot_section.mass, robot_section.inertia, robot_section.human)
    robot = (
        read_specified_robot(specified, package_paths=package_paths, strict=strict)
        if any(source is not None for source in sources)
        else None
    )
    scaled_to = robot
    if scaled_to is None:
        # Solo12 as a rigid body: only its scale matters.
        trace = 3.0 * SOLO12_MASS * SOLO12_GYRATION_RADIUS**2
        roll, pitch = SOLO12_ROLL_INERTIA, SOLO12_PITCH_INERTIA
        inertia = (roll, pitch, trace - roll - pitch)
        scaled_to = robot_by_hand(SOLO12_MASS, inertia, name="Solo12")
    gains = wheel_gains(scaled_to)
    gravity = specified.requirement.gravity or STANDARD_GRAVITY
    default = default_specification(
        scaled_to, kp=gains.stiffness, kd=gains.damping, gravity=gravity
    )
    return StartingPoint(specified, robot, default, example_maneuvers(scaled_to, gravity))


def write_specification(
    start: StartingPoint,
    file: Path,
    *,
    chosen: Collection[str] = (),
    package_paths: Mapping[str, Path] | None = None,
    force: bool = False,
) -> Initialized:
    """Write the specification.

    Args:
        start: its content. file: to write.
        chosen: names of default maneuvers to include.
        package_paths: with which the robot was read.
        force: replace an existing file.

    Raises:
        OutputError: see `write_whole`.
    """
    named = ["ROBOT"] if start.robot is None else []
    packages = [f"--package-path={name}={path}" for name, path in (package_paths or {}).items()]
    command = shlex.join(["ocs-design", "size", *named, "--spec", str(file), *packages])
    subject = "a device" if start.robot is None else f"the device of {start.robot.name}"
    text = commented_toml(
        with_files_from(start.specified, file.parent),
        start.default,
        title=f"What {subject} must do and may be.\n\n  {command}",
        chosen=chosen,
        examples=start.examples,
    )
    write_whole(file, text, force=force)
    return Initialized(
        file=str(file), robot=None if start.robot is None else start.robot.name, next=command
    )
