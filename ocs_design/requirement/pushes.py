"""Pushes that are not known in advance: a torque that hits the trunk in flight or on its feet."""

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import sqrt
from typing import Annotated, ClassVar, Self, TypeAlias

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import Dimension
from ocs_design.requirement.boundary import UPRIGHT, Boundary, Push, Y
from ocs_design.requirement.maneuver import Built, Impulse, Maneuver, Point, Slew, Time, row_text
from ocs_design.requirement.values import Quantities, Quantity, Sign, Vector3
from ocs_design.robot.mass import MassProperties

Torque: TypeAlias = Annotated[
    Vector3,
    Quantities(Dimension.TORQUE, (3,)),
    "torque on the trunk, about its x (forward), y (left) and z",
]

_LONGEST_STRIDE = 5.0
"""Longest stride [s]: a giraffe's takes one second; a robot is observed for several strides."""


class Unforeseen(Maneuver):
    """A torque on the trunk that is not known in advance.

    Attributes:
        torque: in B [N m], shape (3,).
        duration: of the torque [s].
    """

    torque: Vector3
    duration: float

    foreseen: ClassVar[bool] = False

    @property
    @abstractmethod
    def push(self) -> Push:
        """The torque, and the force that goes with it."""

    @property
    @abstractmethod
    def time_left(self) -> float:
        """Time from the end of the torque until the trunk must be level and at rest again [s]."""

    def boundary(self) -> Boundary:
        """A return to level in the time left after the torque, from level at its onset."""
        if self.time_left <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: no time is left after its torque",
                hint="Let the torque start earlier, or the robot jump higher.",
            )
        return Boundary(
            self.name,
            UPRIGHT,
            UPRIGHT,
            Y,
            0.0,
            self.time_left,
            push=self.push,
            height=self.standing_height if self.on_feet else None,
        )

    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """The impulse, which the wheels hold until touchdown (docs/theory.md, Disturbances)."""
        del inertia
        return np.abs(self._impulse)

    def slew(self, inertia: TiltInertia) -> Slew:
        """Stop the trunk, turn it back and hold its momentum, from the end of the torque on.

        When a torque on a free trunk ends, it has tilted the trunk by half its impulse times its
        duration over the inertia.
        """
        momentum, shape = self._impulse, np.shape(inertia.diagonal)
        return Slew(
            np.broadcast_to(0.5 * self.duration * momentum, shape),
            np.broadcast_to(momentum, shape),
            self.time_left,
            yaw=0.0 if self.direct else self._yaw_impulse,
        )

    @property
    def has_heading_demand(self) -> bool:
        """Whether the wheel law stops a yaw that the torque leaves."""
        return self.direct and bool(self._yaw_impulse)

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Demand of stopping the yaw, as about roll and pitch; see `Maneuver.heading`."""
        momentum = np.full_like(inertia, self._yaw_impulse)
        return 0.5 * self.duration * momentum, momentum

    @property
    def zero_demand(self) -> str:
        """Words for a torque without roll and pitch; empty: it has one of them."""
        return "" if any(self.torque[:2]) else "torque about roll and pitch is 0"

    @property
    def _yaw_impulse(self) -> float:
        """Angular impulse about the vertical [N m s]; 0 on feet, which hold the heading."""
        return 0.0 if self.on_feet else self.torque[2] * self.duration

    @property
    def _impulse(self) -> FloatArray:
        """Angular impulse about roll and pitch [N m s], shape (2,)."""
        return np.array(self.torque[:2]) * self.duration


@dataclass(frozen=True, eq=False, kw_only=True)
class Disturbance(Unforeseen):
    """A jump during which a torque hits the trunk (paper, section 4, first test).

    Attributes:
        velocity_change: of the centre of mass by a force of the same duration, in B [m/s], shape
            (3,); the torque is then the one about the centre of mass.
        impulse: of that force, if torque and change of velocity follow from it (`on`), in B [N s],
            shape (3,). point: where it hits the trunk, in B [m], shape (3,).
    """

    takeoff_velocity: Annotated[
        tuple[float, float], Quantities(Dimension.SPEED, (2,)), "velocity at lift-off: forward, up"
    ]
    torque: Torque
    onset: Annotated[
        float, Quantity(Dimension.TIME, Sign.NOT_NEGATIVE), "time from lift-off to the torque"
    ]
    duration: Annotated[Time, "duration of the torque"]
    velocity_change: Annotated[
        Vector3,
        Quantities(Dimension.SPEED, (3,)),
        "change of the centre of mass's velocity, by a force in addition to the torque",
    ] = (0.0, 0.0, 0.0)
    impulse: Annotated[Impulse, "impulse of a force; torque and velocity_change follow from it"] = (
        0.0,
        0.0,
        0.0,
    )
    point: Point = (0.0, 0.0, 0.0)

    milder_by: ClassVar[tuple[str, ...]] = ("torque", "velocity_change", "impulse")
    reducible: ClassVar[str] = "push"

    def on(self, body: MassProperties) -> Self:
        """Disturbance of a body: the angular impulse r x p about its centre of mass, and p / m."""
        if not any(self.impulse):
            return self
        # Rounded, so that zeros are exact.
        turned = np.round(np.cross(np.subtract(self.point, body.com), self.impulse), 12) + 0.0
        return replace(
            self,
            torque=tuple((turned / self.duration).tolist()),
            velocity_change=tuple((np.array(self.impulse) / body.mass).tolist()),
        )

    def as_built(self, slew: Slew, built: Built) -> Slew:
        """Slew of robots as built: an offset changes the lever and angular impulse of a force."""
        turned = -np.cross(built.offset, self.impulse)
        swept = slew.swept + 0.5 * self.duration * turned[:, :2]
        momentum, yaw = slew.momentum + turned[:, :2], slew.yaw + turned[:, 2]
        return replace(slew, swept=swept, momentum=momentum, yaw=yaw)

    @property
    def momentum_of_body(self) -> FloatArray | None:
        """Angular impulse of a force [N m s], shape (2,); None for a torque."""
        return self._impulse if any(self.impulse) else None

    @property
    def push(self) -> Push:
        """Torque and force, which hit the trunk in flight."""
        return Push(
            np.array(self.torque),
            self.onset,
            self.duration,
            np.array(self.velocity_change) / self.duration,
            np.array(self.impulse) / self.duration,
            np.array(self.point),
        )

    @property
    def takeoff(self) -> tuple[float, float]:
        """Speed as specified [m/s]."""
        return self.takeoff_velocity

    @property
    def rise(self) -> float:
        """Height of its jump [m]; 0: a vertical push changes it."""
        return 0.0 if self.velocity_change[2] else super().rise

    @property
    def time_left(self) -> float:
        """Time left in the air [s]."""
        return self.flight_time - self.onset - self.duration

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands at the height of its take-off [s].

        An upward change of velocity w in the middle of the push, at t', shifts the parabola:
        v t - g t^2 / 2 + w (t - t') = 0.
        """
        upward, gained = self.takeoff_velocity[1], self.velocity_change[2]
        later = upward + gained
        lost = 2.0 * self.gravity * gained * (self.onset + 0.5 * self.duration)
        return (later + sqrt(max(later**2 - lost, 0.0))) / self.gravity

    def slower(self, factor: float) -> Self:
        """A higher jump, with `factor` times the time after the torque."""
        time = self.flight_time + (factor - 1.0) * self.time_left
        forward, _ = self.takeoff_velocity
        # The lift-off speed of `flight_time`, solved for.
        left = time - self.onset - 0.5 * self.duration
        gained = self.velocity_change[2] * left / time
        upward = time * self.gravity / 2.0 - gained
        return replace(self, takeoff_velocity=(forward, upward))

    def contradictions(self) -> Iterator[str]:
        """What contradicts itself, one line each: a torque must end in flight."""
        yield from super().contradictions()
        yield from self._landing_before("its torque", self.onset + self.duration)

    @property
    def summary(self) -> str:
        """Lift-off and torque."""
        forward, upward = self.takeoff_velocity
        text = (
            f"lift-off at {forward:.3g} m/s forward and {upward:.3g} m/s up, "
            f"{row_text(self.torque)} N m on the trunk for {self.duration:.3g} s, "
            f"{self.onset:.3g} s after it"
        )
        if any(self.velocity_change):
            text += f", which changes its velocity by {row_text(self.velocity_change)} m/s"
        return text


