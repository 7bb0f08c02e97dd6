"""Area moments of any outline by Green's theorem: an oracle for closed forms of shapes."""

from math import cos, sin

import numpy as np

from ocs_design.parts.outline import Arc


def area_moments(outline):
    """Area, first moments, shape (2,), and second ones about the origin, shape (2, 2).

    Sums triangles to the origin and the segments between arcs and chords.
    """
    total = np.zeros(7)
    for start, end, bulge in outline.edges():
        total += triangle_moments(start, end)
        if bulge != 0.0:
            total += segment_moments(Arc.of(start, end, bulge))
    return total[0], total[1:3], total[3:].reshape(2, 2)


def as_area_moments(moments):
    """Area, first and second moments in the same form, from a shape's own moments."""
    second = [[moments.xx, moments.xy], [moments.xy, moments.yy]]
    return moments.mass, np.array([moments.x, moments.y]), np.array(second)


def triangle_moments(start, end):
    """Moments of a triangle with a corner at the origin: m/12 (s s' + e e' + (s + e)(s + e)')."""
    area = (start[0] * end[1] - start[1] * end[0]) / 2.0
    both = start + end
    squares = np.outer(start, start) + np.outer(end, end) + np.outer(both, both)
    return np.concatenate([[area], area * both / 3.0, (area * squares / 12.0).ravel()])


def segment_moments(arc):
    """Moments between an arc of half angle p and its chord: a sector less a triangle.

    About the centre, with u towards the arc: area rho^2 (p - sin p cos p), first moment
    2/3 rho^3 sin^3 p, second ones rho^4/4 (p + sin p cos p - 2 sin p cos^3 p) along u and
    rho^4/4 (p - sin p cos p - 2/3 sin^3 p cos p) across it. All are odd in p.
    """
    p, rho, u, centre = arc.half_angle, arc.radius, arc.outward, arc.centre
    s, c = sin(p), cos(p)
    area, first = rho**2 * (p - s * c), 2.0 / 3.0 * (rho * s) ** 3 * u
    along = p + s * c - 2.0 * s * c**3
    across = p - s * c - 2.0 / 3.0 * s**3 * c
    towards = np.outer(u, u)
    second = rho**4 / 4.0 * (along * towards + across * (np.eye(2) - towards))
    cross = np.outer(centre, first)
    second = second + cross + cross.T + area * np.outer(centre, centre)
    return np.concatenate([[area], first + area * centre, second.ravel()])
