"""Charts of wheel momentum, inertia, lower bound and incidence of the wheel axes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import rpm
from ocs_design.common.wording import degrees, in_unit
from ocs_design.device.answers import PostureLine
from ocs_design.device.layout import PAIR
from ocs_design.device.records.design import OcsDesign
from ocs_design.parts.module import part_name
from ocs_design.report.charts.chart import (
    SERIES,
    Axis,
    Chart,
    Curve,
    FilledArea,
    Ink,
    Mark,
    Points,
    Rule,
)
from ocs_design.report.story import Story
from ocs_design.requirement.bound import AXES, bound_curve

_SIDE = 300.0
"""Height of charts in the plane of the axes [px]."""

_SPEED_FRACTIONS = (0.25, 0.5, 1.0, 2.0)
"""Wheel speeds of the curves of the bound, relative to the design's maximum."""

_RATE_SAMPLES = 160

_NEGLIGIBLE_MOMENTUM = 0.02
"""Share of the largest momentum about an axis below which a maneuver is left out."""


@dataclass(frozen=True, eq=False)
class ManeuverMomentum:
    """Momentum of the wheels in one maneuver.

    Attributes:
        source: name of the maneuver or of another demand.
        incidence: incidence of the modules in it [rad].
        path: roll and pitch momentum of all wheels together [N m s], shape (n, 2).
    """

    source: str
    incidence: float
    path: FloatArray

    def largest(self, axis: int) -> float:
        """Largest momentum about roll (0) or pitch (1) [N m s]."""
        return float(np.abs(self.path[:, axis]).max())


def maneuver_momenta(story: Story) -> tuple[ManeuverMomentum, ...]:
    """Momenta of each flight with the device up to its verdict; without flights, those demanded.

    A chosen drive may turn a robot with less momentum than the constant torque, one way and then
    the other, that the demands assume. Then only flights show the momentum.
    """
    ocs = story.design.ocs
    incidences = {
        maneuver.name: maneuver.incidence for maneuver in story.design.requirement.maneuvers
    }
    momenta = []
    for flight in story.flights:
        if flight.record.ocs:
            incidence = incidences.get(flight.record.scenario)
            incidence = ocs.incidence if incidence is None else incidence
            speeds = np.stack([flight.wheel_speed(wheel) for wheel in flight.wheels], axis=1)
            wheel_momenta = ocs.spin_inertia * speeds[flight.driven_samples]
            path = wheel_momenta @ ocs.axes.axes(incidence)[:2].T
            momenta.append(ManeuverMomentum(flight.record.scenario, incidence, path))
    if momenta or story.design.selection is not None:
        return tuple(momenta)
    for demand in story.design.requirement.demands:
        momentum = np.array([[demand.roll_momentum, demand.pitch_momentum]])
        momenta.append(ManeuverMomentum(demand.source, demand.incidence, momentum))
    return tuple(momenta)


