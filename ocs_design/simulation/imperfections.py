"""Imperfections between wheel law and wheels: sensors, delay, real motors, friction, air drag.

The law assumes the design; each world has its own sensors and drives. Everything is vectorised
over the worlds of a batch, and costs next to nothing compared with their physics.

The faces drag like an enclosed disc (Daily and Nece, J. Basic Engineering 82, 1960, 217-230), the
rim like a cylinder inside a wider one: Couette flow, exact, then with vortices, then turbulent
(Bilgen and Boulos, J. Fluids Engineering 95, 1973, 122-126). Drag in each regime follows a power of
the Reynolds number, and the regime with the most drag applies.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray, stacked_columns
from ocs_design.parts.printed import CLEARANCE
from ocs_design.parts.wheel import Flywheel
from ocs_design.simulation.motor_limits import MotorLimits

_NOISE_CHANNELS = 5
"""Numbers that noise is added to at each instant: two of attitude, three of rate."""


@dataclass(frozen=True, eq=False)
class Imperfections:
    """Sensors and drives of one world.

    Attributes:
        attitude_bias: of measured roll and pitch [rad], shape (2,). gyro_bias: [rad/s], (3,).
        attitude_noise, gyro_noise: standard deviation of each measurement [rad], [rad/s].
        stream: seed of the noise; equal streams give equal noise.
        torque_gain: torque given over torque commanded, by each of m motors, shape (m,).
        limits: of each real motor, arrays of shape (m,) or (1,).
        coulomb, viscous: friction of each wheel [N m], [N m s/rad], shape (m,).
        air: drag of a wheel in its housing, the same for all worlds of a batch.
        air_factor: multiplies `air`.
        delay: from measurement to torque, in steps of the physics.
    """

    attitude_bias: FloatArray
    gyro_bias: FloatArray
    attitude_noise: float
    gyro_noise: float
    stream: np.random.SeedSequence
    torque_gain: FloatArray
    limits: MotorLimits
    coulomb: FloatArray
    viscous: FloatArray
    air: "AirDrag"
    air_factor: float
    delay: int

    def noise(self, instants: int) -> FloatArray:
        """Errors of the measurements, bias included, shape (instants, 5)."""
        generator = np.random.Generator(np.random.Philox(self.stream))
        deviation = np.repeat([self.attitude_noise, self.gyro_noise], [2, 3])
        bias = np.concatenate([self.attitude_bias, self.gyro_bias])
        return np.asarray(bias + deviation * generator.standard_normal((instants, _NOISE_CHANNELS)))


@dataclass(frozen=True, eq=False)
class AirDrag:
    """Air drag torque on a wheel, linear between speeds that rise from zero, shapes (m,)."""

    speed: FloatArray
    torque: FloatArray

    def at(self, speed: FloatArray) -> FloatArray:
        """Torque at speeds of any shape [N m]; beyond the last speed, the torque at that speed."""
        return np.interp(speed, self.speed, self.torque)


class Sensing:
    """Sensors of n trunks."""

    def __init__(
        self, imperfections: Sequence[Imperfections], lengths: Sequence[int], period: float
    ) -> None:
        """Sensors of worlds that each run for `lengths` control steps of `period` [s]."""
        self._errors = np.zeros((max(lengths), len(lengths), _NOISE_CHANNELS))
        for world, (own, length) in enumerate(zip(imperfections, lengths, strict=True)):
            self._errors[:length, world] = own.noise(length)
        # Gravity says nothing about heading, so heading comes from integrating the gyroscope.
        self._heading = period * np.cumsum(self._errors[:, :, -1], axis=0)

    def measured(
        self, k: int, vertical: FloatArray, rate: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Measurements of the first n worlds at control instant `k`.

        A trunk whose measured roll and pitch are too large by small angles e sees the vertical v
        as v + v x e.

        Args:
            vertical: the world's upward direction in B, shape (n, 3); it is not renormalised.
            rate: of the trunk in B [rad/s], shape (n, 3).
        """
        error = self._errors[k, : len(rate)]
        roll, pitch = error[:, 0], error[:, 1]
        x, y, z = vertical.T
        tilted = np.stack([x - z * pitch, y + z * roll, z + x * pitch - y * roll], axis=1)
        return tilted, rate + error[:, 2:]

    def attitude(self, k: int, attitude: FloatArray) -> FloatArray:
        """Attitudes that the first n worlds measure, quaternions (n, 4); see `measured`."""
        n = len(attitude)
        error = np.column_stack([self._errors[k, :n, :2], self._heading[k, :n]])
        half = np.column_stack([np.ones(n), 0.5 * error])
        measured = quaternions.product(attitude, half)
        length: FloatArray = np.linalg.norm(measured, axis=1, keepdims=True)
        return measured / length


