"""Maneuvers as data: what the device must do, and how its validation by simulation starts.

They are the `[[maneuver]]` tables of a specification. This module has what they have in common;
their kinds are in `pushes`, `turns` and `pivoted`, listed in `kinds`. A field that is a key has its
dimension and its meaning in its annotation; values are in SI, and vectors in B.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import inf, nan
from typing import Annotated, Any, ClassVar, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import STANDARD_GRAVITY, Dimension, format_quantity
from ocs_design.requirement.boundary import Boundary, End, Freedom, Push
from ocs_design.requirement.values import (
    GRAVITY,
    INCIDENCE,
    SPIN,
    TILT,
    TIME,
    Quantities,
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
        initial_speed: initial speed of all wheels, in the direction of swept and momentum [rad/s].
        one_way: whether the wheels do not really return to that speed, as gravity acts in place of
            the turn's way back.
        yaw: momentum about the vertical, which turns the trunk meanwhile [N m s]. What the wheels
            hold stays where it is in space, at every heading that is passed.
    """

    swept: FloatArray
    momentum: FloatArray
    duration: float
    initial_speed: float = 0.0
    one_way: bool = False
    yaw: FloatArray | float = 0.0

    def headings(self, yaw_inertia: ArrayLike, count: int) -> FloatArray:
        """Headings passed from start to end, at equal distances [rad], shape (..., count).

        `yaw_inertia`: I_zz of the whole [kg m^2], shape (...).
        """
        rate = self.yaw / np.asarray(yaw_inertia, dtype=np.float64)
        return np.multiply.outer(rate * self.duration, np.linspace(0.0, 1.0, count))


@dataclass(frozen=True, eq=False)
class Built:
    """Errors of n robots as built, as far as a slew depends on them beyond the inertia.

    Attributes:
        offset: of the centre of mass in B [m], shape (n, 3).
        weight: relative to that of the design, shape (n,).
        bias: error of measured roll and pitch [rad], shape (n, 2).
    """

    offset: FloatArray
    weight: FloatArray
    bias: FloatArray


Time: TypeAlias = Annotated[float, TIME]
Tilt: TypeAlias = Annotated[float, TILT]
Spin: TypeAlias = Annotated[float, SPIN]
Impulse: TypeAlias = Annotated[Vector3, Quantities(Dimension.IMPULSE, (3,))]
Point: TypeAlias = Annotated[
    Vector3, Quantities(Dimension.LENGTH, (3,)), "point of the trunk that the force hits"
]
Rate: TypeAlias = Annotated[Vector3, Quantities(Dimension.ANGULAR_SPEED, (3,))]


