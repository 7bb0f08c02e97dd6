"""The inertia that the wheels turn: robot and both modules, braked, for many devices at once."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.mass_moments import MassMoments
from ocs_design.sizing.placement import Place, Size


class Modules(NamedTuple):
    """One of the two equal modules of each device, all of shape (n,).

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
        """From all of a module's mass and its moments about the wheel's centre."""
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


_Range: TypeAlias = tuple[FloatArray, FloatArray]
"""From and to."""


class Least(NamedTuple):
    """What no module of a kind is below, all of shape (n,), and what it is not beyond.

    Attributes:
        mass: of what stands about the wheel's centre, wheel and drum [kg].
        inertia: of that about any axis [kg m^2].
        behind: of what stands behind it [kg].
        depth, above: of its middle from the wheel's, at most [m].
        smallest, largest: rooms that modules take.
        heaviest: [kg].
    """

    mass: FloatArray
    inertia: FloatArray
    behind: FloatArray
    depth: FloatArray
    above: FloatArray
    smallest: Size[FloatArray]
    largest: Size[FloatArray]
    heaviest: FloatArray


class Products(NamedTuple):
    """Of inertia of robot and device, by the sine of the incidence; shape (n,) each.

    Attributes:
        xy, xz, yz: with the modules' centres of mass at their wheels [kg m^2].
        xy_slope, xz_slope: what their being off them adds, per sine [kg m^2].
        flat: I_xx + I_yy - I_zz, which no incidence changes [kg m^2].
    """

    xy: FloatArray
    xz: FloatArray
    yz: FloatArray
    xy_slope: FloatArray
    xz_slope: FloatArray
    flat: FloatArray

    def at(self, sine: FloatArray, diagonal: FloatArray) -> FloatArray:
        """J_xy, see `TiltInertia`, with I_xx and I_yy (n, k, 2) at sines (n, k) [kg m^2]."""
        xy, xz, yz, xy_slope, xz_slope, flat = (values[:, None] for values in self)
        yaw = (xz + xz_slope * sine) * yz / (diagonal.sum(axis=-1) - flat)
        return np.asarray(xy + xy_slope * sine - yaw)


class TrunkInertia(NamedTuple):
    """Of robot and device about roll and pitch, by the incidence of the axes; shape (n, 2) each.

    With the sine for roll and the cosine for pitch, I = base + spread share^2 + (linear + square
    other) other, where `other` is the cosine for roll and the sine for pitch.

    Attributes:
        base: with all of a module's inertia taken as transverse, its mass at its wheel [kg m^2].
        spread: what both modules have more about their axes than across [kg m^2].
        linear, square: what their centres of mass off the wheels' add [kg m^2].
        products: what couples roll and pitch.
    """

    base: FloatArray
    spread: FloatArray
    linear: FloatArray
    square: FloatArray
    products: Products

    def at(self, shares: FloatArray) -> TiltInertia:
        """At sin and cos of incidences, shape (n, k, 2); of shape (n, k)."""
        other = shares[..., ::-1]
        off = (self.linear[:, None, :] + self.square[:, None, :] * other) * other
        diagonal = self.base[:, None, :] + self.spread[:, None, :] * shares**2 + off
        return TiltInertia(diagonal, self.products.at(shares[..., 0], diagonal))


