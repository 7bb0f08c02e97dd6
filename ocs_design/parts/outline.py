"""Closed outlines of straight lines and circular arcs in a plane, and their exact area moments."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import atan, cos, pi, sin, tan

import numpy as np

from ocs_design.arrays import FloatArray, frozen


@dataclass(frozen=True, eq=False)
class AreaMoments:
    """Integrals over a plane region.

    Attributes:
        area: [m^2].
        first: of the position [m^3], shape (2,).
        second: of the position times itself [m^4], shape (2, 2).
    """

    area: float
    first: FloatArray
    second: FloatArray

    def __add__(self, other: "AreaMoments") -> "AreaMoments":
        return AreaMoments(
            self.area + other.area, self.first + other.first, self.second + other.second
        )

    def shifted(self, offset: FloatArray) -> "AreaMoments":
        """Of the region moved by `offset` (parallel axes)."""
        cross = np.outer(offset, self.first)
        second = self.second + cross + cross.T + self.area * np.outer(offset, offset)
        return AreaMoments(self.area, self.first + self.area * offset, second)


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed curve that does not cross itself, counter-clockwise.

    Attributes:
        points: where its lines and arcs meet [m], shape (n, 2).
        bulges: of the edge from each point to the next, the tangent of a quarter of its angle as in
            DXF: 0 for a line, 1 for half a circle, negative where it turns clockwise, shape (n,).
            Arcs flatter than 0.01 lose digits to their far centres.
    """

    points: FloatArray
    bulges: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", frozen(self.points))
        object.__setattr__(self, "bulges", frozen(self.bulges))

    def edges(self) -> Iterator[tuple[FloatArray, FloatArray, float]]:
        """Start, end and bulge of each edge."""
        ends = np.roll(self.points, -1, axis=0)
        return zip(self.points, ends, self.bulges.tolist(), strict=True)

    def moments(self) -> AreaMoments:
        """About the origin: triangles to the origin, and what arcs enclose beyond their chords."""
        total = AreaMoments(0.0, np.zeros(2), np.zeros((2, 2)))
        for start, end, bulge in self.edges():
            total = total + _triangle(start, end)
            if bulge != 0.0:
                total = total + _segment(Arc.of(start, end, bulge))
        return total


@dataclass(frozen=True, eq=False)
class Arc:
    """A circular arc.

    Attributes:
        centre: [m], shape (2,).
        radius: [m]; negative where the arc runs clockwise.
        outward: unit vector to the right of its chord, shape (2,).
        half_angle: [rad]; negative where it runs clockwise.
    """

    centre: FloatArray
    radius: float
    outward: FloatArray
    half_angle: float

    @classmethod
    def of(cls, start: FloatArray, end: FloatArray, bulge: float) -> "Arc":
        """The arc that an edge of an outline stands for."""
        chord = end - start
        length = float(np.hypot(*chord))
        half_angle = 2.0 * atan(bulge)
        radius = length / (2.0 * sin(half_angle))
        outward = np.array([chord[1], -chord[0]]) / length
        centre = (start + end) / 2.0 - outward * radius * cos(half_angle)
        return cls(centre, radius, outward, half_angle)

    def points(self, angles: FloatArray, radius: float) -> FloatArray:
        """At these angles from its middle [rad], on a concentric arc [m], shape (n, 2)."""
        along = np.array([-self.outward[1], self.outward[0]])
        ring = np.outer(np.cos(angles), self.outward) + np.outer(np.sin(angles), along)
        return np.asarray(self.centre + radius * ring)


def circle(radius: float, centre: Sequence[float] = (0.0, 0.0)) -> Outline:
    """A full circle [m]."""
    x, y = centre
    return Outline(np.array([[x + radius, y], [x - radius, y]]), np.ones(2))


def polygon(points: Sequence[Sequence[float]]) -> Outline:
    """Straight lines between points, counter-clockwise [m]."""
    return Outline(np.array(points), np.zeros(len(points)))


def rectangle(left: float, right: float, bottom: float, top: float) -> Outline:
    """Parallel to the axes [m]."""
    return polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def arc_slot(radius: float, width: float, start: float, stop: float) -> Outline:
    """What a cutter of diameter `width` leaves on its way around the origin.

    Args:
        radius: of the path of the cutter's centre [m].
        width: [m].
        start, stop: angles of the path's ends [rad], less than a full turn apart.
    """
    inner, outer = radius - width / 2.0, radius + width / 2.0
    turns = [(outer, start), (outer, stop), (inner, stop), (inner, start)]
    points = [(distance * cos(angle), distance * sin(angle)) for distance, angle in turns]
    quarter = tan((stop - start) / 4.0)
    return Outline(np.array(points), np.array([quarter, 1.0, -quarter, 1.0]))


def ring_of_points(radius: float, count: int, first: float = -pi / 2.0) -> FloatArray:
    """Evenly spaced around the origin, the first at the angle `first` [rad], shape (count, 2)."""
    angles = first + 2.0 * pi * np.arange(count) / count
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def _triangle(start: FloatArray, end: FloatArray) -> AreaMoments:
    """Of the triangle with a corner at the origin: m/12 (s s' + e e' + (s + e)(s + e)')."""
    area = float(start[0] * end[1] - start[1] * end[0]) / 2.0
    both = start + end
    squares = np.outer(start, start) + np.outer(end, end) + np.outer(both, both)
    return AreaMoments(area, area * both / 3.0, area * squares / 12.0)


def _segment(arc: Arc) -> AreaMoments:
    """Between an arc of half angle p and its chord: a sector less a triangle.

    About the centre, with u towards the arc: area rho^2 (p - sin p cos p), first moment
    2/3 rho^3 sin^3 p, second ones rho^4/4 (p + sin p cos p - 2 sin p cos^3 p) along u and
    rho^4/4 (p - sin p cos p - 2/3 sin^3 p cos p) across it. All are odd in p.
    """
    p, rho, u = arc.half_angle, arc.radius, arc.outward
    s, c = sin(p), cos(p)
    along = p + s * c - 2.0 * s * c**3
    across = p - s * c - 2.0 / 3.0 * s**3 * c
    towards = np.outer(u, u)
    second = rho**4 / 4.0 * (along * towards + across * (np.eye(2) - towards))
    own = AreaMoments(rho**2 * (p - s * c), 2.0 / 3.0 * (rho * s) ** 3 * u, second)
    return own.shifted(arc.centre)
