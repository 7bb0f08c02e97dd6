"""Composite inertia of robot and all braked modules, for many devices, and its lower bound."""

from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import NamedTuple, TypeAlias

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import PAIR, Layout
from ocs_design.parts.moments import MassMoments
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.place import Place, Size


@dataclass(frozen=True, eq=False)
class CompositeInertia:
    """Inertia of robot and n devices about roll and pitch as a function of the layout's angle.

    Attributes:
        robot: without the modules, in B. layout: of the modules.
        module: moments of one module of each device about its wheel's centre, in its own frame.
        centers: of the wheels relative to the robot's centre of mass, in B [m], shape (n, w, 3).
    """

    robot: MassProperties
    layout: Layout
    module: MassMoments[FloatArray]
    centers: FloatArray

    def at(self, angle: FloatArray) -> tuple[TiltInertia, FloatArray]:
        """Inertia about roll and pitch with the modules at angles [rad], and I_zz [kg m^2].

        The result has shape (n, k) for angles of shape (n, k) or (1, k). By the parallel axis
        theorem for second moments, with a module's mass m, first moment f_i = R_i f and second
        moments S about its wheel's centre c_i, all relative to the robot's centre of mass:

            S = S_robot + sum_i (m c_i c_i^T + c_i f_i^T + f_i c_i^T + R_i S R_i^T)
                - F F^T / (M + sum_i m),    F = sum_i (m c_i + f_i).
        """
        module = MassMoments(
            *(np.asarray(moment)[..., None] for moment in vars(self.module).values())
        )
        frames = self.layout.frames(angle)
        # Components of the outward and upward axes, and the wheels' positions, shape (3, w, n, k).
        y, z = np.ascontiguousarray(frames.T[1:].swapaxes(-1, -2))
        centers, module_moments = self.centers.T[..., None], module.y * y + module.z * z
        count = frames.shape[-3]
        total_mass = self.robot.mass + count * module.mass
        first_moment = module.mass * centers.sum(axis=1) + module_moments.sum(axis=1)
        of_robot = np.trace(self.robot.inertia) / 2.0 * np.eye(3) - self.robot.inertia
        # Sums of mass times two coordinates about the whole's centre of mass [kg m^2].
        second: dict[tuple[int, int], FloatArray] = {}
        for i, j in combinations_with_replacement(range(3), 2):
            # R_i S R_i^T = xx 1 + (yy - xx) y y^T + (zz - xx) z z^T + yz (y z^T + z y^T).
            of_modules = (module.yy - module.xx) * (y[i] * y[j]).sum(axis=0)
            of_modules = of_modules + (module.zz - module.xx) * (z[i] * z[j]).sum(axis=0)
            of_modules = of_modules + module.yz * (y[i] * z[j] + z[i] * y[j]).sum(axis=0)
            of_positions = module.mass * (centers[i] * centers[j]).sum(axis=0)
            of_positions = of_positions + (
                centers[i] * module_moments[j] + module_moments[i] * centers[j]
            ).sum(axis=0)
            isotropic = (i == j) * count * module.xx
            second[i, j] = (
                of_robot[i, j]
                + of_modules
                + isotropic
                + of_positions
                - first_moment[i] * first_moment[j] / total_mass
            )
        xx, yy, zz = (second[axis, axis] for axis in range(3))
        product = -second[0, 1] - second[0, 2] * second[1, 2] / (xx + yy)
        return TiltInertia(np.stack([yy + zz, xx + zz], axis=-1), product), xx + yy


_Range: TypeAlias = tuple[FloatArray, FloatArray]
"""Two ends, from and to."""


class LeastInertia(NamedTuple):
    """Lower bound of the inertia about roll and pitch, and the range of their coupling.

    Attributes:
        inertia: the least about either axis, with the coupling of the robot alone, shape (n, 2).
        spread: largest difference of J_xy from that coupling [kg m^2], shape (n,).
    """

    inertia: TiltInertia
    spread: FloatArray


