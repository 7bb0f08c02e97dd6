"""A maneuver's torques applied to the gyrostat again, by an integrator that knows no collocation.

What the program claims is checked against: the rigid body through the push, then the gyrostat
under the torques that were found, by classical Runge-Kutta steps on a grid ten times finer than
the program's.
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.motion import Motion

FINER = 10
"""Steps for each interval of the program."""

_PUSH_STEPS = 20


@dataclass(frozen=True, eq=False)
class Flight:
    """Trunk and wheels on the fine grid.

    Attributes:
        time: [s], shape (n,).
        vertical: the world's upward direction in B, shape (n, 3).
        rate, acceleration: of the trunk in B [rad/s], [rad/s^2], shape (n, 3).
        wheel_speed: [rad/s], shape (n, 2).
        wheel_torque: [N m], shape (n, 2); where it jumps, the mean of both sides.
        swept: integral of the trunk's rate [rad], shape (n, 3).
    """

    time: FloatArray
    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    swept: FloatArray


def fly(gyrostat: Gyrostat, asked: Boundary, motion: Motion) -> Flight:
    """Apply the torques of `motion` from where the maneuver starts."""
    model = _Model.of(gyrostat)
    state = np.concatenate([after_push(gyrostat, asked), np.zeros(5)])
    steps = np.repeat(motion.lengths / FINER, FINER)
    offsets = np.arange(FINER) / FINER
    first, middle, last = (motion.torque_within(offsets + part / FINER) for part in (0.0, 0.5, 1.0))
    states = [state]
    for h, before, halfway, after in zip(steps, first, middle, last, strict=True):
        k1 = model.slope(state, before)
        k2 = model.slope(state + h / 2.0 * k1, halfway)
        k3 = model.slope(state + h / 2.0 * k2, halfway)
        k4 = model.slope(state + h * k3, after)
        state = state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states.append(state)
    torque = np.vstack([first[:1], (first[1:] + last[:-1]) / 2.0, last[-1:]])
    return _flight(model, np.append(0.0, np.cumsum(steps)), np.array(states), torque)


@dataclass(frozen=True, eq=False)
class _Model:
    """The equations of motion, solved for the accelerations.

    Attributes:
        momentum: from rate and wheel speeds to H, shape (3, 5).
        inverse: of the mass matrix, shape (5, 5).
    """

    momentum: FloatArray
    inverse: FloatArray

    @classmethod
    def of(cls, gyrostat: Gyrostat) -> "_Model":
        """Factored once for a flight."""
        matrix = gyrostat.mass_matrix
        return cls(matrix[:3], np.asarray(np.linalg.inv(matrix), dtype=np.float64))

    def slope(self, state: FloatArray, torque: FloatArray) -> FloatArray:
        """Of vertical, rate, wheel speeds and the integral of the rate, shape (11,)."""
        rate = state[3:6]
        gyroscopic = _cross(self.momentum @ state[3:8], rate)
        accelerations = self.inverse @ np.concatenate([gyroscopic, torque])
        return np.concatenate([_cross(state[:3], rate), accelerations, rate])


def _flight(model: _Model, time: FloatArray, states: FloatArray, torque: FloatArray) -> Flight:
    slopes = np.array([model.slope(*row) for row in zip(states, torque, strict=True)])
    return Flight(
        time=time,
        vertical=states[:, :3],
        rate=states[:, 3:6],
        acceleration=slopes[:, 3:6],
        wheel_speed=states[:, 6:8],
        wheel_torque=torque,
        swept=states[:, 8:],
    )


def after_push(gyrostat: Gyrostat, asked: Boundary) -> FloatArray:
    """Vertical and rate where the turn starts, the wheels held till then, shape (6,)."""
    inertia, state = gyrostat.inertia, np.append(asked.vertical, np.zeros(3))
    step = asked.push_duration / _PUSH_STEPS

    def slope(now: FloatArray) -> FloatArray:
        """Rates of change of vertical and rate under the push: Euler's equation."""
        vertical, rate = now[:3], now[3:]
        torque = asked.push + _cross(inertia @ rate, rate)
        return np.append(_cross(vertical, rate), np.linalg.solve(inertia, torque))

    for _ in range(_PUSH_STEPS):
        k1 = slope(state)
        k2 = slope(state + step / 2.0 * k1)
        k3 = slope(state + step / 2.0 * k2)
        k4 = slope(state + step * k3)
        state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return state


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Of two vectors, shape (3,); `np.cross` takes ten times as long on one pair."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
