"""Maneuvers as data: what the device must do, and how its validation by simulation starts.

They are the `[[maneuver]]` tables of a specification. This module has their common part and the
paper's maneuvers: a disturbed jump, a shove, a drop and a flip.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import inf, pi, remainder, sqrt
from typing import Annotated, Any, ClassVar, Self, TypeAlias

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.quaternions import from_axis_angle, product, vertical_of
from ocs_design.common.units import STANDARD_GRAVITY, Dimension, format_quantity
from ocs_design.requirement.boundary import (
    UPRIGHT,
    Boundary,
    End,
    Freedom,
    Push,
    X,
    Y,
)
from ocs_design.requirement.values import (
    HEIGHT,
    INCIDENCE,
    SPIN,
    TILT,
    TIME,
    TURN,
    Quantities,
    Quantity,
    Sign,
    Text,
    Vector3,
)
from ocs_design.robot.mass import MassProperties


@dataclass(frozen=True, eq=False)
class Slew:
    """What both wheels together must do to the trunk in a given time, about roll and pitch.

    Attributes:
        swept: time integral of the momentum that the wheels must take: inertia times angle of a
            turn from rest to rest [N m s^2], shape (..., 2).
        momentum: that the wheels still hold at the end [N m s], shape (..., 2).
            Relative signs matter; the overall sign does not.
        duration: in which it must be done [s].
        begins: initial speed of all wheels, in the direction of swept and momentum [rad/s].
        one_way: whether the wheels do not really return to that speed, as gravity acts in place of
            the turn's way back.
    """

    swept: FloatArray
    momentum: FloatArray
    duration: float
    begins: float = 0.0
    one_way: bool = False


Time: TypeAlias = Annotated[float, TIME]
Height: TypeAlias = Annotated[float, HEIGHT]
JumpHeight: TypeAlias = Annotated[Height, "of the centre of mass"]
TurnTime: TypeAlias = Annotated[Time, "of the turn, from lift-off"]
Tilt: TypeAlias = Annotated[float, TILT]
Turn: TypeAlias = Annotated[float, TURN]
Spin: TypeAlias = Annotated[float, SPIN]
Torque: TypeAlias = Annotated[
    Vector3,
    Quantities(Dimension.TORQUE, (3,)),
    "on the trunk, about its x (forward), y (left) and z",
]
Impulse: TypeAlias = Annotated[Vector3, Quantities(Dimension.IMPULSE, (3,))]
Point: TypeAlias = Annotated[
    Vector3, Quantities(Dimension.LENGTH, (3,)), "of the trunk that the force hits"
]
Rate: TypeAlias = Annotated[Vector3, Quantities(Dimension.ANGULAR_SPEED, (3,))]

_LONGEST_STRIDE = 5.0
"""Longest stride [s]: a giraffe's takes one second; a robot is observed for several strides."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Maneuver(ABC):
    """One task of the device: a boundary value problem, and what follows from its kind.

    Attributes:
        name: unique in a specification.
        gravity: [m/s^2]; 0 in orbit, where only turns and catches are possible.
        incidence: angle to which the modules are turned by hand [rad]; None: the design's.
        estimate: factor on the closed-form demand of a kind that is `estimated`.
        on_pivot: whether the robot is on a point or an edge of its trunk, its joints locked.
        on_feet: whether it is on its feet from start to end; otherwise it flies or floats.
        foreseen: whether its trajectory can be planned; otherwise feedback alone meets it.
        estimated: whether a plan may find that it takes more than its closed-form demand, so that
            the device is resized.
        turns_over: whether it turns the trunk over in pitch, and whole turns count.
        heads: whether its change of heading is of interest.
        turned_by: fields that make the angle of its turn, where a front may vary that and its time.
        milder_by: fields to which its tilt or push is proportional. part: which of the two a
            lighter device may be offered part of; empty: neither.
    """

    name: Annotated[str, Text(), "of your choice, different for each maneuver"]
    gravity: Annotated[
        float,
        Quantity(Dimension.ACCELERATION, Sign.NOT_NEGATIVE),
        "if not that of [requirement]",
    ] = STANDARD_GRAVITY
    incidence: Annotated[float | None, INCIDENCE, "if the modules are turned by hand for it"] = None
    estimate: float = 1.0

    on_pivot: ClassVar[bool] = False
    on_feet: ClassVar[bool] = False
    foreseen: ClassVar[bool] = True
    estimated: ClassVar[bool] = False
    turns_over: ClassVar[bool] = False
    heads: ClassVar[bool] = False
    turned_by: ClassVar[tuple[str, ...]] = ()
    milder_by: ClassVar[tuple[str, ...]] = ()
    part: ClassVar[str] = ""

    @abstractmethod
    def boundary(self, standing_height: float) -> Boundary:
        """The boundary value problem.

        Args:
            standing_height: of the trunk above the ground [m].

        Raises:
            SpecificationError: no time is left for it.
        """

    @property
    def end(self) -> str:
        """Condition at the end, one of `End`."""
        return End.LEVEL

    @property
    def takeoff(self) -> tuple[float, float]:
        """Speed at the end of a push-off, forward and upward [m/s]; zeros where there is none."""
        return 0.0, 0.0

    @property
    def lift_off(self) -> float:
        """Upward speed at the end of a push-off [m/s]; 0 where there is none."""
        return self.takeoff[1]

    @property
    def pushed_off(self) -> bool:
        """Whether it begins with a push-off that the legs can be planned to make."""
        return self.lift_off > 0.0

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands where it took off [s]; 0 where it does not."""
        return 0.0

    @property
    def rise(self) -> float:
        """Height of its jump [m]; 0: there is none, or a push changes it."""
        return self.lift_off**2 / (2.0 * self.gravity) if self.lift_off else 0.0

    @property
    def push(self) -> Push | None:
        """Push on the trunk, which is not known in advance; None: there is none."""
        return None

    @property
    def stride(self) -> float:
        """Stride of a trot on the spot during which it happens [s]; 0: the robot does not trot."""
        return 0.0

    @property
    def stop(self) -> float:
        """Time in which a brake stops the wheels at the start [s]; inf: none does."""
        return inf

    @property
    def angles(self) -> FloatArray:
        """Roll and pitch between the start and the end of a turn [rad], shape (2,)."""
        return np.zeros(2)

    @property
    def turn(self) -> FloatArray:
        """Turn about roll and pitch that the wheels are sized for [rad], shape (2,); else zeros."""
        return np.zeros(2)

    @property
    def headed(self) -> bool:
        """Whether wheels that reach the vertical turn or stop the trunk about it."""
        return False

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Time integral of the momentum about the vertical, and that held at the end, (...) each.

        Args:
            inertia: I_zz of the robot with its device, wheels braked [kg m^2], shape (...).
        """
        return np.zeros_like(inertia), np.zeros_like(inertia)

    @property
    def stray(self) -> float:
        """Tilt at the end per radian that the trunk has drifted about the other axis [1].

        The chord of the turn [rad]: a whole turn ends where it began (`TiltInertia.within_reach`).
        """
        return float(2.0 * abs(np.sin(np.hypot(*self.turn) / 2.0)))

    def on(self, body: MassProperties) -> Self:
        """The maneuver for a body, in B, where it depends on the body."""
        del body
        return self

    @property
    def momentum_of_body(self) -> FloatArray | None:
        """Momentum about roll and pitch that depends on the body [N m s], shape (2,); or None."""
        return None

    def with_wheels(self, *, direct: bool) -> Self:
        """The maneuver for wheels that act about the vertical or not, where it depends on that."""
        del direct
        return self

    def freedom(self, body: MassProperties) -> Freedom:
        """How a body is free to turn."""
        return Freedom(body.inertia, np.zeros(3), None)

    def turned(self, inertia: TiltInertia) -> TiltInertia:
        """Inertia that is turned, from that about the centre of mass."""
        return inertia

    @abstractmethod
    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Largest roll and pitch momentum of both wheels together, as magnitudes [N m s].

        Args:
            inertia: of the robot with its device, wheels braked.
            standing_height: of the trunk above the ground [m].
        """

    def least_torque(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Least torque of both wheels together on roll and on pitch [N m], shape (2,).

        A smaller torque cannot finish a turn in time, whatever the wheel; zero without a time limit
        (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked.
            standing_height: of the trunk above the ground [m].
        """
        del inertia, standing_height
        return np.zeros(2)

    @abstractmethod
    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """Slew that the motors must make for it (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked; or of many of them.
            standing_height: of the trunk above the ground [m].
        """

    def scaled(self, factor: float, *names: str) -> Self:
        """The maneuver with these fields, numbers or rows of them, multiplied by `factor`."""
        changes: dict[str, Any] = {}
        for name in names:
            value = getattr(self, name)
            row = isinstance(value, tuple)
            changes[name] = tuple(factor * each for each in value) if row else factor * value
        return replace(self, **changes)

    @abstractmethod
    def slower(self, factor: float, standing_height: float) -> Self:
        """The maneuver with `factor` times the time: a higher fall or jump, a longer turn.

        Args:
            factor: positive; below 1: less time.
            standing_height: of the trunk above the ground [m].
        """

    def stretched(self, factor: float, standing_height: float) -> Self:
        """The maneuver with `factor` times the time both for its turn and for its flight."""
        return self.slower(factor, standing_height)

    def milder(self, share: float) -> Self:
        """The maneuver with part of its tilt or push, 0..1."""
        return self.scaled(share, *self.milder_by)

    def calmer(self) -> Self:
        """The maneuver with less torque and more momentum, where it may be made so."""
        return self

    def corrected(self, factor: float) -> Self:
        """The maneuver with another factor on its demand, if that is an estimate."""
        return replace(self, estimate=factor) if self.estimated else self

    def contradictions(self) -> Iterator[str]:
        """What contradicts itself, one line each."""
        if not self.gravity:
            yield f"maneuver.{self.name}: nothing falls in orbit: use a turn or a catch"

    def _landing_before(self, what: str, time: float) -> Iterator[str]:
        """A flight that ends before this time after lift-off [s], in one line."""
        if self.gravity and time >= self.flight_time:
            yield (
                f"maneuver.{self.name}: {what} ends {time:.3g} s after lift-off, "
                f"but the flight lasts {max(self.flight_time, 0.0):.3g} s"
            )

    def unfit(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """What these wheels cannot do (`with_wheels`), or no robot can, one line each.

        Args:
            tilting: how many axes across the vertical the wheels act about, 1 or 2.
            tolerance: largest tilt at touchdown of a maneuver that ends level [rad].
        """
        del tilting, tolerance
        yield from ()

    @property
    def idle(self) -> str:
        """Keys whose zeros require nothing of roll and pitch; empty: something is required."""
        return ""

    @property
    def upset(self) -> str:
        """What feedback alone corrects, as in `pitch 2.1 deg`, where its time matters less."""
        return ""

    @property
    @abstractmethod
    def summary(self) -> str:
        """What happens, in words with units."""


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

    def boundary(self, standing_height: float) -> Boundary:
        """Back to level in the time left after the torque, from level at its onset."""
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
            height=standing_height if self.on_feet else None,
        )

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """The impulse, which the wheels hold until touchdown (docs/theory.md, Disturbances)."""
        del inertia, standing_height
        return np.abs(self._impulse)

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """Stop the trunk, turn it back and hold its momentum, from the end of the torque on.

        When a torque on a free trunk ends, it has tilted the trunk by half its impulse times its
        duration over the inertia.
        """
        del standing_height
        momentum, shape = self._impulse, np.shape(inertia.diagonal)
        return Slew(
            np.broadcast_to(0.5 * self.duration * momentum, shape),
            np.broadcast_to(momentum, shape),
            self.time_left,
        )

    @property
    def idle(self) -> str:
        """Torque about roll and pitch, if it is zero."""
        return "" if any(self.torque[:2]) else "torque about roll and pitch is 0"

    @property
    def _impulse(self) -> FloatArray:
        """Angular impulse about roll and pitch [N m s], shape (2,)."""
        return np.array(self.torque[:2]) * self.duration


