"""Solids with exact moments: prisms, bodies of revolution, reliefs; and parts made of them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from math import pi
from operator import add
from typing import Any, Generic, Protocol, TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.common.frames import Placement
from ocs_design.common.ranges import NotNegative, Signed
from ocs_design.parts.moments import MassMoments, Real, product
from ocs_design.parts.outline import Outline, even_points
from ocs_design.robot.mass import MassProperties, combine

ORIGIN = Placement.identity()

THREE_POINTS = tuple(map(frozen, np.polynomial.legendre.leggauss(3)))
"""Nodes and weights of three-point Gauss quadrature on [-1, 1]."""


class Region(Protocol[Real]):
    """A region of a plane."""

    @property
    def area(self) -> Real:
        """Area [m^2]."""

    @property
    def moments(self) -> MassMoments[Real]:
        """Moments about the origin, of unit density."""

    def outline(self) -> Outline:
        """The edge of a shape whose sizes are numbers."""


def placed(moments: MassMoments[Real], place: Placement) -> MassMoments[Real]:
    """Moments in the frame in which their own has this placement."""
    return moments.turned(place.rotation).moved(*place.position.tolist())


@dataclass(frozen=True, eq=False)
class Revolution:
    """A body of revolution about the z axis.

    Attributes:
        profile: r and z of its cross-section's corners [m], r >= 0, counter-clockwise with r to the
            right and z up, shape (n, 2).
    """

    profile: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "profile", frozen(self.profile))

    def each(self) -> Iterator["Revolution"]:
        """The solid itself, as a ring of prisms gives each of them."""
        yield self

    def volume(self) -> float:
        """Volume [m^3]."""
        return self.moments().mass

    def moments(self) -> MassMoments[float]:
        """Moments in the part's frame, of unit density, exact.

        Green's theorem turns the integrals over the cross-section into sums over its edges:
        V = pi o r^2 dz, z_c V = pi o r^2 z dz, and the second moments about the origin
        int z^2 dV = pi o r^2 z^2 dz and int x^2 dV = pi/4 o r^4 dz. Along a line they are
        polynomials of degree 4 at most, which three-point Gauss quadrature integrates exactly.
        """
        start, end = self.profile, np.roll(self.profile, -1, axis=0)
        nodes, weights = THREE_POINTS
        r, z = (start + (1.0 + nodes[:, None, None]) / 2.0 * (end - start)).transpose(2, 0, 1)
        dz = weights[:, None] / 2.0 * (end - start)[:, 1]
        volume, first, along, across = (
            pi * float(np.sum(integrand * dz))
            for integrand in (r**2, r**2 * z, r**2 * z**2, r**4 / 4.0)
        )
        return MassMoments(volume, 0.0, first, across, across, along, 0.0)


@dataclass(frozen=True, eq=False)
class Prism(Generic[Real]):
    """A shape extruded along the z axis of its own frame, or a ring of them around that axis.

    Attributes:
        shape: in the xy plane of that frame.
        low, high: its ends along z [m].
        placement: of that frame in the part's.
        count: of equal prisms, evenly spaced around the z axis.
        first: angle of the first of them around that axis [rad].
    """

    shape: Region[Real]
    low: Real | float
    high: Real | float
    placement: Placement = ORIGIN
    count: int = 1
    first: float = 0.0

    @property
    def outline(self) -> Outline:
        """Outline of the first prism; sizes must be numbers."""
        return self.shape.outline().turned(self.first)

    def each(self) -> Iterator["Prism[Any]"]:
        """Every single prism; sizes must be numbers."""
        for index in range(self.count):
            angle = self.first + 2.0 * pi * index / self.count
            yield replace(self, count=1, first=angle)

    def volume(self) -> Real:
        """Volume [m^3]."""
        return self.count * self.shape.area * (self.high - self.low)

    def moments(self) -> MassMoments[Real]:
        """Moments in the part's frame, of unit density, exact."""
        plane = self.shape.moments.around(self.count, self.first)
        length, middle = self.high - self.low, (self.high + self.low) / 2.0
        volume, lever = plane.mass * length, length * middle
        y, x, xy = (product(own, length) for own in (plane.y, plane.x, plane.xy))
        xx, yy, zz = plane.xx * length, plane.yy * length, volume * (middle**2 + length**2 / 12.0)
        yz, xz = product(plane.y, lever), product(plane.x, lever)
        own = MassMoments(volume, y, volume * middle, xx, yy, zz, yz, x, xy, xz)
        return own if self.placement is ORIGIN else placed(own, self.placement)


