"""Braking the wheels down while the robot stands, so that they can take up momentum again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.requirement.froude import Scale
from ocs_design.requirement.maneuver import STANDARD_GRAVITY
from ocs_design.robot.robot import Robot
from ocs_design.simulation.controller import Target

SETTLING = 0.25
"""Time on the ground before braking starts, of Solo12 [s]."""

BRAKING = 0.5
"""Time constant of the wheels' speed, of Solo12 [s]."""

SUPPORT = 0.05
"""Largest torque of a wheel over weight times standing height: the feet stay down."""


@dataclass(frozen=True)
class Desaturation:
    """How the wheels of one world are braked while it stands.

    The law damps the trunk meanwhile: the feet take up what the wheels let go.

    Attributes:
        settling: on the ground before it starts [s].
        damping: torque per wheel speed [N m s/rad]. torque_max: [N m].
    """

    settling: float
    damping: float
    torque_max: float

    @classmethod
    def of(
        cls, robot: Robot, standing: float, spin_inertia: float, gravity: float
    ) -> "Desaturation":
        """With times that scale as the robot's own, and a torque that its weight outdoes."""
        time = Scale.of(robot).time(STANDARD_GRAVITY)
        return cls(
            SETTLING * time,
            spin_inertia / (BRAKING * time),
            SUPPORT * robot.mass * gravity * standing,
        )


class Braked(Protocol):
    """A world whose wheels may be braked."""

    @property
    def desaturation(self) -> Desaturation | None:
        """None: they are not."""


class WheelBrake:
    """The same for n worlds, with the time that each has stood."""

    def __init__(self, own: Sequence[Desaturation | None], period: float) -> None:
        """Of worlds that decide every `period` [s]."""
        idle = Desaturation(np.inf, 0.0, 0.0)
        rows = [idle if each is None else each for each in own]
        self._settling = np.array([each.settling for each in rows])
        self._damping = np.array([[each.damping] for each in rows])
        self._largest = np.array([[each.torque_max] for each in rows])
        self._stood, self._period = np.zeros(len(rows)), period

    @classmethod
    def of(cls, worlds: Sequence[Braked], period: float) -> "WheelBrake | None":
        """None where no world brakes."""
        own = [world.desaturation for world in worlds]
        return cls(own, period) if any(own) else None

    def added(self, target: Target, speed: FloatArray, contact: NDArray[np.bool_]) -> Target:
        """The target with the braking torque on top.

        Args:
            target: of the first n worlds. speed: of their wheels [rad/s], shape (n, 2).
            contact: whether each has just touched the floor, shape (n,).
        """
        n = len(speed)
        self._stood[:n] = np.where(contact, self._stood[:n] + self._period, 0.0)
        wanted = np.clip(-self._damping[:n] * speed, -self._largest[:n], self._largest[:n])
        stands = (self._stood[:n] >= self._settling[:n])[:, None]
        return replace(target, torque=target.torque + np.where(stands, wanted, 0.0))
