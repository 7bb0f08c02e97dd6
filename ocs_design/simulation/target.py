"""Targets of trunks at one instant: the wheel law's input besides its measurements."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray, Table


@dataclass(frozen=True, eq=False)
class RegulatedPlan(Table):
    """Planned states of n worlds at one instant, and the gains that hold a trunk to them.

    Attributes:
        attitude: quaternions (n, 4). rate: in B [rad/s], (n, 3). wheel_speed: [rad/s], (n, m).
        wheel_torque: of the motors [N m], (n, m).
        gains: see `Trajectory`, (n, m, 6 + m).
        holds: whether each world follows such a plan now, (n,).
    """

    attitude: FloatArray
    rate: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    gains: FloatArray
    holds: NDArray[np.bool_]

    def torque(self, attitude: FloatArray, rate: FloatArray, speed: FloatArray) -> FloatArray:
        """Planned torque minus the gains times the errors [N m], shape (n, m)."""
        attitude_error = quaternions.product(quaternions.conjugate(self.attitude), attitude)
        error = np.concatenate(
            [
                quaternions.rotation_vector(attitude_error),
                rate - self.rate,
                speed - self.wheel_speed,
            ],
            axis=1,
        )
        correction: FloatArray = np.einsum("nij,nj->ni", self.gains, error)
        return self.wheel_torque - correction


@dataclass(frozen=True, eq=False)
class Target(Table):
    """Attitude and rate that n trunks should have at one instant.

    Attributes:
        vertical: the world's upward direction in B, unit vectors (n, 3). The heading
            is free.
        rate, acceleration: in B [rad/s, rad/s^2], shape (n, 3); about yaw they count only if the
            wheels span all three axes.
        torque: of the motors, in addition to those for the acceleration and the present gyroscopic
            torque [N m], shape (n, m).
        stands: whether the feet are on the ground, shape (n,). Three or more legs then hold the
            attitude and the wheels only damp: if the stance leans, wheels that push against it run
            up to their top speed and become useless.
        plan: that worlds follow with its own gains instead of all this; None: none does.
        shared: matrices from the torques asked of all motors to those of the motors still running
            (`shared_by_others`), shape (n, m, m); None: all run.
    """

    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    stands: NDArray[np.bool_]
    plan: RegulatedPlan | None = None
    shared: FloatArray | None = None

    def landed(self, contact: NDArray[np.bool_]) -> "Target":
        """Target with rest for worlds whose feet are on the ground, where plans end."""
        in_flight, plan = ~contact[:, None], self.plan
        return Target(
            self.vertical,
            self.rate * in_flight,
            self.acceleration * in_flight,
            self.torque * in_flight,
            self.stands | contact,
            None if plan is None else replace(plan, holds=plan.holds & ~contact),
        )


@dataclass(frozen=True)
class StoppedDrive:
    """A drive that stops in flight: its motor gives no torque, and its wheel runs on.

    Attributes:
        wheel: index, from 0. instant: from lift-off or release [s].
        detection: time from `instant` until the law knows of it [s].
    """

    wheel: int
    instant: float
    detection: float