def ellipsoid_chart(design: OcsDesign) -> Chart:
    """Inertia ellipse from above, with the wheel axes at alpha* (paper, figures 3 and 4).

    As in the paper, its semi-axes are the eigenvalues of the inertia in the horizontal plane.
    Forward is up, left is left.
    """
    total = np.array(design.ocs.total_inertia)[:2, :2]
    robot_alone = np.array(design.robot.inertia)[:2, :2]
    half_range = 1.15 * max(
        float(np.linalg.eigvalsh(inertia)[-1]) for inertia in (total, robot_alone)
    )
    arc = np.linspace(0.0, design.ocs.incidence, 40)
    marks: list[Mark] = [
        FilledArea(*_chart_coordinates(_ellipse(total)), Ink.BLUE, "robot with device"),
        Curve(*_chart_coordinates(_ellipse(total)), Ink.BLUE),
        Curve(*_chart_coordinates(_ellipse(robot_alone)), Ink.FAINT, "robot alone", dashed=True),
    ]
    inks = 2 * (Ink.VERMILION, Ink.PURPLE, Ink.GREEN, Ink.ORANGE)
    for index, (module, ink) in enumerate(zip(design.ocs.modules, inks, strict=False)):
        end = half_range * np.array(module.axis[:2])
        line = _chart_coordinates(np.stack([-end, end], axis=1))
        marks.append(
            Curve(*line, ink, f"axis of {part_name('wheel', module.name)}", dashed=index % 2 == 1)
        )
    axes_text = f"of the layout {str(design.ocs.layout)!r}"
    if design.ocs.axes == PAIR:
        # Arc from the lateral direction to the axis at alpha*.
        marks.append(
            Curve(
                *_chart_coordinates(0.5 * half_range * np.stack([np.sin(arc), np.cos(arc)])),
                Ink.PLAIN,
                thin=True,
            )
        )
        axes_text = f"at α* = {degrees(design.ocs.incidence)}"
    return Chart(
        name="inertia_ellipsoid",
        title=f"Inertia from above, wheel axes {axes_text}",
        description="Ellipse whose half axes are the principal inertias in the horizontal plane, "
        f"forward is up and left is left, with the spin axes of the wheels {axes_text} "
        "(α*: angle to the lateral direction).",
        x=Axis("inertia, lateral direction", "kg m²", -half_range, half_range),
        y=Axis("inertia, forward", "kg m²", -half_range, half_range),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def _ellipse(inertia: FloatArray) -> FloatArray:
    """Points of the ellipse in B, forward and left, shape (2, n)."""
    values, axes = np.linalg.eigh(inertia)
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    return np.asarray(axes @ (values[:, None] * np.stack([np.cos(angle), np.sin(angle)])))


def _chart_coordinates(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Chart coordinates of points in B: forward is up, left is left."""
    return -points[1], points[0]


def momentum_chart(story: Story) -> Chart:
    """Momentum envelope of the wheels, and the momenta of the maneuvers.

    The envelope of n wheels is the zonotope of their axes; for a pair it is the rhombus
    `|L_x| / sin a + |L_y| / cos a <= 2 I_w w_max` (docs/theory.md, Incidence angle). There is one
    for each incidence at which a maneuver is flown.
    """
    ocs, momenta = story.design.ocs, maneuver_momenta(story)
    wheel_momentum = ocs.spin_inertia * story.design.requirement.wheel_speed_max
    incidences = dict.fromkeys([ocs.incidence, *(momentum.incidence for momentum in momenta)])
    marks: list[Mark] = []
    for incidence, dashed in zip(incidences, (False, True, True, True), strict=False):
        x, y = _zonotope(wheel_momentum * ocs.axes.axes(incidence)[:2])
        name = f"reach at {degrees(incidence)}" if incidence or ocs.axes == PAIR else "reach"
        marks += [FilledArea(x, y, Ink.FAINT), Curve(x, y, Ink.FAINT, name, dashed=dashed)]
    for momentum, ink in zip(momenta, SERIES * 2, strict=False):
        roll, pitch = momentum.path.T
        peak = int(np.argmax(np.hypot(roll, pitch)))
        # The path, and a ring at its largest momentum.
        marks.append(Curve(roll, pitch, ink, momentum.source))
        marks.append(Points(roll[peak : peak + 1], pitch[peak : peak + 1], ink, hollow=True))
    largest = len(ocs.modules) * wheel_momentum
    half_range = 1.15 * max(
        [largest, *(momentum.largest(axis) for momentum in momenta for axis in (0, 1))]
    )
    return Chart(
        name="momentum",
        title="Wheel momentum: capacity and use",
        description="Outline of the roll and pitch momenta that the wheels can hold together at "
        "top speed, and the momenta of each maneuver up to where it is judged.",
        x=Axis("roll momentum", "N m s", -half_range, half_range),
        y=Axis("pitch momentum", "N m s", -half_range, half_range),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def _zonotope(sides: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Closed outline, shapes (2 n + 1,), of all sums of the columns, shape (2, n), times -1..1."""
    upwards = sides * np.where(sides[1] < 0.0, -1.0, 1.0)
    sorted_sides = upwards[:, np.argsort(np.arctan2(upwards[1], upwards[0]))]
    steps = 2.0 * np.concatenate([sorted_sides, -sorted_sides], axis=1)
    corners = np.cumsum(steps, axis=1) - sorted_sides.sum(axis=1)[:, None]
    return np.append(corners[0], corners[0, 0]), np.append(corners[1], corners[1, 0])


def bound_charts(story: Story) -> Iterator[Chart]:
    """Lower bound on the device's inertia, and the design, for each axis (paper, figure 2)."""
    momenta, design = maneuver_momenta(story), story.design
    speeds = [fraction * design.requirement.wheel_speed_max for fraction in _SPEED_FRACTIONS]
    for axis, name in reversed(list(enumerate(AXES))):
        # Name, equivalent change of rate and device inertia of each maneuver, without those that
        # hardly turn about this axis.
        points = []
        largest = max((momentum.largest(axis) for momentum in momenta), default=0.0)
        for momentum in momenta:
            peak = momentum.largest(axis)
            axis_share = float(np.abs(design.ocs.axes.axes(momentum.incidence)[axis]).sum())
            negligible = _NEGLIGIBLE_MOMENTUM * max(largest, momentum.largest(1 - axis))
            if peak > negligible and axis_share > 0.0:
                rate_change = peak / design.ocs.total_inertia[axis][axis]
                points.append((momentum.source, rate_change, axis_share * design.ocs.spin_inertia))
        if not points:
            continue
        changes = np.array([rate_change for _, rate_change, _ in points])
        inertias = np.array([inertia for _, _, inertia in points])
        rates = np.linspace(1e-3, 1.25 * changes.max(), _RATE_SAMPLES)
        bound = design.robot.inertia[axis][axis] * bound_curve(rates, speeds)
        curves = np.where(np.isfinite(bound), bound, np.nan)
        lines = [
            # The curve of the design's own speed is solid.
            Curve(rates, curve, ink, rpm(speed), dashed=fraction != 1.0)
            for fraction, speed, curve, ink in zip(
                _SPEED_FRACTIONS, speeds, curves, SERIES, strict=False
            )
        ]
        # Closer to zero the curves fall without limit.
        lowest = min(float(line.y[int(0.15 * len(line.y))]) for line in lines)
        ends = (0.3 * min(lowest, inertias.min()), 3.0 * max(inertias.max(), lines[1].y[-1]))
        labels = tuple(source for source, _, _ in points)
        yield Chart(
            name=f"bound_{name}",
            title=f"Lower bound on the device's inertia, {name}",
            description=f"Inertia that the wheels must present about {name} against the change of "
            "rate, one curve for each top wheel speed, and the design's inertia at the change of "
            "rate that corresponds to each maneuver's momentum. A point above the solid curve "
            "(the design's wheel speed) has a margin.",
            x=Axis("change of rate", "rad/s", 0.0, float(rates[-1])),
            y=Axis("inertia required", "kg m²", float(ends[0]), float(ends[1]), log=True),
            marks=(*lines, Points(changes, inertias, Ink.PLAIN, "the design", labels=labels)),
            height=290.0,
        )


_ROW, _FRAME = 22.0, 110.0
"""Height of a row, and of the margins around all rows [px]."""


def criterion_chart(design: OcsDesign) -> Chart:
    """Best incidence under each criterion, with the device and for the robot alone."""
    with_device = design.ocs.incidence_by_criterion
    robot_alone = design.ocs.incidence_by_criterion_robot_alone
    alone = [
        (row, robot_alone[name]) for row, name in enumerate(with_device) if name in robot_alone
    ]
    return _incidence_rows(
        design,
        "incidence_criterion",
        "Incidence angle by criterion",
        "The best incidence angle under each criterion, with the device and for the robot alone.",
        rows=tuple(with_device),
        angles={"robot alone": alone, "with the device": list(enumerate(with_device.values()))},
    )


def posture_chart(design: OcsDesign, postures: Sequence[PostureLine]) -> Chart:
    """Best incidence under the paper's criterion for other postures of the robot alone."""
    angles = [(row, line.incidence) for row, line in enumerate(postures)]
    return _incidence_rows(
        design,
        "incidence_posture",
        "Incidence angle by posture",
        "Incidence angle of the paper's criterion, the arctangent of roll over pitch inertia, in "
        "several postures of the robot without the device.",
        rows=tuple(line.posture for line in postures),
        angles={"equal-rate, robot alone": angles},
    )


def _incidence_rows(
    design: OcsDesign,
    name: str,
    title: str,
    description: str,
    *,
    rows: tuple[str, ...],
    angles: Mapping[str, Sequence[tuple[int, float]]],
) -> Chart:
    """Chart with a row for each name, the first on top, its angles [rad] and the design's angle."""
    chosen = design.ocs.incidence
    label = f"α* {degrees(chosen)}"
    marks: list[Mark] = [Rule(in_unit(chosen, "deg"), upright=True, label=label, ink=Ink.VERMILION)]
    for index, (legend, pairs) in enumerate(angles.items(), start=1):
        heights = np.array([float(row) for row, _ in pairs])
        angles_deg = in_unit(np.array([angle for _, angle in pairs]), "deg")
        marks.append(Points(angles_deg, heights, Ink.BLUE, legend, hollow=index < len(angles)))
    return Chart(
        name=name,
        title=title,
        description=description,
        # Margins so that discs at 0 and 90 deg are not clipped.
        x=Axis("incidence angle", "deg", -3.0, 93.0),
        y=Axis("", "", len(rows) - 0.4, -0.6),
        marks=tuple(marks),
        rows=rows,
        height=_FRAME + _ROW * len(rows),
    )


def incidence_charts(story: Story) -> Iterator[Chart]:
    """Inertia and momenta in the plane of the wheel axes, and alternative incidences."""
    yield ellipsoid_chart(story.design)
    yield momentum_chart(story)
    if story.design.ocs.axes != PAIR:
        return
    yield criterion_chart(story.design)
    if story.postures:
        yield posture_chart(story.design, story.postures)
