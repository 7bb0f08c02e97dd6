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

_SPEEDS = (0.25, 0.5, 1.0, 2.0)
"""Wheel speeds of the curves of the bound, relative to the design's maximum."""

_SAMPLES = 160

_NEGLIGIBLE_MOMENTUM = 0.02
"""Share of the largest momentum about an axis below which a maneuver is left out."""


@dataclass(frozen=True, eq=False)
class Taken:
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


def taken(story: Story) -> tuple[Taken, ...]:
    """Momenta of each flight with the device up to its verdict; without flights, those demanded.

    A chosen drive may turn a robot with less momentum than the constant torque, one way and then
    the other, that the demands assume. Then only flights show the momentum.
    """
    ocs = story.design.ocs
    own = {each.name: each.incidence for each in story.design.requirement.maneuvers}
    flown = []
    for flight in story.flights:
        if flight.ocs:
            specified = own.get(flight.scenario)
            incidence = ocs.incidence if specified is None else specified
            speeds = np.stack([flight.wheel_speed(wheel) for wheel in flight.wheels], axis=1)
            along = ocs.spin_inertia * speeds[flight.driven]
            path = along @ ocs.axes.axes(incidence)[:2].T
            flown.append(Taken(flight.scenario, incidence, path))
    if flown or story.design.selection is not None:
        return tuple(flown)
    return tuple(
        Taken(
            demand.source,
            demand.incidence,
            np.array([[demand.roll_momentum, demand.pitch_momentum]]),
        )
        for demand in story.design.requirement.demands
    )


