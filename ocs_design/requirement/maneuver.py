"""Maneuvers as data: what the device must do, and how the proof by simulation starts.

They are the `[[maneuver]]` tables of a specification.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from enum import StrEnum
from math import pi, remainder, sqrt
from types import MappingProxyType
from typing import Any

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import Dimension, format_quantity
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
    """

    swept: FloatArray
    momentum: FloatArray
    duration: float


STANDARD_GRAVITY = 9.81
"""[m/s^2], as the paper takes it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Maneuver(ABC):
    """One thing that the device must do in the air.

    Attributes:
        name: unique in a specification.
        gravity: [m/s^2], positive.
        incidence: angle that the device is set to by hand [rad]; None: the design's.
    """

    name: str
    gravity: float = STANDARD_GRAVITY
    incidence: float | None = None

    @property
    def turn(self) -> FloatArray:
        """Turn about roll and pitch [rad], shape (2,); zero where a push leaves it open."""
        return np.zeros(2)

    @property
    def stray(self) -> float:
        """Tilt at the end for each radian that the trunk has drifted about the other axis [1].

        The chord of the turn [rad]: a whole one ends where it began (`TiltInertia.within_reach`).
        """
        return float(2.0 * abs(np.sin(np.hypot(*self.turn) / 2.0)))

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

    torque: tuple[float, float, float]
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

    takeoff_velocity: tuple[float, float]
    torque: tuple[float, float, float]
    onset: float
    duration: float
    velocity_change: tuple[float, float, float] = (0.0, 0.0, 0.0)
    impulse: tuple[float, float, float] = (0.0, 0.0, 0.0)
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def on(self, body: MassProperties) -> "Disturbance":
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
        """Until a rigid robot lands as high as it took off [s].

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

    torque: tuple[float, float, float]
    duration: float
    settling: float
    stride: float = 0.0

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


def _torque(torque: tuple[float, float, float]) -> str:
    return f"{_row(torque)} N m"


def _row(values: tuple[float, float, float]) -> str:
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

    height: float
    roll: float = 0.0
    pitch: float

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

    jump_height: float
    angle: float
    duration: float

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
        """Until a rigid robot lands where it took off [s]."""
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
        jump_height: of the centre of mass over its height at lift-off [m].
        roll, pitch, yaw: of the attitude at the end, reached from level by yaw, then pitch, then
            roll [rad].
        duration: from lift-off [s].
        rate: of the trunk at lift-off, in B [rad/s], shape (3,).
        wheel_speed: of all wheels at lift-off [rad/s].
        end: see `End`.
        estimate: factor on what closed forms ask for; above 1 where a plan was found to need more.
    """

    jump_height: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    duration: float
    rate: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wheel_speed: float = 0.0
    end: str = End.ATTITUDE
    estimate: float = 1.0

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
        return loop_length(remainder(self.yaw, 2.0 * pi)) * 2.0 / pi

    @property
    def flight_time(self) -> float:
        """Until a rigid robot lands where it took off [s]."""
        return sqrt(8.0 * self.jump_height / self.gravity)

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
        turned = super().slew(inertia, standing_height)
        return Slew(turned.swept, self._begun(inertia), self._share * turned.duration)

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
            told += f" with wheels at {format_quantity(self.wheel_speed, 'rpm')}"
        return (
            f"{told}{_ENDS[self.end]} in {self.duration:.3g} s, "
            f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Catch(TurnTo):
    """A stop of a trunk that turns as it leaves the ground."""

    rate: tuple[float, float, float]
    end: str = End.LEVEL


@dataclass(frozen=True)
class ManeuverReserve:
    """What a device keeps for a maneuver that is not quite as designed.

    Attributes:
        demand: factor on what is asked of the wheels, at least 1.
        rate: of roll and pitch that the trunk may begin with [rad/s].
        begun: factor on what is asked with that rate; below 1 where there is enough to spare.
    """

    demand: float = 1.0
    rate: tuple[float, float] = (0.0, 0.0)
    begun: float = 1.0


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
    """

    maneuvers: tuple[Maneuver, ...]
    rate_change: float | None
    wheel_speed_max: float
    spin_inertia: float | None
    standing_height: float
    reserves: Mapping[str, ManeuverReserve] = field(default_factory=dict)
    free: bool = False

    def on(self, body: MassProperties) -> "Requirement":
        """Requirement of a body, which kicks turn about its centre of mass (`Disturbance.on`)."""
        hit = (each.on(body) if isinstance(each, Disturbance) else each for each in self.maneuvers)
        return replace(self, maneuvers=tuple(hit))

    @property
    def kicks(self) -> FloatArray:
        """Angular impulses of forces about roll and pitch [N m s], shape (n, 2)."""
        hit = (each for each in self.maneuvers if isinstance(each, Disturbance))
        found = [np.multiply(each.torque[:2], each.duration) for each in hit if any(each.impulse)]
        return np.reshape(found, (-1, 2))

    def slew(self, maneuver: Maneuver, inertia: TiltInertia, *, begun: bool = False) -> Slew:
        """What a motor must do for a maneuver with its reserve (`Maneuver.slew`).

        Args:
            maneuver: of this requirement. inertia: see there.
            begun: whether the trunk begins with the rate of the reserve: momentum that the wheels
                hold till the end, with the sense of what they hold anyway.
        """
        slew, kept = maneuver.slew(inertia, self.standing_height), self.reserves.get(maneuver.name)
        if kept is None:
            return slew
        factor, momentum = kept.demand, slew.momentum
        if begun:
            factor = kept.begun
            momentum = momentum + np.copysign(inertia.diagonal * np.array(kept.rate), momentum)
        return Slew(factor * slew.swept, factor * momentum, slew.duration)


