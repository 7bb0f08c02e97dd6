"""The paper's lower bound on the device's inertia, and where the design lies (paper, figure 2)."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design_file import OcsDesign
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import SERIES, Ink, Line, Points
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.taken import Taken, taken
from ocs_design.report.quantities import rpm
from ocs_design.report.story import Story
from ocs_design.requirement.bound import AXES, authority, bound_curve

_SPEEDS = (0.25, 0.5, 1.0, 2.0)
"""Of the curves, over the highest speed of the wheels."""

_SAMPLES = 160

_HARDLY = 0.02
"""Of the largest momentum: a maneuver that takes less about an axis is not about it."""


def bound_charts(story: Story) -> Iterator[Chart]:
    """One for each axis that the wheels take momentum about."""
    found = taken(story)
    for axis, name in reversed(list(enumerate(AXES))):
        points = _points(story.design, axis, found)
        if points:
            yield _chart(story.design, axis, name, points)


def _points(design: OcsDesign, axis: int, found: Sequence[Taken]) -> list[tuple[str, float, float]]:
    """Of each maneuver: name, change of rate that its momentum is worth [rad/s], what the device
    has for it [kg m^2]; without those that hardly turn about this axis.
    """
    total = design.ocs.total_inertia[axis][axis]
    most = max((each.largest(axis) for each in found), default=0.0)
    points = []
    for each in found:
        momentum, share = each.largest(axis), float(authority(each.incidence)[axis])
        if momentum > _HARDLY * max(most, each.largest(1 - axis)) and share > 0.0:
            points.append((each.source, momentum / total, 2.0 * share * design.ocs.spin_inertia))
    return points


def _chart(design: OcsDesign, axis: int, name: str, asked: list[tuple[str, float, float]]) -> Chart:
    fastest, inertia = design.requirement.wheel_speed_max, design.robot.inertia[axis][axis]
    changes = np.array([change for _, change, _ in asked])
    present = np.array([each for _, _, each in asked])
    rates = np.linspace(1e-3, 1.25 * changes.max(), _SAMPLES)
    lines = _curves(rates, fastest, inertia)
    ends = (0.3 * min(_least(lines, 0.15), present.min()), 3.0 * max(present.max(), lines[1].y[-1]))
    points = Points(
        changes, present, Ink.PLAIN, "the design", labels=tuple(source for source, _, _ in asked)
    )
    return Chart(
        name=f"bound_{name}",
        title=f"Lower bound on the device's inertia, {name}",
        description=f"Inertia that the wheels must present about {name} against the change of "
        "rate, one curve for each highest wheel speed, and what the design has for the change that "
        "each maneuver's momentum is worth. A point over the solid curve of the design's own wheel "
        "speed has inertia to spare.",
        x=Axis("change of rate", "rad/s", 0.0, float(rates[-1])),
        y=Axis("inertia required", "kg m²", float(ends[0]), float(ends[1]), log=True),
        marks=(*lines, points),
        height=290.0,
    )


def _curves(rates: FloatArray, fastest: float, inertia: float) -> list[Line]:
    """One for each wheel speed; the design's own is solid."""
    speeds = [part * fastest for part in _SPEEDS]
    curves = inertia * bound_curve(rates, speeds)
    return [
        Line(
            rates, np.where(np.isfinite(curve), curve, np.nan), ink, rpm(speed), dashed=part != 1.0
        )
        for part, speed, curve, ink in zip(_SPEEDS, speeds, curves, SERIES, strict=False)
    ]


def _least(lines: list[Line], part: float) -> float:
    """Of all curves, that far along; nearer to zero they fall without end."""
    return min(float(line.y[int(part * len(line.y))]) for line in lines)