@dataclass(frozen=True, eq=False, kw_only=True)
class Maneuver(ABC):
    """One task of the device: a boundary value problem, and what follows from its kind.

    Attributes:
        name: unique in a specification.
        gravity: [m/s^2]; 0 in orbit, where only turns and catches are possible.
        incidence: angle to which the modules are turned by hand [rad]; None: the design's.
        estimate: factor on the closed-form demand of a kind that is `estimated`.
        standing_height: of the trunk above the ground, the robot on its feet [m]; nan: not known
            yet.
        direct: whether the wheels can act about the vertical.
        on_pivot: whether the robot is on a point or an edge of its trunk, its joints locked.
        on_feet: whether it is on its feet from start to end; otherwise it flies or floats.
        foreseen: whether its trajectory can be planned; otherwise feedback alone meets it.
        estimated: whether a plan may find that it takes more than its closed-form demand, so that
            the device is resized.
        counts_turns: whether whole turns about its axis count, and not its final attitude alone.
        heading_matters: whether its change of heading is judged and told.
        turned_by: fields that make the angle of its turn, where a front may vary that and its time.
        milder_by: fields to which its tilt or push is proportional.
        reducible: `tilt` or `push`, if less of it may be proposed for a lighter device; empty: not.
    """

    name: Annotated[str, Text(), "your choice, different for each maneuver"]
    gravity: Annotated[float, GRAVITY, "gravity, if not that of [requirement]"] = STANDARD_GRAVITY
    incidence: Annotated[
        float | None, INCIDENCE, "angle, if the modules are turned by hand for this maneuver"
    ] = None
    estimate: float = 1.0
    standing_height: float = nan
    direct: bool = False

    on_pivot: ClassVar[bool] = False
    on_feet: ClassVar[bool] = False
    foreseen: ClassVar[bool] = True
    estimated: ClassVar[bool] = False
    counts_turns: ClassVar[bool] = False
    heading_matters: ClassVar[bool] = False
    turned_by: ClassVar[tuple[str, ...]] = ()
    milder_by: ClassVar[tuple[str, ...]] = ()
    reducible: ClassVar[str] = ""

    @abstractmethod
    def boundary(self) -> Boundary:
        """The boundary value problem.

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
    def braking_time(self) -> float:
        """Time in which a brake stops the wheels at the start [s]; inf: none does."""
        return inf

    @property
    def angles(self) -> FloatArray:
        """Roll and pitch between the start and the end of a turn [rad], shape (2,)."""
        return np.zeros(2)

    @property
    def pitches_over(self) -> bool:
        """Whether it turns the trunk over in pitch, and with it the axis of roll."""
        return self.counts_turns and bool(self.angles[1])

    @property
    def turn(self) -> FloatArray:
        """Turn about roll and pitch that the wheels are sized for [rad], shape (2,); else zeros."""
        return np.zeros(2)

    @property
    def has_heading_demand(self) -> bool:
        """Whether wheels that reach the vertical turn or stop the trunk about it."""
        return False

    def heading(self, inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Time integral of the momentum about the vertical, and that held at the end, (...) each.

        Args:
            inertia: I_zz of the robot with its device, wheels braked [kg m^2], shape (...).
        """
        return np.zeros_like(inertia), np.zeros_like(inertia)

    @property
    def tilt_per_drift(self) -> float:
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
        """The maneuver for wheels that act about the vertical or not."""
        return replace(self, direct=direct)

    def freedom(self, body: MassProperties) -> Freedom:
        """How a body is free to turn."""
        return Freedom(body.inertia, np.zeros(3), None)

    def turned(self, inertia: TiltInertia) -> TiltInertia:
        """Inertia that is turned, from that about the centre of mass."""
        return inertia

    @abstractmethod
    def momentum(self, inertia: TiltInertia) -> FloatArray:
        """Largest roll and pitch momentum of both wheels together, as magnitudes [N m s].

        Args:
            inertia: of the robot with its device, wheels braked.
        """

    def least_torque(self, inertia: TiltInertia) -> FloatArray:
        """Least torque of both wheels together on roll and on pitch [N m], shape (2,).

        A smaller torque cannot finish a turn in time, whatever the wheel; zero without a time limit
        (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked.
        """
        del inertia
        return np.zeros(2)

    @abstractmethod
    def slew(self, inertia: TiltInertia) -> Slew:
        """Slew that the motors must make for it (docs/theory.md, What a motor can do).

        Args:
            inertia: of the robot with its device, wheels braked; or of many of them.
        """

    def as_built(self, slew: Slew, built: Built) -> Slew:
        """Slew of robots that are built with errors, from that of the design."""
        del built
        return slew

    @property
    def growth(self) -> float:
        """Factor by which a tilt that the wheels leave grows until the end; above 1 on a pivot."""
        return 1.0

    def scaled(self, factor: float, *names: str) -> Self:
        """The maneuver with these fields, numbers or rows of them, multiplied by `factor`."""
        changes: dict[str, Any] = {}
        for name in names:
            value = getattr(self, name)
            row = isinstance(value, tuple)
            changes[name] = (
                tuple(factor * component for component in value) if row else factor * value
            )
        return replace(self, **changes)

    @abstractmethod
    def slower(self, factor: float) -> Self:
        """The maneuver with `factor` times the time: a higher fall or jump, a longer turn.

        Args:
            factor: positive; below 1: less time.
        """

    def stretched(self, factor: float) -> Self:
        """The maneuver with `factor` times the time both for its turn and for its flight."""
        return self.slower(factor)

    def milder(self, share: float) -> Self:
        """The maneuver with part of its tilt or push, 0..1."""
        return self.scaled(share, *self.milder_by)

    def with_less_torque(self) -> Self:
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

    def infeasibilities(self, *, tilting: int, tolerance: float) -> Iterator[str]:
        """What these wheels cannot do (`with_wheels`), or no robot can, one line each.

        Args:
            tilting: how many axes across the vertical the wheels act about, 1 or 2.
            tolerance: largest tilt at touchdown of a maneuver that ends level [rad].
        """
        del tilting, tolerance
        yield from ()

    @property
    def zero_demand(self) -> str:
        """Keys whose zeros require nothing of roll and pitch; empty: something is required."""
        return ""

    @property
    def disturbance_text(self) -> str:
        """What feedback alone corrects, as in `pitch 2.1 deg`, where its time matters less."""
        return ""

    @property
    @abstractmethod
    def summary(self) -> str:
        """What happens, in words with units."""


def row_text(values: Iterable[float], factor: float = 1.0) -> str:
    """Row of numbers for display, each times a factor, as in `(0, 0.2, 0)`."""
    return f"({', '.join(f'{factor * value:.3g}' for value in values)})"


def rates_text(rates: Vector3) -> str:
    """Row of rates [rad/s] for display, as in `(0, 30, 0) deg/s`."""
    return f"{row_text(np.degrees(rates))} deg/s"


def angles_text(**angles: float) -> str:
    """Nonzero angles by name [rad] for display, as in `roll 5 deg and yaw 2 deg`."""
    text = (f"{name} {format_quantity(angle, 'deg')}" for name, angle in angles.items() if angle)
    return " and ".join(text)
