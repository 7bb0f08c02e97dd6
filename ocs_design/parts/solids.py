"""Solids with exact mass properties: bodies of revolution and prisms."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import TypeAlias

import numpy as np

from ocs_design.arrays import FloatArray, frozen
from ocs_design.parts.outline import Outline
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.tree import Placement


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

    def mass_properties(self, density: float) -> MassProperties:
        """In the part's frame, exact.

        Green's theorem turns the integrals over the cross-section into sums over its edges:
        V = pi o r^2 dz, z_c V = pi o r^2 z dz, and the second moments about the origin
        int z^2 dV = pi o r^2 z^2 dz and int x^2 dV = pi/4 o r^4 dz. Along a line they are
        polynomials of degree 4 at most, which three points of Gauss integrate exactly.
        """
        start, end = self.profile, np.roll(self.profile, -1, axis=0)
        nodes, weights = np.polynomial.legendre.leggauss(3)
        r, z = (start + (1.0 + nodes[:, None, None]) / 2.0 * (end - start)).transpose(2, 0, 1)
        dz = weights[:, None] / 2.0 * (end - start)[:, 1]
        volume, first, along, across = (
            pi * float(np.sum(integrand * dz))
            for integrand in (r**2, r**2 * z, r**2 * z**2, r**4 / 4.0)
        )
        return _from_moments(
            density, volume, np.array([0.0, 0.0, first]), np.diag([across, across, along])
        )


@dataclass(frozen=True, eq=False)
class Prism:
    """An outline pushed along the z axis of its own frame.

    Attributes:
        outline: in the xy plane of that frame.
        low, high: where it begins and ends along z [m].
        placement: of that frame in the part's.
    """

    outline: Outline
    low: float
    high: float
    placement: Placement = field(default_factory=Placement.identity)

    def mass_properties(self, density: float) -> MassProperties:
        """In the part's frame, exact."""
        plane = self.outline.moments()
        length, middle = self.high - self.low, (self.high + self.low) / 2.0
        second = np.zeros((3, 3))
        second[:2, :2] = plane.second * length
        second[:2, 2] = second[2, :2] = plane.first * length * middle
        second[2, 2] = plane.area * (self.high**3 - self.low**3) / 3.0
        first = length * np.array([*plane.first, plane.area * middle])
        own = _from_moments(density, plane.area * length, first, second)
        return own.moved(self.placement.rotation, self.placement.position)


Solid: TypeAlias = Revolution | Prism


def hollow_cylinder(inner: float, outer: float, low: float, high: float) -> Revolution:
    """About the z axis, between two radii and two heights [m]; a disc if `inner` is 0."""
    return Revolution(np.array([[inner, low], [outer, low], [outer, high], [inner, high]]))


def revolved(corners: Iterable[Sequence[float]]) -> Revolution:
    """A body of revolution; corners that repeat the one before them are left out."""
    points = np.array(list(corners))
    distinct = np.any(points != np.roll(points, 1, axis=0), axis=1)
    return Revolution(points[distinct])


def _from_moments(
    density: float, volume: float, first: FloatArray, second: FloatArray
) -> MassProperties:
    """From the integrals of 1, x and x x' over the volume, about the origin."""
    com = first / volume
    about_com = second - volume * np.outer(com, com)
    inertia = density * (np.trace(about_com) * np.eye(3) - about_com)
    return MassProperties(density * volume, com, inertia)
