"""Turns in a given time: a fall, a flip, a turn to an attitude with its heading, and a catch."""

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import pi, remainder, sqrt
from typing import Annotated, ClassVar, Self, TypeAlias

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.quaternions import from_axis_angle, product, scaled_vertical
from ocs_design.common.units import format_quantity, rpm
from ocs_design.requirement.boundary import UPRIGHT, Boundary, End, X, Y, Z
from ocs_design.requirement.maneuver import (
    Maneuver,
    Rate,
    Slew,
    Spin,
    Tilt,
    Time,
    angles_text,
    rates_text,
)
from ocs_design.requirement.values import HEIGHT, TURN, YAW, Choice
from ocs_design.requirement.vocabulary import ORTHOGONAL, PYRAMID

_Height: TypeAlias = Annotated[float, HEIGHT]
_JumpHeight: TypeAlias = Annotated[_Height, "rise of the centre of mass"]
_Turn: TypeAlias = Annotated[float, TURN]
_TurnTime: TypeAlias = Annotated[Time, "time of the turn, from lift-off"]


class Reorientation(Maneuver):
    """A rest-to-rest turn of the trunk from level by a specified angle."""

    @property
    def turn(self) -> FloatArray:
        """All of its roll and pitch [rad], shape (2,)."""
        return self.angles

    @abstractmethod
    def time(self) -> float:
        """Time that the turn may take [s]."""

    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """Half the time speeding up, half slowing down: a peak rate of 2 theta / T."""
        peak = 2.0 / self.time()
        return np.abs(inertia.momentum(self.turn)) * peak

    def least_torque(self, inertia: TiltInertia) -> FloatArray:
        """Least torque of the turn from rest to rest, 4 I theta / T^2 [N m]."""
        return 2.0 * self.momentum(inertia) / self.time()

    def slew(self, inertia: TiltInertia) -> Slew:
        """The whole turn, rest to rest."""
        swept = inertia.momentum(self.turn)
        return Slew(swept, np.zeros_like(swept), self.time())


