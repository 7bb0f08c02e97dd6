"""The robot that a specification names, or gives by hand."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from ocs_design.exceptions import RobotError, UsageError
from ocs_design.requirement.specification import Specification
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot

SCALES = 0.02
"""Of a robot's mass over what it weighs: a battery or a harness that its file lacks is more."""


def read_stated_robot(
    specification: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> Robot:
    """Read it.

    Raises:
        UsageError: neither or both are stated.
        RobotError: it cannot be read; with `strict`, also if there is any warning.
    """
    stated = specification.robot
    if stated.file is not None and (stated.mass is not None or stated.inertia is not None):
        raise UsageError("a robot file and --mass/--inertia exclude each other", hint="give one")
    if stated.file is not None:
        robot = read_robot(
            stated.file,
            trunk=stated.trunk,
            posture=stated.posture,
            joints=stated.joints or {},
            package_paths=package_paths,
        )
    elif stated.mass is not None and stated.inertia is not None:
        robot = robot_by_hand(stated.mass, stated.inertia, name=stated.name or "robot")
    elif stated.mass is not None or stated.inertia is not None:
        raise UsageError(
            "a robot by hand needs both its mass and its inertia",
            hint="give --mass MASS and --inertia IXX,IYY,IZZ, or both keys under [robot]",
        )
    else:
        raise UsageError(
            "no robot is given",
            hint="give a robot file, or --mass and --inertia, or [robot] in the specification; "
            "see docs/tutorial.md",
        )
    if stated.weighed is not None:
        doubts = tuple(_mass_doubts(robot.mass, stated.weighed))
        robot = replace(robot, warnings=(*robot.warnings, *doubts))
    if strict and robot.warnings:
        raise RobotError("--strict: " + "; ".join(robot.warnings), hint="mend the robot's file")
    return robot


def _mass_doubts(mass: float, weighed: float) -> Iterator[str]:
    """Whether the parts in the file [kg] add up to the robot on the scales [kg]."""
    if abs(mass - weighed) > SCALES * weighed:
        yield (
            f"the parts' masses add up to {mass:.4g} kg, but the robot weighs {weighed:.4g} kg: "
            f"{'something is missing' if mass < weighed else 'something is too heavy'} in its file"
        )
