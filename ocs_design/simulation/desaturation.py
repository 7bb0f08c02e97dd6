"""Braking of the wheels while the robot stands, so that they can absorb momentum again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, Table, stacked_columns
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.requirement.froude import FroudeScale
from ocs_design.robot.robot import Robot
from ocs_design.simulation.target import Target

SETTLING = 0.25
"""Time on the ground before braking starts, of Solo12 [s]."""

BRAKING = 0.5
"""Time constant of the wheels' speed, of Solo12 [s]."""

SUPPORT = 0.05
"""Largest braking torque of a wheel over weight times standing height: the feet stay down."""


@dataclass(frozen=True, eq=False)
class Desaturation(Table):
    """Braking of the wheels in stance, for one world or, with arrays of shape (n, 1), for n.

    Meanwhile the law damps the trunk: the feet take up the momentum that the wheels give off.

    Attributes:
        settling: time on the ground before braking starts [s].
        damping: torque per wheel speed [N m s/rad]. torque_max: [N m].
    """

    settling: FloatArray | float
    damping: FloatArray | float
    torque_max: FloatArray | float

    @classmethod
    def of(
        cls, robot: Robot, standing: float, spin_inertia: float, gravity: float
    ) -> "Desaturation":
        """Settings with times scaled to the robot, and a torque too small to lift its feet."""
        time = FroudeScale.of(robot).time(STANDARD_GRAVITY)
        return cls(
            SETTLING * time,
            spin_inertia / (BRAKING * time),
            SUPPORT * robot.mass * gravity * standing,
        )

    def torque(self, speed: FloatArray, stood: FloatArray) -> FloatArray:
        """Torque that brakes wheels while the robot stands [N m], shape (n, wheels).

        Args:
            speed: of the wheels [rad/s], shape (n, wheels).
            stood: time on the ground [s], shape (n, 1).
        """
        braking = np.minimum(np.maximum(-self.damping * speed, -self.torque_max), self.torque_max)
        return np.where(stood >= self.settling, braking, 0.0)


class WheelBrake:
    """Brakes the wheels of n worlds, and keeps the time that each has stood."""

    def __init__(self, desaturations: Sequence[Desaturation | None], period: float) -> None:
        """Brakes of worlds with control steps of `period` [s]."""
        idle = Desaturation(np.inf, 0.0, 0.0)
        self._brakes = stacked_columns(
            [idle if desaturation is None else desaturation for desaturation in desaturations]
        )
        self._stood, self._period = np.zeros(len(desaturations)), period

    def with_braking(self, target: Target, speed: FloatArray, contact: NDArray[np.bool_]) -> Target:
        """The target with the braking torque added.

        Args:
            target: of the first n worlds. speed: of their wheels [rad/s], shape (n, m).
            contact: whether each has just touched the floor, shape (n,).
        """
        n = len(speed)
        self._stood[:n] = np.where(contact, self._stood[:n] + self._period, 0.0)
        torque = self._brakes.take(slice(n)).torque(speed, self._stood[:n, None])
        return replace(target, torque=target.torque + torque)
