"""Composite inertia of robot and both modules, braked, for many devices at once."""

from typing import NamedTuple

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.moments import MassMoments
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.placement import Place, Size


class Modules(NamedTuple):
    """One of the equal modules of each device, all of shape (n,).

    Attributes:
        mass: [kg].
        along, up: of its centre of mass from the wheel's, in the module's frame [m].
        axial_inertia: about the axis through it that is parallel to the wheel's, braked [kg m^2].
        transverse_inertia: about the horizontal one across it [kg m^2].
        upright: of its mass times its height off its centre of mass squared [kg m^2].
        slant: of its mass times its place along its axis and its height, likewise [kg m^2].
        size: the room that it takes.
    """

    mass: FloatArray
    along: FloatArray
    up: FloatArray
    axial_inertia: FloatArray
    transverse_inertia: FloatArray
    upright: FloatArray
    slant: FloatArray
    size: Size[FloatArray]

    @classmethod
    def of(cls, moments: MassMoments[FloatArray], size: Size[FloatArray]) -> "Modules":
        """Modules of this mass and these moments about the wheel's centre."""
        mass = moments.mass
        along, up = moments.y / mass, moments.z / mass
        upright = moments.zz - mass * up**2
        return cls(
            mass=mass,
            along=along,
            up=up,
            axial_inertia=moments.xx + upright,
            transverse_inertia=moments.yy - mass * along**2 + upright,
            upright=upright,
            slant=moments.yz - mass * along * up,
            size=size,
        )


class CompositeInertia(NamedTuple):
    """Inertia of robot and device about roll and pitch as a function of the incidence.

    With the sine for roll and the cosine for pitch, I = base + spread share^2 + (linear + square
    other) other, where `other` is the cosine for roll and the sine for pitch.

    Attributes:
        base: with all of a module's inertia taken as transverse, its mass at its wheel [kg m^2],
            shape (n, 2).
        spread: what both modules have more about their axes than across [kg m^2], shape (n, 2).
        linear, square: what their centres of mass off the wheels' add [kg m^2], shape (n, 2).
        products: I_xy, I_xz and I_yz with the modules' centres of mass at their wheels, what
            their being off them adds to the first two per sine, and I_xx + I_yy - I_zz, which no
            incidence changes [kg m^2], shape (6, n, 1).
    """

    base: FloatArray
    spread: FloatArray
    linear: FloatArray
    square: FloatArray
    products: FloatArray

    def at(self, shares: FloatArray) -> TiltInertia:
        """Inertia at sin and cos of incidences, shape (n, k, 2); of shape (n, k)."""
        other, sine = shares[..., ::-1], shares[..., 0]
        off = (self.linear[:, None, :] + self.square[:, None, :] * other) * other
        diagonal = self.base[:, None, :] + self.spread[:, None, :] * shares**2 + off
        xy, xz, yz, xy_slope, xz_slope, flat = self.products
        yaw = (xz + xz_slope * sine) * yz / (diagonal.sum(axis=-1) - flat)
        return TiltInertia(diagonal, np.asarray(xy + xy_slope * sine - yaw))


def composite_inertia(robot: MassProperties, place: Place, modules: Modules) -> CompositeInertia:
    """Inertia of each device on the robot, by parallel axes.

    The left module's centre of mass is at (x + e sin, y + e cos, z + d), the right one's mirrored.
    Both together act as one body of twice the mass, its centre of mass in the sagittal plane, and
    two bodies m at a distance act on their common centre as the reduced mass.
    """
    x, y, z = place.left(modules.size)
    along, both = modules.along, 2.0 * modules.mass
    reduced = robot.mass * both / (robot.mass + both)
    forward, up = x - robot.com[0], z + modules.up - robot.com[2]
    own = 2.0 * modules.transverse_inertia
    roll = robot.inertia[0, 0] + reduced * (robot.com[1] ** 2 + up**2) + both * y**2 + own
    pitch = robot.inertia[1, 1] + reduced * (forward**2 + up**2) + own
    spread = 2.0 * (modules.axial_inertia - modules.transverse_inertia)
    left, moved = -robot.com[1], reduced * along
    flat = robot.inertia[0, 0] + robot.inertia[1, 1] - robot.inertia[2, 2]
    products = (
        robot.inertia[0, 1] - reduced * forward * left,
        robot.inertia[0, 2] - reduced * forward * up,
        robot.inertia[1, 2] - reduced * left * up,
        -moved * left,
        -moved * up - 2.0 * modules.slant,
        flat + 2.0 * (reduced * up**2 + 2.0 * modules.upright),
    )
    return CompositeInertia(
        base=pairs_of(roll, pitch),
        spread=pairs_of(spread, spread),
        linear=pairs_of(2.0 * both * y * along, 2.0 * reduced * forward * along),
        square=pairs_of(both * along**2, reduced * along**2),
        products=np.stack(np.broadcast_arrays(*products))[..., None],
    )


def pairs_of(roll: FloatArray, pitch: FloatArray) -> FloatArray:
    """Values about roll and pitch in one array, shape (n, 2)."""
    return np.stack(np.broadcast_arrays(roll, pitch), axis=-1)
