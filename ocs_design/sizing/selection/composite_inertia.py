"""Composite inertia of robot and all modules, braked, for many devices at once."""

from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import Layout
from ocs_design.parts.moments import MassMoments
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.placement import Place, Size


class Modules(NamedTuple):
    """One of the equal modules of each device, all of shape (n,).

    Attributes:
        mass: [kg].
        along, up: of its centre of mass from the wheel's, in the module's frame [m].
        xx, yy, zz, yz: of its mass times two coordinates off its centre of mass [kg m^2].
        size: the room that it takes.
    """

    mass: FloatArray
    along: FloatArray
    up: FloatArray
    xx: FloatArray
    yy: FloatArray
    zz: FloatArray
    yz: FloatArray
    size: Size[FloatArray]

    @classmethod
    def of(cls, moments: MassMoments[FloatArray], size: Size[FloatArray]) -> "Modules":
        """Modules of this mass and these moments about the wheel's centre."""
        mass = moments.mass
        along, up = moments.y / mass, moments.z / mass
        return cls(
            mass=mass,
            along=along,
            up=up,
            xx=moments.xx,
            yy=moments.yy - mass * along**2,
            zz=moments.zz - mass * up**2,
            yz=moments.yz - mass * along * up,
            size=size,
        )


@dataclass(frozen=True, eq=False)
class CompositeInertia:
    """Inertia of robot and n devices about roll and pitch as a function of the layout's angle.

    Attributes:
        robot: without the modules, in B. layout: of the modules.
        modules: one of each device.
        centers: of the wheels in B, from the robot's centre of mass [m], shape (n, w, 3).
    """

    robot: MassProperties
    layout: Layout
    modules: Modules
    centers: FloatArray

    def at(self, angle: FloatArray) -> TiltInertia:
        """Inertia about roll and pitch; see `second_moments`."""
        second = self.second_moments(angle)
        x, y, z = (second[axis, axis] for axis in range(3))
        diagonal = np.stack([y + z, x + z], axis=-1)
        return TiltInertia(diagonal, -second[0, 1] - second[0, 2] * second[1, 2] / (x + y))

    def upright(self, angle: FloatArray) -> FloatArray:
        """I_zz [kg m^2], of the shape of `angle`; see `second_moments`."""
        second = self.second_moments(angle)
        return second[0, 0] + second[1, 1]

    def second_moments(self, angle: FloatArray) -> dict[tuple[int, int], FloatArray]:
        """Sums of mass times two coordinates about the whole's centre of mass [kg m^2].

        With the modules at angles [rad], of the shape of `angle`, (n, k) or (1, k).

        By parallel axes of second moments: S = S_robot + sum_i (m p_i p_i^T + R_i S_i R_i^T)
        - (sum_i m p_i) (sum_i m p_i)^T / (M + sum_i m) from the robot's centre of mass.
        """
        mass, along, up, xx, yy, zz, yz = (each[:, None] for each in self.modules[:7])
        frames = self.layout.frames(angle)
        # Components of outward and upward, and places of the modules, shape (3, w, n, k).
        y, z = np.ascontiguousarray(frames.T[1:].swapaxes(-1, -2))
        place = self.centers.T[..., None] + along * y + up * z
        first, count = mass * place.sum(axis=1), frames.shape[-3]
        whole = self.robot.mass + count * mass
        of_robot = np.trace(self.robot.inertia) / 2.0 * np.eye(3) - self.robot.inertia
        second: dict[tuple[int, int], FloatArray] = {}
        for i, j in combinations_with_replacement(range(3), 2):
            # R_i S_i R_i^T = xx 1 + (yy - xx) y y^T + (zz - xx) z z^T + yz (y z^T + z y^T).
            own = (yy - xx) * (y[i] * y[j]).sum(axis=0) + (zz - xx) * (z[i] * z[j]).sum(axis=0)
            own = own + yz * (y[i] * z[j] + z[i] * y[j]).sum(axis=0) + (i == j) * count * xx
            apart = mass * (place[i] * place[j]).sum(axis=0) - first[i] * first[j] / whole
            second[i, j] = of_robot[i, j] + own + apart
        return second


def composite_inertia(
    robot: MassProperties, place: Place, modules: Modules, layout: Layout
) -> CompositeInertia:
    """Inertia of each device on the robot; see `CompositeInertia`."""
    return CompositeInertia(robot, layout, modules, place.centers(modules.size) - robot.com)
