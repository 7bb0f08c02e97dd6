"""Turns that the wheels can follow, as reference attitude and rate."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.drive import RESERVE
from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

_TRAPEZOID_NOTE = (
    f"the turn follows a trapezoidal rate profile instead of the quintic, which would take more "
    f"than {RESERVE:.0%} of the motors' voltage or current"
)
_STEP_NOTE = (
    "the turn is commanded as a step, as in the paper: no smooth profile that the motors can "
    "follow ends before touchdown"
)


class Profile(ABC):
    """How a turn runs from 0 to 1 over the unit time s = 0..1."""

    @abstractmethod
    def position(self, s: FloatArray) -> FloatArray:
        """Share of the turn completed at `s`."""

    @abstractmethod
    def rate(self, s: FloatArray) -> FloatArray:
        """Its first derivative."""

    @abstractmethod
    def acceleration(self, s: FloatArray) -> FloatArray:
        """Its second derivative."""


class Step(Profile):
    """The whole turn in one step: the paper's command."""

    def position(self, s: FloatArray) -> FloatArray:
        """1 throughout."""
        return np.ones_like(s)

    def rate(self, s: FloatArray) -> FloatArray:
        """0: the jump itself is left to the feedback."""
        return np.zeros_like(s)

    def acceleration(self, s: FloatArray) -> FloatArray:
        """0, as for the rate."""
        return np.zeros_like(s)


class Quintic(Profile):
    """`10 s^3 - 15 s^4 + 6 s^5`: rest to rest, peak rate 1.875, peak acceleration 5.77."""

    def position(self, s: FloatArray) -> FloatArray:
        """The polynomial."""
        return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)

    def rate(self, s: FloatArray) -> FloatArray:
        """Its first derivative."""
        return 30.0 * (s * (1.0 - s)) ** 2

    def acceleration(self, s: FloatArray) -> FloatArray:
        """Its second derivative."""
        return 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)


@dataclass(frozen=True)
class SmoothTrapezoid(Profile):
    """Constant rate between two ramps, without jumps in acceleration.

    Attributes:
        ramp: share of the time for each ramp, 0..0.5; the peak rate is 1 / (1 - ramp), the peak
            acceleration 1.5 / (ramp (1 - ramp)).
    """

    ramp: float

    def position(self, s: FloatArray) -> FloatArray:
        """The integral of the rate; its second half mirrors the first."""
        early = np.minimum(s, 1.0 - s)
        x = np.minimum(early / self.ramp, 1.0)
        ramped = self.ramp * (x**3 - 0.5 * x**4) + np.maximum(early - self.ramp, 0.0)
        half = ramped / (1.0 - self.ramp)
        return np.where(s <= 0.5, half, 1.0 - half)

    def rate(self, s: FloatArray) -> FloatArray:
        """Cubic ramps, `3 x^2 - 2 x^3`."""
        x = np.minimum(np.minimum(s, 1.0 - s) / self.ramp, 1.0)
        return x**2 * (3.0 - 2.0 * x) / (1.0 - self.ramp)

    def acceleration(self, s: FloatArray) -> FloatArray:
        """The ramps' slope."""
        x = np.minimum(np.minimum(s, 1.0 - s) / self.ramp, 1.0)
        slope = 6.0 * x * (1.0 - x) / (self.ramp * (1.0 - self.ramp))
        return np.where(s <= 0.5, slope, -slope)


