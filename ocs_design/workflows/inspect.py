"""What `inspect` shows: the robot, its incidence angles, and how they move with its posture."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import vector
from ocs_design.common.errors import UsageError
from ocs_design.device.answers import (
    Inspection,
    LegLine,
    PostureLine,
    ReadingLine,
    RecognitionRecord,
)
from ocs_design.device.layout import Criterion, heading_drift, incidence_by_criterion
from ocs_design.device.records.design import SCHEMA_VERSION
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.export.folder import write_whole
from ocs_design.report.charts.svg import png_of
from ocs_design.report.stick_figure import stick_figure
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.robot.leg_geometry import axis_name, up_axis
from ocs_design.robot.legs import ANKLED_JOINTS, is_wheel
from ocs_design.robot.posture import posture_sensitivity
from ocs_design.robot.robot import Recognition, Robot


def inspect_robot(
    specification: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
    picture: Path | None = None,
) -> Inspection:
    """Read the robot of a specification and measure it over plausible postures.

    Trunk and legs need not be clear: the answer says what they may be.

    Args:
        specification: that names the robot.
        package_paths: folder of each package that `package://` addresses name.
        strict: whether warnings are errors.
        picture: file to draw what was recognised in, `.svg` or `.png`; None: none.

    Raises:
        OcsError: see `read_specified_robot`; the picture cannot be drawn or written.
    """
    if picture is not None and picture.suffix.lower() not in {".svg", ".png"}:
        raise UsageError(
            f"--picture {picture}: .svg and .png are drawn", hint="name a file *.svg or *.png"
        )
    robot = read_specified_robot(
        specification, package_paths=package_paths, strict=strict, sure=False
    )
    if picture is not None:
        if robot.recognition is None:
            raise UsageError("a robot by hand has nothing to draw", hint="leave out --picture")
        # As recognised or, where that is not clear, in its likeliest reading.
        asked = robot.recognition.likely
        shown = asked[0] if asked else robot.recognition.reading
        words = [
            f"{robot.name}: trunk {shown.trunk}, {len(shown.legs)} legs, "
            f"confidence {shown.confidence:.0%}, posture {robot.posture_name}",
            *(f"or {each.options} ({each.confidence:.0%})" for each in asked[1:]),
        ]
        drawn = stick_figure(robot, shown.legs, words)
        content = drawn if picture.suffix.lower() == ".svg" else png_of(drawn)
        write_whole(picture, content, force=True)
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
        recognition=None
        if robot.recognition is None
        else _recognition_record(robot, robot.recognition),
    )


def _recognition_record(robot: Robot, recognition: Recognition) -> RecognitionRecord:
    reading = recognition.reading
    turn = np.eye(3) if robot.mount is None else robot.mount.placement.rotation
    up = up_axis(robot.tree, robot.trunk, robot.legs) if robot.legs else np.eye(3)[2]
    legs = []
    for leg in robot.legs:
        end = "sole" if len(leg.joints) >= ANKLED_JOINTS else "point"
        if is_wheel(robot.tree.bodies[leg.body]):
            end = "wheel"
        elif leg.foot_radius > 0.0:
            end = "ball"
        line = LegLine(foot=leg.name, ends_in=end, length=leg.length, joints=leg.joints)
        legs.append(line)
    return RecognitionRecord(
        trunk=robot.trunk if robot.mount is None else robot.mount.link,
        legs=tuple(legs),
        forward=axis_name(turn[:, 0]),
        left=axis_name(turn[:, 1]),
        up=axis_name(turn @ up),
        stated=tuple(sorted(recognition.stated)),
        confidence=reading.confidence,
        speaks_for=tuple(sign.what for sign in reading.signs if sign.holds),
        speaks_against=(
            *(sign.against for sign in reading.signs if sign.holds is False),
            *(doubt.what for doubt in reading.doubts),
        ),
        likely=tuple(
            ReadingLine(
                trunk=each.trunk,
                legs=tuple(leg.name for leg in each.legs),
                confidence=each.confidence,
            )
            for each in recognition.likely
        ),
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