@dataclass(frozen=True, eq=False)
class Relief:
    """A block over a rectangle with an uneven upper face, and through holes.

    Each cell of the grid is two triangles, on both sides of the diagonal from its first corner.

    Attributes:
        left, right, bottom, top: ends of the rectangle along x and y [m].
        heights: of the upper face, positive, at the nodes of a regular grid along x and y [m],
            shape (m, n).
        holes: x, y and radius of each, through the block along z [m].
        placement: of its frame in the part's.
    """

    left: float
    right: float
    bottom: float
    top: float
    heights: FloatArray
    holes: tuple[tuple[float, float, float], ...] = ()
    placement: Placement = ORIGIN

    def __post_init__(self) -> None:
        object.__setattr__(self, "heights", frozen(self.heights))

    def each(self) -> Iterator["Relief"]:
        """The solid itself, as a ring of prisms gives each of them."""
        yield self

    @property
    def x(self) -> FloatArray:
        """Positions of the grid's nodes along x [m], shape (m,)."""
        return np.linspace(self.left, self.right, self.heights.shape[0])

    @property
    def y(self) -> FloatArray:
        """Positions of the grid's nodes along y [m], shape (n,)."""
        return np.linspace(self.bottom, self.top, self.heights.shape[1])

    def height(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights of the upper face at points of the rectangle [m]."""
        (m, n), cells = self.heights.shape, []
        for of, low, high, count in ((x, self.left, self.right, m), (y, self.bottom, self.top, n)):
            cell = (np.asarray(of) - low) / (high - low) * (count - 1)
            index = np.clip(np.floor(cell), 0, count - 2).astype(np.intp)
            cells.append((index, cell - index))
        (i, u), (j, v) = cells
        h = self.heights
        first, last = h[i, j], h[i + 1, j + 1]
        corner = np.where(u >= v, h[i + 1, j], h[i, j + 1])
        most, least = np.maximum(u, v), np.minimum(u, v)
        return np.asarray(first + most * (corner - first) + least * (last - corner))

    def volume(self) -> float:
        """Volume [m^3]."""
        return self.moments().mass

    def moments(self) -> MassMoments[float]:
        """Moments in the part's frame, of unit density, exact except for the holes.

        Over each triangle integrals over z leave polynomials of degree 3 at most, which four points
        integrate exactly (Strang and Fix). Holes are integrated approximately, with many points.
        """
        x, y, area = self._points()
        h = self.height(x, y)
        # The four points of a triangle are inside it, so rounding cannot move one to another.
        first, second, third = area * h, area * h**2 / 2.0, area * h**3 / 3.0
        # In the order of the fields.
        upright = first, first * y, second, first * x**2, first * y**2, third, second * y
        integrands = *upright, first * x, first * x * y, second * x
        own = MassMoments(*(float(integrand.sum()) for integrand in integrands))
        return placed(own, self.placement)

    def _points(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Quadrature points on the face minus its holes [m], and their weights as areas [m^2]."""
        xs, ys = self.x, self.y
        wide, tall = float(xs[1] - xs[0]), float(ys[1] - ys[0])
        share = np.array([[1.0, 1.0, 1.0], [1.8, 0.6, 0.6], [0.6, 1.8, 0.6], [0.6, 0.6, 1.8]]) / 3.0
        weight = np.array([-27.0, 25.0, 25.0, 25.0]) / 48.0 * wide * tall / 2.0
        points = []
        for corners in (((0, 0), (1, 0), (1, 1)), ((0, 0), (0, 1), (1, 1))):
            u, v = (share @ np.array(corners)).T
            grid = xs[:-1, None, None] + wide * u, ys[None, :-1, None] + tall * v, weight
            points.append(np.stack(np.broadcast_arrays(*grid)).reshape(3, -1))
        around = even_points(0.0, 1.0, 16, 64)
        for middle_x, middle_y, radius in self.holes:
            x, y = (radius * around + [middle_x, middle_y]).T
            points.append(np.stack([x, y, np.full(len(x), -pi * radius**2 / len(x))]))
        x, y, area = np.concatenate(points, axis=1)
        return x, y, area


Solid: TypeAlias = Revolution | Prism | Relief


def hollow_cylinder(inner: float, outer: float, low: float, high: float) -> Revolution:
    """A hollow cylinder about z, between two radii and two heights [m]; a disc if `inner` is 0."""
    return Revolution(np.array([[inner, low], [outer, low], [outer, high], [inner, high]]))


def revolved(corners: Iterable[Sequence[float]]) -> Revolution:
    """A body of revolution; corners equal to the previous one are left out."""
    points = np.array(list(corners))
    distinct = np.any(points != np.roll(points, 1, axis=0), axis=1)
    return Revolution(points[distinct])


@dataclass(frozen=True)
class Part(Generic[Real]):
    """One piece of one material: solids joined, minus solids cut out.

    With arrays for sizes it stands for many parts at once, to be weighed.

    Its mass is right only if the joined solids touch without overlapping, and the holes lie within
    them without overlapping. Code that makes a part must ensure this; tests compare the part with
    its mesh and its B-rep, which do not rely on it.

    Attributes:
        name: of the part, also in files.
        density: [kg/m^3].
        solids: at least one.
        holes: holes, slots, marks.
    """

    name: str
    density: float
    solids: tuple[Revolution | Prism[Real] | Relief, ...]
    holes: tuple[Prism[Real] | Revolution, ...] = ()

    @property
    def joined(self) -> tuple[Solid, ...]:
        """The solids of a drawn part, with those of rings one by one."""
        return tuple(one for solid in self.solids for one in solid.each())

    @property
    def cut(self) -> tuple[Revolution | Prism, ...]:
        """The solids cut out of a drawn part, one by one."""
        return tuple(one for solid in self.holes for one in solid.each())

    def mass(self) -> Real:
        """Mass in closed form [kg]."""
        whole: Any = sum(solid.volume() for solid in self.solids)
        mass: Real = self.density * (whole - sum(hole.volume() for hole in self.holes))
        return mass

    def moments(self) -> MassMoments[Real]:
        """Mass and its moments in the part's frame, in closed form."""
        whole: MassMoments[Any] = reduce(add, (solid.moments() for solid in self.solids))
        if self.holes:
            whole += reduce(add, (hole.moments() for hole in self.holes)).times(-1.0)
        return whole.times(self.density)

    def mass_properties(self) -> MassProperties:
        """Mass properties of one part in its own frame, in closed form."""
        moments: MassMoments[Any] = self.moments()
        com = np.array([moments.x, moments.y, moments.z]) / moments.mass
        about = np.array(moments.second) - moments.mass * np.outer(com, com)
        return MassProperties(float(moments.mass), com, np.trace(about) * np.eye(3) - about)


def total(parts: Iterable[Part[float]]) -> MassProperties:
    """Mass properties of parts that share one frame."""
    return combine(part.mass_properties() for part in parts)


@dataclass(frozen=True)
class Carrier:
    """Mass and inertia of a wheel, or of all stationary parts of a module, as one body.

    It is symmetric about the vertical plane through the wheel's axis. With only the mass and the
    first two inertias given it is a body of revolution at the wheel's centre.

    Attributes:
        mass: [kg].
        axial_inertia: about the axis through its centre of mass parallel to the wheel's, with the
            rotor locked [kg m^2].
        transverse_inertia: about the horizontal axis across it [kg m^2].
        vertical_inertia: about the vertical axis [kg m^2]; None: equal to `transverse_inertia`.
        product_of_inertia: entry yz of its inertia tensor, y along the wheel's axis away from the
            other module, z up [kg m^2].
        along, up: of its centre of mass from the wheel's centre [m]; negative: towards the other
            module, below the axis.
    """

    mass: NotNegative
    axial_inertia: NotNegative
    transverse_inertia: NotNegative
    vertical_inertia: NotNegative | None = None
    product_of_inertia: Signed = 0.0
    along: Signed = 0.0
    up: Signed = 0.0

    @classmethod
    def of(cls, moments: MassMoments[float]) -> "Carrier":
        """Carrier with these moments about the wheel's centre."""
        mass = moments.mass
        along, up = (moments.y / mass, moments.z / mass) if mass else (0.0, 0.0)
        xx, yy, zz = moments.xx, moments.yy - mass * along**2, moments.zz - mass * up**2
        # Axial, transverse and vertical, and their product.
        inertias = xx + zz, yy + zz, xx + yy, mass * along * up - moments.yz
        return cls(*map(float, (mass, *inertias, along, up)))

    @property
    def inertia(self) -> FloatArray:
        """Inertia about its centre of mass in the module's frame [kg m^2], shape (3, 3)."""
        across, upright = self.transverse_inertia, self.vertical_inertia
        tensor = np.diag([across, self.axial_inertia, across if upright is None else upright])
        tensor[1, 2] = tensor[2, 1] = self.product_of_inertia
        return tensor

    def mass_properties(self) -> MassProperties:
        """Mass properties in the module's frame."""
        return MassProperties(self.mass, np.array([0.0, self.along, self.up]), self.inertia)


NO_CARRIER = Carrier(mass=0.0, axial_inertia=0.0, transverse_inertia=0.0)
"""Carrier of the assumed motor, which is massless."""
