"""Maneuvers as data: what the device must do, and how the proof by simulation starts.

They are the `[[maneuver]]` tables of a specification.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from enum import StrEnum
from functools import cached_property
from math import cos, exp, hypot, log, pi, remainder, sqrt
from types import MappingProxyType
from typing import (
    Annotated,
    Any,
    ClassVar,
    NamedTuple,
    Self,
    TypeAlias,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import Dimension, format_quantity, rpm
from ocs_design.requirement.values import (
    HEIGHT,
    INCIDENCE,
    SPIN,
    TILT,
    TURN,
    YAW,
    Choice,
    Quantities,
    Quantity,
    Sign,
    Text,
    Value,
    Vector3,
)
from ocs_design.robot.mass import MassProperties


@dataclass(frozen=True, eq=False)
class Slew:
    """What both wheels together must do to the trunk in a given time, roll and pitch.

    Attributes:
        swept: momentum that must pass through the wheels, over time: inertia times angle of a turn
            from rest to rest [N m s^2], shape (..., 2).
        momentum: that the wheels still hold at the end [N m s], shape (..., 2).
            Signs count, but for that of all together.
        duration: in which it must be done [s].
        begins: speed of all wheels at the start, where they turn as swept and momentum say [rad/s].
    """

    swept: FloatArray
    momentum: FloatArray
    duration: float
    begins: float = 0.0


Time: TypeAlias = Annotated[float, Quantity(Dimension.TIME)]
Height: TypeAlias = Annotated[float, HEIGHT]
Tilt: TypeAlias = Annotated[float, TILT]
Turn: TypeAlias = Annotated[float, TURN]
Spin: TypeAlias = Annotated[float, SPIN]
Torque: TypeAlias = Annotated[Vector3, Quantities(Dimension.TORQUE, (3,))]
Impulse: TypeAlias = Annotated[Vector3, Quantities(Dimension.IMPULSE, (3,))]
Point: TypeAlias = Annotated[Vector3, Quantities(Dimension.LENGTH, (3,))]
Rate: TypeAlias = Annotated[Vector3, Quantities(Dimension.ANGULAR_SPEED, (3,))]

_LONGEST_STRIDE = 5.0
"""[s]: a giraffe's takes one; a robot is watched for several."""

STANDARD_GRAVITY = 9.81
"""[m/s^2], as the paper takes it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Maneuver(ABC):
    """One thing that the device must do in the air.

    Attributes:
        name: unique in a specification.
        gravity: [m/s^2]; 0 in orbit, where only turns and catches are known.
        incidence: angle that the device is set to by hand [rad]; None: the design's.
    """

    name: Annotated[str, Text()]
    gravity: Annotated[float, Quantity(Dimension.ACCELERATION, Sign.NOT_NEGATIVE)] = (
        STANDARD_GRAVITY
    )
    incidence: Annotated[float | None, INCIDENCE] = None

    @property
    def turn(self) -> FloatArray:
        """Turn about roll and pitch [rad], shape (2,); zero where a push leaves it open."""
        return np.zeros(2)

    @property
    def headed(self) -> bool:
        """Whether wheels that reach the vertical turn or stop the trunk about it."""
        return False

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Momentum over time about the vertical, and what wheels hold of it at the end, (...) each.

        Args:
            inertia: I_zz of the robot with its device, wheels braked [kg m^2], shape (...).
        """
        return np.zeros_like(inertia), np.zeros_like(inertia)

    @property
    def stray(self) -> float:
        """Tilt at the end for each radian that the trunk has drifted about the other axis [1].

        The chord of the turn [rad]: a whole one ends where it began (`TiltInertia.within_reach`).
        """
        return float(2.0 * abs(np.sin(np.hypot(*self.turn) / 2.0)))

    def on(self, body: MassProperties) -> Self:
        """The maneuver of a body, in B, where it depends on which one it is."""
        del body
        return self

    def turned(self, inertia: TiltInertia) -> TiltInertia:
        """Inertia that is turned, of that about the centre of mass."""
        return inertia

    @abstractmethod
    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Largest roll and pitch momentum that both wheels take at once, none below zero [N m s].

        Args:
            inertia: of the robot with its device, wheels braked.
            standing_height: of the trunk over the ground [m].
        """

    def least_torque(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Least torque of both wheels together on roll and on pitch [N m], shape (2,).

        Less than that cannot finish a turn in time, whatever the wheel; zero where no time is set
        (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked.
            standing_height: of the trunk over the ground [m].
        """
        del inertia, standing_height
        return np.zeros(2)

    @abstractmethod
    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """What a motor must do for it (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked, or of many such.
            standing_height: of the trunk over the ground [m].
        """

    @property
    @abstractmethod
    def summary(self) -> str:
        """What happens, for people, with units."""


