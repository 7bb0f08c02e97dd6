"""The quickest slew of a wheel: how long it takes, and speed and torque over time.

A wheel starts at rest relative to the trunk. Its motor accelerates the reduced inertia I_red on
min(tau_L, tau_s (1 - W / w_0)), holds it at the highest speed if it gets there, brakes with
min(tau_L, tau_s (1 + W / w_0)), full reverse voltage within the current limit, and ends at the
speed W_f. What counts is the wheel's angle beyond W_f: phi, the integral of (W - W_f) over time
(docs/theory.md, What a motor can do).

All functions take arrays that broadcast, with those of the line too.

The closed forms are those of `unit_slew`. While braking on the voltage line from the speed m, the
speed is x = (1 + m) e^(-t/l) - 1.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.unit_drive import (
    UnitDrive,
    braked_speed,
    farthest_slew,
    positive,
    quickest_time,
    rise_for,
    rise_sweep,
    risen_speed,
)
from ocs_design.common.arrays import FloatArray


def slew_time(
    phi: ArrayLike, reduced_inertia: ArrayLike, line: DriveLine, final_speed: ArrayLike = 0.0
) -> FloatArray:
    """Least time in which the wheel turns by `phi` beyond its final speed [s]; inf: never.

    Args:
        phi: integral of the wheel's speed over its final speed [rad], at least 0.
        reduced_inertia: I_red, what the motor accelerates while the trunk gives way [kg m^2].
        line: of the drive at the wheel.
        final_speed: W_f [rad/s], at least 0.
    """
    drive, unit = in_units(line, reduced_inertia)
    final = np.asarray(final_speed) / drive.no_load_speed
    excess = np.asarray(phi) / (drive.no_load_speed * unit)
    excess, final = np.broadcast_arrays(excess, final)
    # A supply whose power the friction takes whole leaves no torque.
    moves = (drive.torque > 0.0) | ((excess == 0.0) & (final == 0.0))
    possible = (final < drive.highest) & np.isfinite(excess) & moves
    time = quickest_time(drive, np.where(possible, excess, 0.0), np.where(possible, final, 0.0))
    return np.where(possible, time * unit, np.inf)


def in_units(line: DriveLine, reduced_inertia: ArrayLike) -> tuple[UnitDrive, FloatArray]:
    """The shape of the drive, and its unit of time T_0 = I_red w_0 / a_0 [s].

    Without torque that of 1 N m, which nothing lasts.
    """
    drive = UnitDrive.of(line)
    torque = positive(drive.torque)
    return drive, np.asarray(np.asarray(reduced_inertia) * drive.no_load_speed / torque)


@dataclass(frozen=True, eq=False)
class SlewProfile:
    """A slew from rest over time; arrays of one shape, NaN where the slew cannot be done.

    Up to `coast_from` the current, the power and then the voltage limit the acceleration. From
    `brake_from` to `end` the power, the current and then the reverse voltage limit the braking.
    Phases that do not occur have no length.

    Attributes:
        line: of the drive at the wheel.
        reduced_inertia: I_red [kg m^2].
        coast_from, brake_from, end: times [s].
        peak_speed, final_speed: of the wheel [rad/s].
    """

    line: DriveLine
    reduced_inertia: FloatArray
    coast_from: FloatArray
    brake_from: FloatArray
    end: FloatArray
    peak_speed: FloatArray
    final_speed: FloatArray

    def speed(self, time: ArrayLike) -> FloatArray:
        """Wheel speed [rad/s] at `time` [s], which broadcasts with the slews."""
        drive, unit = in_units(self.line, self.reduced_inertia)
        return self._speed(drive, unit, np.asarray(time)) * drive.no_load_speed

    def torque(self, time: ArrayLike) -> FloatArray:
        """Motor torque at the wheel [N m] at `time` [s]; negative while it brakes."""
        drive, unit = in_units(self.line, self.reduced_inertia)
        at = np.asarray(time)
        speed = self._speed(drive, unit, at)
        pushing, held = at < self.coast_from, at < self.brake_from
        share = np.where(
            pushing, drive.accelerating(speed), np.where(held, 0.0, -drive.braking(speed))
        )
        return np.where((at >= 0.0) & (at < self.end), share, 0.0) * drive.torque

    def _speed(self, drive: UnitDrive, unit: FloatArray, at: FloatArray) -> FloatArray:
        """x at a time [w_0]."""
        peak, final = self.peak_speed / drive.no_load_speed, self.final_speed / drive.no_load_speed
        rising = risen_speed(drive, rise_for(drive, np.clip(at, 0.0, self.coast_from) / unit))
        braked = np.clip(at - self.brake_from, 0.0, self.end - self.brake_from) / unit
        falling = braked_speed(drive, peak, final, braked)
        speed = np.where(at < self.brake_from, np.minimum(rising, peak), falling)
        return np.where(at < self.end, speed, final + 0.0 * self.end)


def slew_profile(
    phi: ArrayLike, reduced_inertia: ArrayLike, line: DriveLine, final_speed: ArrayLike = 0.0
) -> SlewProfile:
    """The quickest slew by `phi` beyond the final speed; arguments as for `slew_time`."""
    drive, unit = in_units(line, reduced_inertia)
    time = slew_time(phi, reduced_inertia, line, final_speed)
    final = np.asarray(final_speed) / drive.no_load_speed
    possible = np.isfinite(time)
    final = np.where(possible, final, 0.0)
    slew = farthest_slew(drive, np.where(possible, time, 0.0) / unit, final)
    up = rise_sweep(drive, slew.rise).time
    known = np.where(possible, unit, np.nan)
    return SlewProfile(
        line=line,
        reduced_inertia=np.broadcast_to(reduced_inertia, time.shape),
        coast_from=up * known,
        brake_from=(up + slew.coast) * known,
        end=np.where(possible, time, np.nan),
        peak_speed=np.where(possible, slew.peak * drive.no_load_speed, np.nan),
        final_speed=np.where(possible, final * drive.no_load_speed, np.nan),
    )