class ImperfectDrives:
    """Drives that turn commands into torques, for the m motors of each of n worlds."""

    def __init__(
        self,
        imperfections: Sequence[Imperfections],
        *,
        response: FloatArray,
        instants: int,
        hold: int,
        step: float,
    ) -> None:
        """Drives of worlds whose commands are held for `hold` steps of the physics.

        Args:
            response: acceleration of a wheel per motor torque, see `Gyrostat`, shape (n,).
            instants: control steps of the longest run.
            hold: steps of the physics from one command to the next. step: of the physics [s].
        """
        self._air = imperfections[0].air
        self._gain = (response * hold * step)[:, None]
        self._limits = stacked_columns([own.limits for own in imperfections])
        self._torque_gain, self._coulomb, self._viscous = (
            np.stack([getattr(own, name) for own in imperfections])
            for name in ("torque_gain", "coulomb", "viscous")
        )
        self._air_factor = np.array([[own.air_factor] for own in imperfections])
        delay = np.array([own.delay for own in imperfections])
        steps, remainder = np.divmod(delay, hold)
        # Until the fractional part of the delay has passed, the older command still holds.
        self._delay_steps = steps[:, None] + (np.arange(hold) < remainder[:, None])
        self._longest_delay = int(self._delay_steps.max())
        self._commands = np.zeros((self._longest_delay + instants, *self._coulomb.shape))
        self._worlds = np.arange(len(delay))[:, None]

    def applied_torque(
        self, k: int, command: FloatArray, speed: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Torque of the motors, and the torque left for the wheels after friction [N m].

        Args:
            command: of the law to the motors of the first n worlds at instant `k` [N m], (n, m).
            speed: of the wheels at instant `k` [rad/s], shape (n, m).

        Returns:
            Mean motor torque over the control step, shape (n, m); torque on the wheels in every
            physics step, shape (n, hold, m).
        """
        n = len(command)
        self._commands[self._longest_delay + k, :n] = command
        delayed = self._commands[self._longest_delay + k - self._delay_steps[:n], self._worlds[:n]]
        limits, gain = self._limits.take(slice(n)), self._gain[:n, None]
        motor = limits.clipped(delayed * self._torque_gain[:n, None], speed[:, None], gain)
        # The law limits its commands to the nominal motor's power; the supply limits the real one.
        motor = limits.within_supply(motor, speed[:, None], gain)
        # Written so that the mean of equal torques is that torque to the last bit.
        mean = motor[:, 0] + (motor - motor[:, :1]).mean(axis=1)
        # Friction is implicit: at most it brings a wheel to rest, and a wheel at rest stays there
        # until its motor overcomes friction.
        speed_magnitude = np.abs(speed)
        air = self._air_factor[:n] * self._air.at(speed_magnitude)
        friction_max = self._coulomb[:n] + self._viscous[:n] * speed_magnitude + air
        to_rest = speed / self._gain[:n] + mean
        friction = np.minimum(np.maximum(to_rest, -friction_max), friction_max)
        return mean, motor - friction[:, None]


AIR_DENSITY = 1.225
"""Density of the standard atmosphere at sea level, 15 degrees Celsius [kg/m^3] (ISO 2533)."""

AIR_VISCOSITY = 1.4607e-5
"""Kinematic viscosity of the same air [m^2/s]."""

_SPEEDS = np.concatenate([[0.0], np.geomspace(0.1, 2e4, 600)])
"""Speeds close enough for linear interpolation to be within 1e-3 of the formulas [rad/s]."""


def air_drag(wheel: Flywheel, gap: float = CLEARANCE) -> AirDrag:
    """Air drag of a wheel in its housing, with a clearance of `gap` [m] all round."""
    speeds = _SPEEDS[1:]
    torque = disc_drag(speeds, wheel.outer_radius, gap) + cylinder_drag(
        speeds, wheel.outer_radius, wheel.height, gap
    )
    return AirDrag(_SPEEDS, np.concatenate([[0.0], torque]))


def disc_drag(speed: FloatArray, radius: float, gap: float) -> FloatArray:
    """Drag torque on both faces of a disc between two walls [N m], `C rho W^2 R^5 / 2`.

    Laminar and turbulent flow, each with merged and with separate boundary layers.

    Args:
        speed: positive [rad/s].
        radius: of the disc [m]. gap: from a face to its wall [m].
    """
    reynolds, ratio = speed * radius**2 / AIR_VISCOSITY, gap / radius
    coefficient = np.max(
        [
            2.0 * np.pi / (ratio * reynolds),
            3.70 * ratio**0.1 / reynolds**0.5,
            0.080 / (ratio ** (1.0 / 6.0) * reynolds**0.25),
            0.102 * ratio**0.1 / reynolds**0.2,
        ],
        axis=0,
    )
    return np.asarray(0.5 * coefficient * AIR_DENSITY * speed**2 * radius**5)


def cylinder_drag(speed: FloatArray, radius: float, height: float, gap: float) -> FloatArray:
    """Drag torque on a cylinder in a wider one [N m], `C pi rho W^2 R^4 h / 2`.

    Args:
        speed: positive [rad/s].
        radius: of the cylinder [m]. height: [m]. gap: between the two [m].
    """
    reynolds = speed * radius * gap / AIR_VISCOSITY
    narrow, wider = (gap / radius) ** 0.3, (1.0 + gap / radius) ** 2
    coefficient = np.max(
        [
            8.0 * wider / (wider - 1.0) * (gap / radius) / reynolds,
            2.0 * narrow / reynolds**0.6,
            1.03 * narrow / reynolds**0.5,
            0.065 * narrow / reynolds**0.2,
        ],
        axis=0,
    )
    return np.asarray(0.5 * np.pi * coefficient * AIR_DENSITY * speed**2 * radius**4 * height)
