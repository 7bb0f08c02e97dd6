"""What the motor lets a wheel do: its voltage line and its current limit."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Motor


@dataclass(frozen=True)
class MotorLimits:
    """Limits of a motor at its wheel (docs/theory.md, What a motor can do).

    Attributes:
        no_load_speed: w_0 [rad/s]; inf: not limited.
        line_slope: speed lost per torque on the voltage line, w_0 / tau_s [rad/s/(N m)]; 0 where no
            stall torque is given: full torque up to w_0.
        torque_limit: at the current limit [N m]; inf: not limited.
    """

    no_load_speed: float
    line_slope: float
    torque_limit: float

    @classmethod
    def of(cls, motor: Motor) -> "MotorLimits":
        """The limits of a catalogue or assumed motor."""
        limit = np.inf if motor.torque_limit is None else motor.torque_limit
        if motor.stall_torque is None:
            return cls(motor.no_load_speed, 0.0, limit)
        if np.isinf(motor.no_load_speed):
            return cls(np.inf, 0.0, min(limit, motor.stall_torque))
        return cls(motor.no_load_speed, motor.no_load_speed / motor.stall_torque, limit)

    def utilisation(self, speed: FloatArray, torque: FloatArray) -> float:
        """The largest share of the bus voltage or of the current limit that a motion takes.

        At most 1 for what the motor can do: `|W + slope * tau| <= w_0` and `|tau| <= tau_L`.
        """
        voltage = np.abs(speed + self.line_slope * torque).max() / self.no_load_speed
        current = np.abs(torque).max() / self.torque_limit
        return float(max(voltage, current))
