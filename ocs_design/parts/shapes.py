"""Flat shapes: their outlines, and their exact areas and moments.

Sizes of a shape to be drawn are numbers. If it is only weighed, they may be arrays or CasADi
symbols, since its figures use operators only. Moments are those of a plate of unit density in the
plane z = 0, about the origin: area [m^2], first [m^3] and second moments [m^4].
"""

from dataclasses import dataclass
from functools import cached_property
from math import asin, cos, pi, sin, tan
from typing import Any, Generic

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.moments import MassMoments, Real, product
from ocs_design.parts.outline import Outline

EAR_COUNT = 4
"""Number of ears around a band."""


@dataclass(frozen=True, eq=False)
class Disc(Generic[Real]):
    """A full disc.

    Attributes:
        radius: [m].
        centre: x and y [m].
    """

    radius: Real
    centre: tuple[Real | float, Real | float] = (0.0, 0.0)

    @property
    def area(self) -> Real:
        """Area pi r^2 [m^2]."""
        return pi * self.radius**2

    @property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density."""
        (x, y), area, own = self.centre, self.area, self.radius**2 / 4.0
        xx, yy, xy = area * (own + x**2), area * (own + y**2), product(x, area * y)
        return flat(area, xx, yy, x=product(x, area), y=product(y, area), xy=xy)

    def outline(self) -> Outline:
        """Two half circles."""
        x, y = self.centre
        return Outline(np.array([[x + self.radius, y], [x - self.radius, y]]), np.ones(2))


@dataclass(frozen=True, eq=False)
class Rectangle(Generic[Real]):
    """A rectangle parallel to the axes, between these coordinates [m]."""

    left: Real
    right: Real
    bottom: float
    top: float

    @property
    def area(self) -> Real:
        """Width times height [m^2]."""
        return (self.right - self.left) * (self.top - self.bottom)

    @property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density."""
        x, y = (self.left + self.right) / 2.0, (self.bottom + self.top) / 2.0
        across, tall = self.right - self.left, self.top - self.bottom
        area = self.area
        xx, yy = area * (x**2 + across**2 / 12.0), area * (y**2 + tall**2 / 12.0)
        return flat(area, xx, yy, x=area * x, y=area * y, xy=area * x * y)

    def outline(self) -> Outline:
        """Four lines."""
        left, right, bottom, top = self.left, self.right, self.bottom, self.top
        corners = [[left, bottom], [right, bottom], [right, top], [left, top]]
        return Outline(np.array(corners), np.zeros(4))


