"""What stands between the wheel law and the wheels: sensors, delay, real motors and friction.

The law believes in the design; each world has its own sensors and drives. Everything is vectorised
over the worlds of a batch, and costs next to nothing beside their physics.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.simulation.motor_limits import clipped

_SENSED = 5
"""Numbers that noise is added to at each instant: two of attitude, three of rate."""


@dataclass(frozen=True, eq=False)
class Imperfections:
    """Sensors and drives of one world.

    Attributes:
        attitude_bias: of measured roll and pitch [rad], shape (2,). gyro_bias: [rad/s], (3,).
        attitude_noise, gyro_noise: standard deviation of each measurement [rad], [rad/s].
        stream: that the noise is drawn from; equal streams give equal noise.
        torque_gain: torque given over torque commanded, by each motor, shape (2,).
        no_load_speed, line_slope, torque_limit: of each real motor, see `MotorLimits`, (2,).
        coulomb, viscous: friction of each wheel [N m], [N m s/rad], shape (2,).
        air: drag of a wheel in its housing, the same for all worlds of a batch.
        air_factor: times that.
        delay: from measurement to torque, in steps of the physics.
    """

    attitude_bias: FloatArray
    gyro_bias: FloatArray
    attitude_noise: float
    gyro_noise: float
    stream: np.random.SeedSequence
    torque_gain: FloatArray
    no_load_speed: FloatArray
    line_slope: FloatArray
    torque_limit: FloatArray
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
        return np.asarray(bias + deviation * generator.standard_normal((instants, _SENSED)))


@dataclass(frozen=True, eq=False)
class AirDrag:
    """Torque of the air on a wheel, linear between speeds from zero up, shapes (m,)."""

    speed: FloatArray
    torque: FloatArray

    def at(self, speed: FloatArray) -> FloatArray:
        """[N m], of any shape; beyond the last speed as there."""
        return np.interp(speed, self.speed, self.torque)


class Sensing:
    """What n trunks measure."""

    def __init__(self, imperfections: Sequence[Imperfections], lengths: Sequence[int]) -> None:
        """Of worlds that run for so many control steps each."""
        self._errors = np.zeros((max(lengths), len(lengths), _SENSED))
        for world, (own, length) in enumerate(zip(imperfections, lengths, strict=True)):
            self._errors[:length, world] = own.noise(length)

    def measured(
        self, k: int, vertical: FloatArray, rate: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """What the law sees of the first n worlds at control instant `k`.

        A trunk that believes to be rolled and pitched by small angles e more than it is sees the
        vertical v as v + v x e.

        Args:
            k: control instant.
            vertical: the world's upward direction in B, shape (n, 3); its length is left alone.
            rate: of the trunk in B [rad/s], shape (n, 3).
        """
        error = self._errors[k, : len(rate)]
        roll, pitch = error[:, 0], error[:, 1]
        x, y, z = vertical.T
        seen = np.stack([x - z * pitch, y + z * roll, z + x * pitch - y * roll], axis=1)
        return seen, rate + error[:, 2:]


class Drives:
    """What n pairs of motors make of their commands."""

    def __init__(
        self,
        imperfections: Sequence[Imperfections],
        *,
        response: FloatArray,
        instants: int,
        hold: int,
        step: float,
    ) -> None:
        """Of worlds whose commands are held for `hold` steps of the physics.

        Args:
            imperfections: of each world.
            response: of a wheel's speed to its motor's torque, see `Gyrostat`, shape (n,).
            instants: control steps of the longest run.
            hold: steps of the physics from one command to the next. step: of the physics [s].
        """
        self._own, self._air = imperfections, imperfections[0].air
        self._gain = (response * hold * step)[:, None]
        self._torque_gain = self._each("torque_gain")
        self._line, self._slope = self._each("no_load_speed"), self._each("line_slope")
        self._limit = self._each("torque_limit")
        self._coulomb, self._viscous = self._each("coulomb"), self._each("viscous")
        self._air_factor = np.array([[own.air_factor] for own in imperfections])
        delay = np.array([own.delay for own in imperfections])
        whole, part = np.divmod(delay, hold)
        # Before a part of a control step has passed, the command before the last still holds.
        self._back = whole[:, None] + (np.arange(hold) < part[:, None])
        self._before = int(self._back.max())
        self._commands = np.zeros((self._before + instants, len(delay), 2))
        self._worlds = np.arange(len(delay))[:, None]

    def _each(self, name: str) -> FloatArray:
        return np.stack([getattr(own, name) for own in self._own])

    def driven(
        self, k: int, command: FloatArray, speed: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Torque of the motors, and what friction leaves of it for the wheels [N m].

        Args:
            k: control instant.
            command: of the law to the first n pairs of motors at that instant [N m], (n, 2).
            speed: of the wheels then [rad/s], shape (n, 2).

        Returns:
            Mean over the control step, shape (n, 2), and of every step of the physics,
            shape (n, hold, 2).
        """
        n = len(command)
        self._commands[self._before + k, :n] = command
        heard = self._commands[self._before + k - self._back[:n], self._worlds[:n]]
        motor = clipped(
            heard * self._torque_gain[:n, None],
            speed[:, None],
            gain=self._gain[:n, None],
            line_slope=self._slope[:n, None],
            no_load_speed=self._line[:n, None],
            torque_limit=self._limit[:n, None],
        )
        # So written, the mean of equal torques is that torque to the last bit.
        mean = motor[:, 0] + (motor - motor[:, :1]).mean(axis=1)
        return mean, motor - self._friction(mean, speed)[:, None]

    def _friction(self, torque: FloatArray, speed: FloatArray) -> FloatArray:
        """What holds the wheels back [N m], shape (n, 2).

        Implicit: a wheel is brought to rest at most, and one at rest stays so until its motor
        overcomes the friction.
        """
        n, turning = len(torque), np.abs(speed)
        air = self._air_factor[:n] * self._air.at(turning)
        largest = self._coulomb[:n] + self._viscous[:n] * turning + air
        to_rest = speed / self._gain[:n] + torque
        return np.minimum(np.maximum(to_rest, -largest), largest)
