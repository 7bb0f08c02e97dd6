"""The legs in flight: they brake, and return to the nominal posture for landing.

The trunk turns against them, since angular momentum is conserved in flight. Integrating the free
robot gives the effect on its attitude at touchdown.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.floating_base import POSE, FloatingBase

_STEP = 4e-3
"""Step of the integration [s]."""


@dataclass(frozen=True, eq=False)
class LegReturn:
    """Motion of the joints from lift-off to the landing posture.

    First constant deceleration to rest, then a quintic from rest to rest.

    Attributes:
        position, velocity: at lift-off, shape (n,). posture: for landing, shape (n,).
        brake, swing: durations of the two parts [s].
    """

    position: FloatArray
    velocity: FloatArray
    posture: FloatArray
    brake: float
    swing: float

    @property
    def duration(self) -> float:
        """Duration of both parts [s]."""
        return self.brake + self.swing

    def at(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and accelerations, shape (k, n), at times since lift-off [s]."""
        t = time[:, None]
        braking = np.minimum(t, self.brake)
        s = np.clip((t - self.brake) / self.swing, 0.0, 1.0)
        slowed = self.velocity / self.brake
        stop = self.position + 0.5 * self.brake * self.velocity
        span = self.posture - stop
        early = t < self.brake
        position = np.where(
            early,
            self.position + braking * self.velocity - 0.5 * slowed * braking**2,
            stop + span * s**3 * (10.0 - 15.0 * s + 6.0 * s**2),
        )
        velocity = np.where(
            early,
            self.velocity - slowed * braking,
            span / self.swing * 30.0 * (s * (1.0 - s)) ** 2,
        )
        acceleration = np.where(
            early, -slowed, span / self.swing**2 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
        )
        return position, velocity, acceleration


@dataclass(frozen=True, eq=False)
class LegFlight:
    """Flight during a `LegReturn`.

    Attributes:
        time: since lift-off [s], shape (k,).
        position, velocity, torque: of the joints, shape (k, n).
        tilt: roll, pitch and yaw of the trunk at touchdown [rad], shape (3,).
    """

    time: FloatArray
    position: FloatArray
    velocity: FloatArray
    torque: FloatArray
    tilt: FloatArray


class FreeRobot:
    """The robot in the air, with prescribed joint motion."""

    def __init__(self, base: FloatingBase) -> None:
        unknown, known = base.a[:POSE], base.a[POSE:]
        bias = ca.substitute(
            ca.vertcat(base.imbalance, base.torque),
            ca.vertcat(unknown, base.f),
            ca.SX.zeros(POSE + base.f.numel()),
        )
        sensitivity = ca.jacobian(ca.vertcat(base.imbalance, base.torque), unknown)
        pose = ca.solve(sensitivity[:POSE, :], -bias[:POSE])
        torque = bias[POSE:] + sensitivity[POSE:, :] @ pose
        self._step = _runge_kutta(base, ca.vertcat(pose, torque), known)
        # Angular momentum is linear in the rates, which for a level trunk equal its angle rates.
        locked = ca.jacobian(base.spin, base.v[3:POSE])
        self._locked = ca.Function("locked", [base.y, base.load.packed()], [locked])

    def inertia(self, y: FloatArray, load: FloatArray) -> FloatArray:
        """Inertia of the robot with locked joints about its centre of mass [kg m^2], shape (3, 3).

        The trunk is level.
        """
        return np.asarray(self._locked(y, load))

    def fly(
        self, y: FloatArray, v: FloatArray, legs: LegReturn, load: FloatArray, duration: float
    ) -> LegFlight:
        """The flight from lift-off until touchdown, by classical Runge-Kutta steps.

        Args:
            y, v: pose and joints, and their rates, at lift-off.
            load: see `floating_base.Load.values`.
            duration: of the flight [s], no shorter than that of `legs`.
        """
        steps = int(np.ceil(legs.duration / _STEP))
        halves = legs.at(np.linspace(0.0, legs.duration, 2 * steps + 1))
        joint_motion = np.hstack(halves)
        # An additional step gives the torque at the end.
        joint_motion = np.vstack([joint_motion, joint_motion[-1:], joint_motion[-1:]]).T
        run = self._step.mapaccum("flight", steps + 1)
        start = np.append(y[:POSE], v[:POSE])
        instants = [joint_motion[:, first : first + 2 * steps + 1 : 2] for first in range(3)]
        states, torque = run(start, *instants, legs.duration / steps, load)
        _, tilt, _, rate = np.split(np.asarray(states)[:, steps - 1], 4)
        time = np.linspace(0.0, legs.duration, steps + 1)
        # From then on no joint moves, and the remaining spin stays constant.
        tilt = tilt + rate * (duration - legs.duration)
        return LegFlight(time, halves[0][::2], halves[1][::2], np.asarray(torque).T, tilt)


def _runge_kutta(base: FloatingBase, response: ca.SX, known: ca.SX) -> ca.Function:
    """Function for one step of the pose and its rate, which also gives the torques at its start.

    Its arguments are the pose with its rate; the joints' positions, velocities and accelerations at
    start, middle and end of the step; the length of the step; and the load.
    """
    given = ca.vertcat(base.y[POSE:], base.v[POSE:], known)
    state = ca.vertcat(base.y[:POSE], base.v[:POSE])
    inputs = [state, given, base.load.packed()]
    change = ca.vertcat(base.v[:POSE], response[:POSE])
    rates = ca.Function("rates", inputs, [change, response[POSE:]])
    current = ca.MX.sym("now", 2 * POSE)
    load = ca.MX.sym("load", inputs[2].numel())
    h = ca.MX.sym("h")
    start, middle, end = (ca.MX.sym(name, given.numel()) for name in ("start", "middle", "end"))
    first, torque = rates(current, start, load)
    second, _ = rates(current + h / 2.0 * first, middle, load)
    third, _ = rates(current + h / 2.0 * second, middle, load)
    fourth, _ = rates(current + h * third, end, load)
    next_state = current + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    return ca.Function("step", [current, start, middle, end, h, load], [next_state, torque])