@dataclass(frozen=True, eq=False, kw_only=True)
class Drop(Reorientation):
    """A fall from rest with the trunk tilted (paper, section 4, second test)."""

    height: Annotated[_Height, "height of the trunk's frame above the ground"]
    roll: Annotated[Tilt, "roll at release; positive: right side down"] = 0.0
    pitch: Annotated[Tilt, "pitch at release; positive: nose down"]

    turned_by: ClassVar[tuple[str, ...]] = ("roll", "pitch")
    milder_by: ClassVar[tuple[str, ...]] = turned_by
    reducible: ClassVar[str] = "tilt"

    def boundary(self) -> Boundary:
        """A turn to level within the fall, from rest, pitched about y and then rolled about x."""
        attitude = product(from_axis_angle(Y, self.pitch), from_axis_angle(X, self.roll))
        vertical = scaled_vertical(attitude)
        # A rate w changes the vertical v by -w x v.
        axis = np.cross([0.0, 0.0, 1.0], vertical)
        length = float(np.linalg.norm(axis))
        axis = axis / length if length > 0.0 else Y
        angle, duration = float(np.arctan2(length, vertical[2])), self.time()
        return Boundary(self.name, attitude, UPRIGHT, axis, angle, duration, height=self.height)

    def time(self) -> float:
        """Time from release until the feet of the levelled robot touch the ground [s].

        Raises:
            SpecificationError: the robot would already stand on the ground.
        """
        fall = self.height - self.standing_height
        if fall <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: the trunk is released at {self.height:.3g} m, but stands "
                f"at {self.standing_height:.3g} m: there is no fall",
                hint="Release it higher.",
            )
        return float(np.sqrt(2.0 * fall / self.gravity))

    def slower(self, factor: float) -> Self:
        """A higher fall."""
        fall = (self.height - self.standing_height) * factor**2
        return replace(self, height=self.standing_height + fall)

    @property
    def zero_demand(self) -> str:
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

    def time(self) -> float:
        """Time as specified [s]."""
        return self.duration

    def slower(self, factor: float) -> Self:
        """A longer turn; in a higher jump where it needs one."""
        longer = self.scaled(factor, "duration")
        higher = max(_LONGER_THAN_ITS_TURN * longer.duration / self.flight_time, 1.0) ** 2
        return longer.scaled(higher, "jump_height")

    def stretched(self, factor: float) -> Self:
        """A longer turn in the same part of a higher jump."""
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
    """A full turn, or part of one, in a vertical jump (paper, section 4, third test)."""

    jump_height: _JumpHeight
    angle: Annotated[_Turn, "turn in pitch; negative: a back-flip"]
    duration: _TurnTime

    counts_turns: ClassVar[bool] = True
    turned_by: ClassVar[tuple[str, ...]] = ("angle",)

    def boundary(self) -> Boundary:
        """A turn in pitch, from level."""
        final = from_axis_angle(Y, self.angle)
        return Boundary(self.name, UPRIGHT, final, Y, self.angle, self.duration)

    @property
    def angles(self) -> FloatArray:
        """Turn about pitch alone [rad], shape (2,)."""
        return np.array([0.0, self.angle])

    @property
    def zero_demand(self) -> str:
        """Angle, if it is zero."""
        return "" if self.angle else "angle is 0"

    def infeasibilities(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """A turn that is not whole, in one line."""
        del tilting
        left_over = abs(remainder(self.angle, 2.0 * pi))
        if left_over > tolerance:
            angle_text = format_quantity(self.angle, "deg")
            yield (
                f"maneuver.{self.name}: after {angle_text} the trunk is "
                f"{format_quantity(left_over, 'deg')} off level, but a flip must land level: ask "
                "for 360deg (back, forward). If this attitude at touchdown is meant, ask for a "
                f"turn to it: 'pitch {angle_text.replace(' ', '')} in {self.duration:.3g}s'"
            )

    @property
    def summary(self) -> str:
        """Turn, time, jump and gravity."""
        return (
            f"turns {format_quantity(self.angle, 'deg')} of pitch in {self.duration:.3g} s, "
            f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        )


LOOP_SHARE = 0.75
"""Fraction of the tilt loop that wheels and motors are sized for, in that fraction of its time."""

_InitialRate: TypeAlias = Annotated[Rate, "rate of the trunk at lift-off, about its x, y and z"]
_End: TypeAlias = Annotated[
    str, Choice(tuple(End)), "required end: level, attitude (with its heading) or at rest"
]

_ENDS: Mapping[str, str] = {
    End.LEVEL: ", any heading,",
    End.ATTITUDE: "",
    End.AT_REST: " or any attitude",
}


def loop_length(heading: float) -> float:
    """Shortest path of a trunk's z axis that changes the heading [rad], `sqrt(h (4 pi - h))`.

    Where the wheels cannot act about the vertical, the heading h changes by the solid angle that
    the z axis encircles. The shortest path around it is a circle: the isoperimetric inequality on
    the sphere (docs/theory.md, Yaw by two wheels).

    Args:
        heading: at most one turn [rad].
    """
    return sqrt(abs(heading) * (4.0 * pi - abs(heading)))


@dataclass(frozen=True, eq=False, kw_only=True)
class TurnTo(TimedTurn):
    """A turn of the trunk in a vertical jump, from level to any attitude, heading included.

    Wheels that act about the vertical (`direct`) need no tilt loop.
    """

    jump_height: _JumpHeight = 0.0
    roll: Annotated[_Turn, "roll at the end, reached by yaw, then pitch, then roll"] = 0.0
    pitch: Annotated[_Turn, "pitch at the end"] = 0.0
    yaw: Annotated[float, YAW, "yaw at the end"] = 0.0
    duration: _TurnTime
    rate: _InitialRate = (0.0, 0.0, 0.0)
    wheel_speed: Annotated[Spin, "speed of all wheels at lift-off"] = 0.0
    end: _End = End.ATTITUDE

    estimated: ClassVar[bool] = True
    heading_matters: ClassVar[bool] = True

    def boundary(self) -> Boundary:
        """A turn from level to the attitude, which is yaw, then pitch, then roll."""
        angles = np.array([self.roll, self.pitch, self.yaw])
        final = product(
            from_axis_angle(Z, self.yaw),
            product(from_axis_angle(Y, self.pitch), from_axis_angle(X, self.roll)),
        )
        if np.count_nonzero(angles) == 1:
            # About one axis, it may be more than half a turn.
            axis, angle = np.sign(angles), float(np.abs(angles).sum())
        else:
            final = final * np.copysign(1.0, final[0])
            sine = float(np.linalg.norm(final[1:]))
            axis = final[1:] / sine if sine > 0.0 else Y
            angle = 2.0 * float(np.arctan2(sine, final[0]))
        return Boundary(
            self.name,
            UPRIGHT,
            final,
            axis,
            angle,
            self.duration,
            self.end,
            np.array(self.rate),
            self.wheel_speed,
        )

    @property
    def pushed_off(self) -> bool:
        """Whether the legs can be planned to make its jump; none is planned to end with a rate."""
        return super().pushed_off and not (any(self.rate) or self.wheel_speed)

    def contradictions(self) -> Iterator[str]:
        """What contradicts itself, one line each: there is a jump where there is gravity."""
        if bool(self.gravity) != bool(self.jump_height):
            text = "is missing" if self.gravity else "there is no jump in orbit"
            yield f"maneuver.{self.name}.jump_height: {text}"
        else:
            yield from self._landing_before("its turn", self.duration)

    @property
    def zero_demand(self) -> str:
        """Attitude and rates, if all that these wheels act about are zero."""
        if self.has_heading_demand or any((self.roll, self.pitch, self.yaw, *self.rate[:2])):
            return ""
        return "roll, pitch and yaw, and the rates about roll and pitch are 0"

    @property
    def has_heading_demand(self) -> bool:
        """Whether a change of heading is required and the wheels can act about the vertical."""
        return self.direct and (bool(self.yaw) or bool(self.rate[2]))

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Demand of the turn in yaw and of the yaw rate at lift-off; see `Maneuver.heading`."""
        estimated = self.estimate * inertia
        yaw = self.yaw if self.end == End.ATTITUDE else 0.0
        return estimated * yaw, estimated * self.rate[2]

    @property
    def turn(self) -> FloatArray:
        """Roll and pitch [rad], shape (2,), with the demand of a change of heading on two wheels.

        On a circle of `loop_length` each axis turns by 2 / pi of it, at a steady rate except at its
        start and end. Going round the circle takes torque, too: sizing for `LOOP_SHARE` of it, in
        that share of the time, gives wheels 1.15 to 1.25 times as large as planned turns need,
        unless they are limited by torque (docs/theory.md, Yaw by two wheels).
        """
        tilt = self.angles
        return np.asarray(self.estimate * self._share * (tilt + np.copysign(self._loop, tilt)))

    @property
    def _share(self) -> float:
        return LOOP_SHARE if self._loop else 1.0

    @property
    def angles(self) -> FloatArray:
        """Roll and pitch at the end [rad], shape (2,)."""
        return np.array([self.roll, self.pitch])

    @property
    def _loop(self) -> float:
        """Contribution of a change of heading to roll and to pitch [rad]."""
        return 0.0 if self.direct else loop_length(remainder(self.yaw, 2.0 * pi)) * 2.0 / pi

    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """Momentum of the tilt, half the time up and half down, of loop and initial rates."""
        peak = 2.0 * self.angles + np.copysign(self._loop, self.angles)
        turning = self.estimate * np.abs(inertia.momentum(peak)) / self.duration
        return np.asarray(turning + np.abs(self._initial_momentum(inertia)))

    def slew(self, inertia: TiltInertia) -> Slew:
        """The turn, and the momentum at lift-off, which the wheels hold until touchdown."""
        turned, time = super().slew(inertia), self._share * self.duration
        # Wheels spin against a turn of the trunk, but with a rate that they absorb. A loop, and a
        # turn with a rate, need both.
        sense = any(self.rate) - any((self.roll, self.pitch, self.yaw))
        initial_speed = 0.0 if self._loop else sense * self.wheel_speed
        return Slew(turned.swept, self._initial_momentum(inertia), time, initial_speed)

    def _initial_momentum(self, inertia: TiltInertia) -> FloatArray:
        """Momentum about roll and pitch at lift-off, as estimated [N m s], shape (..., 2)."""
        return self.estimate * inertia.momentum(np.array(self.rate[:2]))

    @property
    def summary(self) -> str:
        """Attitude, rate, time, jump and gravity."""
        text = f"turns to {angles_text(roll=self.roll, pitch=self.pitch, yaw=self.yaw) or 'level'}"
        if any(self.rate):
            text += f" from rates of {rates_text(self.rate)}"
        if self.wheel_speed:
            text += f" with wheels at {rpm(self.wheel_speed)}"
        where = "in orbit"
        if self.gravity:
            where = f"in a jump of {self.jump_height:.3g} m at {self.gravity:.3g} m/s2"
        return f"{text}{_ENDS[self.end]} in {self.duration:.3g} s, {where}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Catch(TurnTo):
    """A stop of a trunk that rotates at lift-off."""

    roll: Annotated[_Turn, "roll at the end, where end is attitude"] = 0.0
    duration: Annotated[Time, "time from lift-off to rest"]
    rate: _InitialRate
    end: _End = End.LEVEL

    def infeasibilities(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """A yaw rate that the wheels cannot stop, in one line."""
        del tilting, tolerance
        if self.rate[2] and not self.direct:
            yield (
                f"maneuver.{self.name}: these wheels do not act about the vertical and cannot stop "
                f"a yaw of {np.degrees(self.rate[2]):.4g} deg/s: leave yaw out, or choose "
                f"ocs.layout {ORTHOGONAL!r} or {PYRAMID!r}"
            )
