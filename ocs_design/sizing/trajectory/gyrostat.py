"""A rigid trunk with n driven wheels in free flight.

See docs/theory.md, The robot with its wheels: a gyrostat.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray

OUT_OF_REACH = 1e-6
"""Share of their torque below which the wheels leave an axis alone."""


@dataclass(frozen=True, eq=False)
class Gyrostat:
    """A rigid trunk with n driven wheels, all alike.

    With the motor torques tau at the wheels and the drive's armature a:

        I_tot w_dot + h A W_dot = -w x H,    H = I_tot w + h A W
        h A^T w_dot + (h + a) W_dot = tau

    Attributes:
        inertia: I_tot, of everything about its centre of mass in B, wheels braked [kg m^2],
            shape (3, 3).
        axes: A, unit spin axes as columns, shape (3, n).
        spin_inertia: h, momentum of one wheel per speed relative to the trunk [kg m^2].
        armature: a, what a motor accelerates beyond h [kg m^2].
    """

    inertia: FloatArray
    axes: FloatArray
    spin_inertia: float
    armature: float = 0.0

    @property
    def mass_matrix(self) -> FloatArray:
        """Mass matrix of trunk rate and wheel speeds, shape (3 + n, 3 + n).

        Its first three rows give the momentum.
        """
        coupling = self.spin_inertia * self.axes
        driven = (self.spin_inertia + self.armature) * np.eye(self.axes.shape[1])
        return np.block([[self.inertia, coupling], [coupling.T, driven]])

    @property
    def reaction(self) -> float:
        """Torque on the trunk per motor torque, `h / (h + a)`: the armature takes the rest."""
        return self.spin_inertia / (self.spin_inertia + self.armature)

    @property
    def actuated_inertia(self) -> FloatArray:
        """Inertia that the reaction accelerates, J [kg m^2], shape (3, 3).

        `J = I_tot - h^2 / (h + a) A A^T`, and
        `J w_dot = -h / (h + a) A tau - w x H`, the wheel's equation put into the trunk's.
        """
        return self.inertia - self.reaction * self.spin_inertia * self.axes @ self.axes.T

    @property
    def wheel_response(self) -> float:
        """Largest change of wheel speed per motor torque, all motors pushing alike [1/(kg m^2)].

        From the same equations: `W_dot = (1 / (h + a) + (h / (h + a))^2 A^T J^-1 A) tau`.
        """
        coupling = self.axes.T @ np.linalg.solve(self.actuated_inertia, self.axes)
        alone = 1.0 / (self.spin_inertia + self.armature)
        return float(alone + self.reaction**2 * np.abs(coupling).sum(axis=1).max())

    @property
    def reach(self) -> NDArray[np.bool_]:
        """Whether the wheels act about each axis of B, shape (3,)."""
        return np.asarray(np.abs(self.axes).max(axis=1) > OUT_OF_REACH)

    @property
    def sharing(self) -> FloatArray:
        """Matrix from a torque on the trunk to the smallest minus motor torques, shape (n, 3)."""
        inverse = np.linalg.pinv(self.axes, rcond=OUT_OF_REACH)
        return np.asarray(inverse / self.reaction, dtype=np.float64)