class Unforeseen(Maneuver):
    """A torque on the trunk that nobody knows beforehand.

    Attributes:
        torque: in B [N m], shape (3,).
        duration: of the torque [s].
    """

    torque: Vector3
    duration: float

    @property
    @abstractmethod
    def time_left(self) -> float:
        """Time from the end of the torque until the trunk must be level and at rest again [s]."""

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """The impulse, which the wheels hold till touchdown (docs/theory.md, Disturbances)."""
        del inertia, standing_height
        return np.abs(self._impulse)

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """Stop the trunk, turn it back and hold its momentum, from the end of the torque on.

        A torque on a free trunk has tilted it by half its impulse times its duration over the
        inertia when it ends.
        """
        del standing_height
        momentum, shape = self._impulse, np.shape(inertia.diagonal)
        return Slew(
            np.broadcast_to(0.5 * self.duration * momentum, shape),
            np.broadcast_to(momentum, shape),
            self.time_left,
        )

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
        impulse: of that force, where torque and change of velocity are to follow from it (`on`),
            in B [N s], shape (3,). point: where it hits the trunk, in B [m], shape (3,).
    """

    takeoff_velocity: Annotated[tuple[float, float], Quantities(Dimension.SPEED, (2,))]
    torque: Torque
    onset: Annotated[float, Quantity(Dimension.TIME, Sign.NOT_NEGATIVE)]
    duration: Time
    velocity_change: Annotated[Vector3, Quantities(Dimension.SPEED, (3,))] = (0.0, 0.0, 0.0)
    impulse: Impulse = (0.0, 0.0, 0.0)
    point: Point = (0.0, 0.0, 0.0)

    def on(self, body: MassProperties) -> Self:
        """Disturbance of a body: the angular impulse r x p about its centre of mass, and p / m."""
        if not any(self.impulse):
            return self
        # Without the rounding errors of zeros.
        turned = np.round(np.cross(np.subtract(self.point, body.com), self.impulse), 12) + 0.0
        return replace(
            self,
            torque=tuple((turned / self.duration).tolist()),
            velocity_change=tuple((np.array(self.impulse) / body.mass).tolist()),
        )

    @property
    def time_left(self) -> float:
        """Time left in the air [s]."""
        return self.flight_time - self.onset - self.duration

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands as high as it took off [s].

        An upward change of velocity w in the middle of the push, at t', shifts the parabola:
        v t - g t^2 / 2 + w (t - t') = 0.
        """
        upward, gained = self.takeoff_velocity[1], self.velocity_change[2]
        later = upward + gained
        lost = 2.0 * self.gravity * gained * (self.onset + 0.5 * self.duration)
        return (later + sqrt(max(later**2 - lost, 0.0))) / self.gravity

    @property
    def summary(self) -> str:
        """Lift-off and torque."""
        forward, upward = self.takeoff_velocity
        told = (
            f"lift-off at {forward:.3g} m/s forward and {upward:.3g} m/s up, "
            f"{_torque(self.torque)} on the trunk for {self.duration:.3g} s, {self.onset:.3g} s "
            f"after it"
        )
        if any(self.velocity_change):
            told += f", which changes its velocity by {_row(self.velocity_change)} m/s"
        return told


@dataclass(frozen=True, eq=False, kw_only=True)
class Shove(Unforeseen):
    """A torque on the trunk of a robot that stands or trots, to be calmed (paper, section 5).

    What the legs do about it is not counted: the device is sized to do it alone.

    Attributes:
        torque: on the trunk in B [N m], shape (3,).
        duration: of the torque [s].
        settling: from its end until the trunk must be level and at rest again [s].
        stride: of a trot on the spot [s]; 0: the robot stands.
    """

    torque: Torque
    duration: Time
    settling: Time
    stride: Annotated[float, Quantity(Dimension.TIME, Sign.NOT_NEGATIVE, most=_LONGEST_STRIDE)] = (
        0.0
    )

    @property
    def time_left(self) -> float:
        """Time left as specified [s]."""
        return self.settling

    @property
    def summary(self) -> str:
        """Torque and time."""
        does = f"trots on the spot, {self.stride:.3g} s a stride" if self.stride else "stands"
        return (
            f"{does}; {_torque(self.torque)} on the trunk for {self.duration:.3g} s, "
            f"to be at rest {self.settling:.3g} s after it"
        )


def _millimetres(point: Vector3) -> str:
    x, y, z = point
    return _row((1e3 * x, 1e3 * y, 1e3 * z))


def _torque(torque: Vector3) -> str:
    return f"{_row(torque)} N m"


def _row(values: Vector3) -> str:
    return f"({', '.join(f'{value:.3g}' for value in values)})"