@dataclass(frozen=True, eq=False)
class Polygon(Generic[Real]):
    """A polygon that does not cross itself.

    Attributes:
        corners: x and y of each, counter-clockwise [m].
    """

    corners: tuple[tuple[Real | float, Real | float], ...]

    @property
    def area(self) -> Real:
        """Area by Green's theorem [m^2]."""
        area: Real = self.moments.mass
        return area

    @property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density: sum over triangles from it to each edge."""
        sums: list[Any] = [0.0] * 6
        for (a, b), (c, d) in zip(self.corners, self.corners[1:] + self.corners[:1], strict=True):
            twice: Any = a * d - c * b
            terms = (
                twice / 2.0,
                twice * (a + c) / 6.0,
                twice * (b + d) / 6.0,
                twice * (a**2 + a * c + c**2) / 12.0,
                twice * (b**2 + b * d + d**2) / 12.0,
                twice * (a * d + 2.0 * a * b + 2.0 * c * d + c * b) / 24.0,
            )
            sums = [one + other for one, other in zip(sums, terms, strict=True)]
        area, x, y, xx, yy, xy = sums
        return flat(area, xx, yy, x=x, y=y, xy=xy)

    def outline(self) -> Outline:
        """The corners in order, joined by straight lines."""
        return Outline(np.array(self.corners), np.zeros(len(self.corners)))


@dataclass(frozen=True, eq=False)
class ArcSlot(Generic[Real]):
    """Slot cut by a tool of diameter `width` on its path around the origin.

    Attributes:
        radius: of the path of the cutter's centre [m].
        width: [m].
        start, stop: angles of the path's ends [rad], less than a full turn apart.
    """

    radius: Real
    width: float
    start: float
    stop: float

    @property
    def area(self) -> Real:
        """Width times the path of its middle, plus half a disc at each end [m^2]."""
        return (self.stop - self.start) * self.width * self.radius + pi / 4.0 * self.width**2

    @property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density.

        A sector of a ring with half discs at its ends, whose centroids are 4 q / (3 pi) from their
        flat sides: along the middle of the path (u) and across it (v), then turned.
        """
        rho, q, a = self.radius, self.width / 2.0, (self.stop - self.start) / 2.0
        s, c = sin(a), cos(a)
        fourth = ((rho + q) ** 4 - (rho - q) ** 4) / 4.0
        third = ((rho + q) ** 3 - (rho - q) ** 3) / 3.0
        half, beyond = pi * q**2 / 2.0, 2.0 / 3.0 * q**3
        radial, round_, both = half * (q**2 / 4.0 + rho**2), half * q**2 / 4.0, rho * beyond
        u = 2.0 * (third * s + half * c * rho - beyond * s)
        uu = fourth * (a + s * c) + 2.0 * (radial * c**2 + round_ * s**2 - 2.0 * both * s * c)
        vv = fourth * (a - s * c) + 2.0 * (radial * s**2 + round_ * c**2 + 2.0 * both * s * c)
        x, y = cos((self.start + self.stop) / 2.0), sin((self.start + self.stop) / 2.0)
        xx, yy = uu * x**2 + vv * y**2, uu * y**2 + vv * x**2
        return flat(self.area, xx, yy, x=u * x, y=u * y, xy=(uu - vv) * x * y)

    def outline(self) -> Outline:
        """Four arcs, the inner one clockwise."""
        inner, outer = self.radius - self.width / 2.0, self.radius + self.width / 2.0
        turns = [(outer, self.start), (outer, self.stop), (inner, self.stop), (inner, self.start)]
        points = [(distance * cos(angle), distance * sin(angle)) for distance, angle in turns]
        quarter = tan((self.stop - self.start) / 4.0)
        return Outline(np.array(points), np.array([quarter, 1.0, -quarter, 1.0]))


class _Stemmed(Generic[Real]):
    """A disc with stems: `radius` of the disc, `side` half of a stem's width [m]."""

    radius: Real
    side: Real | float

    @cached_property
    def _root(self) -> Real:
        """Distance of a stem's root from the disc's middle, along it [m]."""
        root: Real = (self.radius**2 - self.side**2) ** 0.5
        return root

    @cached_property
    def _beside(self) -> Real:
        """Half of the angle of the disc that a stem covers [rad]."""
        return arcsine(self.side / self.radius)


@dataclass(frozen=True, eq=False)
class Keyhole(_Stemmed[Real]):
    """A disc on the y axis, and a stem from it towards higher y.

    Attributes:
        radius: of the disc [m].
        side: half of the stem's width, less than the radius [m].
        low, high: y of the disc's middle, and of the stem's end outside the disc [m].
    """

    radius: Real
    side: Real
    low: Real
    high: Real

    @cached_property
    def area(self) -> Real:
        """Area of a sector, the triangle under the stem and the stem's rectangle [m^2]."""
        sector = self.radius**2 * (pi - self._beside)
        area: Real = sector + self.side * (2.0 * (self.high - self.low) - self._root)
        return area

    @cached_property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density, computed about the disc's middle first."""
        r, s, root, end = self.radius, self.side, self._root, self.high - self.low
        # The part missing from the full disc has its centroid 2 r sin(b) / (3 b) off the middle.
        y = s * (end**2 - root**2 / 3.0 - 2.0 / 3.0 * r**2)
        sector, aslant = r**4 / 4.0 * (pi - self._beside), r**2 * s * root / 4.0
        xx = sector + aslant + s**3 * (2.0 / 3.0 * end - root / 2.0)
        yy = sector - aslant + s * (2.0 / 3.0 * end**3 - root**3 / 6.0)
        return flat(self.area, xx, yy, y=y).moved(0.0, self.low, 0.0)

    def outline(self) -> Outline:
        """Three lines and most of a circle."""
        s, root, high = self.side, self.low + self._root, self.high
        points = [[s, root], [s, high], [-s, high], [-s, root]]
        around = tan((pi - asin(s / self.radius)) / 2.0)
        return Outline(np.array(points), np.array([0.0, 0.0, 0.0, around]))


