"""Closed outlines of straight lines and circular arcs, and polygons of equal area."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from math import atan, ceil, cos, pi, sin, sqrt

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen

SECTIONS = 256
"""Chords per full circle: 1.4 degrees each."""

LARGE_RADIUS = 0.04
"""Least radius of arcs that get the full number of chords [m]: corners are 2 um off."""

LEAST_SECTIONS = 8
"""Fewest chords per full circle."""


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed curve that does not cross itself, counter-clockwise.

    Attributes:
        points: where its lines and arcs meet [m], shape (n, 2).
        bulges: of the edge from each point to the next, the tangent of a quarter of its angle as in
            DXF: 0 for a line, 1 for half a circle, negative if it turns clockwise, shape (n,).
            Bulges below 0.01 lose digits, as the centre of the arc is far away.
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

    def turned(self, angle: float) -> "Outline":
        """The outline turned around the origin [rad]."""
        if angle == 0.0:
            return self
        c, s = cos(angle), sin(angle)
        return Outline(self.points @ np.array([[c, s], [-s, c]]), self.bulges)


@dataclass(frozen=True, eq=False)
class Arc:
    """A circular arc.

    Attributes:
        centre: [m], shape (2,).
        radius: [m]; negative if the arc runs clockwise.
        outward: unit vector to the right of its chord, shape (2,).
        half_angle: [rad]; negative if the arc runs clockwise.
    """

    centre: FloatArray
    radius: float
    outward: FloatArray
    half_angle: float

    @classmethod
    def of(cls, start: FloatArray, end: FloatArray, bulge: float) -> "Arc":
        """The arc of an outline's edge."""
        chord = end - start
        length = float(np.hypot(*chord))
        half_angle = 2.0 * atan(bulge)
        radius = length / (2.0 * sin(half_angle))
        outward = np.array([chord[1], -chord[0]]) / length
        centre = (start + end) / 2.0 - outward * radius * cos(half_angle)
        return cls(centre, radius, outward, half_angle)

    def points(self, angles: FloatArray, radius: float) -> FloatArray:
        """Points at these angles from its middle [rad], on a concentric arc [m], shape (n, 2)."""
        along = np.array([-self.outward[1], self.outward[0]])
        ring = np.outer(np.cos(angles), self.outward) + np.outer(np.sin(angles), along)
        return np.asarray(self.centre + radius * ring)


def circle_radius_factor(sections: int) -> float:
    """Ratio of a polygon's circumradius to the radius of a circle of equal area.

    `sqrt(x / sin x)`, `x = 2 pi / n`. Areas are exact; the polar moment is that of the circle times
    `x (2 + cos x) / (3 sin x)`, about `1 + x^4 / 180`: 2e-9 more with 256 sections.
    """
    step = 2.0 * pi / sections
    return sqrt(step / sin(step))


def arc_sections(radius: float, sections: int) -> int:
    """Number of sections of a full circle of this radius [m].

    Corners are `radius x^2 / 12` outside their arcs, `x = 2 pi / n`. The number grows with the
    square root of the radius up to `LARGE_RADIUS`, so that small holes are no finer than necessary.
    """
    return max(LEAST_SECTIONS, ceil(sections * sqrt(min(1.0, abs(radius) / LARGE_RADIUS))))


def flat_outline(outline: Outline, sections: int = SECTIONS) -> FloatArray:
    """Corners of a polygon with the outline's area [m], shape (n, 2)."""
    if len(outline.points) == 2 and bool(np.all(outline.bulges == 1.0)):
        start, end = outline.points
        radius = float(np.hypot(*(end - start))) / 2.0
        count = arc_sections(radius, sections)
        ring = ring_points(2.0 * pi * np.arange(count) / count)
        return np.asarray((start + end) / 2.0 + radius * circle_radius_factor(count) * ring)
    corners = []
    for start, end, bulge in outline.edges():
        corners.append(start[None])
        if bulge != 0.0:
            # Both ends stay, and the corners between them move outwards until the area equals that
            # of the arc. With m chords of angle d, the radius rho, and corners at k rho:
            # (m - 2) k^2 sin d + 2 k sin d = m d.
            arc = Arc.of(start, end, bulge)
            chords = max(2, ceil(abs(arc.half_angle) * arc_sections(arc.radius, sections) / pi))
            step = 2.0 * arc.half_angle / chords
            target = chords * step / sin(step)
            factor = target / (1.0 + sqrt(1.0 + (chords - 2.0) * target))
            angles = frozen(step * np.arange(1, chords) - arc.half_angle)
            corners.append(arc.points(angles, factor * arc.radius))
    return np.concatenate(corners)


@lru_cache(maxsize=64)
def even_points(inner: float, outer: float, rings: int, around: int) -> FloatArray:
    """Points for equal shares of a ring's area about the origin [m], shape (rings * around, 2).

    Args:
        inner, outer: its radii [m]. rings, around: number of points along the radius and around.
    """
    radii = np.sqrt(inner**2 + (np.arange(rings) + 0.5) / rings * (outer**2 - inner**2))
    angles = (np.arange(around) + 0.5) * 2.0 * pi / around
    return frozen((radii[:, None, None] * ring_points(angles)).reshape(-1, 2))


def ring_points(angles: FloatArray) -> FloatArray:
    """Points of the unit circle at these angles [rad], shape (n, 2)."""
    return np.column_stack([np.cos(angles), np.sin(angles)])