@dataclass(frozen=True)
class ManeuverKind:
    """A kind of maneuver as the file sees it.

    Attributes:
        maneuver: the class.
        values: how each of its fields is read.
    """

    maneuver: type[Maneuver]
    values: Mapping[str, Value[Any]]

    @property
    def required(self) -> tuple[str, ...]:
        """Fields that have no default."""
        return tuple(item.name for item in fields(self.maneuver) if item.default is MISSING)


_COMMON: Mapping[str, Value[Any]] = {
    "name": Text(),
    "gravity": Quantity(Dimension.ACCELERATION),
    "incidence": INCIDENCE,
}
_TIME = Quantity(Dimension.TIME)
_LONGEST_STRIDE = 5.0
"""[s]: a giraffe's takes one; a robot is watched for several."""

_TURN: Mapping[str, Value[Any]] = {
    **_COMMON,
    "jump_height": HEIGHT,
    "roll": TURN,
    "pitch": TURN,
    "yaw": YAW,
    "duration": _TIME,
    "rate": Quantities(Dimension.ANGULAR_SPEED, (3,)),
    "wheel_speed": SPIN,
    "end": Choice(tuple(End)),
}

MANEUVER_KINDS: Mapping[str, ManeuverKind] = MappingProxyType(
    {
        "disturbance": ManeuverKind(
            Disturbance,
            {
                **_COMMON,
                "takeoff_velocity": Quantities(Dimension.SPEED, (2,)),
                "torque": Quantities(Dimension.TORQUE, (3,)),
                "onset": Quantity(Dimension.TIME, Sign.NOT_NEGATIVE),
                "duration": _TIME,
                "velocity_change": Quantities(Dimension.SPEED, (3,)),
                "impulse": Quantities(Dimension.IMPULSE, (3,)),
                "point": Quantities(Dimension.LENGTH, (3,)),
            },
        ),
        "shove": ManeuverKind(
            Shove,
            {
                **_COMMON,
                "torque": Quantities(Dimension.TORQUE, (3,)),
                "duration": _TIME,
                "settling": _TIME,
                "stride": Quantity(Dimension.TIME, Sign.NOT_NEGATIVE, most=_LONGEST_STRIDE),
            },
        ),
        "drop": ManeuverKind(
            Drop,
            {**_COMMON, "height": HEIGHT, "roll": TILT, "pitch": TILT},
        ),
        "flip": ManeuverKind(
            Flip,
            {
                **_COMMON,
                "jump_height": HEIGHT,
                "angle": TURN,
                "duration": _TIME,
            },
        ),
        "turn": ManeuverKind(TurnTo, _TURN),
        "catch": ManeuverKind(Catch, _TURN),
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
