"""The inertia that the wheels turn: robot and both modules, braked, for many devices at once."""

from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.placement import Place, sphere_radius


class Modules(NamedTuple):
    """One of the two equal modules of each device, all of shape (n,).

    Attributes:
        mass: [kg].
        axial_inertia: about the wheel's axis, braked. transverse_inertia: across it [kg m^2].
        outer_radius, height: of its housing [m].
    """

    mass: FloatArray
    axial_inertia: FloatArray
    transverse_inertia: FloatArray
    outer_radius: FloatArray
    height: FloatArray


class TrunkInertia(NamedTuple):
    """Of robot and device about roll and pitch, by the incidence of the axes.

    Attributes:
        base: with all of a module's inertia taken as transverse [kg m^2], shape (n, 2).
        spread: what both modules have more about their axes than across [kg m^2], shape (n,).
    """

    base: FloatArray
    spread: FloatArray

    def at(self, shares: FloatArray) -> FloatArray:
        """I_xx and I_yy at sin and cos of incidences [kg m^2], shape (n, k, 2) as `shares`."""
        inertia: FloatArray = self.base[:, None, :] + self.spread[:, None, None] * shares * shares
        return inertia


def trunk_inertia(robot: MassProperties, place: Place, modules: Modules) -> TrunkInertia:
    """Of each device on the robot, by parallel axes.

    Both modules together act as one body of twice the mass, its centre of mass in the sagittal
    plane, and two bodies m at a distance act on their common centre as the reduced mass.
    """
    x, y, z = place.left(modules.outer_radius, modules.height)
    forward, up = x - robot.com[0], z - robot.com[2]
    return _joined(robot, modules, forward**2, y * y, up**2)


def least_trunk_inertia(
    robot: MassProperties, place: Place, least: Modules, largest: Modules
) -> FloatArray:
    """A lower bound over all devices that are no smaller and no lighter [kg m^2], shape (n, 2).

    Every term grows with mass, inertia or a distance; each distance is at its own least between
    where the smallest and where the largest module stands.

    Args:
        robot, place: of the problem.
        least: smallest mass, inertias and sizes.
        largest: sizes; the rest is not looked at.
    """
    near = sphere_radius(least.outer_radius, least.height)
    far = sphere_radius(largest.outer_radius, largest.height)
    com = (robot.com[0], 0.0, robot.com[2])
    squares = (
        _least_square(start + along * near - about, start + along * far - about)
        for start, along, about in zip(place.origin, place.outward, com, strict=True)
    )
    inertia, spread = _joined(robot, least, *squares)
    return inertia + np.minimum(spread, 0.0)[:, None]


def _joined(
    robot: MassProperties,
    modules: Modules,
    forward: FloatArray,
    sideways: FloatArray,
    up: FloatArray,
) -> TrunkInertia:
    """From the squares of the modules' distances, forward and up from the centre of mass."""
    both = 2.0 * modules.mass
    reduced = robot.mass * both / (robot.mass + both)
    own = 2.0 * modules.transverse_inertia
    roll = robot.inertia[0, 0] + reduced * (robot.com[1] ** 2 + up) + both * sideways + own
    pitch = robot.inertia[1, 1] + reduced * (forward + up) + own
    base = np.stack(np.broadcast_arrays(roll, pitch), axis=-1)
    return TrunkInertia(base, 2.0 * (modules.axial_inertia - modules.transverse_inertia))


def _least_square(near: FloatArray, far: FloatArray) -> FloatArray:
    """Of anything between `near` and `far`."""
    least: FloatArray = np.where(near * far <= 0.0, 0.0, np.minimum(np.abs(near), np.abs(far))) ** 2
    return least