@dataclass(frozen=True, eq=False)
class Turn:
    """A turn of the trunk about an axis that is fixed in B and in the world.

    Attributes:
        axis: unit vector, shape (3,).
        start, end: angle about it from level [rad].
        duration: [s], from lift-off.
        extendable: whether it may take longer if the wheels need it; a fall does not wait.
        note: how it was changed so that the wheels can follow, one sentence; empty: unchanged.
    """

    axis: FloatArray
    start: float
    end: float
    duration: float
    profile: Profile
    extendable: bool = True
    note: str = ""

    def angle(self, time: FloatArray) -> FloatArray:
        """Angle at `time` from lift-off [rad]."""
        return self.start + self.span * self.profile.position(self._unit(time))

    def rate(self, time: FloatArray) -> FloatArray:
        """Rate at `time` from lift-off [rad/s]."""
        return self.span / self.duration * self.profile.rate(self._unit(time))

    @property
    def span(self) -> float:
        """The whole angle [rad]."""
        return self.end - self.start

    def _unit(self, time: FloatArray) -> FloatArray:
        return np.clip(np.asarray(time) / self.duration, 0.0, 1.0)


NO_TURN = Turn(np.array([0.0, 1.0, 0.0]), 0.0, 0.0, 1.0, Step())
"""The trunk stays level."""


def fit_turn(turn: Turn, body: Gyrostat, limits: MotorLimits) -> Turn:
    """Turn with the first profile that leaves the feedback its reserve (`actuation.drive.RESERVE`).

    The turn's own profile is tried first, then trapezoids from gentle to short ramps, which trade
    wheel speed for torque. If none suffices in the given time, the turn takes longer; if it may
    not, it is commanded as the paper's step, which lets the feedback use all that the motors have.
    """
    usable = limits.reserved()
    if turn.span == 0.0 or utilisation(turn, body, usable) <= 1.0:
        return turn
    ramps = np.linspace(0.45, 0.1, 15)
    options = [replace(turn, profile=SmoothTrapezoid(float(ramp))) for ramp in ramps]
    for option in options:
        if utilisation(option, body, usable) <= 1.0:
            return replace(option, note=_TRAPEZOID_NOTE)
    if not turn.extendable:
        return replace(turn, profile=Step(), note=_STEP_NOTE)
    stretched = []
    for option in (turn, *options):
        # The shortest time that keeps the limits, by bisection.
        too_short, enough = option.duration, 2.0 * option.duration
        while utilisation(replace(option, duration=enough), body, usable) > 1.0:
            too_short, enough = enough, 2.0 * enough
        for _ in range(30):
            middle = 0.5 * (too_short + enough)
            if utilisation(replace(option, duration=middle), body, usable) > 1.0:
                too_short = middle
            else:
                enough = middle
        stretched.append(replace(option, duration=enough))
    shortest = min(stretched, key=lambda option: option.duration)
    note = (
        f"the turn takes {shortest.duration:.3g} s instead of the {turn.duration:.3g} s asked "
        f"for: the wheels cannot turn the trunk faster"
    )
    return replace(shortest, note=note)


def utilisation(turn: Turn, body: Gyrostat, limits: MotorLimits) -> float:
    """Largest share of the limits that the wheels need along the turn, from zero momentum.

    A gyrostat with no momentum has `I_tot w + h A W = 0` and `J w_dot = -g A tau`, g the reaction
    (see `Gyrostat`). The pseudo-inverse leaves out an axis that the wheels do not reach.
    """
    s = np.linspace(0.0, 1.0, 401)
    rate = turn.span / turn.duration * turn.profile.rate(s)
    acceleration = turn.span / turn.duration**2 * turn.profile.acceleration(s)
    momentum = body.reaction * body.sharing @ _momentum_per_rate(body.inertia, turn.axis)
    speed = np.outer(momentum / body.spin_inertia, rate)
    torque = np.outer(
        body.sharing @ _momentum_per_rate(body.actuated_inertia, turn.axis), acceleration
    )
    return limits.utilisation(speed, torque)


def _momentum_per_rate(inertia: FloatArray, axis: FloatArray) -> FloatArray:
    """Momentum per rate of a turn whose heading drifts so that none is about yaw, shape (3,)."""
    drift = -(inertia[2, :2] @ axis[:2]) / inertia[2, 2]
    momentum: FloatArray = inertia @ np.append(axis[:2], drift)
    return momentum
