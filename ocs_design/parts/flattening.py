"""Outlines as polygons of the same area."""

from math import ceil, pi, sin, sqrt

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.parts.outline import Arc, Outline

SECTIONS = 256
"""Chords of a full circle: 1.4 degrees each."""

LARGE_RADIUS = 0.04
"""Least radius of arcs with as many chords as bodies of revolution [m]: corners are 2 um off."""

LEAST_SECTIONS = 8
"""Fewest chords of a full circle."""


def circle_radius_factor(sections: int) -> float:
    """How much larger than the circle a polygon's must be for the circle's own area.

    `sqrt(x / sin x)`, `x = 2 pi / n`. Areas are exact; the polar moment is that of the circle times
    `x (2 + cos x) / (3 sin x)`, about `1 + x^4 / 180`: 2e-9 more with 256 sections.
    """
    step = 2.0 * pi / sections
    return sqrt(step / sin(step))


def arc_sections(radius: float, sections: int) -> int:
    """Sections of a full circle of that radius [m].

    Corners are `radius x^2 / 12` outside their arcs, `x = 2 pi / n`; the number grows with the root
    of the radius up to `LARGE_RADIUS`, so that small holes are no finer than they need to be.
    """
    return max(LEAST_SECTIONS, ceil(sections * sqrt(min(1.0, abs(radius) / LARGE_RADIUS))))


def flat_outline(outline: Outline, sections: int = SECTIONS) -> FloatArray:
    """A polygon of the outline's own area, its corners [m], shape (n, 2)."""
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
            # Both ends stay, and the corners between them move out for the arc's own area. With m
            # chords of the angle d and the radius rho, those in between at k rho:
            # (m - 2) k^2 sin d + 2 k sin d = m d.
            arc = Arc.of(start, end, bulge)
            chords = max(2, ceil(abs(arc.half_angle) * arc_sections(arc.radius, sections) / pi))
            step = 2.0 * arc.half_angle / chords
            target = chords * step / sin(step)
            factor = target / (1.0 + sqrt(1.0 + (chords - 2.0) * target))
            angles = frozen(step * np.arange(1, chords) - arc.half_angle)
            corners.append(arc.points(angles, factor * arc.radius))
    return np.concatenate(corners)


def ring_points(angles: FloatArray) -> FloatArray:
    """Points of the unit circle at these angles [rad], shape (n, 2)."""
    return np.column_stack([np.cos(angles), np.sin(angles)])