@dataclass(frozen=True, eq=False, kw_only=True)
class Disturbance(Unforeseen):
    """A jump during which a torque hits the trunk (paper, section 4, first test).

    Attributes:
        takeoff_velocity: forward and upward at lift-off [m/s].
        torque: on the trunk in B [N m], shape (3,).
        onset: time from lift-off to the torque [s].
        duration: of the torque [s].
        velocity_change: of the centre of mass by a force of the same duration, in B [m/s], shape
            (3,); the torque is then the one about the centre of mass.
        impulse: of that force, if torque and change of velocity follow from it (`on`), in B [N s],
            shape (3,). point: where it hits the trunk, in B [m], shape (3,).
    """

    takeoff_velocity: Annotated[
        tuple[float, float], Quantities(Dimension.SPEED, (2,)), "forward, up"
    ]
    torque: Torque
    onset: Annotated[float, Quantity(Dimension.TIME, Sign.NOT_NEGATIVE), "after lift-off"]
    duration: Annotated[Time, "of the torque"]
    velocity_change: Annotated[
        Vector3,
        Quantities(Dimension.SPEED, (3,)),
        "of the centre of mass, by a force in addition to the torque",
    ] = (0.0, 0.0, 0.0)
    impulse: Annotated[Impulse, "of a force, from which torque and velocity_change follow"] = (
        0.0,
        0.0,
        0.0,
    )
    point: Point = (0.0, 0.0, 0.0)

    milder_by: ClassVar[tuple[str, ...]] = ("torque", "velocity_change", "impulse")
    part: ClassVar[str] = "push"

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

    def slower(self, factor: float, standing_height: float) -> Self:
        """A higher jump, with `factor` times the time after the torque."""
        del standing_height
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
        told = (
            f"lift-off at {forward:.3g} m/s forward and {upward:.3g} m/s up, "
            f"{row_text(self.torque)} N m on the trunk for {self.duration:.3g} s, "
            f"{self.onset:.3g} s after it"
        )
        if any(self.velocity_change):
            told += f", which changes its velocity by {row_text(self.velocity_change)} m/s"
        return told