def trunk_inertia(robot: MassProperties, place: Place, modules: Modules) -> TrunkInertia:
    """Of each device on the robot, by parallel axes.

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
    products = Products(
        xy=robot.inertia[0, 1] - reduced * forward * left,
        xz=robot.inertia[0, 2] - reduced * forward * up,
        yz=robot.inertia[1, 2] - reduced * left * up,
        xy_slope=-moved * left,
        xz_slope=-moved * up - 2.0 * modules.slant,
        flat=_flat(robot) + 2.0 * (reduced * up**2 + 2.0 * modules.upright),
    )
    return TrunkInertia(
        base=_pairs(roll, pitch),
        spread=_pairs(spread, spread),
        linear=_pairs(2.0 * both * y * along, 2.0 * reduced * forward * along),
        square=_pairs(both * along**2, reduced * along**2),
        products=products,
    )


class LeastInertia(NamedTuple):
    """What no device is below about roll and pitch, shape (n, 2), and how much it couples them.

    Attributes:
        inertia: the least about either axis, coupled as the robot alone.
        spread: that J_xy differs by from that at most [kg m^2], shape (n,).
    """

    inertia: TiltInertia
    spread: FloatArray


def least_trunk_inertia(robot: MassProperties, place: Place, least: Least) -> LeastInertia:
    """Of all devices that are no smaller and no lighter, shape (n,).

    Every term grows with mass, inertia or a distance; each distance is at its own least between
    where the smallest and where the largest module stands, at any incidence. What is not looked at,
    the foot, would only add to the inertia about the common centre of mass.
    """
    x, y, z = (_range(values) for values in zip(*_corners(place, least), strict=True))
    mass = least.mass + least.behind
    off = least.behind * least.depth / mass
    forward = _least_square(_from(x, off), robot.com[0])
    up = _least_square(_to(z, least.behind * least.above / mass), robot.com[2])
    sideways = least.mass * _least_square(y, 0.0)
    sideways = sideways + least.behind * _least_square(_from(y, least.depth), 0.0)
    reduced = robot.mass * 2.0 * mass / (robot.mass + 2.0 * mass)
    own = 2.0 * least.inertia
    roll = robot.inertia[0, 0] + reduced * (robot.com[1] ** 2 + up) + 2.0 * sideways + own
    diagonal = _pairs(roll, robot.inertia[1, 1] + reduced * (forward + up) + own)
    product = np.full(len(roll), TiltInertia.of(robot.inertia).product)
    return LeastInertia(TiltInertia(diagonal, product), _coupling_spread(robot, place, least))


def _coupling_spread(robot: MassProperties, place: Place, least: Least) -> FloatArray:
    """What a device changes J_xy by at most, term by term [kg m^2], shape (n,).

    A module's own products are no more than its mass times its room around its wheel squared.
    """
    x, _, z = (_range(values) for values in zip(*_corners(place, least), strict=True))
    reach, standing = least.largest
    room = reach + standing + np.abs(least.above)
    mass = 2.0 * least.heaviest
    reduced = robot.mass * mass / (robot.mass + mass)
    forward = _most(x, robot.com[0]) + room
    left, up = abs(robot.com[1]), _most(z, robot.com[2]) + room
    xz, yz = np.abs(robot.inertia[:2, 2])
    aslant, sideways = reduced * forward * up + mass * room**2, reduced * left * up
    # Of I_xz I_yz / I_zz, the last term because I_zz grows too.
    yaw = aslant * yz + xz * sideways + aslant * sideways + xz * yz
    return np.asarray(reduced * left * forward + yaw / robot.inertia[2, 2])


def _flat(robot: MassProperties) -> float:
    """Twice the integral of its mass times its height squared [kg m^2]."""
    return float(robot.inertia[0, 0] + robot.inertia[1, 1] - robot.inertia[2, 2])


def _pairs(roll: FloatArray, pitch: FloatArray) -> FloatArray:
    return np.stack(np.broadcast_arrays(roll, pitch), axis=-1)


def _corners(place: Place, least: Least) -> Iterator[tuple[FloatArray, FloatArray, FloatArray]]:
    """Where modules of the least and the largest reach and height stand."""
    for reach in (least.smallest.reach, least.largest.reach):
        for standing in (least.smallest.standing, least.largest.standing):
            yield place.left(Size(reach, standing))


def _range(values: Sequence[FloatArray]) -> _Range:
    return np.minimum.reduce(values), np.maximum.reduce(values)


def _from(between: _Range, back: FloatArray) -> _Range:
    """A range that begins so much earlier."""
    return between[0] - back, between[1]


def _to(between: _Range, more: FloatArray) -> _Range:
    """A range that ends so much later."""
    return between[0], between[1] + more


def _least_square(between: _Range, about: float) -> FloatArray:
    """Of the distance from `about` of anything in a range."""
    low, high = between[0] - about, between[1] - about
    least: FloatArray = np.maximum(np.maximum(low, -high), 0.0) ** 2
    return least


def _most(between: _Range, about: float) -> FloatArray:
    """Largest distance from `about` of anything in a range."""
    return np.asarray(np.maximum(np.abs(between[0] - about), np.abs(between[1] - about)))
