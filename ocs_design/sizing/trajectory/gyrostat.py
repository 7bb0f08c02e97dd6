"""A rigid trunk with n driven wheels, in free flight or about a pivot.

See docs/theory.md, The robot with its wheels: a gyrostat.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray

NO_AUTHORITY = 1e-6
"""Fraction of the wheels' torque about an axis below which they do not control it."""


@dataclass(frozen=True, eq=False)
class Gyrostat:
    """A rigid trunk with n identical driven wheels.

    About a pivot, with the upward direction e in B and the centre of mass at l:

        I_tot w_dot + h A W_dot = -w x H + m g e x l

    With the motor torques tau at the wheels and the drive's armature a:

        I_tot w_dot + h A W_dot = -w x H,    H = I_tot w + h A W
        h A^T w_dot + (h + a) W_dot = tau

    Attributes:
        inertia: I_tot, of the whole about its centre of mass, or the pivot, in B, wheels braked [kg
            m^2], shape (3, 3).
        axes: A, unit spin axes as columns, shape (3, n).
        spin_inertia: h, momentum of one wheel per speed relative to the trunk [kg m^2].
        armature: a, inertia that a motor accelerates beyond h [kg m^2].
        gravity_moment: m g l from the pivot, in B [N m], shape (3,); zero in free flight.
        edge: unit vector in B, the only axis about which the trunk turns, shape (3,); None: any
            axis.
    """

    inertia: FloatArray
    axes: FloatArray
    spin_inertia: float
    armature: float = 0.0
    gravity_moment: FloatArray = field(default_factory=lambda: np.zeros(3))
    edge: FloatArray | None = None

    @property
    def stands(self) -> bool:
        """Whether it turns about a pivot, with gravity."""
        return bool(self.gravity_moment.any())

    @property
    def controlled_axes(self) -> FloatArray:
        """Axes in B about which the trunk is free and the wheels act, as rows, shape (k, 3)."""
        if self.edge is None:
            return np.eye(3)[self.controlled]
        reached = np.abs(self.edge @ self.axes).max() > NO_AUTHORITY
        return np.reshape(self.edge if reached else (), (-1, 3))

    @property
    def upright(self) -> FloatArray:
        """Attitude with the centre of mass above the pivot, the nearest to level, shape (4,)."""
        return quaternions.upright(self.gravity_moment)

    @property
    def mobility(self) -> FloatArray:
        """Rate per momentum with the wheels held, in B [1/(kg m^2)], shape (3, 3)."""
        if self.edge is None:
            return np.asarray(np.linalg.inv(self.inertia))
        return np.outer(self.edge, self.edge) / float(self.edge @ self.inertia @ self.edge)

    @property
    def inverse_mass_matrix(self) -> FloatArray:
        """Accelerations of trunk and wheels per torque on them, shape (3 + n, 3 + n).

        About an edge, `N (N^T M N)^-1 N^T` with N the motions that it allows.
        """
        if self.edge is None:
            return np.asarray(np.linalg.inv(self.mass_matrix))
        wheels = self.axes.shape[1]
        motions = np.zeros((3 + wheels, 1 + wheels))
        motions[:3, 0], motions[3:, 1:] = self.edge, np.eye(wheels)
        reduced = motions.T @ self.mass_matrix @ motions
        return np.asarray(motions @ np.linalg.solve(reduced, motions.T))

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
        """Torque on the trunk per motor torque, `h / (h + a)`: the armature absorbs the rest."""
        return self.spin_inertia / (self.spin_inertia + self.armature)

    @property
    def actuated_inertia(self) -> FloatArray:
        """Inertia that the reaction accelerates, J [kg m^2], shape (3, 3).

        `J = I_tot - h^2 / (h + a) A A^T`, and `J w_dot = -h / (h + a) A tau - w x H`, the wheel's
        equation substituted into the trunk's.
        """
        return self.inertia - self.reaction * self.spin_inertia * self.axes @ self.axes.T

    @property
    def wheel_response(self) -> float:
        """Largest change of wheel speed per torque, equal for all motors [1/(kg m^2)].

        From the same equations: `W_dot = (1 / (h + a) + (h / (h + a))^2 A^T J^-1 A) tau`.
        """
        coupling = self.axes.T @ np.linalg.solve(self.actuated_inertia, self.axes)
        alone = 1.0 / (self.spin_inertia + self.armature)
        return float(alone + self.reaction**2 * np.abs(coupling).sum(axis=1).max())

    @property
    def controlled(self) -> NDArray[np.bool_]:
        """Whether the wheels have authority about each axis of B, shape (3,)."""
        return np.asarray(np.abs(self.axes).max(axis=1) > NO_AUTHORITY)

    @property
    def axis_rank(self) -> int:
        """Number of independent axes of the wheels."""
        return int(np.linalg.matrix_rank(self.axes, NO_AUTHORITY))

    @property
    def sharing(self) -> FloatArray:
        """Matrix from a trunk torque to the negative of the least motor torques, shape (n, 3)."""
        inverse = np.linalg.pinv(self.axes, rcond=NO_AUTHORITY)
        return np.asarray(inverse / self.reaction, dtype=np.float64)


def shared_by_others(axes: FloatArray, wheel: int) -> FloatArray:
    """Matrix from torques of all motors to those of the remaining ones for the same trunk torque.

    `pinv(A_k) A`, with A_k the axes A, shape (3, n), with column k set to zero, whose motor gives
    no torque: the smallest torques, as close as the remaining axes allow.
    """
    running = np.arange(axes.shape[1]) != wheel
    return np.asarray(
        running[:, None] * (np.linalg.pinv(axes * running, rcond=NO_AUTHORITY) @ axes)
    )


def takeover_factor(axes: FloatArray) -> float:
    """Largest motor torque after one motor has stopped, relative to the largest before.

    The largest row sum of `shared_by_others` over all motors that may stop: at least 1, and 2 for
    four wheels in two pairs, a triad and a pyramid.
    """
    wheels = range(axes.shape[1])
    return max(float(np.abs(shared_by_others(axes, wheel)).sum(axis=1).max()) for wheel in wheels)