@dataclass(frozen=True, eq=False, kw_only=True)
class Shove(Unforeseen):
    """A torque on the trunk of a standing or trotting robot, to be absorbed (paper, section 5).

    The legs are not relied on: the device is sized to absorb it alone.

    Attributes:
        torque: on the trunk in B [N m], shape (3,).
        duration: of the torque [s].
        settling: from its end until the trunk must be level and at rest again [s].
        stride: of a trot on the spot [s]; 0: the robot stands.
    """

    torque: Torque
    duration: Annotated[Time, "of the torque"]
    settling: Annotated[Time, "from the end of the torque to rest"]
    stride: Annotated[
        float,
        Quantity(Dimension.TIME, Sign.NOT_NEGATIVE, most=_LONGEST_STRIDE),
        "of a trot on the spot; 0: the robot stands",
    ] = 0.0

    on_feet: ClassVar[bool] = True
    milder_by: ClassVar[tuple[str, ...]] = ("torque",)
    part: ClassVar[str] = "push"

    @property
    def push(self) -> Push:
        """Torque as specified."""
        return Push(np.array(self.torque), 0.0, self.duration)

    def slower(self, factor: float, standing_height: float) -> Self:
        """More time to come to rest."""
        del standing_height
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


def row_text(values: Iterable[float], factor: float = 1.0) -> str:
    """Row of numbers for display, each times a factor, as in `(0, 0.2, 0)`."""
    return f"({', '.join(f'{factor * value:.3g}' for value in values)})"


