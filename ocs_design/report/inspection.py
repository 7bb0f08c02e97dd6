"""What `inspect` prints."""

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.answers import Inspection
from ocs_design.report.layout import columns, heading, note, show
from ocs_design.report.quantities import signed
from ocs_design.report.terminal import print_joints, print_robot

PAPER_ANGLE = (
    "The paper states about 40 deg for Solo12; its own formula gives that only with the legs "
    "spread by about 0.75 to 1 rad."
)

SAME_RATE = (
    "weighted and simultaneous: for the same rate on both axes; `size` puts in what is asked of "
    "each axis."
)


def print_inspection(console: Console, inspection: Inspection, *, verbose: bool = False) -> None:
    """Mass, posture, inertia, incidence angles and how they move with the posture."""
    robot = inspection.robot
    print_robot(
        console,
        robot,
        [
            ("read from", f"{robot.source} ({robot.format})"),
            ("links, joints", f"{inspection.links}, {inspection.joints} moving"),
            ("legs", ", ".join(robot.legs) or "none found"),
            (
                "heading drift",
                f"{signed(inspection.heading_drift[0])} rad of yaw per rad of roll, "
                f"{signed(inspection.heading_drift[1])} per rad of pitch",
            ),
        ],
    )
    _print_criteria(console, inspection)
    _print_postures(console, inspection)
    if robot.posture and verbose:
        print_joints(console, robot)


def _print_criteria(console: Console, inspection: Inspection) -> None:
    heading(console, "Incidence angle alpha* of the robot alone, by criterion")
    table = columns("criterion", "deg")
    for name, angle in inspection.incidence_by_criterion.items():
        table.add_row(name, f"{np.degrees(angle):.3f}")
    show(console, table)
    note(console, SAME_RATE)


def _print_postures(console: Console, inspection: Inspection) -> None:
    heading(console, "Incidence angle (equal-rate) over postures")
    table = columns("posture", "Ixx\nkg m2", "Iyy\nkg m2", "Izz\nkg m2", "alpha*\ndeg")
    for line in inspection.incidence_by_posture:
        moments = (f"{moment:#.4g}" for moment in line.inertia_diagonal)
        table.add_row(Text(line.posture), *moments, f"{np.degrees(line.incidence):.2f}")
    show(console, table)
    if "solo12" in inspection.robot.name.lower():
        note(console, PAPER_ANGLE)
