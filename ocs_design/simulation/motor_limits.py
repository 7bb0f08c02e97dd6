"""Limits of motors and their supply at the wheels, for a batch of worlds at once.

The same limits clip the torques of a control step and judge a planned motion.
"""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.drive import RESERVE, Drive, power_less_friction
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import FloatArray, Table

_UNLIMITED_POWER = 1e100
"""Stand-in for unlimited power, finite so that its products are too [W]."""

USED_SHARE = 0.99
"""Share of voltage and of the supply's power that the law uses. The rest exceeds what else changes
the wheels' speed and power within a control step, as when the trunk hits the ground."""


@dataclass(frozen=True, eq=False)
class MotorLimits(Table):
    """Limits of a motor at its wheel (docs/theory.md, What a motor can do).

    Numbers for one motor; for n worlds, arrays that broadcast to the torques of their wheels, of
    shape (n, 1), or (n, 1, m) with m motors each (`stacked_columns`).

    Attributes:
        no_load_speed: end of the voltage line, less friction [rad/s]; inf: not limited.
        line_slope: speed lost per torque on the voltage line, w_0 / tau_s [rad/s/(N m)]; 0 without
            a stall torque: full torque up to w_0.
        torque_limit: at the current limit [N m]; inf: not limited.
        speed_max: mechanical [rad/s]; inf: not limited.
        copper: heat in the winding over the squared torque, R / (N eta k_t)^2 [W/(N m)^2].
        efficiency: of the gear.
        power_max: of the supply, for all motors together, less the most that their friction takes
            [W]; inf: not limited.
        voltage: of the supply [V]; None: the winding or the supply is not known.
    """

    no_load_speed: FloatArray | float
    line_slope: FloatArray | float
    torque_limit: FloatArray | float
    speed_max: FloatArray | float = np.inf
    copper: FloatArray | float = 0.0
    efficiency: FloatArray | float = 1.0
    power_max: FloatArray | float = np.inf
    voltage: FloatArray | float | None = None

    @classmethod
    def of(cls, motor: Drive, supply: Supply | None = None, wheels: int = 1) -> "MotorLimits":
        """The limits of a catalogue or assumed motor.

        Args:
            supply: feeds all motors; None: unknown.
            wheels: how many motors it feeds.
        """
        limit = np.inf if motor.torque_limit is None else motor.torque_limit
        top = np.inf if motor.speed_max is None else motor.speed_max
        line = cls(motor.no_load_speed, 0.0, limit, top)
        if motor.stall_torque is not None and np.isinf(motor.no_load_speed):
            line = cls(np.inf, 0.0, min(limit, motor.stall_torque), top)
        elif motor.stall_torque is not None:
            line = replace(
                line,
                no_load_speed=motor.friction_factor * motor.no_load_speed,
                line_slope=motor.no_load_speed / motor.stall_torque,
            )
        if supply is None or motor.resistance is None or motor.torque_constant is None:
            return line
        current = float(line.torque_limit) / motor.torque_per_current
        return replace(
            line,
            copper=motor.resistance / motor.torque_per_current**2,
            efficiency=motor.gear_efficiency,
            power_max=power_less_friction(supply, wheels, motor, current),
            voltage=supply.voltage,
        )

    def clipped(self, torque: FloatArray, speed: FloatArray, gain: FloatArray) -> FloatArray:
        """Torques clipped to current limit, voltage line and top speed.

        Voltage line and top speed are taken at the end of the control step, at `W + tau * gain`.
        This is backward Euler: it tends to the exact line as the period goes to zero, is stable for
        any motor, and a wheel just stays below its top speed. Both clip driving torque and leave
        braking torque alone.

        Args:
            torque: commanded [N m]. speed: of the wheels now [rad/s].
            gain: change of speed in a control step per torque [rad/s/(N m)].
        """
        speed_per_torque, line = gain + self.line_slope, self.no_load_speed
        highest = np.minimum((line - speed) / speed_per_torque, (self.speed_max - speed) / gain)
        lowest = np.maximum((-line - speed) / speed_per_torque, (-self.speed_max - speed) / gain)
        driven = np.minimum(np.maximum(torque, lowest), highest)
        return np.minimum(np.maximum(driven, -self.torque_limit), self.torque_limit)

    def within_supply(self, torque: FloatArray, speed: FloatArray, gain: FloatArray) -> FloatArray:
        """Torques of a world, scaled by one factor so that the supply can give or take their power.

        Held torques speed the wheels up and draw more and more power: a control step draws most at
        its end and feeds back most at its start. With all torques times f, the power at the end is
        convex in f and zero at f = 0; each of its pieces is `a f^2 + b f`, which equals P at
        2 P / (b + root).

        Args:
            torque: that the motors could give [N m], (..., wheels).
            speed: of the wheels now [rad/s], broadcast to `torque`.
            gain: change of speed in a control step per torque [rad/s/(N m)], shape (..., 1).
        """
        if np.isinf(self.power_max).all():
            return torque
        limit = np.minimum(self.power_max, _UNLIMITED_POWER)[..., 0]
        shaft, efficiency = torque * speed, self.efficiency
        heat = (self.copper * torque**2).sum(axis=-1)
        factor = np.ones_like(heat)
        for _ in range(torque.shape[-1] + 1):
            # A motor that brakes at the start may drive at the end: each such change needs another
            # iteration.
            ends = factor[..., None] * gain * torque**2 + shaft
            share = np.where(ends > 0.0, 1.0 / efficiency, efficiency)
            square = heat + (share * gain * torque**2).sum(axis=-1)
            linear = (share * shaft).sum(axis=-1)
            # Largest factor f up to 1 with `square f^2 + linear f` within the limit.
            depth = linear + np.sqrt(linear**2 + 4.0 * square * limit)
            factor = np.minimum(factor, 2.0 * limit / np.maximum(depth, 2.0 * limit))
        share = np.where(shaft > 0.0, 1.0 / efficiency, efficiency)
        braking_power = (share * shaft).sum(axis=-1)
        # Beyond the larger root, the windings burn enough of the braking power.
        root = np.sqrt(np.maximum(braking_power**2 - 4.0 * heat * limit, 0.0))
        regenerates = factor * (heat * factor + braking_power) < -limit
        least = 2.0 * limit / np.where(regenerates, root - braking_power, 1.0)
        scaled: FloatArray = (
            torque * np.where(regenerates, np.minimum(factor, least), factor)[..., None]
        )
        return scaled

    @property
    def is_finite(self) -> bool:
        """Whether the torque has a limit at every speed."""
        return bool(np.isfinite(self.torque_limit) or self.line_slope > 0.0)

    @property
    def usable(self) -> "MotorLimits":
        """Limits that the wheel law uses (`USED_SHARE`); it does not need the supply's voltage."""
        line, power = USED_SHARE * self.no_load_speed, USED_SHARE * self.power_max
        return replace(self, no_load_speed=line, power_max=power, voltage=None)

    def reserved(self) -> "MotorLimits":
        """Limits for references; the rest of voltage, current, speed and power is for feedback."""
        return replace(
            self,
            no_load_speed=RESERVE * self.no_load_speed,
            torque_limit=RESERVE * self.torque_limit,
            speed_max=RESERVE * self.speed_max,
            power_max=RESERVE * self.power_max,
        )

    def torque_range(self, speed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest torque at each wheel speed [N m], in the shape of `speed` [rad/s].

        On the voltage line and within the current limit; no torque drives a wheel beyond its top
        speed.
        """
        # Without a slope: all or nothing on either side of the line's end.
        with np.errstate(divide="ignore", invalid="ignore"):
            highest = np.nan_to_num((self.no_load_speed - speed) / self.line_slope, posinf=np.inf)
            lowest = np.nan_to_num((-self.no_load_speed - speed) / self.line_slope, neginf=-np.inf)
        highest = np.where(speed < self.speed_max, highest, np.minimum(highest, 0.0))
        lowest = np.where(speed > -self.speed_max, lowest, np.maximum(lowest, 0.0))
        limit = self.torque_limit
        return np.clip(lowest, -limit, limit), np.clip(highest, -limit, limit)

    def utilisation(self, speed: FloatArray, torque: FloatArray) -> float:
        """The largest share of bus voltage, current, power or top speed that a motion takes.

        At most 1 if motor and supply can do it: `|W + slope * tau| <= w_0`, `|tau| <= tau_L`,
        `|W| <= speed_max`, and at most `power_max` drawn or fed back by all wheels together.
        """
        voltage = np.abs(speed + self.line_slope * torque).max() / self.no_load_speed
        current = np.abs(torque).max() / self.torque_limit
        power = 0.0
        if np.isfinite(self.power_max):
            power = np.abs(self.bus_power(speed, torque)).max() / self.power_max
        return float(max(voltage, current, np.abs(speed).max() / self.speed_max, power))

    def bus_power(self, speed: FloatArray, torque: FloatArray) -> FloatArray:
        """Power of all motors of a world at the bus [W], shape (n,): R i^2 and shaft power.

        A gear's loss adds to the power drawn in driving and reduces the power fed back in braking.

        Args:
            speed, torque: of the wheels [rad/s, N m], shape (n, wheels).
        """
        shaft = torque * speed
        shaft_power = np.maximum(shaft / self.efficiency, shaft * self.efficiency)
        power: FloatArray = (self.copper * torque**2 + shaft_power).sum(axis=-1)
        return power
