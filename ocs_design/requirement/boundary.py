"""A maneuver as a boundary value problem: its start, what acts on the robot, and its end.

Attitudes are unit quaternions (w, x, y, z) that turn B into the world.
"""

from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.quaternions import scaled_vertical

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
"""Trunk upright, its x axis along the world's."""

X, Y, Z = np.eye(3)
"""Axes of the trunk in B: of roll, pitch and yaw."""


class End(StrEnum):
    """Condition at the end of a turn; about the axes that the wheels reach, it ends at rest.

    Attributes:
        LEVEL: the trunk is upright, whatever its heading.
        ATTITUDE: it has the specified attitude, heading included.
        AT_REST: it no longer turns, whatever its attitude.
    """

    LEVEL = "level"
    ATTITUDE = "attitude"
    AT_REST = "at rest"


@dataclass(frozen=True, eq=False)
class Push:
    """A torque on the trunk in B [N m], shape (3,), from `onset` for `duration` [s].

    Attributes:
        acceleration: of the whole robot by an additional force, in B [m/s^2], shape (3,): on each
            body in proportion to its mass, so that it turns nothing.
        force: in B [N], shape (3,); if it is not zero, `of_force` replaces torque and acceleration
            by its effect on the robot as flown.
        point: where the force acts, in B [m], shape (3,).
    """

    torque: FloatArray
    onset: float
    duration: float
    acceleration: FloatArray = field(default_factory=lambda: np.zeros(3))
    force: FloatArray = field(default_factory=lambda: np.zeros(3))
    point: FloatArray = field(default_factory=lambda: np.zeros(3))

    def of_force(self, mass: float, com: FloatArray) -> "Push":
        """The push of its force on a body of this mass [kg] and centre of mass in B [m]."""
        arm = self.point - com
        return replace(self, torque=np.cross(arm, self.force), acceleration=self.force / mass)

    def share(self, starts: FloatArray, period: float) -> FloatArray:
        """Share of each control step, from `starts`, in which it acts: its impulse is exact."""
        begin = np.maximum(starts, self.onset)
        end = np.minimum(starts + period, self.onset + self.duration)
        share: FloatArray = np.clip(end - begin, 0.0, None) / period
        return share


NO_PUSH = Push(np.zeros(3), 0.0, 0.0)


class Freedom(NamedTuple):
    """How a rigid body is free to turn: about its centre of mass, or about a pivot.

    Attributes:
        inertia: about that point, in B [kg m^2], shape (3, 3).
        gravity_moment: weight times the lever from the pivot, m g l in B [N m], shape (3,); zero in
            the air.
        edge: unit vector in B, the only axis about which it turns, shape (3,); None: any axis.
    """

    inertia: FloatArray
    gravity_moment: FloatArray
    edge: FloatArray | None


@dataclass(frozen=True, eq=False)
class Boundary:
    """A turn of the trunk that ends at rest about all axes that the wheels control.

    Attributes:
        name: of the maneuver.
        attitude: at the start, shape (4,).
        final_attitude: at the end, shape (4,); `end` says which part of it counts.
        axis: unit vector about which the trunk mainly turns, in B, shape (3,).
        angle: of that turn [rad], signed; beyond half a turn it gives the number of revolutions.
        duration: duration of the turn [s].
        end: final condition, one of `End`.
        rate: of the trunk at the start, in B [rad/s], shape (3,).
        wheel_speed: at the start [rad/s], shape (n,) or one for all.
        push: on the trunk before the turn; the wheels are held until it ends.
        height: of the trunk above the ground at the start [m]; None: it has just lifted off, or
            floats.
    """

    name: str
    attitude: FloatArray
    final_attitude: FloatArray
    axis: FloatArray
    angle: float
    duration: float
    end: str = End.LEVEL
    rate: FloatArray = field(default_factory=lambda: np.zeros(3))
    wheel_speed: FloatArray | float = 0.0
    push: Push = NO_PUSH
    height: float | None = None

    @property
    def final_vertical(self) -> FloatArray:
        """The world's upward direction in B at the end, shape (3,)."""
        return scaled_vertical(self.final_attitude)