@dataclass(frozen=True, eq=False, kw_only=True)
class Shove(Unforeseen):
    """A torque on the trunk of a standing or trotting robot, to be absorbed (paper, section 5).

    The legs are not relied on: the device is sized to absorb it alone.
    """

    torque: Torque
    duration: Annotated[Time, "duration of the torque"]
    settling: Annotated[Time, "time from the end of the torque to rest"]
    stride: Annotated[
        float,
        Quantity(Dimension.TIME, Sign.NOT_NEGATIVE, most=_LONGEST_STRIDE),
        "period of a trot on the spot; 0: the robot stands",
    ] = 0.0

    on_feet: ClassVar[bool] = True
    milder_by: ClassVar[tuple[str, ...]] = ("torque",)
    reducible: ClassVar[str] = "push"

    @property
    def push(self) -> Push:
        """Torque as specified."""
        return Push(np.array(self.torque), 0.0, self.duration)

    def slower(self, factor: float) -> Self:
        """More time to come to rest."""
        return self.scaled(factor, "settling")

    @property
    def time_left(self) -> float:
        """Time left as specified [s]."""
        return self.settling

    @property
    def summary(self) -> str:
        """Torque and time."""
        does = f"trots on the spot, {self.stride:.3g} s a stride" if self.stride else "stands"
        return (
            f"{does}; {row_text(self.torque)} N m on the trunk for {self.duration:.3g} s, "
            f"to be at rest {self.settling:.3g} s after it"
        )
