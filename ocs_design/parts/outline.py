"""Closed outlines of straight lines and circular arcs in a plane, as they are drawn."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan, cos, sin

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen


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
        """Points at these angles from its middle [rad], on a concentric arc [m], shape (n, 2)."""
        along = np.array([-self.outward[1], self.outward[0]])
        ring = np.outer(np.cos(angles), self.outward) + np.outer(np.sin(angles), along)
        return np.asarray(self.centre + radius * ring)
