"""The robot in the terminal: data read from its file, as shown by `inspect` and `size`."""

from collections.abc import Iterable

from rich.console import Console

from ocs_design.common.wording import degrees_number
from ocs_design.device.answers import Inspection
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.report.device import heading_drift, robot_facts
from ocs_design.report.table import CellTable, columns
from ocs_design.report.text.layout import facts, heading, note, show, warn

PAPER_ANGLE = (
    "The paper states about 40 deg for Solo12; its own formula gives that only with the legs "
    "spread by about 0.75 to 1 rad."
)

SAME_RATE = (
    "Here weighted and simultaneous assume the same rate on both axes; `size` uses the demand on "
    "each axis."
)


def print_inspection(console: Console, inspection: Inspection, *, verbose: bool = False) -> None:
    """Print mass, posture, inertia, incidence angles and their change with the posture."""
    robot, recognition = inspection.robot, inspection.recognition
    legs, recognition_rows = ", ".join(robot.legs) or "none found", []
    if recognition is not None:
        if recognition.legs:
            # Feet and the kinds of their end links.
            feet = ", ".join(leg.foot for leg in recognition.legs)
            kinds = sorted({leg.ends_in for leg in recognition.legs})
            ends = " and ".join(f"{kind}s" for kind in kinds)
            legs = f"{feet} ({len(recognition.legs)}, ending in {ends})"
        directions = f"forward {recognition.forward}, left {recognition.left}, up {recognition.up}"
        confidence = "as specified"
        if not {"trunk", "legs"} <= set(recognition.stated):
            as_specified = "".join(f", {name} as specified" for name in recognition.stated)
            confidence = f"{recognition.confidence:.0%} confidence{as_specified}"
            if recognition.speaks_against:
                confidence += f": but {'; '.join(recognition.speaks_against)}"
        recognition_rows = [
            ("directions", f"{directions} of '{recognition.trunk}'"),
            ("trunk, legs", confidence),
        ]
    print_robot(
        console,
        robot,
        [
            (f"read from {robot.format}", robot.source),
            ("links, joints", f"{inspection.links}, {inspection.joints} moving"),
            ("legs", legs),
            *recognition_rows,
            ("heading drift", heading_drift(inspection.heading_drift)),
        ],
    )
    if recognition is not None and recognition.likely:
        heading(console, "Trunk and legs are ambiguous; `size` will ask for one of")
        readings = []
        for reading in recognition.likely:
            options = f"--trunk {reading.trunk} --legs {','.join(reading.legs) or 'none'}"
            readings.append((options, f"{reading.confidence:.0%}"))
        show(console, CellTable(columns("<options", "confidence"), tuple(readings)))
    heading(console, "Incidence angle alpha* of the robot alone, by criterion")
    criteria = inspection.incidence_by_criterion.items()
    angles = tuple((name, degrees_number(angle, 3)) for name, angle in criteria)
    show(console, CellTable(columns("<criterion", "deg"), angles))
    note(console, SAME_RATE)
    heading(console, "Incidence angle (equal-rate) over postures")
    heads = columns("<posture", "Ixx [kg m2]", "Iyy [kg m2]", "Izz [kg m2]", "alpha* [deg]")
    postures = []
    for line in inspection.incidence_by_posture:
        moments = (f"{moment:#.4g}" for moment in line.inertia_diagonal)
        postures.append((line.posture, *moments, degrees_number(line.incidence, 2)))
    show(console, CellTable(heads, tuple(postures)))
    if "solo12" in robot.name.lower():
        note(console, PAPER_ANGLE)
    if robot.posture and verbose:
        print_joints(console, robot)


def print_joints(console: Console, robot: RobotRecord) -> None:
    """Print the value of every joint in the nominal posture."""
    heading(console, f"Joints at {robot.posture_name}")
    rows = ((name, f"{value:.4f}", degrees_number(value)) for name, value in robot.posture.items())
    show(console, CellTable(columns("<joint", "rad or m", "deg"), tuple(rows)))


def print_robot(console: Console, robot: RobotRecord, more: Iterable[tuple[str, str]] = ()) -> None:
    """Print the data read of a robot and `more` facts; then the warnings about its file."""
    heading(console, f"Robot: {robot.name}")
    facts(console, [*robot_facts(robot), *more])
    warn(console, robot.warnings)
