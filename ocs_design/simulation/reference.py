"""Turns that the wheels can follow, as reference attitude and rate."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.drive import RESERVE
from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

_TRAPEZOID_NOTE = (
    "the turn follows a trapezoidal rate profile instead of the quintic, which would take more "
    f"than {RESERVE:.0%} of the motors' voltage or current"
)
_STEP_NOTE = (
    "the turn is commanded as a step, as in the paper: no smooth turn that the motors can follow "
    "ends before touchdown"
)


@dataclass(frozen=True, eq=False)
class Turn:
    """A turn of the trunk about an axis that is fixed in B and in the world.

    Over the unit time s = 0..1 it runs from rest to rest: its angle is `10 s^3 - 15 s^4 + 6 s^5` of
    the span, with peak rate 1.875 and peak acceleration 5.77, or with a `ramp` its rate is a
    trapezoid of cubic ramps, with peak rate `1 / (1 - ramp)` and peak acceleration
    `1.5 / (ramp (1 - ramp))`.

    Attributes:
        axis: unit vector, shape (3,).
        start, end: angle about it from level [rad].
        duration: [s], from lift-off.
        extendable: whether it may take longer if the wheels need it; a fall does not wait.
        ramp: share of the time for each ramp, 0..0.5; 0: the polynomial.
        at_once: whether all of it is commanded at the start, as in the paper: the jump itself is
            left to the feedback.
        note: how it was changed so that the wheels can follow, one sentence; empty: unchanged.
    """

    axis: FloatArray
    start: float
    end: float
    duration: float
    extendable: bool = True
    ramp: float = 0.0
    at_once: bool = False
    note: str = ""

    def angle(self, time: FloatArray) -> FloatArray:
        """Angle at `time` from lift-off [rad]."""
        return self.start + self.span * self._profile(time)[0]

    def rate(self, time: FloatArray) -> FloatArray:
        """Rate at `time` from lift-off [rad/s]."""
        return self.span / self.duration * self._profile(time)[1]

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration at `time` from lift-off [rad/s^2]."""
        return self.span / self.duration**2 * self._profile(time)[2]

    @property
    def span(self) -> float:
        """The whole angle [rad]."""
        return self.end - self.start

    def _profile(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Share of the turn completed, and its first two derivatives over the unit time."""
        s, ramp = np.clip(np.asarray(time) / self.duration, 0.0, 1.0), self.ramp
        if self.at_once:
            return np.ones_like(s), np.zeros_like(s), np.zeros_like(s)
        if ramp == 0.0:
            return (
                s**3 * (10.0 - 15.0 * s + 6.0 * s**2),
                30.0 * (s * (1.0 - s)) ** 2,
                60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
            )
        # The second half mirrors the first.
        early, first = np.minimum(s, 1.0 - s), s <= 0.5
        x = np.minimum(early / ramp, 1.0)
        half = (ramp * (x**3 - 0.5 * x**4) + np.maximum(early - ramp, 0.0)) / (1.0 - ramp)
        slope = 6.0 * x * (1.0 - x) / (ramp * (1.0 - ramp))
        return (
            np.where(first, half, 1.0 - half),
            x**2 * (3.0 - 2.0 * x) / (1.0 - ramp),
            np.where(first, slope, -slope),
        )


NO_TURN = Turn(np.array([0.0, 1.0, 0.0]), 0.0, 0.0, 1.0)
"""The trunk stays level."""


def fit_turn(turn: Turn, body: Gyrostat, limits: MotorLimits) -> Turn:
    """Turn that leaves the feedback its reserve (`actuation.drive.RESERVE`).

    If the wheels cannot follow the polynomial, trapezoids are tried, from gentle to short ramps,
    which trade wheel speed for torque. If none suffices in the given time, the turn takes longer;
    if it may not, it is commanded as the paper's step, which lets the feedback use all that the
    motors have.
    """
    usable = limits.reserved()
    if turn.span == 0.0 or utilisation(turn, body, usable) <= 1.0:
        return turn
    trapezoids = [replace(turn, ramp=float(ramp)) for ramp in np.linspace(0.45, 0.1, 15)]
    for trapezoid in trapezoids:
        if utilisation(trapezoid, body, usable) <= 1.0:
            return replace(trapezoid, note=_TRAPEZOID_NOTE)
    if not turn.extendable:
        return replace(turn, at_once=True, note=_STEP_NOTE)
    slower = [_just_slow_enough(option, body, usable) for option in (turn, *trapezoids)]
    shortest = min(slower, key=lambda option: option.duration)
    note = (
        f"the turn takes {shortest.duration:.3g} s instead of the {turn.duration:.3g} s asked for: "
        "the wheels cannot turn the trunk faster"
    )
    return replace(shortest, note=note)


def _just_slow_enough(turn: Turn, body: Gyrostat, limits: MotorLimits) -> Turn:
    """The turn in the shortest time that keeps the limits, by bisection."""
    too_short, enough = turn.duration, 2.0 * turn.duration
    while utilisation(replace(turn, duration=enough), body, limits) > 1.0:
        too_short, enough = enough, 2.0 * enough
    for _ in range(30):
        middle = 0.5 * (too_short + enough)
        if utilisation(replace(turn, duration=middle), body, limits) > 1.0:
            too_short = middle
        else:
            enough = middle
    return replace(turn, duration=enough)


def utilisation(turn: Turn, body: Gyrostat, limits: MotorLimits) -> float:
    """Largest share of the limits that the wheels need along the turn, from zero momentum.

    A gyrostat with no momentum has `I_tot w + h A W = 0` and `J w_dot = -g A tau`, g the reaction
    (see `Gyrostat`). The pseudo-inverse leaves out an axis that the wheels do not reach.
    """
    time = turn.duration * np.linspace(0.0, 1.0, 401)
    rate, acceleration = turn.rate(time), turn.acceleration(time)
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
