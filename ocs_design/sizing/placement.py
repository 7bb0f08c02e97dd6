"""Where the two modules stand on the trunk."""

from dataclasses import dataclass
from typing import TypeVar

from ocs_design.arrays import FloatArray, frozen
from ocs_design.robot.bounds import trunk_top
from ocs_design.robot.robot import Robot

CLEARANCE = 1.1
"""Room kept around a wheel, over the radius of the sphere that it sweeps at any incidence."""

Real = TypeVar("Real", float, FloatArray)


@dataclass(frozen=True)
class Place:
    """Centres of both modules as their size grows, the right one mirrored in y.

    The left one stands at `origin + outward * reach` with `reach = sqrt(R^2 + h^2 / 4)`, the radius
    of the sphere that a module of outer radius R and height h sweeps at any incidence.

    Attributes:
        origin: of the left one, if it had no size, in B [m].
        outward: how far it stands off, per radius of that sphere, in B.
    """

    origin: tuple[float, float, float]
    outward: tuple[float, float, float]

    def __call__(self, outer_radius: float, height: float) -> FloatArray:
        """Centres in B for R and h [m], left first, shape (2, 3)."""
        x, y, z = self.left(outer_radius, height)
        return frozen([[x, y, z], [x, -y, z]])

    def left(self, outer_radius: Real, height: Real) -> tuple[Real, Real, Real]:
        """Centre of the left module in B [m], of numbers, arrays or CasADi's symbols alike."""
        return self.left_of_reach(sphere_radius(outer_radius, height))

    def left_of_reach(self, reach: Real) -> tuple[Real, Real, Real]:
        """Likewise, by the radius of its sphere [m]."""
        (x, y, z), (along_x, along_y, along_z) = self.origin, self.outward
        return x + along_x * reach, y + along_y * reach, z + along_z * reach


def sphere_radius(outer_radius: Real, height: Real) -> Real:
    """Of the sphere around a cylinder, sqrt(R^2 + h^2 / 4) [m]."""
    # No function of numpy: symbols know only operators.
    square: Real = outer_radius**2 + height**2 / 4.0
    reach: Real = square**0.5
    return reach


def place_on_top(robot: Robot) -> Place:
    """On top of the trunk over the centre of mass, symmetric to the sagittal plane.

    Each module may be turned to any incidence without touching the trunk or the other one. Other
    parts of the robot are not looked at: see `free_place`.
    """
    # To the micrometre, so that no rounding error of the centre of mass reaches the files.
    forward = round(float(robot.com[0]), 6) + 0.0
    top = round(trunk_top(robot.tree, robot.trunk), 6)
    return Place(origin=(forward, 0.0, top), outward=(0.0, CLEARANCE, CLEARANCE))


def place_at(position: tuple[float, ...]) -> Place:
    """The left module at `position` in B [m], the right one mirrored in y."""
    x, y, z = position
    return Place(origin=(x, y, z), outward=(0.0, 0.0, 0.0))
