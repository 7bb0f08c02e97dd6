"""Mass, centre of mass and inertia of rigid bodies: transport, sum and physical conditions.

Source of the transport and sum rules: Featherstone, Rigid Body Dynamics Algorithms (2008),
section 2.13; of the physical conditions: Traversaro et al., IROS 2016.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Rigid-body mass properties in some frame.

    Attributes:
        mass: [kg].
        com: centre of mass in the frame [m], shape (3,).
        inertia: about the centre of mass, in the frame's axes [kg m^2], shape (3, 3).
    """

    mass: float
    com: FloatArray
    inertia: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "com", frozen(self.com))
        object.__setattr__(self, "inertia", frozen(self.inertia))

    @classmethod
    def zero(cls) -> "MassProperties":
        """A body without mass."""
        return cls(0.0, np.zeros(3), np.zeros((3, 3)))

    @property
    def gyration_radius(self) -> float:
        """Radius of gyration about axes through the centre of mass, sqrt(trace(I) / 3 m) [m]."""
        return float(np.sqrt(np.trace(self.inertia) / 3.0 / self.mass))

    def moved(self, rotation: FloatArray, position: FloatArray) -> "MassProperties":
        """Mass properties in a frame in which the present one is at `rotation`, `position`."""
        return MassProperties(
            self.mass, rotation @ self.com + position, rotation @ self.inertia @ rotation.T
        )

    def inertia_about(self, point: FloatArray) -> FloatArray:
        """Inertia about `point` of the frame (parallel axes) [kg m^2], shape (3, 3)."""
        offset = self.com - point
        return self.inertia + self.mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def combine(parts: Iterable[MassProperties]) -> MassProperties:
    """Mass properties of several rigidly joined bodies, given in one frame."""
    bodies = list(parts)
    mass = sum(body.mass for body in bodies)
    if mass == 0.0:
        inertia = sum((body.inertia for body in bodies), np.zeros((3, 3)))
        return MassProperties(0.0, np.zeros(3), inertia)
    com = sum((body.mass * body.com for body in bodies), np.zeros(3)) / mass
    inertia = sum((body.inertia_about(com) for body in bodies), np.zeros((3, 3)))
    return MassProperties(mass, com, inertia)


NEGLIGIBLE_MOMENT = 1e-15
"""Rounding of a zero moment [kg m^2]: a milligram at 0.1 mm has ten times as much."""


_MOMENT_ROUNDING = 1e-9
"""Rounding of the moments in a file, over the largest one."""


def physical_defect(body: MassProperties) -> str | None:
    """Why no distribution of positive mass has these properties; None if one has.

    Principal moments must be positive and obey the triangle inequality.
    """
    if not (
        np.isfinite(body.mass) and np.isfinite(body.com).all() and np.isfinite(body.inertia).all()
    ):
        return "holds a number that is not finite"
    if body.mass < 0.0:
        return f"has the negative mass {body.mass:g} kg"
    moments = np.linalg.eigvalsh(body.inertia)
    slack = max(_MOMENT_ROUNDING * max(abs(moments[2]), abs(moments[0])), NEGLIGIBLE_MOMENT)
    if moments[0] < -slack:
        return f"has the negative principal moment {moments[0]:.3g} kg m^2"
    if moments[2] > moments[0] + moments[1] + slack:
        return (
            "has principal moments that break the triangle inequality "
            f"({moments[0]:.4g} + {moments[1]:.4g} < {moments[2]:.4g} kg m^2)"
        )
    return None


def solid_defect(body: MassProperties) -> str | None:
    """Why a torque cannot turn a body with these properties; None if it can.

    They must be physical, with a positive mass and an inertia about every axis.
    """
    defect = physical_defect(body)
    if defect is not None:
        return defect
    if body.mass == 0.0:
        return "has no mass"
    smallest = np.linalg.eigvalsh(body.inertia)[0]
    if smallest <= 0.0:
        return (
            f"has no inertia about one of its axes (its least principal moment is {smallest:.3g} "
            "kg m^2)"
        )
    return None


DENSEST, THINNEST = 19_300.0, 0.012
"""Densities of tungsten and of a hundredth of air [kg/m^3], for a ball with a robot's mass and
gyration radius. Public robots lie between 5 and 484, a double pendulum of rods at 0.02; a unit
that is wrong by a thousand takes them out of this range."""


def ball_density(body: MassProperties) -> float:
    """Density of a homogeneous ball of the same mass and inertia, `2 m R^2 / 5` [kg/m^3]."""
    radius = np.sqrt(2.5) * body.gyration_radius
    return float(body.mass / (4.0 / 3.0 * np.pi * radius**3))


def impossible_size(body: MassProperties) -> str | None:
    """Why a robot's mass and inertia must be in wrong units; None if they are plausible."""
    density = ball_density(body)
    if THINNEST <= density <= DENSEST:
        return None
    radius = body.gyration_radius
    size = f"{radius:.3g} m" if radius >= 1.0 else f"{1e3 * radius:.3g} mm"
    than = "thinner than air" if density < THINNEST else "denser than a ball of tungsten"
    return f"{body.mass:.4g} kg with a radius of gyration of {size} is {than}"
