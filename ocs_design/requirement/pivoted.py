"""Maneuvers about a pivot: balancing on a point or an edge, and standing up on it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from math import cos, exp, hypot, inf, log, pi, sqrt
from typing import Annotated, ClassVar, NamedTuple, Self

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import Dimension, format_quantity, rpm
from ocs_design.common.wording import listed
from ocs_design.requirement.boundary import Boundary, End, Freedom, Y
from ocs_design.requirement.maneuver import (
    Built,
    Impulse,
    Maneuver,
    Point,
    Rate,
    Slew,
    Spin,
    Tilt,
    Time,
    angles_text,
    rates_text,
    row_text,
)
from ocs_design.requirement.values import Choice, Quantities, Vector3
from ocs_design.robot.mass import MassProperties


class Actuation(StrEnum):
    """How a robot that stands up gets its momentum from the wheels.

    Attributes:
        MOTOR: by the motor, from the start.
        BRAKE: by a brake that stops, in an instant, wheels that the motor has slowly spun up;
            the motor then holds the robot at the top.
    """

    MOTOR = "motor"
    BRAKE = "brake"


HOLD_TIME_RATIO = 1.5
"""Time for which a robot that has stood up or recovered is held upright, relative to the time
given."""

SPIN_UP = 60.0
"""Time for spinning wheels up to the speed from which a brake stops them [s]."""


_GRAVITY_SHARE_MAX = 0.02
"""Largest share of a climb's momentum that gravity may take while a brake stops its wheels, if that
is to count as an instant."""


class Swing(NamedTuple):
    """Least torque that brings a pendulum from a tilt and a rate to rest at the top in a time.

    Attributes:
        torque: at first, and then with the opposite sign [N m].
        switch: time at which the sign changes [s].
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
        tilt: theta at the start [rad]. rate: theta' at the start [rad/s]. time: T [s].
    """
    growth_rate = sqrt(stiffness / inertia)
    x, y = tilt + rate / growth_rate, tilt - rate / growth_rate
    if x < 0.0:
        x, y = -x, -y
    if x == 0.0:
        return Swing(0.0, 0.0)
    end = exp(growth_rate * time)
    linear = y * (1.0 + 1.0 / end) - x * (1.0 + end)
    growth_to_switch = (sqrt(max(linear**2 + 16.0 * x * y, 0.0)) - linear) / (4.0 * x)
    growth_to_switch = min(max(growth_to_switch, 1.0), end)
    scale = hypot(1.0 - 2.0 / growth_to_switch + 1.0 / end, 1.0 - 2.0 * growth_to_switch + end)
    return Swing(stiffness * hypot(x, y) / scale, log(growth_to_switch) / growth_rate)


@dataclass(frozen=True, eq=False, kw_only=True)
class Pivoted(Maneuver):
    """A robot on a point or an edge that must be upright and at rest again.

    Upright means that the centre of mass is above the pivot. All joints of the robot are locked.

    Attributes:
        edge: direction of the edge that it turns about, level in B, of any length; zeros: a point.
        roll, pitch: tilt at the start from upright, one rotation about the axis (roll, pitch, 0) of
            a B that stands upright [rad].
        end: see `End`; not `at rest`, as a robot that is not upright cannot stay at rest.
        stretch: factor on the longest time of the estimate; a larger one needs less torque and more
            momentum (`StandUp.with_less_torque`).
        body: the robot, in B; None: not known yet (`on`).
    """

    pivot: Annotated[Point, "point on which it stands, in the trunk's frame"]
    edge: Annotated[
        Vector3,
        Quantities(Dimension.RATIO, (3,)),
        "direction of the edge on which it stands; zeros: a point",
    ] = (0.0, 0.0, 0.0)
    roll: Annotated[Tilt, "roll at the start, from balance"] = 0.0
    pitch: Annotated[Tilt, "pitch at the start, from balance"] = 0.0
    duration: Annotated[Time, "time until it is upright and at rest"]
    wheel_speed: Annotated[Spin, "speed of all wheels at the start"] = 0.0
    end: Annotated[
        str,
        Choice((End.LEVEL, End.ATTITUDE)),
        "required end: level, or attitude (heading included)",
    ] = End.LEVEL
    stretch: float = 1.0
    body: MassProperties | None = None

    on_pivot: ClassVar[bool] = True

    def boundary(self) -> Boundary:
        """A turn to upright, from a tilt and, after a brake or an impulse, a rate."""
        angle = float(np.linalg.norm(self.tilt))
        axis = self.tilt / angle if angle > 0.0 else Y
        if angle == 0.0 and self.initial_rate.any():
            axis = self.initial_rate / float(np.linalg.norm(self.initial_rate))
        upright = quaternions.upright(self.gravity_moment)
        attitude = quaternions.product(quaternions.from_axis_angle(axis, angle), upright)
        return Boundary(
            name=self.name,
            attitude=attitude,
            final_attitude=upright,
            axis=axis,
            angle=-angle,
            duration=self.duration,
            end=self.end,
            rate=self.initial_rate,
            wheel_speed=self.wheel_speed,
            # The pivot is at floor height.
            height=-float((quaternions.matrix(attitude) @ np.array(self.pivot))[2]),
        )

    @property
    def angles(self) -> FloatArray:
        """Roll and pitch at the start [rad], shape (2,)."""
        return np.array([self.roll, self.pitch])

    def freedom(self, body: MassProperties) -> Freedom:
        """Freedom to turn about the pivot, under gravity."""
        on_body = self.on(body)
        return Freedom(on_body.inertia, on_body.gravity_moment, on_body.axis)

    @property
    def momentum_of_body(self) -> FloatArray | None:
        """Momentum of the wheels [N m s], shape (2,)."""
        return self.momentum(TiltInertia.uncoupled(np.ones(2)))

    def slower(self, factor: float) -> Self:
        """More time until it is upright."""
        return self.scaled(factor, "duration")

    def on(self, body: MassProperties) -> Self:
        """The maneuver for a body that stands on the pivot.

        Raises:
            SpecificationError: its centre of mass is not above the pivot.
        """
        on_body = replace(self, body=body)
        if any(self.edge) and not any(self.edge[:2]):
            raise SpecificationError(
                f"maneuver {self.name!r}: its edge is vertical: the robot cannot stand up about it",
                hint="Write an edge in the level plane, as 'along left' or 'along forward'.",
            )
        height = float(on_body.lever[2])
        if height <= 0.0:
            raise SpecificationError(
                f"maneuver {self.name!r}: the pivot is {format_quantity(-height, 'mm')} above the "
                f"centre of mass, so the robot would hang instead of standing",
                hint=f"The centre of mass is at z = {format_quantity(body.com[2], 'mm')} in the "
                f"trunk's frame: put the pivot below it.",
            )
        return on_body

    @property
    def _known_body(self) -> MassProperties:
        """The body, once it is known."""
        assert self.body is not None, "the body is not known yet"
        return self.body

    @property
    def lever(self) -> FloatArray:
        """Vector from the pivot to the centre of mass in B, across the edge [m], shape (3,)."""
        lever, axis = self._known_body.com - np.array(self.pivot), self.axis
        return np.asarray(lever if axis is None else lever - axis * (axis @ lever))

    @property
    def axis(self) -> FloatArray | None:
        """Unit vector along the edge in B, shape (3,); None: it stands on a point."""
        length = float(np.linalg.norm(self.edge))
        return np.array(self.edge) / length if length > 0.0 else None

    @property
    def inertia(self) -> FloatArray:
        """Inertia about the pivot in B, wheels braked [kg m^2], shape (3, 3)."""
        return self._known_body.inertia_about(np.array(self.pivot))

    def turned(self, inertia: TiltInertia) -> TiltInertia:
        """Inertia about the pivot, from that about the centre of mass: parallel axes."""
        mass, (x, y, z) = self._known_body.mass, self._known_body.com - np.array(self.pivot)
        parallel_axis = mass * np.array([y * y + z * z, x * x + z * z])
        return TiltInertia(inertia.diagonal + parallel_axis, inertia.product - mass * x * y)

    @property
    def gravity_moment(self) -> FloatArray:
        """Weight times lever, m g l in B [N m], shape (3,)."""
        return np.asarray(self._known_body.mass * self.gravity * self.lever)

    @property
    def rate_after_disturbance(self) -> FloatArray:
        """Rate that a disturbance leaves, in B [rad/s], shape (3,)."""
        return np.zeros(3)

    @property
    def initial_rate(self) -> FloatArray:
        """Rate at the start, in B [rad/s], shape (3,)."""
        return self.rate_after_disturbance

    @property
    def tilt(self) -> FloatArray:
        """Rotation vector of the tilt at the start [rad], shape (3,)."""
        return np.array([self.roll, self.pitch, 0.0])

    @property
    def mobility(self) -> FloatArray:
        """Rate per angular momentum about the pivot, in B [1/(kg m^2)], shape (3, 3)."""
        axis = self.axis
        if axis is None:
            return np.asarray(np.linalg.inv(self.inertia))
        return np.outer(axis, axis) / float(axis @ self.inertia @ axis)

    @property
    def _pendulum(self) -> tuple[FloatArray, float, float, float, float]:
        """Axis of the tilt; inertia, stiffness, tilt and rate about it.

        The stiffness K is that of the linear pendulum with the energy of the true one at the tilt:
        `K theta^2 / 2 = m g l (1 - cos theta)`.
        """
        weight, rate = float(np.linalg.norm(self.gravity_moment)), self.rate_after_disturbance
        axis = self.axis
        if axis is None:
            largest = float(np.linalg.eigvalsh(self.inertia)[-1])
            axis = (self.tilt + rate * sqrt(largest / weight)) * np.array([1.0, 1.0, 0.0])
            length = float(np.linalg.norm(axis))
            axis = axis / length if length > 0.0 else np.array([0.0, 1.0, 0.0])
        inertia, tilt = float(axis @ self.inertia @ axis), float(axis @ self.tilt)
        stiffness_ratio = 2.0 * (1.0 - cos(tilt)) / tilt**2 if abs(tilt) > _SMALL_TILT else 1.0
        return axis, inertia, stiffness_ratio * weight, tilt, float(axis @ rate)

    @property
    def growth_rate(self) -> float:
        """Rate at which a small tilt grows, sqrt(m g l / I) [1/s]."""
        _, inertia, _, _, _ = self._pendulum
        return sqrt(float(np.linalg.norm(self.gravity_moment)) / inertia)

    def _swing(self) -> tuple[FloatArray, Swing]:
        """Axis about which the wheels first speed up, its roll and pitch parts, and the swing."""
        axis, inertia, stiffness, tilt, rate = self._pendulum
        axis = np.copysign(1.0, tilt + rate * sqrt(inertia / stiffness)) * axis
        longest = self.stretch * self._longest / sqrt(stiffness / inertia)
        time = min(self.duration, longest)
        linear_swing = swing(stiffness, inertia, tilt, rate, time)
        return axis[:2], Swing(self.estimate * linear_swing.torque, linear_swing.switch)

    _longest: ClassVar[float] = 3.0
    """Longest time used in the estimate, over the e-folding time of a tilt."""

    def infeasibilities(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """What the pivot or these wheels do not allow, one line each."""
        del tolerance
        where, axis = f"maneuver.{self.name}", self.axis
        tilt = float(np.linalg.norm(self.tilt))
        if tilt > pi / 2.0:
            yield (
                f"{where}: tilted by {format_quantity(tilt, 'deg')}, it would be below its pivot: "
                "90 deg at most"
            )
        if axis is None:
            if tilting < 2:
                yield (
                    f"{where}: on a point it falls about roll and pitch, but these wheels act "
                    "about only one: give the edge that it stands on, or an ocs.layout with more "
                    "wheels"
                )
            return
        if abs(axis[2]) > _DIRECTION_TOLERANCE:
            yield f"{where}.edge: must be level in the trunk's frame, so its z must be 0"
        if tilt and abs(abs(self.tilt @ axis) - tilt) > _DIRECTION_TOLERANCE:
            along = ", ".join(f"{component:.3g}" for component in axis)
            yield (
                f"{where}: roll and pitch tilt it about an axis other than the edge, which is "
                f"along ({along}): it can turn about its edge only"
            )

    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """Momentum of the wheels when the torque changes its sign."""
        del inertia
        axis, linear_swing = self._swing()
        return np.abs(axis) * linear_swing.torque * linear_swing.switch

    def least_torque(self, inertia: TiltInertia) -> FloatArray:
        """Least torque that does it in time, for the linear pendulum [N m], shape (2,)."""
        del inertia
        axis, linear_swing = self._swing()
        return np.abs(axis) * linear_swing.torque

    def slew(self, inertia: TiltInertia) -> Slew:
        """A turn from rest to rest without gravity, with the same torque and largest momentum.

        A torque tau, and then -tau, for T_1 each turns an inertia I by tau T_1^2 / I.
        """
        axis, linear_swing = self._swing()
        shape = np.shape(inertia.diagonal)
        swept = np.broadcast_to(axis * linear_swing.torque * linear_swing.switch**2, shape)
        return Slew(
            swept, np.zeros(shape), 2.0 * linear_swing.switch, self.wheel_speed, one_way=True
        )

    def as_built(self, slew: Slew, built: Built) -> Slew:
        """Slew of robots as built: torques grow with weight and tilt.

        A centre of mass off by d over the lever, and a level that is measured wrongly, are a tilt.
        The law keeps to the attitudes of the design, so it stays until the end.
        """
        axis, inertia, stiffness, tilt, rate = self._pendulum
        across = np.stack([-built.offset[:, 1], built.offset[:, 0]], axis=1)
        tipped = (across / float(np.linalg.norm(self.lever)) - built.bias) @ axis[:2]
        diverging = tilt + rate / sqrt(stiffness / inertia)
        larger = built.weight * (1.0 + (tipped / diverging if diverging else 0.0))
        swept, momentum = slew.swept * larger[:, None], slew.momentum * larger[:, None]
        return replace(slew, swept=swept, momentum=momentum)

    @property
    def growth(self) -> float:
        """exp(kappa T), the growth of a tilt that no torque opposes."""
        _, inertia, stiffness, _, _ = self._pendulum
        growth_rate = sqrt(stiffness / inertia)
        return exp(min(growth_rate * self.duration, self.stretch * self._longest))

    @property
    def _place(self) -> str:
        """Pivot and tilt, in words."""
        point = row_text(self.pivot, 1e3)
        on = f"stands on a point at {point} mm"
        if self.axis is not None:
            on = f"stands on an edge at {point} mm along {row_text(self.axis)}"
        tilt = angles_text(roll=self.roll, pitch=self.pitch) or "upright"
        with_wheels = f" with wheels at {rpm(self.wheel_speed)}"
        return f"{on}, {tilt}{with_wheels if self.wheel_speed else ''}"


_SMALL_TILT = 1e-6
"""Tilt below which a pendulum counts as linear [rad]."""

_DIRECTION_TOLERANCE = 1e-6
"""Tolerance of a direction's components, for rounding."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Balance(Pivoted):
    """A tilt, a rate or an impulse, not known in advance, that feedback alone corrects."""

    rate: Annotated[Rate, "rate of the trunk at the start, about its x, y and z"] = (0.0, 0.0, 0.0)
    impulse: Annotated[Impulse, "impulse of a force at the start"] = (0.0, 0.0, 0.0)
    point: Point = (0.0, 0.0, 0.0)

    _longest: ClassVar[float] = 2.0
    foreseen: ClassVar[bool] = False
    milder_by: ClassVar[tuple[str, ...]] = ("roll", "pitch", "rate", "impulse")

    @property
    def rate_after_disturbance(self) -> FloatArray:
        """The specified rate plus that of the impulse, in B [rad/s], shape (3,)."""
        turned = np.cross(np.subtract(self.point, self.pivot), self.impulse)
        return np.asarray(np.array(self.rate) + self.mobility @ turned)

    @property
    def zero_demand(self) -> str:
        """Tilt, rate and impulse, if all are zero."""
        if any((*self.tilt, *self.rate_after_disturbance[:2])):
            return ""
        return "tilt, rate and impulse about roll and pitch are 0"

    @property
    def disturbance_text(self) -> str:
        """Tilt, rate and impulse, as in `pitch 2.1 deg and an impulse of (0, 0.2, 0) N s`."""
        angles = {"roll": self.roll, "pitch": self.pitch}
        upsets = [f"{name} {format_quantity(a, 'deg')}" for name, a in angles.items() if a]
        if any(self.rate):
            upsets.append(f"a rate of {rates_text(self.rate)}")
        if any(self.impulse):
            upsets.append(f"an impulse of {row_text(self.impulse)} N s")
        return listed(upsets)

    @property
    def summary(self) -> str:
        """Pivot, tilt, rate and impulse."""
        disturbance = ""
        if any(self.rate):
            disturbance += f", turning at {rates_text(self.rate)}"
        if any(self.impulse):
            disturbance += (
                f", hit by {row_text(self.impulse)} N s at {row_text(self.point, 1e3)} mm"
            )
        return f"{self._place}{disturbance}; upright and at rest after {self.duration:.3g} s"