def ellipsoid_chart(design: OcsDesign) -> Chart:
    """Inertia ellipse from above, with the wheel axes at alpha* (paper, figures 3 and 4).

    As in the paper, its semi-axes are the eigenvalues of the inertia in the horizontal plane.
    Forward is up, left is left.
    """
    total = np.array(design.ocs.total_inertia)[:2, :2]
    alone = np.array(design.robot.inertia)[:2, :2]
    reach = 1.15 * float(max(np.linalg.eigvalsh(total)[-1], np.linalg.eigvalsh(alone)[-1]))
    arc = np.linspace(0.0, design.ocs.incidence, 40)
    marks: list[Mark] = [
        FilledArea(*_seen(_ellipse(total)), Ink.BLUE, "robot with device"),
        Curve(*_seen(_ellipse(total)), Ink.BLUE),
        Curve(*_seen(_ellipse(alone)), Ink.FAINT, "robot alone", dashed=True),
    ]
    inks = 2 * (Ink.VERMILION, Ink.PURPLE, Ink.GREEN, Ink.ORANGE)
    for index, (module, ink) in enumerate(zip(design.ocs.modules, inks, strict=False)):
        end = reach * np.array(module.axis[:2])
        line = _seen(np.stack([-end, end], axis=1))
        marks.append(
            Curve(*line, ink, f"axis of {part_name('wheel', module.name)}", dashed=index % 2 == 1)
        )
    seen = f"of the layout {str(design.ocs.layout)!r}"
    if design.ocs.axes == PAIR:
        # Arc from the lateral direction to the axis at alpha*.
        marks.append(
            Curve(*_seen(0.5 * reach * np.stack([np.sin(arc), np.cos(arc)])), Ink.PLAIN, thin=True)
        )
        seen = f"at α* = {degrees(design.ocs.incidence)}"
    return Chart(
        name="inertia_ellipsoid",
        title=f"Inertia from above, wheel axes {seen}",
        description="Ellipse whose half axes are the principal inertias in the horizontal plane, "
        f"forward is up and left is left, with the spin axes of the wheels {seen} (α*: angle to "
        "the lateral direction).",
        x=Axis("inertia, lateral direction", "kg m²", -reach, reach),
        y=Axis("inertia, forward", "kg m²", -reach, reach),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def _ellipse(inertia: FloatArray) -> FloatArray:
    """Points of the ellipse in B, forward and left, shape (2, n)."""
    values, axes = np.linalg.eigh(inertia)
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    return np.asarray(axes @ (values[:, None] * np.stack([np.cos(angle), np.sin(angle)])))


def _seen(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Chart coordinates of points in B: forward is up, left is left."""
    return -points[1], points[0]


def momentum_chart(story: Story) -> Chart:
    """Momentum envelope of the wheels, and the momenta of the maneuvers.

    The envelope of n wheels is the zonotope of their axes; for a pair it is the rhombus
    `|L_x| / sin a + |L_y| / cos a <= 2 I_w w_max` (docs/theory.md, Incidence angle). There is one
    for each incidence at which a maneuver is flown.
    """
    ocs, found = story.design.ocs, taken(story)
    each_wheel = ocs.spin_inertia * story.design.requirement.wheel_speed_max
    incidences = dict.fromkeys([ocs.incidence, *(each.incidence for each in found)])
    marks: list[Mark] = []
    for incidence, dashed in zip(incidences, (False, True, True, True), strict=False):
        x, y = _zonotope(each_wheel * ocs.axes.axes(incidence)[:2])
        name = f"reach at {degrees(incidence)}" if incidence or ocs.axes == PAIR else "reach"
        marks += [FilledArea(x, y, Ink.FAINT), Curve(x, y, Ink.FAINT, name, dashed=dashed)]
    for each, ink in zip(found, SERIES * 2, strict=False):
        roll, pitch = each.path.T
        most = int(np.argmax(np.hypot(roll, pitch)))
        # The path, and a ring at its largest momentum.
        marks.append(Curve(roll, pitch, ink, each.source))
        marks.append(Points(roll[most : most + 1], pitch[most : most + 1], ink, hollow=True))
    largest = len(ocs.modules) * each_wheel
    reach = 1.15 * max([largest, *(each.largest(axis) for each in found for axis in (0, 1))])
    return Chart(
        name="momentum",
        title="Wheel momentum: capacity and use",
        description="Outline of the roll and pitch momenta that the wheels can hold together at "
        "top speed, and the momenta of each maneuver up to where it is judged.",
        x=Axis("roll momentum", "N m s", -reach, reach),
        y=Axis("pitch momentum", "N m s", -reach, reach),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def _zonotope(sides: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Closed outline, shapes (2 n + 1,), of all sums of the columns, shape (2, n), times -1..1."""
    upwards = sides * np.where(sides[1] < 0.0, -1.0, 1.0)
    turned = upwards[:, np.argsort(np.arctan2(upwards[1], upwards[0]))]
    steps = 2.0 * np.concatenate([turned, -turned], axis=1)
    corners = np.cumsum(steps, axis=1) - turned.sum(axis=1)[:, None]
    return np.append(corners[0], corners[0, 0]), np.append(corners[1], corners[1, 0])


def bound_charts(story: Story) -> Iterator[Chart]:
    """Lower bound on the device's inertia, and the design, for each axis (paper, figure 2)."""
    found, design = taken(story), story.design
    speeds = [part * design.requirement.wheel_speed_max for part in _SPEEDS]
    for axis, name in reversed(list(enumerate(AXES))):
        # Name, equivalent change of rate and device inertia of each maneuver, without those that
        # hardly turn about this axis.
        asked = []
        most = max((each.largest(axis) for each in found), default=0.0)
        for each in found:
            momentum = each.largest(axis)
            share = float(np.abs(design.ocs.axes.axes(each.incidence)[axis]).sum())
            if momentum > _NEGLIGIBLE_MOMENTUM * max(most, each.largest(1 - axis)) and share > 0.0:
                change = momentum / design.ocs.total_inertia[axis][axis]
                asked.append((each.source, change, share * design.ocs.spin_inertia))
        if not asked:
            continue
        changes = np.array([change for _, change, _ in asked])
        present = np.array([inertia for _, _, inertia in asked])
        rates = np.linspace(1e-3, 1.25 * changes.max(), _SAMPLES)
        bound = design.robot.inertia[axis][axis] * bound_curve(rates, speeds)
        curves = np.where(np.isfinite(bound), bound, np.nan)
        lines = [
            # The curve of the design's own speed is solid.
            Curve(rates, curve, ink, rpm(speed), dashed=part != 1.0)
            for part, speed, curve, ink in zip(_SPEEDS, speeds, curves, SERIES, strict=False)
        ]
        # Closer to zero the curves fall without limit.
        least = min(float(line.y[int(0.15 * len(line.y))]) for line in lines)
        ends = (0.3 * min(least, present.min()), 3.0 * max(present.max(), lines[1].y[-1]))
        labels = tuple(source for source, _, _ in asked)
        yield Chart(
            name=f"bound_{name}",
            title=f"Lower bound on the device's inertia, {name}",
            description=f"Inertia that the wheels must present about {name} against the change of "
            "rate, one curve for each top wheel speed, and the design's inertia at the change of "
            "rate that corresponds to each maneuver's momentum. A point above the solid curve "
            "(the design's wheel speed) has a margin.",
            x=Axis("change of rate", "rad/s", 0.0, float(rates[-1])),
            y=Axis("inertia required", "kg m²", float(ends[0]), float(ends[1]), log=True),
            marks=(*lines, Points(changes, present, Ink.PLAIN, "the design", labels=labels)),
            height=290.0,
        )


_ROW, _FRAME = 22.0, 110.0
"""Height of a row, and of the margins around all rows [px]."""


def criterion_chart(design: OcsDesign) -> Chart:
    """Best incidence under each criterion, with the device and for the robot alone."""
    found, alone = (
        design.ocs.incidence_by_criterion,
        design.ocs.incidence_by_criterion_robot_alone,
    )
    known = [(row, alone[name]) for row, name in enumerate(found) if name in alone]
    return _rows(
        design,
        "incidence_criterion",
        "Incidence angle by criterion",
        "The best incidence angle under each criterion, with the device and for the robot alone.",
        rows=tuple(found),
        angles={"robot alone": known, "with the device": list(enumerate(found.values()))},
    )


def posture_chart(design: OcsDesign, postures: Sequence[PostureLine]) -> Chart:
    """Best incidence under the paper's criterion for other postures of the robot alone."""
    angles = [(row, each.incidence) for row, each in enumerate(postures)]
    return _rows(
        design,
        "incidence_posture",
        "Incidence angle by posture",
        "Incidence angle of the paper's criterion, the arctangent of roll over pitch inertia, in "
        "several postures of the robot without the device.",
        rows=tuple(each.posture for each in postures),
        angles={"equal-rate, robot alone": angles},
    )


def _rows(
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
    for index, (what, found) in enumerate(angles.items(), start=1):
        places = np.array([float(row) for row, _ in found])
        turned = in_unit(np.array([angle for _, angle in found]), "deg")
        marks.append(Points(turned, places, Ink.BLUE, what, hollow=index < len(angles)))
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
