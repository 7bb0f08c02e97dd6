"""A drive in its own units, where only the shape of its line is left.

Speeds x are in units of w_0, torques in units of a_0 = min(tau_L, tau_s), the torque at rest. With
lam = tau_L / tau_s,

    knee   l = min(1, lam)      accelerating   a(x) = min(1, (1 - x) / l)
    brake  q = min(1, 1 / lam)  braking        b(x) = min(1 / q, (1 + x) / l)

The current limits the acceleration up to x_c = 1 - l, and the braking from x_b = lam - 1 up.
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine

# Stands for a torque without limit: its square is finite, and its times are zero to all digits.
_UNLIMITED = 1e100


@dataclass(frozen=True, eq=False)
class UnitDrive:
    """The shape of a drive's line, and its units; arrays that broadcast.

    Attributes:
        no_load_speed: w_0, the unit of speed [rad/s].
        torque: a_0, the unit of torque [N m].
        knee: l, of the torque at rest over that of the voltage line, 0..1; 0: no line.
        brake: q, of the torque at rest over the current limit, 0..1; 0: no current limit.
        clamp: x_b, from which up the current limits the braking; 1 at most, as every peak.
        cap: highest speed [w_0]; at most 1 without a line, inf: not limited below 1.
    """

    no_load_speed: FloatArray
    torque: FloatArray
    knee: FloatArray
    brake: FloatArray
    clamp: FloatArray
    cap: FloatArray

    @classmethod
    def of(cls, line: DriveLine) -> "UnitDrive":
        """The shape of `line`."""
        stall = np.asarray(line.stall_torque, dtype=np.float64)
        limit = np.asarray(line.torque_limit, dtype=np.float64)
        speed = np.asarray(line.no_load_speed, dtype=np.float64)
        endless = np.isinf(stall)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(endless, 0.0, limit / stall)
            brake = np.where(endless, 1.0, np.minimum(1.0, stall / limit))
        cap = np.asarray(line.speed_max / speed)
        return cls(
            no_load_speed=speed,
            torque=np.minimum(np.minimum(stall, limit), _UNLIMITED),
            knee=np.minimum(1.0, ratio),
            brake=brake,
            clamp=np.clip(ratio - 1.0, 0.0, 1.0),
            cap=np.where(endless, np.minimum(cap, 1.0), np.where(cap < 1.0, cap, np.inf)),
        )

    @property
    def highest(self) -> FloatArray:
        """Speed that no slew exceeds [w_0]."""
        return np.minimum(self.cap, 1.0)

    @property
    def end_of_limit(self) -> FloatArray:
        """x_c, up to which the current limits the acceleration."""
        return 1.0 - self.knee

    def accelerating(self, speed: FloatArray) -> FloatArray:
        """a(x) [a_0]."""
        spare = (1.0 - speed) / positive(self.knee)
        return np.where(speed > self.end_of_limit, spare, 1.0)

    def braking(self, speed: FloatArray) -> FloatArray:
        """b(x), positive [a_0]."""
        reverse = (1.0 + speed) / positive(self.knee)
        return np.where(speed < self.clamp, reverse, 1.0 / positive(self.brake))


def positive(value: FloatArray) -> FloatArray:
    """`value`, or 1 where it is not positive and the quotient is not used."""
    return np.where(value > 0.0, value, 1.0)