@dataclass(frozen=True, eq=False)
class Eared(_Stemmed[Real]):
    """The disc of a band with its ears, which have straight sides and round ends.

    Attributes:
        radius: outer radius of the band [m].
        axis: distance of the centres of the ears' round ends from the middle [m].
        side: half of an ear's width [m].
        first: angle of the first ear [rad].
    """

    radius: Real
    axis: Real
    side: float
    first: float = 0.0

    @cached_property
    def area(self) -> Real:
        """Sectors, triangles under the ears, rectangles and half circles [m^2]."""
        sectors = self.radius**2 * (pi - EAR_COUNT * self._beside)
        ears = self.side * (2.0 * self.axis - self._root) + pi / 2.0 * self.side**2
        return sectors + EAR_COUNT * ears

    @cached_property
    def moments(self) -> MassMoments[Real]:
        """Moments of unit density; with four ears they are equal about every axis in the plane."""
        root, end, side = self._root, self.axis, self.side
        sectors = self.radius**4 * (pi - EAR_COUNT * self._beside) / 2.0
        triangle = side * root * (root**2 / 2.0 + side**2 / 6.0)
        rectangle = 2.0 / 3.0 * side * (end**3 - root**3 + side**2 * (end - root))
        tip = side**2 * (pi / 2.0 * end**2 + 4.0 / 3.0 * end * side + pi / 4.0 * side**2)
        across = (sectors + EAR_COUNT * (triangle + rectangle + tip)) / 2.0
        return flat(self.area, across, across)

    def outline(self) -> Outline:
        """Four ears, with an arc of the band between each and the next."""
        between = tan((pi / 2.0 / EAR_COUNT) - asin(self.side / self.radius) / 2.0)
        turns = 2.0 * pi * np.arange(EAR_COUNT) / EAR_COUNT
        ears = [Outline(self.ear(), np.zeros(4)).turned(self.first + turn) for turn in turns]
        bulges = np.tile([0.0, 1.0, 0.0, between], EAR_COUNT)
        return Outline(np.concatenate([ear.points for ear in ears]), bulges)

    def ear(self) -> FloatArray:
        """Corners of an ear on the x axis, from the band outwards and back [m], shape (4, 2)."""
        root, end, side = self._root, self.axis, self.side
        return np.array([[root, -side], [end, -side], [end, side], [root, side]])


@dataclass(frozen=True, eq=False)
class Post:
    """One of four ears, on the x axis, with its piece of the band.

    Attributes:
        eared: the band with all ears.
        bore: inner radius of the band [m].
        half_angle: of the piece around the axis, larger than that of the ear [rad].
    """

    eared: Eared[float]
    bore: float
    half_angle: float

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return self.moments.mass

    @property
    def moments(self) -> MassMoments[float]:
        """A quarter of the moments of all four, which are equal about every axis in the plane."""
        whole, disc = self.eared.moments, Disc(self.eared.radius).moments
        band = disc + Disc(self.bore).moments.times(-1.0)
        ears = (whole + disc.times(-1.0)).times(1.0 / EAR_COUNT)
        return ears + band.times(self.half_angle / pi)

    def outline(self) -> Outline:
        """An ear between two outer arcs of the band, and the band's inner arc."""
        corners = np.array([[cos(self.half_angle), y * sin(self.half_angle)] for y in (-1, 1)])
        outside, inside = self.eared.radius * corners, self.bore * corners
        points = np.concatenate([outside[:1], self.eared.ear(), outside[1:], inside[::-1]])
        beside = tan((self.half_angle - asin(self.eared.side / self.eared.radius)) / 4.0)
        back = -tan(self.half_angle / 2.0)
        return Outline(points, np.array([beside, 0.0, 1.0, 0.0, beside, 0.0, back, 0.0]))


def arcsine(sine: Real) -> Real:
    """Arcsine of numbers, arrays or CasADi symbols, which have a method of their own [rad]."""
    own: Any = getattr(sine, "arcsin", None)
    angle: Real = np.arcsin(sine) if own is None else own()
    return angle


def flat(
    area: Real,
    xx: Real,
    yy: Real,
    *,
    x: Real | float = 0.0,
    y: Real | float = 0.0,
    xy: Real | float = 0.0,
) -> MassMoments[Real]:
    """Moments of a region of the plane z = 0."""
    return MassMoments(area, y, 0.0, xx, yy, 0.0, 0.0, x=x, xy=xy)
