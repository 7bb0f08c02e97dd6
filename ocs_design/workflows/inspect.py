"""Answer of `inspect`: the robot, and how its incidence angles depend on its posture."""

from collections.abc import Mapping
from pathlib import Path

from ocs_design.common.errors import UsageError
from ocs_design.device.answers import Inspection, RecognitionRecord, posture_lines
from ocs_design.device.layout import heading_drift, incidence_by_criterion
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.export.folder import write_whole
from ocs_design.report.charts.svg import png_of
from ocs_design.report.stick_figure import stick_figure
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification


def inspect_robot(
    specification: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
    picture: Path | None = None,
) -> Inspection:
    """Read the robot of a specification and measure it over plausible postures.

    Trunk and legs need not be certain: the answer lists what they may be.

    Args:
        specification: that names the robot.
        package_paths: folder of each package, for `package://` addresses.
        strict: whether warnings are errors.
        picture: file for a drawing of what was recognised, `.svg` or `.png`; None: none.

    Raises:
        OcsError: see `read_specified_robot`; the picture cannot be drawn or written.
    """
    if picture is not None and picture.suffix.lower() not in {".svg", ".png"}:
        raise UsageError(
            f"--picture {picture}: must be .svg or .png", hint="name a file *.svg or *.png"
        )
    robot = read_specified_robot(
        specification, package_paths=package_paths, strict=strict, sure=False
    )
    if picture is not None:
        if robot.recognition is None:
            raise UsageError("there is nothing to draw without a file", hint="leave out --picture")
        # As recognised or, if that is not certain, in its likeliest reading.
        readings = robot.recognition.likely
        reading = readings[0] if readings else robot.recognition.reading
        lines = [
            f"{robot.name}: trunk {reading.trunk}, {len(reading.legs)} legs, "
            f"confidence {reading.confidence:.0%}, posture {robot.posture_name}",
            *(f"or {reading.options} ({reading.confidence:.0%})" for reading in readings[1:]),
        ]
        svg = stick_figure(robot, reading.legs, lines)
        content = svg if picture.suffix.lower() == ".svg" else png_of(svg)
        write_whole(picture, content, force=True)
    return Inspection(
        robot=RobotRecord.of(robot),
        joints=len(robot.tree.joints),
        links=len(robot.tree.body_of_link),
        incidence_by_criterion={
            str(name): angle for name, angle in incidence_by_criterion(robot.inertia).items()
        },
        heading_drift=heading_drift(robot.inertia),
        incidence_by_posture=posture_lines(robot),
        recognition=RecognitionRecord.of(robot),
    )
