"""What `inspect` shows: the robot, its incidence angles, and how they move with its posture."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import vector
from ocs_design.device.answers import Inspection, PostureLine
from ocs_design.device.layout import Criterion, heading_drift, incidence_by_criterion
from ocs_design.device.records import SCHEMA_VERSION, RobotRecord
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.robot.posture import posture_sensitivity
from ocs_design.robot.robot import Robot


def inspect_robot(
    specification: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> Inspection:
    """Read the robot of a specification and measure it over plausible postures.

    Raises:
        OcsError: see `read_specified_robot`.
    """
    robot = read_specified_robot(specification, package_paths=package_paths, strict=strict)
    roll, pitch = heading_drift(robot.inertia)
    return Inspection(
        schema_version=SCHEMA_VERSION,
        robot=RobotRecord.of(robot),
        joints=len(robot.tree.joints),
        links=len(robot.tree.body_of_link),
        incidence_by_criterion={
            str(name): angle for name, angle in incidence_by_criterion(robot.inertia).items()
        },
        heading_drift=(float(roll), float(pitch)),
        incidence_by_posture=posture_lines(robot),
    )


def posture_lines(robot: Robot) -> tuple[PostureLine, ...]:
    """Inertia and alpha* over plausible postures; see `posture_sensitivity`."""
    inertia_of = {row.label: row.mass_properties.inertia for row in posture_sensitivity(robot)}
    return tuple(
        PostureLine(
            posture=posture,
            inertia_diagonal=vector(np.diag(inertia)),
            incidence=incidence_by_criterion(inertia)[Criterion.EQUAL_RATE],
        )
        for posture, inertia in inertia_of.items()
    )
