"""The incidence angle by criterion and by posture."""

from collections.abc import Sequence

import numpy as np

from ocs_design.device.answers import PostureLine
from ocs_design.device.records import OcsDesign
from ocs_design.report.charts.chart import Chart, Ink, Mark, Points, Rule
from ocs_design.report.charts.scales import Axis
from ocs_design.report.quantities import degrees, in_unit

_ROW, _FRAME = 22.0, 110.0
"""Height of a row, and of what is around all rows [px]."""


def criterion_chart(design: OcsDesign) -> Chart:
    """Best incidence under each criterion, with the device and for the robot alone."""
    ocs = design.ocs
    names = tuple(ocs.incidence_by_criterion)
    alone = ocs.incidence_by_criterion_robot_alone
    known = [(row, alone[name]) for row, name in enumerate(names) if name in alone]
    marks: list[Mark] = [
        _chosen(design),
        _points(known, "robot alone", hollow=True),
        _points(list(enumerate(ocs.incidence_by_criterion.values())), "with the device"),
    ]
    return _rows(
        "incidence_criterion",
        "Incidence angle by criterion",
        "The best incidence angle under each criterion, with the device and for the robot alone.",
        names,
        marks,
    )


def posture_chart(design: OcsDesign, postures: Sequence[PostureLine]) -> Chart:
    """Best incidence under the paper's criterion in other postures of the robot alone."""
    marks: list[Mark] = [
        _chosen(design),
        _points(
            [(row, each.incidence) for row, each in enumerate(postures)], "equal-rate, robot alone"
        ),
    ]
    return _rows(
        "incidence_posture",
        "Incidence angle by posture",
        "Incidence angle of the paper's criterion, the arctangent of roll over pitch inertia, in "
        "several postures of the robot without the device.",
        tuple(each.posture for each in postures),
        marks,
    )


def _rows(
    name: str, title: str, description: str, rows: tuple[str, ...], marks: list[Mark]
) -> Chart:
    """A row for each name, the first one on top."""
    return Chart(
        name=name,
        title=title,
        description=description,
        # Discs at either end are seen whole.
        x=Axis("incidence angle", "deg", -3.0, 93.0),
        y=Axis("", "", len(rows) - 0.4, -0.6),
        marks=tuple(marks),
        rows=rows,
        height=_FRAME + _ROW * len(rows),
    )


def _points(rows: Sequence[tuple[int, float]], name: str, *, hollow: bool = False) -> Points:
    places = np.array([float(row) for row, _ in rows])
    angles = in_unit(np.array([angle for _, angle in rows]), "deg")
    return Points(angles, places, Ink.BLUE, name, hollow=hollow)


def _chosen(design: OcsDesign) -> Rule:
    angle = design.ocs.incidence
    return Rule(
        in_unit(angle, "deg"), upright=True, label=f"α* {degrees(angle)}", ink=Ink.VERMILION
    )
