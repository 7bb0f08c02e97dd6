"""The wheel law of the paper, for a batch of worlds at once.

`tau_fb = -I_r (K_p e + K_d e_dot) - w x (I_r w)`, `u = C^T tau_fb` (paper, section 3.3), with what
docs/theory.md adds: the motor torque acts on the wheel and its reaction on the trunk; the
wheels' own momentum is compensated; the pseudo-inverse gives the commanded torque where the
paper's transpose gives it scaled by `C C^T`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.simulation.motor_limits import MotorLimits, clipped
from ocs_design.sizing.gyrostat import Gyrostat


class Allocation(StrEnum):
    """How a torque on the trunk is shared between the wheels."""

    PSEUDO_INVERSE = "pseudo-inverse"
    TRANSPOSE = "transpose"


@dataclass(frozen=True)
class Gains:
    """Of the attitude error: `stiffness` [1/s^2] and `damping` [1/s], per unit of inertia."""

    stiffness: float
    damping: float


@dataclass(frozen=True, eq=False)
class WheelLaw:
    """The law's constants for n worlds; every array has the worlds first.

    Attributes:
        momentum_map: `[I_tot, h A]`, from trunk rate and wheel speeds to momentum,
            shape (n, 3, 5).
        torque_map: from roll and pitch acceleration and the gyroscopic torque to motor torques,
            shape (n, 2, 5).
        stiffness, damping: `Gains`, shape (n,).
        standing_stiffness: in place of `stiffness` on the ground, shape (n,).
        no_load_speed, line_slope, torque_limit, speed_max: see `MotorLimits`, shape (n,).
        wheel_response: see `Gyrostat`, shape (n,).
    """

    momentum_map: FloatArray
    torque_map: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    no_load_speed: FloatArray
    line_slope: FloatArray
    torque_limit: FloatArray
    speed_max: FloatArray
    wheel_response: FloatArray
    standing_stiffness: FloatArray

    @classmethod
    def of(
        cls,
        body: Gyrostat,
        gains: Gains,
        limits: MotorLimits,
        allocation: Allocation,
        *,
        balances: bool = False,
    ) -> "WheelLaw":
        """The law of one world (n = 1); `balances`: the wheels hold the attitude in stance too."""
        momentum_map = np.hstack([body.inertia, body.spin_inertia * body.axes])
        shared = body.axes.T / body.reaction if allocation is Allocation.TRANSPOSE else body.sharing
        torque_map = _torque_map(body.actuated_inertia, shared)
        return cls(
            momentum_map[None],
            torque_map[None],
            np.array([gains.stiffness]),
            np.array([gains.damping]),
            np.array([limits.no_load_speed]),
            np.array([limits.line_slope]),
            np.array([limits.torque_limit]),
            np.array([limits.speed_max]),
            np.array([body.wheel_response]),
            np.array([gains.stiffness if balances else 0.0]),
        )

    @classmethod
    def off(cls) -> "WheelLaw":
        """No torque, in one world."""
        one, none = np.ones(1), np.zeros(1)
        maps = np.zeros((1, 3, 5)), np.zeros((1, 2, 5))
        return cls(*maps, none, none, one, one, none, one, one, none)

    @classmethod
    def stack(cls, laws: Sequence["WheelLaw"]) -> "WheelLaw":
        """Several worlds' laws as one."""
        names = [field.name for field in fields(cls)]
        return cls(*(np.concatenate([getattr(law, name) for law in laws]) for name in names))

    @property
    def is_off(self) -> bool:
        """Whether none of the motors ever pushes."""
        return not self.torque_limit.any()

    def take(self, worlds: slice) -> "WheelLaw":
        """The law of some of the worlds."""
        return WheelLaw(*(getattr(self, field.name)[worlds] for field in fields(self)))

    def torque(
        self,
        vertical: FloatArray,
        rate: FloatArray,
        wheel_speed: FloatArray,
        target: "Target",
        period: float,
    ) -> FloatArray:
        """Motor torque on each wheel [N m], shape (n, 2).

        Args:
            vertical: the world's upward direction in B, unit vectors (n, 3).
            rate: of the trunk in B [rad/s], (n, 3).
            wheel_speed: relative to the trunk [rad/s], (n, 2).
            target: where the trunk should be.
            period: for which the torque will be held [s].
        """
        wanted = self._acceleration(vertical, rate, target)
        gyroscopic = self.gyroscopic(rate, wheel_speed)
        torque = np.einsum(
            "nij,nj->ni", self.torque_map, np.concatenate([wanted, gyroscopic], axis=1)
        )
        return self._limited(torque + target.torque, wheel_speed, period)

    def gyroscopic(self, rate: FloatArray, wheel_speed: FloatArray) -> FloatArray:
        """`w x (I_tot w + h A W)` [N m], shape (n, 3), or (k, 3) of k states of a single world."""
        momentum = np.einsum(
            "nij,nj->ni", self.momentum_map, np.concatenate([rate, wheel_speed], axis=1)
        )
        return _cross(rate, momentum)

    def _acceleration(self, vertical: FloatArray, rate: FloatArray, target: "Target") -> FloatArray:
        """Roll and pitch acceleration that the law asks for [rad/s^2], shape (n, 2)."""
        error = tilt_error(vertical, target.vertical)
        slip = target.rate - rate[:, :2]
        stiffness = np.where(target.stands, self.standing_stiffness, self.stiffness)
        return stiffness[:, None] * error + self.damping[:, None] * slip + target.acceleration

    def _limited(self, torque: FloatArray, wheel_speed: FloatArray, period: float) -> FloatArray:
        """What the motors that the law believes in can give."""
        return clipped(
            torque,
            wheel_speed,
            gain=(self.wheel_response * period)[:, None],
            line_slope=self.line_slope[:, None],
            no_load_speed=self.no_load_speed[:, None],
            torque_limit=self.torque_limit[:, None],
            speed_max=self.speed_max[:, None],
        )


