"""Mass and its moments about the middle of a wheel, which add up without a thought.

A module's own frame stands at the wheel's centre: x forward across the wheel's axis, y along it
away from the other module, z up. Both modules are symmetric to their yz plane, and each is the
other turned about the vertical: left and right are the same parts.

All figures are scalars or arrays that broadcast, and everything is built of operators alone, for
CasADi's symbols too.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import pi
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray

Real = TypeVar("Real", float, FloatArray)


@dataclass(frozen=True, eq=False)
class MassMoments(Generic[Real]):
    """Integrals over the mass of a body that is symmetric to the yz plane.

    Attributes:
        mass: [kg].
        y, z: of the coordinates [kg m].
        xx, yy, zz, yz: of their products [kg m^2].
    """

    mass: Real
    y: Real
    z: Real
    xx: Real
    yy: Real
    zz: Real
    yz: Real

    def __add__(self, other: "MassMoments[Real]") -> "MassMoments[Real]":
        return MassMoments(
            self.mass + other.mass,
            self.y + other.y,
            self.z + other.z,
            self.xx + other.xx,
            self.yy + other.yy,
            self.zz + other.zz,
            self.yz + other.yz,
        )

    def times(self, factor: float) -> "MassMoments[Real]":
        """So many such bodies; -1: cut out."""
        return MassMoments(
            factor * self.mass,
            factor * self.y,
            factor * self.z,
            factor * self.xx,
            factor * self.yy,
            factor * self.zz,
            factor * self.yz,
        )

    def shifted(self, along: Real, up: Real) -> "MassMoments[Real]":
        """Of the body moved along the axis and upwards [m]."""
        return MassMoments(
            mass=self.mass,
            y=self.y + self.mass * along,
            z=self.z + self.mass * up,
            xx=self.xx,
            yy=self.yy + along * (2.0 * self.y + self.mass * along),
            zz=self.zz + up * (2.0 * self.z + self.mass * up),
            yz=self.yz + up * self.y + along * (self.z + self.mass * up),
        )


def rows_of(
    moments: MassMoments[FloatArray], rows: NDArray[np.intp] | NDArray[np.bool_]
) -> MassMoments[FloatArray]:
    """Of some of many bodies, shape (n,) each."""
    return MassMoments(*(values[rows] for values in _figures(moments)))


def stacked(bodies: Sequence[MassMoments[float]]) -> MassMoments[FloatArray]:
    """Many bodies as arrays, shape (n,) each."""
    return MassMoments(*np.array([_figures(body) for body in bodies]).reshape(-1, 7).T)


def _figures(moments: MassMoments[Real]) -> tuple[Real, ...]:
    return tuple(getattr(moments, field.name) for field in fields(moments))


def nothing() -> MassMoments[float]:
    """Of no body at all."""
    return MassMoments(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def point(mass: Real) -> MassMoments[Real]:
    """At the origin [kg]."""
    zero = 0.0 * mass
    return MassMoments(mass, zero, zero, zero, zero, zero, zero)


def round_body(mass: Real, axial_inertia: Real, transverse_inertia: Real) -> MassMoments[Real]:
    """A body of revolution about y with its centre of mass at the origin [kg, kg m^2]."""
    zero = 0.0 * mass
    across, along = axial_inertia / 2.0, transverse_inertia - axial_inertia / 2.0
    return MassMoments(mass, zero, zero, across, along, across, zero)


def cylinder(radius: Real, length: Real, density: float) -> MassMoments[Real]:
    """Solid, about y, its middle at the origin [m, kg/m^3]."""
    mass = pi * density * radius**2 * length
    zero = 0.0 * mass
    across = mass * radius**2 / 4.0
    return MassMoments(mass, zero, zero, across, mass * length**2 / 12.0, across, zero)


def disc(radius: Real, thickness: float, density: float) -> MassMoments[Real]:
    """Solid, about the vertical, its middle at the origin [m, kg/m^3]."""
    mass = pi * density * radius**2 * thickness
    zero = 0.0 * mass
    across = mass * radius**2 / 4.0
    return MassMoments(mass, zero, zero, across, across, mass * thickness**2 / 12.0, zero)


def ring(mass: Real, radius: Real) -> MassMoments[Real]:
    """Evenly on a circle around y, three points or more, in its plane [kg, m]."""
    zero, across = 0.0 * mass * radius, mass * radius**2 / 2.0
    return MassMoments(mass + zero, zero, zero, across, zero, across, zero)


def flat_ring(mass: Real, radius: Real) -> MassMoments[Real]:
    """Likewise around the vertical."""
    zero, across = 0.0 * mass * radius, mass * radius**2 / 2.0
    return MassMoments(mass + zero, zero, zero, across, across, zero, zero)
