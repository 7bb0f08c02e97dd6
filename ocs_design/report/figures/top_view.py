"""What lies in the plane of the two wheel axes: the inertia's ellipse, the axes, the momenta."""

from collections.abc import Iterator

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design_file import OcsDesign
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import SERIES, Area, Ink, Line, Mark, Points
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.taken import Taken, taken
from ocs_design.report.quantities import degrees
from ocs_design.report.story import Story
from ocs_design.sizing.incidence import module_axes

_SIDE = 300.0


def ellipsoid_chart(design: OcsDesign) -> Chart:
    """The inertia's ellipse from above, with the wheel axes at alpha* (paper, figures 3 and 4).

    As in the paper, its half axes are the eigenvalues of the inertia in the horizontal plane.
    Forward is up, left is left.
    """
    total = np.array(design.ocs.total_inertia)[:2, :2]
    alone = np.array(design.robot.inertia)[:2, :2]
    reach = 1.15 * float(max(np.linalg.eigvalsh(total)[-1], np.linalg.eigvalsh(alone)[-1]))
    left, right = module_axes(design.ocs.incidence).T[:, :2] * reach
    marks: list[Mark] = [
        Area(*_seen(_ellipse(total)), Ink.BLUE, "robot with device"),
        Line(*_seen(_ellipse(total)), Ink.BLUE),
        Line(*_seen(_ellipse(alone)), Ink.FAINT, "robot alone", dashed=True),
        _axis_line(left, Ink.VERMILION, "axis of the left wheel"),
        _axis_line(right, Ink.PURPLE, "axis of the right wheel", dashed=True),
        _arc(design.ocs.incidence, 0.5 * reach),
    ]
    return Chart(
        name="inertia_ellipsoid",
        title=f"Inertia from above, wheel axes at α* = {degrees(design.ocs.incidence)}",
        description="Ellipse whose half axes are the principal inertias in the horizontal plane, "
        "forward is up and left is left, with the spin axes of both wheels at the incidence "
        f"angle of {degrees(design.ocs.incidence)} to the lateral direction.",
        x=Axis("inertia, lateral direction", "kg m²", -reach, reach),
        y=Axis("inertia, forward", "kg m²", -reach, reach),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def momentum_chart(story: Story) -> Chart:
    """Momenta that the wheels can take at once, and those that they took.

    The rhombus `|L_x| / sin a + |L_y| / cos a <= 2 I_w w_max` (docs/theory.md, Incidence angle),
    one for each incidence that a maneuver is flown at.
    """
    ocs, found = story.design.ocs, taken(story)
    largest = 2.0 * ocs.spin_inertia * story.design.requirement.wheel_speed_max
    incidences = dict.fromkeys([ocs.incidence, *(each.incidence for each in found)])
    marks: list[Mark] = []
    for incidence, dashed in zip(incidences, (False, True, True, True), strict=False):
        x, y = _rhombus(incidence, largest)
        name = f"reach at {degrees(incidence)}"
        marks += [Area(x, y, Ink.FAINT), Line(x, y, Ink.FAINT, name, dashed=dashed)]
    marks += [
        mark for each, ink in zip(found, SERIES * 2, strict=False) for mark in _path(each, ink)
    ]
    reach = 1.15 * max([largest, *(each.largest(axis) for each in found for axis in (0, 1))])
    return Chart(
        name="momentum",
        title="Momentum that the wheels can take, and took",
        description="Rhombus of roll and pitch momenta that both wheels take together at their "
        "highest speed, and the momenta that they took in each maneuver up to touchdown.",
        x=Axis("roll momentum", "N m s", -reach, reach),
        y=Axis("pitch momentum", "N m s", -reach, reach),
        marks=tuple(marks),
        equal=True,
        height=_SIDE,
    )


def _path(each: Taken, ink: Ink) -> Iterator[Mark]:
    """The way there, and a ring where it was most."""
    roll, pitch = each.path.T
    most = int(np.argmax(np.hypot(roll, pitch)))
    yield Line(roll, pitch, ink, each.source)
    yield Points(roll[most : most + 1], pitch[most : most + 1], ink, hollow=True)


def _rhombus(incidence: float, largest: float) -> tuple[FloatArray, FloatArray]:
    sine, cosine = largest * np.sin(incidence), largest * np.cos(incidence)
    return np.array([sine, 0.0, -sine, 0.0, sine]), np.array([0.0, cosine, 0.0, -cosine, 0.0])


def _ellipse(inertia: FloatArray) -> FloatArray:
    """Points in B, forward and left, shape (2, n)."""
    values, axes = np.linalg.eigh(inertia)
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    return np.asarray(axes @ (values[:, None] * np.stack([np.cos(angle), np.sin(angle)])))


def _seen(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Forward up and left to the left on the sheet, from coordinates in B."""
    return -points[1], points[0]


def _axis_line(end: FloatArray, ink: Ink, name: str, *, dashed: bool = False) -> Line:
    return Line(*_seen(np.stack([-end, end], axis=1)), ink, name, dashed=dashed)


def _arc(incidence: float, radius: float) -> Line:
    """From the lateral direction to the left wheel's axis."""
    angle = np.linspace(0.0, incidence, 40)
    return Line(*_seen(radius * np.stack([np.sin(angle), np.cos(angle)])), Ink.PLAIN, thin=True)