@dataclass(frozen=True, eq=False)
class Target:
    """Where n trunks should be at one instant.

    Attributes:
        vertical: the world's upward direction in B, unit vectors (n, 3). The heading
            is free.
        rate, acceleration: about roll and pitch in B [rad/s, rad/s^2], shape (n, 2).
        torque: of the motors, on top of what the acceleration and the gyroscopic torque of the
            moment ask for [N m], shape (n, 2).
        stands: whether the feet are on the ground, shape (n,). Three legs and more then hold the
            attitude and the wheels only damp: whatever the stance leans by, wheels that push
            against it run up to their top speed and are of no use any more.
    """

    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    stands: NDArray[np.bool_]

    def landed(self, contact: NDArray[np.bool_]) -> "Target":
        """The same in the air; at rest where the feet are on the ground, as plans end there."""
        left = ~contact[:, None]
        return Target(
            self.vertical,
            self.rate * left,
            self.acceleration * left,
            self.torque * left,
            self.stands | contact,
        )


def tilt_error(vertical: FloatArray, target: FloatArray) -> FloatArray:
    """Turn about roll and pitch that takes the trunk to its target [rad], in B, shape (n, 2).

    The attitude error in SO(3) after the target is turned about the vertical to the heading that
    the trunk has: two wheels cannot command yaw, and a heading that drifts must not twist roll and
    pitch. What is left is the swing of the swing-twist split: the smallest turn that brings the
    vertical, as seen from the trunk, to where the target sees it.

    Args:
        vertical: the world's upward direction as seen from the trunk, unit vectors (n, 3).
        target: the same as the target sees it, (n, 3).
    """
    axis = _cross(target, vertical)
    sine = np.sqrt((axis * axis).sum(axis=1))
    angle = np.arctan2(sine, (target * vertical).sum(axis=1))
    error: FloatArray = axis[:, :2] * (angle / (sine + 1e-300))[:, None]
    return error


def _torque_map(actuated_inertia: FloatArray, allocation: FloatArray) -> FloatArray:
    """Motor torques from (roll acceleration, pitch acceleration, w x H), shape (2, 5).

    `J w_dot = -g A tau - w x H`, g the reaction (see `Gyrostat`), solved for tau. The wheels cannot
    push about z, so its row is no command but says which yaw acceleration comes with the other two.
    """
    J = actuated_inertia
    yaw = J[:, 2:] / J[2, 2]
    from_tilt = J[:, :2] - yaw @ J[2:, :2]
    from_gyroscopic = np.eye(3) - yaw @ np.array([[0.0, 0.0, 1.0]])
    torques: FloatArray = -allocation @ np.hstack([from_tilt, from_gyroscopic])
    return torques


def _cross(left: FloatArray, right: FloatArray) -> FloatArray:
    """Row-wise cross product, shape (n, 3); on small batches five times as fast as `np.cross`."""
    a, b, c = left.T
    x, y, z = right.T
    result = np.empty_like(left)
    result[:, 0] = b * z - c * y
    result[:, 1] = c * x - a * z
    result[:, 2] = a * y - b * x
    return result