def rates_text(rates: Vector3) -> str:
    """Row of rates [rad/s] for display, as in `(0, 30, 0) deg/s`."""
    return f"{row_text(np.degrees(rates))} deg/s"


def angles_text(**angles: float) -> str:
    """Nonzero angles by name [rad] for display, as in `roll 5 deg and yaw 2 deg`."""
    told = (f"{name} {format_quantity(angle, 'deg')}" for name, angle in angles.items() if angle)
    return " and ".join(told)


class Reorientation(Maneuver):
    """A rest-to-rest turn of the trunk from level by a specified angle."""

    @property
    def turn(self) -> FloatArray:
        """All of its roll and pitch [rad], shape (2,)."""
        return self.angles

    @abstractmethod
    def time(self, standing_height: float) -> float:
        """Time that the turn may take [s]."""

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Half the time speeding up, half slowing down: a peak rate of 2 theta / T."""
        peak = 2.0 / self.time(standing_height)
        return np.abs(inertia.momentum(self.turn)) * peak

    def least_torque(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Least torque of the turn from rest to rest, 4 I theta / T^2 [N m]."""
        return 2.0 * self.momentum(inertia, standing_height) / self.time(standing_height)

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """The whole turn, rest to rest."""
        swept = inertia.momentum(self.turn)
        return Slew(swept, np.zeros_like(swept), self.time(standing_height))