class Reorientation(Maneuver):
    """A turn of the trunk from level by an angle that is stated, rest to rest."""

    @abstractmethod
    def time(self, standing_height: float) -> float:
        """Time that the turn may take [s]."""

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Half the time up, half the time down: a peak rate of 2 theta / T."""
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
        height: of the trunk frame's origin over the ground [m]. roll, pitch: at release [rad].
    """

    height: Height
    roll: Tilt = 0.0
    pitch: Tilt

    def time(self, standing_height: float) -> float:
        """Time from release until the feet of the levelled robot meet the ground [s].

        Raises:
            SpecificationError: the robot would stand on the ground already.
        """
        fall = self.height - standing_height
        if fall <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: the trunk is released at {self.height:.3g} m, but stands "
                f"at {standing_height:.3g} m: there is no fall",
                hint="Release it higher.",
            )
        return float(np.sqrt(2.0 * fall / self.gravity))

    @property
    def turn(self) -> FloatArray:
        """What the trunk is turned about roll and pitch from level [rad], shape (2,).

        The smallest turn that does it: its way back brings the vertical of the world,
        (-sin p, cos p sin r, cos p cos r) as seen from a trunk that was pitched by p and then
        rolled by r, to the trunk's own; the heading is free.
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


@dataclass(frozen=True, eq=False, kw_only=True)
class Flip(Reorientation):
    """A full turn, or part of one, in a vertical jump (paper, section 4, third test).

    Attributes:
        jump_height: of the centre of mass over its height at lift-off [m].
        angle: of pitch [rad]; a back-flip is negative about y (left). duration: from lift-off [s].
    """

    jump_height: Height
    angle: Turn
    duration: Time

    @property
    def turn(self) -> FloatArray:
        """Turn about pitch alone [rad], shape (2,)."""
        return np.array([0.0, self.angle])

    def time(self, standing_height: float) -> float:
        """Time as specified [s]."""
        del standing_height
        return self.duration

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands where it took off [s]."""
        return float(2.0 * np.sqrt(2.0 * self.jump_height / self.gravity))

    @property
    def summary(self) -> str:
        """Turn, time, jump and gravity."""
        return (
            f"turns {format_quantity(self.angle, 'deg')} of pitch in {self.duration:.3g} s, "
            f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        )


class End(StrEnum):
    """What must hold when a turn ends; about the axes that the wheels reach it ends at rest.

    Attributes:
        LEVEL: the trunk is upright, whatever its heading.
        ATTITUDE: it has the attitude that is stated, heading included.
        AT_REST: it turns no more, whatever its attitude.
    """

    LEVEL = "level"
    ATTITUDE = "attitude"
    AT_REST = "at rest"


LOOP_SHARE = 0.75
"""Share of a loop of the tilt that wheels and motors are asked for, in that share of its time."""

_ENDS: Mapping[str, str] = {
    End.LEVEL: ", any heading,",
    End.ATTITUDE: "",
    End.AT_REST: " or any attitude",
}


def loop_length(heading: float) -> float:
    """Shortest way of a trunk's vertical that changes the heading [rad], `sqrt(h (4 pi - h))`.

    A trunk whose wheels do not reach the vertical turns its heading h by the solid angle that its
    z axis goes round, and of all ways round a circle is the shortest: the isoperimetric inequality
    of the sphere (docs/theory.md, Yaw by two wheels).

    Args:
        heading: within a turn [rad].
    """
    return sqrt(abs(heading) * (4.0 * pi - abs(heading)))


