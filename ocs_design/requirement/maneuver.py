"""Maneuvers as data: what the device must do, and how the proof by simulation starts."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False, kw_only=True)
class Maneuver(ABC):
    """One thing that the device must do in the air.

    Attributes:
        name: unique in a specification.
        gravity: [m/s^2], positive.
        incidence: angle that the device is set to by hand for this maneuver [rad]; None: the design's.
    """

    name: str
    gravity: float = 9.81
    incidence: float | None = None

    @abstractmethod
    def momentum(self, inertia: FloatArray, standing_height: float) -> FloatArray:
        """Largest roll and pitch momentum that both wheels together must take at once [N m s], shape (2,).

        Args:
            inertia: of the robot with its device, wheels braked [kg m^2], shape (3, 3).
            standing_height: of the trunk over the ground [m].
        """


@dataclass(frozen=True, eq=False, kw_only=True)
class Disturbance(Maneuver):
    """A jump during which a torque hits the trunk (paper, section 4, first test).

    Attributes:
        takeoff_velocity: forward and upward at lift-off [m/s].
        torque: on the trunk in B [N m], shape (3,).
        onset: time from lift-off to the torque [s].
        duration: of the torque [s].
    """

    takeoff_velocity: tuple[float, float]
    torque: tuple[float, float, float]
    onset: float
    duration: float

    def momentum(self, inertia: FloatArray, standing_height: float) -> FloatArray:
        """The angular impulse, which the wheels hold until touchdown (THEORY, section 6)."""
        del inertia, standing_height
        return np.abs(np.array(self.torque[:2])) * self.duration


@dataclass(frozen=True, eq=False, kw_only=True)
class Drop(Maneuver):
    """A fall from rest with the trunk tilted (paper, section 4, second test).

    Attributes:
        height: of the trunk frame's origin over the ground [m].
        roll, pitch: at release [rad].
    """

    height: float
    roll: float = 0.0
    pitch: float

    def duration(self, standing_height: float) -> float:
        """From release until the feet of the levelled robot meet the ground [s]."""
        return float(np.sqrt(2.0 * (self.height - standing_height) / self.gravity))

    def momentum(self, inertia: FloatArray, standing_height: float) -> FloatArray:
        """Half the time up, half the time down: a peak rate of 2 theta / T."""
        rate = 2.0 * np.abs([self.roll, self.pitch]) / self.duration(standing_height)
        return np.diag(inertia)[:2] * rate


@dataclass(frozen=True, eq=False, kw_only=True)
class Flip(Maneuver):
    """A full turn, or part of one, in a vertical jump (paper, section 4, third test).

    Attributes:
        jump_height: of the centre of mass over its height at lift-off [m].
        angle: of pitch [rad]; a back-flip is negative about y (left).
        duration: of the turn, from lift-off [s].
    """

    jump_height: float
    angle: float
    duration: float

    def momentum(self, inertia: FloatArray, standing_height: float) -> FloatArray:
        """Half the time up, half the time down: a peak rate of 2 theta / T."""
        del standing_height
        return np.array([0.0, inertia[1, 1] * 2.0 * abs(self.angle) / self.duration])