@dataclass(frozen=True, eq=False, kw_only=True)
class Drop(Reorientation):
    """A fall from rest with the trunk tilted (paper, section 4, second test).

    Attributes:
        height: of the trunk frame's origin above the ground [m]. roll, pitch: at release [rad].
    """

    height: Annotated[Height, "of the trunk above the ground"]
    roll: Annotated[Tilt, "at release"] = 0.0
    pitch: Annotated[Tilt, "at release"]

    turned_by: ClassVar[tuple[str, ...]] = ("roll", "pitch")
    milder_by: ClassVar[tuple[str, ...]] = turned_by
    part: ClassVar[str] = "tilt"

    def boundary(self, standing_height: float) -> Boundary:
        """From rest, pitched about y and then rolled about x, to level within the fall."""
        attitude = product(from_axis_angle(Y, self.pitch), from_axis_angle(X, self.roll))
        vertical = vertical_of(attitude)
        # A rate w changes the vertical v by -w x v.
        axis = np.cross([0.0, 0.0, 1.0], vertical)
        length = float(np.linalg.norm(axis))
        axis = axis / length if length > 0.0 else Y
        angle, duration = float(np.arctan2(length, vertical[2])), self.time(standing_height)
        return Boundary(self.name, attitude, UPRIGHT, axis, angle, duration, height=self.height)

    def time(self, standing_height: float) -> float:
        """Time from release until the feet of the levelled robot touch the ground [s].

        Raises:
            SpecificationError: the robot would already stand on the ground.
        """
        fall = self.height - standing_height
        if fall <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: the trunk is released at {self.height:.3g} m, but stands "
                f"at {standing_height:.3g} m: there is no fall",
                hint="Release it higher.",
            )
        return float(np.sqrt(2.0 * fall / self.gravity))

    def slower(self, factor: float, standing_height: float) -> Self:
        """A higher fall."""
        fall = (self.height - standing_height) * factor**2
        return replace(self, height=standing_height + fall)

    @property
    def idle(self) -> str:
        """Roll and pitch, if they are zero."""
        return "" if self.roll or self.pitch else "roll and pitch are 0"

    @property
    def angles(self) -> FloatArray:
        """Turn of the trunk from level about roll and pitch [rad], shape (2,).

        The smallest turn that gives this tilt: its inverse brings the vertical of the world,
        (-sin p, cos p sin r, cos p cos r) as seen from a trunk pitched by p and then rolled by r,
        to the trunk's own; the heading is free.
        """
        forward, left = np.sin(self.pitch), np.cos(self.pitch) * np.sin(self.roll)
        sine = np.hypot(forward, left)
        angle = np.arctan2(sine, np.cos(self.pitch) * np.cos(self.roll))
        return np.array([left, forward]) * (angle / sine if sine > 0.0 else 1.0)

    @property
    def summary(self) -> str:
        """Height, attitude and gravity."""
        roll, pitch = format_quantity(self.roll, "deg"), format_quantity(self.pitch, "deg")
        return f"falls from {self.height:.3g} m at roll {roll} and pitch {pitch}"


