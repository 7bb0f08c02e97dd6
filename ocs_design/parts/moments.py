"""Mass with its first and second moments, which are additive: of one body, or of many as arrays.

The origin of a module's frame is the wheel's centre: x forward across the wheel's axis, y along it
away from the other module, z up. Both modules are symmetric about their yz planes, and each is the
other turned about the vertical: left and right are the same parts.

Everything uses operators only, and so works for numbers, arrays and CasADi symbols.
"""

from dataclasses import dataclass, replace
from math import cos, sin
from typing import TYPE_CHECKING, Generic

import numpy as np

from ocs_design.common.arrays import FloatArray, Table

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    Real = TypeVar("Real", float, FloatArray, default=float)
else:
    # Python 3.13's own has defaults: a `Part` is a `Part[float]`.
    from typing import TypeVar

    Real = TypeVar("Real", float, FloatArray)


@dataclass(frozen=True, eq=False)
class MassMoments(Table, Generic[Real]):
    """Integrals over the mass of a body, about the origin of some frame.

    Attributes:
        mass: [kg].
        y, z, x: of the coordinates [kg m].
        xx, yy, zz, yz, xy, xz: of their products [kg m^2]. Those with a single x are zero for a
            body symmetric about the yz plane.
    """

    mass: Real
    y: Real | float
    z: Real | float
    xx: Real
    yy: Real
    zz: Real | float
    yz: Real | float
    x: Real | float = 0.0
    xy: Real | float = 0.0
    xz: Real | float = 0.0

    def __add__(self, other: "MassMoments[Real]") -> "MassMoments[Real]":
        both = zip(vars(self).values(), vars(other).values(), strict=True)
        return MassMoments(*(own + more for own, more in both))

    def times(self, factor: float) -> "MassMoments[Real]":
        """Moments of `factor` equal bodies; -1: of one that is cut out."""
        return MassMoments(*(factor * own for own in vars(self).values()))

    def moved(self, x: Real | float, y: Real | float, z: Real | float) -> "MassMoments[Real]":
        """Moments of the body moved along all three axes [m]."""
        dx, dy, dz = (product(distance, self.mass) for distance in (x, y, z))
        new_x, new_y, new_z = self.x + dx, self.y + dy, self.z + dz
        xx, yy = self.xx + product(x, self.x + new_x), self.yy + product(y, self.y + new_y)
        zz, yz = self.zz + product(z, self.z + new_z), self.yz + product(z, self.y)
        xy, xz = self.xy + product(y, self.x), self.xz + product(z, self.x)
        yz, xy, xz = yz + product(y, new_z), xy + product(x, new_y), xz + product(x, new_z)
        return MassMoments(self.mass, new_y, new_z, xx, yy, zz, yz, new_x, xy, xz)

    @property
    def second(self) -> tuple[tuple[Real | float, ...], ...]:
        """Second moments as the rows of a symmetric matrix [kg m^2]."""
        return (self.xx, self.xy, self.xz), (self.xy, self.yy, self.yz), (self.xz, self.yz, self.zz)

    def shifted(self, along: Real | float, up: Real | float) -> "MassMoments[Real]":
        """Moments of the body moved along the wheel's axis y and upwards [m]."""
        return self.moved(0.0, along, up)

    def turned(self, rotation: FloatArray) -> "MassMoments[Real]":
        """Moments in the axes of another frame, into which `rotation` transforms coordinates."""
        rows = [[(k, entry) for k, entry in enumerate(row) if entry] for row in rotation.tolist()]
        first, second = (self.x, self.y, self.z), self.second

        x, y, z = (sum(entry * first[k] for k, entry in row) for row in rows)

        xx, yy, zz, yz, xy, xz = (
            sum(a * b * second[k][m] for k, a in rows[i] for m, b in rows[j])
            for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 1), (0, 2))
        )
        return MassMoments(self.mass, y, z, xx, yy, zz, yz, x, xy, xz)

    def around(self, count: int, first: float = 0.0) -> "MassMoments[Real]":
        """Moments of `count` equal flat bodies, evenly spaced around the z axis.

        Args:
            count: of bodies; with three or more, moments are equal about every transverse axis.
            first: angle by which the first is turned [rad].
        """
        if count > 2:
            across = count * (self.xx + self.yy) / 2.0
            return MassMoments(count * self.mass, 0.0, 0.0, across, across, 0.0, 0.0)
        c, s = cos(first), sin(first)
        one = self if first == 0.0 else self.turned(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
        return one if count == 1 else one + replace(one, x=-one.x, y=-one.y)


def product(one: Real | float, other: Real | float) -> Real | float:
    """Product of two; a zero number times anything stays a number, without an array."""
    return 0.0 if isinstance(one, float) and one == 0.0 else one * other


def cylinder_mass(
    inner_radius: Real | float, outer_radius: Real, height: Real | float, density: Real | float
) -> Real:
    """Mass m = pi rho h (R^2 - r^2) [kg]; with r = 0 that of a disc."""
    return np.pi * density * height * (outer_radius**2 - inner_radius**2)


def point(mass: Real) -> MassMoments[Real]:
    """Moments of a point at the origin [kg]."""
    zero = 0.0 * mass
    return MassMoments(mass, zero, zero, zero, zero, zero, zero)


def round_body(mass: Real, axial_inertia: Real, transverse_inertia: Real) -> MassMoments[Real]:
    """Moments of a body of revolution about y with its centre of mass at the origin.

    Args:
        mass: [kg].
        axial_inertia, transverse_inertia: about y, and about any transverse axis [kg m^2].
    """
    zero = 0.0 * mass
    across, along = axial_inertia / 2.0, transverse_inertia - axial_inertia / 2.0
    return MassMoments(mass, zero, zero, across, along, across, zero)


def ring(mass: Real, radius: Real, count: int = 4) -> MassMoments[Real]:
    """Moments of equal points on a circle around y, the first straight up, in its plane.

    Args:
        mass: of all of them [kg].
        radius: of the circle [m].
        count: of points; from three on it makes no difference.
    """
    zero, both = 0.0 * mass * radius, mass * radius**2
    mass = mass + zero
    if count <= 2:
        up = mass * radius if count == 1 else zero
        return MassMoments(mass, zero, up, zero, zero, both, zero)
    return MassMoments(mass, zero, zero, both / 2.0, zero, both / 2.0, zero)


def flat_ring(mass: Real, radius: Real) -> MassMoments[Real]:
    """Moments of points evenly spaced on a horizontal circle around the vertical [kg, m]."""
    zero, across = 0.0 * mass * radius, mass * radius**2 / 2.0
    return MassMoments(mass + zero, zero, zero, across, across, zero, zero)