@dataclass(frozen=True, eq=False, kw_only=True)
class TurnTo(Reorientation):
    """A turn of the trunk in a vertical jump, from level to any attitude, heading included.

    Attributes:
        jump_height: of the centre of mass over its height at lift-off [m]; 0 in orbit.
        roll, pitch, yaw: of the attitude at the end, reached from level by yaw, then pitch, then
            roll [rad].
        duration: from lift-off [s].
        rate: of the trunk at lift-off, in B [rad/s], shape (3,).
        wheel_speed: of all wheels at lift-off [rad/s].
        end: see `End`.
        estimate: factor on what closed forms ask for; above 1 where a plan was found to need more.
        direct: whether the wheels reach the vertical, and no loop of the tilt is needed.
    """

    jump_height: Height = 0.0
    roll: Turn = 0.0
    pitch: Turn = 0.0
    yaw: Annotated[float, YAW] = 0.0
    duration: Time
    rate: Rate = (0.0, 0.0, 0.0)
    wheel_speed: Spin = 0.0
    end: Annotated[str, Choice(tuple(End))] = End.ATTITUDE
    estimate: float = 1.0
    direct: bool = False

    @property
    def headed(self) -> bool:
        """Whether they reach it, and it is asked for."""
        return self.direct and (bool(self.yaw) or bool(self.rate[2]))

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The turn about the vertical and the rate at lift-off; see `Maneuver.heading`."""
        asked = self.estimate * inertia
        turned = self.yaw if self.end == End.ATTITUDE else 0.0
        return asked * turned, asked * self.rate[2]

    @property
    def turn(self) -> FloatArray:
        """Roll and pitch [rad], shape (2,), with what a change of heading asks of two wheels.

        On a circle of `loop_length` each axis turns by 2 / pi of it, at a rate that is steady but
        for its start and end. It goes round, too, which takes torque: `LOOP_SHARE` of it, in that
        share of the time, asks for 1.15 to 1.25 of the wheels that planned turns need, unless they
        are at the limit of their torque (docs/theory.md, Yaw by two wheels).
        """
        tilt = self._tilt
        return np.asarray(self.estimate * self._share * (tilt + np.copysign(self._loop, tilt)))

    @property
    def _share(self) -> float:
        return LOOP_SHARE if self._loop else 1.0

    @property
    def _tilt(self) -> FloatArray:
        return np.array([self.roll, self.pitch])

    @property
    def _loop(self) -> float:
        """Share of a change of heading on roll and on pitch [rad]."""
        return 0.0 if self.direct else loop_length(remainder(self.yaw, 2.0 * pi)) * 2.0 / pi

    @property
    def flight_time(self) -> float:
        """Time until a rigid robot lands where it took off; in orbit, until the turn ends [s]."""
        return sqrt(8.0 * self.jump_height / self.gravity) if self.gravity else self.duration

    def time(self, standing_height: float) -> float:
        """Time as specified [s]."""
        del standing_height
        return self.duration

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """That of the tilt, half the time up and half down, of the loop and of the rate."""
        del standing_height
        peak = 2.0 * self._tilt + np.copysign(self._loop, self._tilt)
        turning = self.estimate * np.abs(inertia.momentum(peak)) / self.duration
        return np.asarray(turning + np.abs(self._begun(inertia)))

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """The turn, and the momentum at lift-off, which the wheels hold till touchdown."""
        turned, time = super().slew(inertia, standing_height), self._share * self.duration
        # Wheels turn against the trunk, and with the rate that they take from it. A loop, and a
        # turn with a rate, ask for both.
        sense = any(self.rate) - any((self.roll, self.pitch, self.yaw))
        begins = 0.0 if self._loop else sense * self.wheel_speed
        return Slew(turned.swept, self._begun(inertia), time, begins)

    def _begun(self, inertia: TiltInertia) -> FloatArray:
        return self.estimate * inertia.momentum(np.array(self.rate[:2]))

    @property
    def summary(self) -> str:
        """Attitude, rate, time, jump and gravity."""
        angles = {"roll": self.roll, "pitch": self.pitch, "yaw": self.yaw}
        asked = [f"{name} {format_quantity(a, 'deg')}" for name, a in angles.items() if a]
        told = f"turns to {' and '.join(asked) or 'level'}"
        if any(self.rate):
            told += f" from rates of {_row(tuple(np.degrees(self.rate).tolist()))} deg/s"
        if self.wheel_speed:
            told += f" with wheels at {rpm(self.wheel_speed)}"
        where = "in orbit"
        if self.gravity:
            where = f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        return f"{told}{_ENDS[self.end]} in {self.duration:.3g} s, {where}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Catch(TurnTo):
    """A stop of a trunk that turns as it leaves the ground."""

    rate: Rate
    end: Annotated[str, Choice(tuple(End))] = End.LEVEL


class Actuation(StrEnum):
    """What gives a wheel's momentum to a robot that stands up.

    Attributes:
        MOTOR: the motor, from the start.
        BRAKE: a brake that stops, in an instant, wheels which the motor has spun up slowly before;
            the motor holds the robot at the top.
    """

    MOTOR = "motor"
    BRAKE = "brake"


SPIN_UP = 60.0
"""Time in which wheels get to the speed that a brake stops them from [s]."""


_INSTANT = 0.02
"""Share of the momentum of a climb that gravity takes at the most while a brake stops its wheels in
what counts as an instant."""


class Swing(NamedTuple):
    """Least torque that takes a pendulum from a tilt and a rate to rest at the top in a time.

    Attributes:
        torque: on the way there, and then the other way round [N m].
        switch: when it changes its sign [s].
    """

    torque: float
    switch: float


def swing(stiffness: float, inertia: float, tilt: float, rate: float, time: float) -> Swing:
    """Swing of an inverted pendulum `I theta'' = K theta - tau`, full torque either way.

    With `w = sqrt(K / I)` the diverging part of the motion is `x = theta + theta' / w`, the
    converging one `y = theta - theta' / w`. With E = exp(w T) and a = exp(w T_1), a torque tau up
    to T_1 and -tau from there to T ends both where

        K x = tau (1 - 2 / a + 1 / E),        K y = tau (1 - 2 a + E)

    so that `2 x a^2 + (y (1 + 1/E) - x (1 + E)) a - 2 y = 0` (docs/theory.md, About a pivot).

    Args:
        stiffness: K, weight times lever [N m]. inertia: I about the pivot [kg m^2].
        tilt: theta at the start [rad]. rate: theta' then [rad/s]. time: T [s].
    """
    quickness = sqrt(stiffness / inertia)
    x, y = tilt + rate / quickness, tilt - rate / quickness
    if x < 0.0:
        x, y = -x, -y
    if x == 0.0:
        return Swing(0.0, 0.0)
    end = exp(quickness * time)
    middle = y * (1.0 + 1.0 / end) - x * (1.0 + end)
    turned = (sqrt(max(middle**2 + 16.0 * x * y, 0.0)) - middle) / (4.0 * x)
    turned = min(max(turned, 1.0), end)
    asked = hypot(1.0 - 2.0 / turned + 1.0 / end, 1.0 - 2.0 * turned + end)
    return Swing(stiffness * hypot(x, y) / asked, log(turned) / quickness)


@dataclass(frozen=True, eq=False, kw_only=True)
class Pivoted(Maneuver):
    """A robot that stands on a point or on an edge and is to be upright and at rest again.

    Upright is where the centre of mass is above the pivot. All joints of the robot are held.

    Attributes:
        pivot: in B [m], shape (3,).
        edge: direction of the edge that it turns about, level in B, of any length; zeros: a point.
        roll, pitch: tilt at the start from upright, one rotation about the axis (roll, pitch, 0) of
            a B that stands upright [rad].
        duration: until it is upright and at rest [s].
        wheel_speed: of all wheels at the start [rad/s].
        end: see `End`; at rest but not upright is nowhere that a robot can stay.
        estimate: factor on what closed forms ask for; above 1 where a plan was found to need more.
        slower: factor on the longest time of the estimate; more of it takes less torque and more
            momentum (`Pivoted.calmer`).
        body: that stands, in B; None: not known yet (`on`).
    """

    pivot: Point
    edge: Annotated[Vector3, Quantities(Dimension.RATIO, (3,))] = (0.0, 0.0, 0.0)
    roll: Tilt = 0.0
    pitch: Tilt = 0.0
    duration: Time
    wheel_speed: Spin = 0.0
    end: Annotated[str, Choice((End.LEVEL, End.ATTITUDE))] = End.LEVEL
    estimate: float = 1.0
    slower: float = 1.0
    body: MassProperties | None = None

    def calmer(self) -> Self:
        """The same by nearly the least torque, for motors that have no more."""
        return replace(self, slower=4.0 / self._longest)

    def on(self, body: MassProperties) -> Self:
        """The same of a body that stands.

        Raises:
            SpecificationError: its centre of mass is not above the pivot.
        """
        own = replace(self, body=body)
        if any(self.edge) and not any(self.edge[:2]):
            raise SpecificationError(
                f"maneuver {self.name!r}: its edge is vertical, and nothing stands up about it",
                hint="Write an edge in the level plane, as 'along left' or 'along forward'.",
            )
        height = float(own.lever[2])
        if height <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: the pivot is {format_quantity(-height, 'mm')} above the "
                f"centre of mass, where the robot hangs and does not stand",
                hint=f"The centre of mass is at z = {format_quantity(body.com[2], 'mm')} in the "
                f"trunk's frame: put the pivot below it.",
            )
        return own

    @property
    def lever(self) -> FloatArray:
        """Centre of mass from the pivot in B, across the edge [m], shape (3,)."""
        assert self.body is not None, "no body stands yet"
        lever, axis = self.body.com - np.array(self.pivot), self.axis
        return np.asarray(lever if axis is None else lever - axis * (axis @ lever))

    @property
    def axis(self) -> FloatArray | None:
        """Unit vector along the edge in B, shape (3,); None: it stands on a point."""
        length = float(np.linalg.norm(self.edge))
        return np.array(self.edge) / length if length > 0.0 else None

    @property
    def inertia(self) -> FloatArray:
        """Inertia about the pivot in B, wheels braked [kg m^2], shape (3, 3): parallel axes."""
        assert self.body is not None, "no body stands yet"
        lever = self.body.com - np.array(self.pivot)
        return np.asarray(
            self.body.inertia
            + self.body.mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
        )

    def turned(self, inertia: TiltInertia) -> TiltInertia:
        """Inertia about the pivot, of that about the centre of mass: parallel axes."""
        assert self.body is not None, "no body stands yet"
        x, y, z = self.body.com - np.array(self.pivot)
        further = self.body.mass * np.array([y * y + z * z, x * x + z * z])
        return TiltInertia(inertia.diagonal + further, inertia.product - self.body.mass * x * y)

    @property
    def pull(self) -> FloatArray:
        """Weight times lever, m g l in B [N m], shape (3,)."""
        assert self.body is not None, "no body stands yet"
        return np.asarray(self.body.mass * self.gravity * self.lever)

    @property
    def struck(self) -> FloatArray:
        """Rate that a disturbance leaves, in B [rad/s], shape (3,)."""
        return np.zeros(3)

    @property
    def begun(self) -> FloatArray:
        """Rate at the start, in B [rad/s], shape (3,)."""
        return self.struck

    @property
    def tilt(self) -> FloatArray:
        """Rotation vector of the tilt at the start [rad], shape (3,)."""
        return np.array([self.roll, self.pitch, 0.0])

    @property
    def mobility(self) -> FloatArray:
        """Rate per momentum about the pivot, in B [1/(kg m^2)], shape (3, 3)."""
        axis = self.axis
        if axis is None:
            return np.asarray(np.linalg.inv(self.inertia))
        return np.outer(axis, axis) / float(axis @ self.inertia @ axis)

    @property
    def _pendulum(self) -> tuple[FloatArray, float, float, float, float]:
        """Axis of the tilt, and about it inertia, stiffness, tilt and rate.

        The stiffness K is that of the linear pendulum with the energy of the true one at the tilt:
        `K theta^2 / 2 = m g l (1 - cos theta)`.
        """
        weight, rate = float(np.linalg.norm(self.pull)), self.struck
        about = self.axis
        if about is None:
            most = float(np.linalg.eigvalsh(self.inertia)[-1])
            about = (self.tilt + rate * sqrt(most / weight)) * np.array([1.0, 1.0, 0.0])
            length = float(np.linalg.norm(about))
            about = about / length if length > 0.0 else np.array([0.0, 1.0, 0.0])
        inertia, tilt = float(about @ self.inertia @ about), float(about @ self.tilt)
        softer = 2.0 * (1.0 - cos(tilt)) / tilt**2 if abs(tilt) > _STRAIGHT else 1.0
        return about, inertia, softer * weight, tilt, float(about @ rate)

    @property
    def quickness(self) -> float:
        """Rate at which a small tilt grows, sqrt(m g l / I) [1/s]."""
        _, inertia, _, _, _ = self._pendulum
        return sqrt(float(np.linalg.norm(self.pull)) / inertia)

    def _swing(self) -> tuple[FloatArray, Swing]:
        """Axis about which the wheels speed up first, on roll and pitch, and how."""
        axis, inertia, stiffness, tilt, rate = self._pendulum
        axis = np.copysign(1.0, tilt + rate * sqrt(inertia / stiffness)) * axis
        longest = self.slower * self._longest / sqrt(stiffness / inertia)
        time = min(self.duration, longest)
        found = swing(stiffness, inertia, tilt, rate, time)
        return axis[:2], Swing(self.estimate * found.torque, found.switch)

    _longest: ClassVar[float] = 3.0
    """Time that the wheels are estimated with at most, over that in which a tilt grows e-fold."""

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """What the wheels hold where the torque changes its sign."""
        del inertia, standing_height
        axis, found = self._swing()
        return np.abs(axis) * found.torque * found.switch

    def least_torque(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """Least torque that does it in the time, of the linear pendulum [N m], shape (2,)."""
        del inertia, standing_height
        axis, found = self._swing()
        return np.abs(axis) * found.torque

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """A turn from rest to rest without gravity, with the same torque and largest momentum.

        A torque tau up and down again in T_1 each turns an inertia by tau T_1^2 over it.
        """
        del standing_height
        axis, found = self._swing()
        shape = np.shape(inertia.diagonal)
        swept = np.broadcast_to(axis * found.torque * found.switch**2, shape)
        return Slew(swept, np.zeros(shape), 2.0 * found.switch, self.wheel_speed)

    @property
    def _place(self) -> str:
        """Pivot and tilt, for people."""
        point = _millimetres(self.pivot)
        on = f"stands on a point at {point} mm"
        if self.axis is not None:
            on = f"stands on an edge at {point} mm along {_row(tuple(self.axis.tolist()))}"
        angles = {"roll": self.roll, "pitch": self.pitch}
        tilted = [f"{name} {format_quantity(a, 'deg')}" for name, a in angles.items() if a]
        spun = f" with wheels at {rpm(self.wheel_speed)}"
        return f"{on}, {' and '.join(tilted) or 'upright'}{spun if self.wheel_speed else ''}"


_STRAIGHT = 1e-6
"""Tilt below which a pendulum counts as linear [rad]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Balance(Pivoted):
    """A tilt, a rate or an impulse that nobody knows beforehand, and that feedback alone undoes.

    Attributes:
        rate: at the start, in B [rad/s], shape (3,).
        impulse: of a force right then, in B [N s], shape (3,). point: where it hits, in B [m].
    """

    rate: Rate = (0.0, 0.0, 0.0)
    impulse: Impulse = (0.0, 0.0, 0.0)
    point: Point = (0.0, 0.0, 0.0)

    _longest: ClassVar[float] = 2.0

    @property
    def struck(self) -> FloatArray:
        """The rate that is stated and that of the impulse, in B [rad/s], shape (3,)."""
        turned = np.cross(np.subtract(self.point, self.pivot), self.impulse)
        return np.asarray(np.array(self.rate) + self.mobility @ turned)

    def times(self, factor: float) -> Self:
        """The same of so many times the tilt, the rate and the impulse."""
        return replace(
            self,
            roll=factor * self.roll,
            pitch=factor * self.pitch,
            rate=tuple((factor * np.array(self.rate)).tolist()),
            impulse=tuple((factor * np.array(self.impulse)).tolist()),
        )

    @property
    def upset(self) -> str:
        """Tilt, rate and impulse, as in `pitch 2.1 deg and an impulse of (0, 0.2, 0) N s`."""
        angles = {"roll": self.roll, "pitch": self.pitch}
        told = [f"{name} {format_quantity(a, 'deg')}" for name, a in angles.items() if a]
        if any(self.rate):
            told.append(f"a rate of {_row(tuple(np.degrees(self.rate).tolist()))} deg/s")
        if any(self.impulse):
            told.append(f"an impulse of {_row(self.impulse)} N s")
        return " and ".join(filter(None, (", ".join(told[:-1]), *told[-1:])))

    @property
    def summary(self) -> str:
        """Pivot, tilt, rate and impulse."""
        hit = ""
        if any(self.rate):
            hit += f", turning at {_row(tuple(np.degrees(self.rate).tolist()))} deg/s"
        if any(self.impulse):
            at = _millimetres(self.point)
            hit += f", hit by {_row(self.impulse)} N s at {at} mm"
        return f"{self._place}{hit}; upright and at rest after {self.duration:.3g} s"


