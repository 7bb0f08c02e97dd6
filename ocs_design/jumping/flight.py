"""The legs in flight: they brake, and go back to the nominal posture to land on.

The trunk turns against them, for angular momentum is kept in flight. What
that does to its attitude at touchdown is found by integrating the free robot.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.jumping.floating_base import POSE, FloatingBase

_STEP = 4e-3
"""Of the integration [s]."""


@dataclass(frozen=True, eq=False)
class LegReturn:
    """Joints from how they leave the ground to the posture to land in.

    First at constant deceleration to rest, then rest to rest on a quintic.

    Attributes:
        position, velocity: at lift-off, shape (n,). posture: to land in, shape (n,).
        brake, swing: how long both parts take [s].
    """

    position: FloatArray
    velocity: FloatArray
    posture: FloatArray
    brake: float
    swing: float

    @property
    def duration(self) -> float:
        """[s]."""
        return self.brake + self.swing

    def at(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and accelerations at times since lift-off, shape (k, n) each."""
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
    """What comes of a `LegReturn`.

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
    """The robot in the air, its joints moved as told."""

    def __init__(self, base: FloatingBase) -> None:
        unknown, known = base.a[:POSE], base.a[POSE:]
        still = ca.substitute(
            ca.vertcat(base.imbalance, base.torque),
            ca.vertcat(unknown, base.f),
            ca.SX.zeros(POSE + base.f.numel()),
        )
        slope = ca.jacobian(ca.vertcat(base.imbalance, base.torque), unknown)
        pose = ca.solve(slope[:POSE, :], -still[:POSE])
        torque = still[POSE:] + slope[POSE:, :] @ pose
        inputs = [base.y, base.v, known, base.load.packed()]
        self._respond = ca.Function("respond", inputs, [pose, torque])
        # Angular momentum is linear in the rates, which at a level trunk are those of its angles.
        locked = ca.jacobian(base.spin, base.v[3:POSE])
        self._locked = ca.Function("locked", [base.y, base.load.packed()], [locked])

    def inertia(self, y: FloatArray, load: FloatArray) -> FloatArray:
        """Of the whole with its joints locked, about its centre of mass, level [kg m^2], (3, 3)."""
        return np.asarray(self._locked(y, load))

    def fly(
        self, y: FloatArray, v: FloatArray, legs: LegReturn, load: FloatArray, duration: float
    ) -> LegFlight:
        """From lift-off until touchdown, by classical Runge-Kutta steps.

        Args:
            y, v: pose and joints, and their rates, at lift-off.
            legs: how the joints move.
            load: see `floating_base.Load.values`.
            duration: of the flight [s], no shorter than that of `legs`.
        """
        steps = int(np.ceil(legs.duration / _STEP))
        h = legs.duration / steps
        half = legs.at(np.linspace(0.0, legs.duration, 2 * steps + 1))
        pose, rate = y[:POSE].copy(), v[:POSE].copy()
        torque = np.empty((steps + 1, len(legs.posture)))
        for k in range(steps + 1):
            first = self._rates(pose, rate, half, 2 * k, load)
            torque[k] = first[1]
            if k == steps:
                break
            second = self._rates(
                pose + h / 2 * rate, rate + h / 2 * first[0], half, 2 * k + 1, load
            )
            middle = rate + h / 2 * second[0]
            third = self._rates(pose + h / 2 * middle, middle, half, 2 * k + 1, load)
            last = rate + h * third[0]
            fourth = self._rates(pose + h * last, last, half, 2 * k + 2, load)
            pose = pose + h * rate + h**2 / 6 * (first[0] + second[0] + third[0])
            rate = rate + h / 6 * (first[0] + 2 * second[0] + 2 * third[0] + fourth[0])
        time = np.linspace(0.0, legs.duration, steps + 1)
        # From then on nothing moves in the robot, and what is left of its spin stays.
        tilt = pose[3:] + rate[3:] * (duration - legs.duration)
        return LegFlight(time, half[0][::2], half[1][::2], torque, tilt)

    def _rates(
        self,
        pose: FloatArray,
        rate: FloatArray,
        legs: tuple[FloatArray, FloatArray, FloatArray],
        k: int,
        load: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        position, velocity, acceleration = (each[k] for each in legs)
        y, v = np.append(pose, position), np.append(rate, velocity)
        found, torque = self._respond(y, v, acceleration, load)
        return np.asarray(found).ravel(), np.asarray(torque).ravel()
