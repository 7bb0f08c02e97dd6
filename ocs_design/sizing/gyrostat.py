"""A rigid trunk with two driven wheels in free flight.

See docs/theory.md, The robot with its wheels: a gyrostat.
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Gyrostat:
    """A rigid trunk with two driven wheels.

    With the motor torques tau at the wheels and the drive's armature a:

        I_tot w_dot + h A W_dot = -w x H,    H = I_tot w + h A W
        h A^T w_dot + (h + a) W_dot = tau

    Attributes:
        inertia: I_tot, of everything about its centre of mass in B, wheels braked [kg m^2],
            shape (3, 3).
        axes: A, unit spin axes as columns, shape (3, 2).
        spin_inertia: h, momentum of one wheel per speed relative to the trunk [kg m^2].
        armature: a, what a motor accelerates beyond h [kg m^2].
    """

    inertia: FloatArray
    axes: FloatArray
    spin_inertia: float
    armature: float = 0.0

    @property
    def mass_matrix(self) -> FloatArray:
        """Of trunk rate and wheel speeds; its first three rows give the momentum, shape (5, 5)."""
        coupling = self.spin_inertia * self.axes
        driven = (self.spin_inertia + self.armature) * np.eye(2)
        return np.block([[self.inertia, coupling], [coupling.T, driven]])

    @property
    def reaction(self) -> float:
        """Torque on the trunk per motor torque, `h / (h + a)`: the armature takes the rest."""
        return self.spin_inertia / (self.spin_inertia + self.armature)

    @property
    def actuated_inertia(self) -> FloatArray:
        """What the reaction accelerates, `J = I_tot - h^2 / (h + a) A A^T` [kg m^2], shape (3, 3).

        `J w_dot = -h / (h + a) A tau - w x H`, the wheel's equation put into the trunk's.
        """
        return self.inertia - self.reaction * self.spin_inertia * self.axes @ self.axes.T

    @property
    def wheel_response(self) -> float:
        """Largest change of wheel speed per motor torque, both motors pushing alike [1/(kg m^2)].

        From the same equations: `W_dot = (1 / (h + a) + (h / (h + a))^2 A^T J^-1 A) tau`.
        """
        coupling = self.axes.T @ np.linalg.solve(self.actuated_inertia, self.axes)
        alone = 1.0 / (self.spin_inertia + self.armature)
        return float(alone + self.reaction**2 * np.abs(coupling).sum(axis=1).max())

    @property
    def sharing(self) -> FloatArray:
        """From a torque on the trunk to the smallest minus motor torques, shape (2, 3)."""
        # An axis that the wheels reach with less than 1e-6 of their torque is left alone.
        inverse = np.linalg.pinv(self.axes, rcond=1e-6)
        return np.asarray(inverse / self.reaction, dtype=np.float64)
