"""Inertia about roll and pitch of a body whose heading is free.

Two wheels with horizontal axes cannot command yaw, and at zero momentum yaw follows roll and pitch
(docs/theory.md, Heading drift). Eliminating it leaves the coupling of roll and pitch

    J_xy = I_xy - I_xz I_yz / I_zz

and reduces I_xx and I_yy by I_xz^2 / I_zz and I_yz^2 / I_zz, which is neglected: that is
conservative for a turn about one axis (docs/theory.md, Two wheels on a trunk).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.common.arrays import FloatArray

OUT_OF_REACH = 1e-9
"""Sine or cosine of an incidence below which the wheels do not control an axis; cos(pi/2) is 6e-17.
"""

DRIFT_MAX = float(np.radians(1.0))
"""Largest angle off level at a turn's end about an axis that the wheels do not control [rad]."""


class TiltInertia(NamedTuple):
    """Inertia about roll and pitch of one body, or of many, whose heading is free.

    Attributes:
        diagonal: I_xx and I_yy [kg m^2], shape (..., 2).
        product: J_xy, off-diagonal element of the tensor [kg m^2], shape (...).
    """

    diagonal: FloatArray
    product: FloatArray

    @classmethod
    def of(cls, inertia: ArrayLike) -> "TiltInertia":
        """Tilt inertia from the inertia about the centre of mass in B [kg m^2], shape (3, 3)."""
        whole = np.asarray(inertia, dtype=np.float64)
        yaw = whole[0, 2] * whole[1, 2] / whole[2, 2]
        return cls(np.diag(whole)[:2], np.asarray(whole[0, 1] - yaw))

    @classmethod
    def uncoupled(cls, diagonal: ArrayLike) -> "TiltInertia":
        """Tilt inertia of I_xx and I_yy alone, J_xy = 0 [kg m^2], shape (..., 2)."""
        values = np.asarray(diagonal, dtype=np.float64)
        return cls(values, np.zeros(values.shape[:-1]))

    def times(self, shape: tuple[int, ...]) -> "TiltInertia":
        """Tilt inertia broadcast to `shape`."""
        return TiltInertia(
            np.broadcast_to(self.diagonal, (*shape, 2)), np.broadcast_to(self.product, shape)
        )

    def momentum(self, rate: FloatArray) -> FloatArray:
        """Momentum about roll and pitch at these rates [N m s], shape (..., 2)."""
        across = self.product[..., None] * rate[..., ::-1]
        return np.asarray(self.diagonal * rate + across)

    @property
    def share(self) -> FloatArray:
        """|J_xy| / sqrt(I_xx I_yy), below 1, shape (...)."""
        return np.asarray(np.abs(self.product) / np.sqrt(self.diagonal.prod(axis=-1)))

    @property
    def drift(self) -> FloatArray:
        """Roll per pitch and pitch per roll of a body free about that axis, shape (..., 2)."""
        return np.asarray(np.abs(self.product)[..., None] / self.diagonal)

    def drifts_off_level(self, tilt_per_drift: float) -> NDArray[np.bool_]:
        """Whether a turn ends off level about an uncontrolled axis, shape (..., 2).

        `tilt_per_drift`: angle off level at the end, per unit of drift [rad].
        """
        return np.asarray(self.drift * tilt_per_drift > DRIFT_MAX)

    def within_reach(self, shares: FloatArray, tilt_per_drift: float) -> "TiltInertia":
        """Inertia to be turned by wheels that leave an uncontrolled axis free, like yaw.

        The body then drifts about that axis by J_xy over its inertia, and the inertia about the
        other one is reduced by J_xy^2 over it. Where a turn `drifts_off_level`, the coupling stays:
        it requires momentum that these wheels cannot absorb.

        `shares`: components of a wheel's axis about roll and pitch, shape (..., 2).
        """
        uncontrolled = shares <= OUT_OF_REACH
        if not uncontrolled.any():
            return self
        free = uncontrolled & ~self.drifts_off_level(tilt_per_drift)
        reduction = np.abs(self.product)[..., None] * self.drift * free
        return TiltInertia(
            np.asarray(self.diagonal - reduction[..., ::-1]),
            np.where(free.any(axis=-1), 0.0, self.product),
        )