@dataclass(frozen=True, eq=False, kw_only=True)
class StandUp(Pivoted):
    """A planned climb from rest in a tilt to upright, by motors or a brake (`Actuation`)."""

    actuation: Annotated[
        str,
        Choice(tuple(Actuation)),
        "motor, or brake: wheels spun up beforehand stop in an instant",
    ] = Actuation.MOTOR

    estimated: ClassVar[bool] = True
    milder_by: ClassVar[tuple[str, ...]] = ("roll", "pitch")
    reducible: ClassVar[str] = "tilt"

    def with_less_torque(self) -> Self:
        """This climb with nearly the least torque, for motors that have no more; once only."""
        return replace(self, stretch=4.0 / self._longest) if self.stretch == 1.0 else self

    @property
    def zero_demand(self) -> str:
        """Roll and pitch, if they are zero."""
        return "" if self.roll or self.pitch else "roll and pitch are 0"

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
    def initial_rate(self) -> FloatArray:
        """Rate right after braking, which conserves the momentum; zero without a brake."""
        return np.asarray(self.mobility @ self._climb) if self.braked else np.zeros(3)

    @property
    def braking_time(self) -> float:
        """Time in which a brake stops the wheels [s]; inf: by the motor.

        Meanwhile gravity takes m g l t sin theta of the momentum sqrt(m g l I) theta, about kappa t
        of it, where kappa is `growth_rate`. For the Cubli's wheels (`_climb`) this gives 2.1 ms.
        """
        return _GRAVITY_SHARE_MAX / self.growth_rate if self.braked else inf

    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """Momentum of the wheels before braking, or when the torque changes its sign."""
        if self.braked:
            return self.estimate * np.abs(self._climb[:2])
        return super().momentum(inertia)

    def least_torque(self, inertia: TiltInertia) -> FloatArray:
        """Least torque of the motor [N m], shape (2,); zero with a brake."""
        if self.braked:
            return np.zeros(2)
        return super().least_torque(inertia)

    def slew(self, inertia: TiltInertia) -> Slew:
        """Slew of the wheels; with a brake, the slow spin-up to their speed before it."""
        if not self.braked:
            return super().slew(inertia)
        shape = np.shape(inertia.diagonal)
        momentum = np.broadcast_to(self.estimate * self._climb[:2], shape)
        return Slew(np.zeros(shape), momentum, SPIN_UP)

    def as_built(self, slew: Slew, built: Built) -> Slew:
        """Slew of robots as built; with a brake it is that of the design."""
        return slew if self.braked else super().as_built(slew, built)

    @property
    def summary(self) -> str:
        """Pivot, tilt, time and actuation."""
        by = ", by braking its wheels in an instant" if self.braked else ""
        return f"{self._place}; stands up in {self.duration:.3g} s{by}"