class ModuleBounds(NamedTuple):
    """Lower and upper bounds for one module of a kind, all of shape (n,).

    Attributes:
        mass: least mass of the parts centred on the wheel, wheel and drum [kg].
        inertia: least inertia of those about any axis [kg m^2].
        behind: least mass of the parts behind them [kg].
        depth, above: largest offset of their centre of mass from the wheel's centre [m].
        smallest, largest: bounds of the module's size.
        heaviest: largest mass [kg].
    """

    mass: FloatArray
    inertia: FloatArray
    behind: FloatArray
    depth: FloatArray
    above: FloatArray
    smallest: Size[FloatArray]
    largest: Size[FloatArray]
    heaviest: FloatArray

    def asymmetry(self, apart: FloatArray, layout: Layout) -> FloatArray:
        """Upper bound on I_xy about their middle of modules that are not mirror images [kg m^2].

        `apart`: positions of the wheels from their middle at each corner of the sizes [m], shape
        (..., n, w, 3).
        """
        _, outward, upward = np.moveaxis(layout.frames(layout.angle or 0.0), -1, 0)
        turned = sum(
            abs(float((one[:, 0] * other[:, 1] + other[:, 0] * one[:, 1]).sum()))
            for one, other in ((outward, outward), (upward, upward), (outward, upward))
        )
        along, across = np.abs(apart[..., 0]), np.abs(apart[..., 1])
        places = np.abs((apart[..., 0] * apart[..., 1]).sum(axis=-1)).max(axis=0)
        moved = (along + across).sum(axis=-1).max(axis=0) * np.abs(self.depth)
        return np.asarray(self.heaviest * (places + moved + turned * self.largest.reach**2))

    def coupling_spread(
        self, robot: MassProperties, x: _Range, z: _Range, wheels: int
    ) -> FloatArray:
        """Upper bound on a device's change of J_xy, term by term [kg m^2], shape (n,).

        A module's own products of inertia are at most its mass times the square of its size.
        """
        reach, standing = self.largest
        room, mass = reach + standing + np.abs(self.above), wheels * self.heaviest
        reduced = robot.mass * mass / (robot.mass + mass)
        forward, up = (
            np.maximum(np.abs(low - about), np.abs(high - about)) + room
            for (low, high), about in ((x, robot.com[0]), (z, robot.com[2]))
        )
        left, (xz, yz) = abs(robot.com[1]), np.abs(robot.inertia[:2, 2])
        aslant, sideways = reduced * forward * up + mass * room**2, reduced * left * up
        # Change of I_xz I_yz / I_zz; the last term is there because I_zz grows too.
        yaw = aslant * yz + xz * sideways + aslant * sideways + xz * yz
        return np.asarray(reduced * left * forward + yaw / robot.inertia[2, 2])


def least_composite_inertia(
    robot: MassProperties, place: Place, least: ModuleBounds, layout: Layout = PAIR
) -> LeastInertia:
    """Lower bound of the inertia with modules no smaller and no lighter than the given bounds.

    Every term increases with mass, inertia or a distance; each distance takes its own minimum over
    the positions from the smallest to the largest module, at any incidence. The foot, which is left
    out, would only add to the inertia about the common centre of mass.
    """
    corners = np.stack(
        [
            place.centers(Size(reach, standing))
            for reach in (least.smallest.reach, least.largest.reach)
            for standing in (least.smallest.wheel_height, least.largest.wheel_height)
        ]
    )
    middle = corners.mean(axis=-2)
    x, y, z = zip(middle.min(axis=0).T, middle.max(axis=0).T, strict=True)
    apart = corners - middle[..., None, :]
    wheels, mass = corners.shape[-2], least.mass + least.behind
    off, risen = least.behind * least.depth / mass, least.behind * least.above / mass
    # A pair's wheels face away from each other: the parts behind them do not shift their middle.
    aside, sunk = (0.0 * off, 0.0 * off) if layout.pairs else (off, off + np.abs(risen))
    forward = _least_squared_distance((x[0] - off, x[1] + aside), robot.com[0])
    left = _least_squared_distance((y[0] - aside, y[1] + aside), robot.com[1])
    up = _least_squared_distance((z[0] - sunk, z[1] + risen + sunk), robot.com[2])
    # Spread of the wheels about their own middle, without the parts behind them.
    spread = _least_squared_distance((apart.min(axis=0), apart.max(axis=0)), 0.0).sum(axis=-2)
    along, across, above = least.mass * spread.T
    reduced = robot.mass * wheels * mass / (robot.mass + wheels * mass)
    own = wheels * least.inertia
    roll = robot.inertia[0, 0] + reduced * (left + up) + across + above + own
    pitch = robot.inertia[1, 1] + reduced * (forward + up) + along + above + own
    diagonal = np.stack([roll, pitch], axis=-1)
    product = np.full(len(roll), TiltInertia.of(robot.inertia).product)
    coupling = least.coupling_spread(robot, x, z, wheels)
    if not layout.pairs:
        coupling = coupling + least.asymmetry(apart, layout)
    return LeastInertia(TiltInertia(diagonal, product), coupling)


def _least_squared_distance(interval: _Range, point: float) -> FloatArray:
    """Least squared distance from `point` to any value in a range."""
    low, high = interval[0] - point, interval[1] - point
    least: FloatArray = np.maximum(np.maximum(low, -high), 0.0) ** 2
    return least
