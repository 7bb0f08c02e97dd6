"""Composite inertia of robot and all braked modules, for many devices, and its largest coupling."""

from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import NamedTuple

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


class ModuleBounds(NamedTuple):
    """Upper bounds for one module of a kind, all of shape (n,).

    Attributes:
        size: of the module. mass: of all of it [kg].
        depth, above: offset of the centre of mass of its parts behind the wheel from the wheel's
            centre, backwards and upwards [m].
    """

    size: Size[FloatArray]
    mass: FloatArray
    depth: FloatArray
    above: FloatArray


def largest_coupling(
    robot: MassProperties, place: Place, module: ModuleBounds, layout: Layout = PAIR
) -> FloatArray:
    """Upper bound of |J_xy| of the robot with any device of such modules [kg m^2], shape (n,).

    The change of J_xy is bounded term by term. A module's own products of inertia are at most its
    mass times the square of its size.
    """
    reach, standing = module.size
    none = np.zeros_like(reach)
    corners = np.stack([place.centers(Size(r, h)) for r in (none, reach) for h in (none, standing)])
    middle = corners.mean(axis=-2)
    room, mass = reach + standing + np.abs(module.above), corners.shape[-2] * module.mass
    reduced = robot.mass * mass / (robot.mass + mass)
    forward, left, up = (np.abs(middle - robot.com).max(axis=0) + room[:, None]).T
    left, (xz, yz) = abs(robot.com[1]), np.abs(robot.inertia[:2, 2])
    aslant, sideways = reduced * forward * up + mass * room**2, reduced * left * up
    # Change of I_xz I_yz / I_zz; the last term is there because I_zz grows too.
    yaw = aslant * yz + xz * sideways + aslant * sideways + xz * yz
    coupling = abs(TiltInertia.of(robot.inertia).product) + reduced * left * forward
    coupling = coupling + yaw / robot.inertia[2, 2]
    if not layout.pairs:
        coupling = coupling + _asymmetry(module, corners - middle[..., None, :], layout)
    return np.asarray(coupling)


def _asymmetry(module: ModuleBounds, apart: FloatArray, layout: Layout) -> FloatArray:
    """Upper bound on I_xy about their middle of modules that are not mirror images [kg m^2].

    `apart`: positions of the wheels from their middle at each corner of the sizes [m], shape (...,
    n, w, 3).
    """
    _, outward, upward = np.moveaxis(layout.frames(layout.angle or 0.0), -1, 0)
    turned = sum(
        abs(float((one[:, 0] * other[:, 1] + other[:, 0] * one[:, 1]).sum()))
        for one, other in ((outward, outward), (upward, upward), (outward, upward))
    )
    along, across = np.abs(apart[..., 0]), np.abs(apart[..., 1])
    places = np.abs((apart[..., 0] * apart[..., 1]).sum(axis=-1)).max(axis=0)
    moved = (along + across).sum(axis=-1).max(axis=0) * np.abs(module.depth)
    return np.asarray(module.mass * (places + moved + turned * module.size.reach**2))
