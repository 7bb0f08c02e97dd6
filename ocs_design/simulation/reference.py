"""Turns that the wheels can follow, as reference attitude and rate."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

_STEP_NOTE = (
    "the turn is commanded as a step, as in the paper: no smooth turn that the motors can follow "
    "ends before touchdown"
)


@dataclass(frozen=True, eq=False)
class Turn:
    """A turn of the trunk about an axis that is fixed in B and in the world.

    Its angle is `10 s^3 - 15 s^4 + 6 s^5` of the span over the unit time s = 0..1, from rest to
    rest: the peak rate is 1.875, the peak acceleration 5.77.

    Attributes:
        axis: unit vector, shape (3,).
        start, end: angle about it from level [rad].
        duration: [s], from lift-off.
        extendable: whether it may take longer if the wheels need it; a fall does not wait.
        at_once: whether all of it is commanded at the start, as in the paper: the jump itself is
            left to the feedback.
        note: how it was changed so that the wheels can follow, one sentence; empty: unchanged.
    """

    axis: FloatArray
    start: float
    end: float
    duration: float
    extendable: bool = True
    at_once: bool = False
    note: str = ""

    def angle(self, time: FloatArray) -> FloatArray:
        """Angle at `time` from lift-off [rad]."""
        s = self._unit(time)
        share = np.ones_like(s) if self.at_once else s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        return self.start + self.span * share

    def rate(self, time: FloatArray) -> FloatArray:
        """Rate at `time` from lift-off [rad/s]."""
        s = self._unit(time)
        slope = np.zeros_like(s) if self.at_once else 30.0 * (s * (1.0 - s)) ** 2
        return self.span / self.duration * slope

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration at `time` from lift-off [rad/s^2], of a turn not commanded at once."""
        s = self._unit(time)
        return self.span / self.duration**2 * (60.0 * s * (1.0 - s) * (1.0 - 2.0 * s))

    @property
    def span(self) -> float:
        """The whole angle [rad]."""
        return self.end - self.start

    def _unit(self, time: FloatArray) -> FloatArray:
        return np.clip(np.asarray(time) / self.duration, 0.0, 1.0)


NO_TURN = Turn(np.array([0.0, 1.0, 0.0]), 0.0, 0.0, 1.0)
"""The trunk stays level."""


def fit_turn(turn: Turn, body: Gyrostat, limits: MotorLimits) -> Turn:
    """Turn that leaves the feedback its reserve (`actuation.drive.RESERVE`).

    If the wheels cannot make it in the given time, it takes longer; if it may not, it is commanded
    as the paper's step, which lets the feedback use all that the motors have.
    """
    usable = limits.reserved()
    if turn.span == 0.0 or utilisation(turn, body, usable) <= 1.0:
        return turn
    if not turn.extendable:
        return replace(turn, at_once=True, note=_STEP_NOTE)
    # The shortest time that keeps the limits, by bisection.
    too_short, enough = turn.duration, 2.0 * turn.duration
    while utilisation(replace(turn, duration=enough), body, usable) > 1.0:
        too_short, enough = enough, 2.0 * enough
    for _ in range(30):
        middle = 0.5 * (too_short + enough)
        if utilisation(replace(turn, duration=middle), body, usable) > 1.0:
            too_short = middle
        else:
            enough = middle
    note = (
        f"the turn takes {enough:.3g} s instead of the {turn.duration:.3g} s asked for: the wheels "
        "cannot turn the trunk faster"
    )
    return replace(turn, duration=enough, note=note)


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
