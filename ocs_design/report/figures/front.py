"""Mass of the lightest device against one figure of the specification."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.answers import Front, FrontPoint
from ocs_design.arrays import FloatArray
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import SERIES, Ink, Line, Mark, Points, Rule
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.amounts import in_unit

_HEIGHT = 300.0


def front_chart(front: Front) -> Chart:
    """One line, broken where there is no device, and points by their drives."""
    values = _values(front, front.points)
    masses = np.array([1e3 * p.device.mass if p.device else np.nan for p in front.points])
    y = Axis.around("mass of both modules", "g", masses, room=0.1)
    marks: list[Mark] = [Line(values, masses, Ink.FAINT), *_drives(front), *_without(front, y.low)]
    if front.spans_own_value:
        own = in_unit(front.own_value, front.unit)
        marks.insert(0, Rule(own, upright=True, label="as specified", ink=Ink.FAINT))
    return Chart(
        name="front",
        title=f"{front.robot}: lightest device",
        description=f"Mass of the lightest device against {front.label}; each point is a design of "
        "its own, and has the colour of its motor and gear.",
        x=Axis.around(front.label, front.unit, values, room=0.04),
        y=y,
        marks=tuple(marks),
        height=_HEIGHT,
    )


def _drives(front: Front) -> Iterator[Points]:
    """Those of each motor and gear; once all colours are taken, as rings."""
    drives: dict[str, list[FrontPoint]] = {}
    for point in front.feasible:
        if point.device is not None:
            drives.setdefault(f"{point.device.motor}, {point.device.gear}", []).append(point)
    for index, (name, points) in enumerate(drives.items()):
        hollow = index // len(SERIES) % 2 == 1
        masses = np.array([1e3 * point.device.mass for point in points if point.device])
        ink = SERIES[index % len(SERIES)]
        yield Points(_values(front, points), masses, ink, name, hollow=hollow)


def _without(front: Front, foot: float) -> Iterator[Points]:
    """Values without a device, at the foot."""
    points = [point for point in front.points if point.device is None]
    if points:
        at = np.full(len(points), foot)
        yield Points(_values(front, points), at, Ink.PLAIN, "no device", hollow=True)


def _values(front: Front, points: Sequence[FrontPoint]) -> FloatArray:
    return in_unit(np.array([point.value for point in points]), front.unit)