_LONGER_THAN_ITS_TURN = 1.02
"""Flight time over turn time, where a longer turn needs a longer flight."""


class TimedTurn(Reorientation):
    """A turn in a specified time, in a vertical jump or in orbit.

    Attributes:
        jump_height: of the centre of mass above its height at lift-off [m]; 0 in orbit.
        duration: from lift-off [s].
    """

    jump_height: float
    duration: float

    def time(self, standing_height: float) -> float:
        """Time as specified [s]."""
        del standing_height
        return self.duration

    def slower(self, factor: float, standing_height: float) -> Self:
        """A longer turn; in a higher jump where it needs one."""
        del standing_height
        longer = self.scaled(factor, "duration")
        higher = max(_LONGER_THAN_ITS_TURN * longer.duration / self.flight_time, 1.0) ** 2
        return longer.scaled(higher, "jump_height")

    def stretched(self, factor: float, standing_height: float) -> Self:
        """A longer turn in the same part of a higher jump."""
        del standing_height
        return self.scaled(factor, "duration").scaled(factor**2, "jump_height")

    def contradictions(self) -> Iterator[str]:
        """What contradicts itself, one line each: a turn must end in flight."""
        yield from super().contradictions()
        yield from self._landing_before("its turn", self.duration)

    @property
    def takeoff(self) -> tuple[float, float]:
        """Speed of the vertical jump [m/s]; 0 in orbit."""
        return 0.0, sqrt(2.0 * self.gravity * self.jump_height)

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands where it took off; in orbit, until the turn ends [s]."""
        return sqrt(8.0 * self.jump_height / self.gravity) if self.gravity else self.duration


@dataclass(frozen=True, eq=False, kw_only=True)
class Flip(TimedTurn):
    """A full turn, or part of one, in a vertical jump (paper, section 4, third test).

    Attributes:
        angle: of pitch [rad]; a back-flip is negative about y (left).
    """

    jump_height: JumpHeight
    angle: Annotated[Turn, "of pitch"]
    duration: TurnTime

    turns_over: ClassVar[bool] = True
    turned_by: ClassVar[tuple[str, ...]] = ("angle",)

    def boundary(self, standing_height: float) -> Boundary:
        """A turn in pitch, from level."""
        del standing_height
        final = from_axis_angle(Y, self.angle)
        return Boundary(self.name, UPRIGHT, final, Y, self.angle, self.duration)

    @property
    def angles(self) -> FloatArray:
        """Turn about pitch alone [rad], shape (2,)."""
        return np.array([0.0, self.angle])

    @property
    def idle(self) -> str:
        """Angle, if it is zero."""
        return "" if self.angle else "angle is 0"

    def unfit(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """A turn that is not whole, in one line."""
        del tilting
        left_over = abs(remainder(self.angle, 2.0 * pi))
        if left_over > tolerance:
            asked = format_quantity(self.angle, "deg")
            yield (
                f"maneuver.{self.name}: after {asked} the trunk is "
                f"{format_quantity(left_over, 'deg')} off level, but a flip must land level: ask "
                "for 360deg (back, forward). If this attitude at touchdown is meant, ask for a "
                f"turn to it: 'pitch {asked.replace(' ', '')} in {self.duration:.3g}s'"
            )

    @property
    def summary(self) -> str:
        """Turn, time, jump and gravity."""
        return (
            f"turns {format_quantity(self.angle, 'deg')} of pitch in {self.duration:.3g} s, "
            f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        )
