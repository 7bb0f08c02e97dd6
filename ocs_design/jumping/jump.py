"""A specified jump, and the leg references that make it; importing this needs no solver."""

from dataclasses import dataclass
from typing import NamedTuple

from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.maneuver import Maneuver


@dataclass(frozen=True)
class Jump:
    """A push-off from the nominal stance.

    Attributes:
        forward, upward: velocity of the centre of mass at lift-off [m/s].
        gravity: [m/s^2].
    """

    forward: float
    upward: float
    gravity: float

    @property
    def flight_time(self) -> float:
        """Time until the centre of mass is as high again as at lift-off [s]."""
        return 2.0 * self.upward / self.gravity


@dataclass(frozen=True, eq=False)
class LegTrajectory:
    """Joint references from the nominal stance to the touchdown posture, linear between samples.

    Attributes:
        joints: names, n of them.
        time: from the start of the push-off [s], shape (k,), increasing, from 0; after the last
            sample the joints are held.
        position: [rad or m], shape (k, n).
        velocity: [rad/s or m/s], shape (k, n).
        torque: of the drives [N m or N], shape (k, n).
        lift_off: when the feet are to leave the ground [s].
    """

    joints: tuple[str, ...]
    time: FloatArray
    position: FloatArray
    velocity: FloatArray
    torque: FloatArray
    lift_off: float


@dataclass(frozen=True, eq=False)
class JumpPlan:
    """How the legs make a jump, or which limit forbids it.

    Attributes:
        legs: trajectory to track; None: the legs cannot make the jump.
        note: one sentence; empty if none is needed.
    """

    legs: LegTrajectory | None
    note: str


class JumpPlans(NamedTuple):
    """Plans of one jump with and without the device, which is a load on the legs.

    Attributes:
        carrying: of the robot with its device. bare: of the robot without it.
    """

    carrying: JumpPlan
    bare: JumpPlan


IN_FLIGHT = JumpPlan(None, "")
"""Plan without a push-off: the start is at lift-off or release."""

BALLISTIC = JumpPlans(IN_FLIGHT, IN_FLIGHT)
"""Plans in which neither robot pushes off."""


def jump_of(maneuver: Maneuver) -> Jump | None:
    """Jump that a maneuver requires of the legs; None: it starts in the air."""
    return Jump(*maneuver.takeoff, maneuver.gravity) if maneuver.pushed_off else None