@dataclass(frozen=True, eq=False, kw_only=True)
class StandUp(Pivoted):
    """A climb from a tilt at rest to upright, as planned.

    Attributes:
        actuation: see `Actuation`.
    """

    actuation: Annotated[str, Choice(tuple(Actuation))] = Actuation.MOTOR

    @property
    def braked(self) -> bool:
        """Whether a brake gives the wheels' momentum to the robot."""
        return self.actuation == Actuation.BRAKE

    @property
    def _climb(self) -> FloatArray:
        """Momentum about the pivot with which it climbs to the top and stops there [N m s], (3,).

        `L^2 / (2 I) = m g l (1 - cos theta)`, energy: with one wheel of spin inertia I_w, L = I_w W
        gives the speed of Gajamohan, Merz, Thommen and D'Andrea (The Cubli, IROS 2012), from 45
        deg `W^2 = (2 - sqrt 2) I m g l / I_w^2`.
        """
        axis, inertia, stiffness, tilt, _ = self._pendulum
        return np.asarray(-axis * sqrt(stiffness * inertia) * tilt)

    @property
    def begun(self) -> FloatArray:
        """Rate right after the brake, which leaves the momentum as it is; zero without one."""
        return np.asarray(self.mobility @ self._climb) if self.braked else np.zeros(3)

    @property
    def stop(self) -> float:
        """Time in which a brake stops the wheels [s].

        Gravity takes m g l t sin theta of sqrt(m g l I) theta: kappa t of it, with `quickness`.
        The Cubli's wheels (`_climb`) stop in 2.1 ms by that.
        """
        return _INSTANT / self.quickness

    def momentum(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """What the wheels hold before the brake, or where the torque changes its sign."""
        if self.braked:
            return self.estimate * np.abs(self._climb[:2])
        return super().momentum(inertia, standing_height)

    def least_torque(self, inertia: TiltInertia, standing_height: float) -> FloatArray:
        """None with a brake, of the motor."""
        if self.braked:
            return np.zeros(2)
        return super().least_torque(inertia, standing_height)

    def slew(self, inertia: TiltInertia, standing_height: float) -> Slew:
        """Slew that the wheels make; before a brake stops them, the slow one up to their speed."""
        if not self.braked:
            return super().slew(inertia, standing_height)
        shape = np.shape(inertia.diagonal)
        held = np.broadcast_to(self.estimate * self._climb[:2], shape)
        return Slew(np.zeros(shape), held, SPIN_UP)

    @property
    def summary(self) -> str:
        """Pivot, tilt, time and what drives it."""
        by = ", by braking its wheels in an instant" if self.braked else ""
        return f"{self._place}; stands up in {self.duration:.3g} s{by}"


@dataclass(frozen=True)
class ManeuverReserve:
    """What a device keeps for a maneuver that is not quite as designed.

    Attributes:
        demand: factor on what is asked of the wheels, at least 1.
        rate: of roll and pitch that the trunk may begin with [rad/s].
        begun: factor on what is asked with that rate; below 1 where there is enough to spare.
        roll: rate of roll at lift-off that a flip undoes [rad/s], see `turned_roll`.
        short: whether a device that keeps nothing lacks any of this.
    """

    demand: float = 1.0
    rate: tuple[float, float] = (0.0, 0.0)
    begun: float = 1.0
    roll: float = 0.0
    short: bool = False


@dataclass(frozen=True, eq=False)
class Requirement:
    """Everything that the flywheels must be able to do.

    Attributes:
        maneuvers: see `Maneuver`; may be empty.
        rate_change: of the trunk, on roll and pitch one at a time [rad/s]; None: not asked.
        wheel_speed_max: of a wheel relative to the trunk [rad/s].
        spin_inertia: of one wheel, asked for in place of all else [kg m^2]; None: solved for.
        standing_height: of the trunk over the ground, for maneuvers that end there [m].
        reserves: kept for maneuvers by their names; none for those that are not in it.
        free: whether the incidence is still to be chosen.
        detection: time until it is known that a drive has stopped, where the wheels must do all
            with any one of them left out [s]; None: they need not.
    """

    maneuvers: tuple[Maneuver, ...]
    rate_change: float | None
    wheel_speed_max: float
    spin_inertia: float | None
    standing_height: float
    reserves: Mapping[str, ManeuverReserve] = field(default_factory=dict)
    free: bool = False
    detection: float | None = None

    def on(self, body: MassProperties) -> "Requirement":
        """Requirement of a body, which kicks and pivots depend on (`Maneuver.on`)."""
        return replace(self, maneuvers=tuple(each.on(body) for each in self.maneuvers))

    @property
    def kicks(self) -> FloatArray:
        """Momenta about roll and pitch that follow from the body [N m s], shape (n, 2).

        They are the angular impulses of forces, and what wheels take about a pivot.
        """
        found = []
        for each in self.maneuvers:
            if isinstance(each, Disturbance) and any(each.impulse):
                found.append(np.multiply(each.torque[:2], each.duration))
            elif isinstance(each, Pivoted):
                found.append(each.momentum(TiltInertia.uncoupled(np.ones(2)), 0.0))
        return np.reshape(found, (-1, 2))

    def slew(self, maneuver: Maneuver, inertia: TiltInertia, *, begun: bool = False) -> Slew:
        """What a motor must do for a maneuver with its reserve (`Maneuver.slew`).

        Args:
            maneuver: of this requirement. inertia: see there.
            begun: whether the trunk begins with the rate of the reserve: momentum that the wheels
                hold till the end, with the sense of what they hold anyway.
        """
        slew, kept = maneuver.slew(inertia, self.standing_height), self.reserves.get(maneuver.name)
        slew = replace(slew, duration=slew.duration - (self.detection or 0.0))
        if kept is None:
            return slew
        factor, momentum = kept.demand, slew.momentum
        if begun:
            factor = kept.begun
            momentum = momentum + np.copysign(inertia.diagonal * np.array(kept.rate), momentum)
        return replace(slew, swept=factor * slew.swept, momentum=factor * momentum)


@dataclass(frozen=True)
class ManeuverKind:
    """A kind of maneuver as the file sees it.

    Attributes:
        maneuver: the class; a field whose annotation has a `Value` is a key of the file.
    """

    maneuver: type[Maneuver]

    @cached_property
    def values(self) -> Mapping[str, Value[Any]]:
        """How each key is read, by its name."""
        hints = get_type_hints(self.maneuver, include_extras=True)
        read = {item.name: hints[item.name] for item in fields(self.maneuver)}
        return {
            name: get_args(hint)[1] for name, hint in read.items() if get_origin(hint) is Annotated
        }

    @property
    def required(self) -> tuple[str, ...]:
        """Fields that have no default."""
        return tuple(item.name for item in fields(self.maneuver) if item.default is MISSING)


MANEUVER_KINDS: Mapping[str, ManeuverKind] = MappingProxyType(
    {
        "disturbance": ManeuverKind(Disturbance),
        "shove": ManeuverKind(Shove),
        "drop": ManeuverKind(Drop),
        "flip": ManeuverKind(Flip),
        "turn": ManeuverKind(TurnTo),
        "catch": ManeuverKind(Catch),
        "balance": ManeuverKind(Balance),
        "stand-up": ManeuverKind(StandUp),
    }
)
"""Every kind by the word that `kind` takes."""


def kind_of(maneuver: Maneuver) -> tuple[str, Mapping[str, Value[Any]]]:
    """The word that `kind` takes for a maneuver, and how its fields are read."""
    return next(
        (word, kind.values)
        for word, kind in MANEUVER_KINDS.items()
        if kind.maneuver is type(maneuver)
    )
