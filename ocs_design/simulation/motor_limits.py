"""What the motor lets a wheel do: its voltage line and its current limit."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Motor
from ocs_design.drive.line import RESERVE


def clipped(
    torque: FloatArray,
    speed: FloatArray,
    *,
    gain: FloatArray,
    line_slope: FloatArray,
    no_load_speed: FloatArray,
    torque_limit: FloatArray,
    speed_max: FloatArray | float = np.inf,
) -> FloatArray:
    """Torques cut to current limit, voltage line and top speed at the end of the control step.

    Both taken at the end, at `W + tau * gain`, are backward Euler: the exact line as the period
    goes to zero, stable for any motor, and a wheel just keeps from passing its top speed. They cut
    driving torque and leave braking.

    Args:
        torque: asked for [N m]. speed: of the wheels now [rad/s].
        gain: change of speed in a control step per torque [rad/s/(N m)].
        line_slope, no_load_speed, torque_limit, speed_max: see `MotorLimits`.
    """
    give = gain + line_slope
    highest = np.minimum((no_load_speed - speed) / give, (speed_max - speed) / gain)
    lowest = np.maximum((-no_load_speed - speed) / give, (-speed_max - speed) / gain)
    driven = np.minimum(np.maximum(torque, lowest), highest)
    return np.minimum(np.maximum(driven, -torque_limit), torque_limit)


@dataclass(frozen=True)
class MotorLimits:
    """Limits of a motor at its wheel (docs/theory.md, What a motor can do).

    Attributes:
        no_load_speed: w_0 [rad/s]; inf: not limited.
        line_slope: speed lost per torque on the voltage line, w_0 / tau_s [rad/s/(N m)]; 0 where no
            stall torque is given: full torque up to w_0.
        torque_limit: at the current limit [N m]; inf: not limited.
        speed_max: mechanical [rad/s]; inf: not limited.
    """

    no_load_speed: float
    line_slope: float
    torque_limit: float
    speed_max: float = np.inf

    @classmethod
    def of(cls, motor: Motor) -> "MotorLimits":
        """The limits of a catalogue or assumed motor."""
        limit = np.inf if motor.torque_limit is None else motor.torque_limit
        top = np.inf if motor.speed_max is None else motor.speed_max
        if motor.stall_torque is None:
            return cls(motor.no_load_speed, 0.0, limit, top)
        if np.isinf(motor.no_load_speed):
            return cls(np.inf, 0.0, min(limit, motor.stall_torque), top)
        return cls(motor.no_load_speed, motor.no_load_speed / motor.stall_torque, limit, top)

    @property
    def is_finite(self) -> bool:
        """Whether the torque has a limit at every speed."""
        return bool(np.isfinite(self.torque_limit) or self.line_slope > 0.0)

    def reserved(self) -> "MotorLimits":
        """What a reference may take; the rest of voltage and current is left to the feedback."""
        return replace(
            self,
            no_load_speed=RESERVE * self.no_load_speed,
            torque_limit=RESERVE * self.torque_limit,
        )

    def torque_range(self, speed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest torque at each wheel speed [rad/s], shapes as that [N m].

        On the voltage line, within the current limit; none that drives the wheel beyond its top
        speed.
        """
        # No slope: all or nothing on either side of the line's end.
        with np.errstate(divide="ignore", invalid="ignore"):
            highest = np.nan_to_num((self.no_load_speed - speed) / self.line_slope, posinf=np.inf)
            lowest = np.nan_to_num((-self.no_load_speed - speed) / self.line_slope, neginf=-np.inf)
        highest = np.where(speed < self.speed_max, highest, np.minimum(highest, 0.0))
        lowest = np.where(speed > -self.speed_max, lowest, np.maximum(lowest, 0.0))
        limit = self.torque_limit
        return np.clip(lowest, -limit, limit), np.clip(highest, -limit, limit)

    def utilisation(self, speed: FloatArray, torque: FloatArray) -> float:
        """The largest share of bus voltage, current limit or top speed that a motion takes.

        At most 1 for what the motor can do: `|W + slope * tau| <= w_0`, `|tau| <= tau_L` and
        `|W| <= speed_max`.
        """
        voltage = np.abs(speed + self.line_slope * torque).max() / self.no_load_speed
        current = np.abs(torque).max() / self.torque_limit
        return float(max(voltage, current, np.abs(speed).max() / self.speed_max))
