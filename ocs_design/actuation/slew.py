"""The quickest slew of a wheel: its duration, peak speed and peak torque.

A wheel starts at rest relative to the trunk. Its motor accelerates the reduced inertia I_red with
the torque min(tau_L, tau_s (1 - W / w_0)), holds the highest speed if it is reached, brakes with
min(tau_L, tau_s (1 + W / w_0)), full reverse voltage within the current limit, and ends at the
speed W_f. The relevant quantity is the wheel's angle beyond W_f: phi, the integral of (W - W_f)
over time (docs/theory.md, What a motor can do).

All functions take arrays that broadcast, also with those of the line.

The closed forms are those of `unit_drive`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.unit_drive import (
    UnitDrive,
    farthest_slew,
    positive,
    quickest_time,
    rise_sweep,
)
from ocs_design.common.arrays import FloatArray


def slew_time(
    phi: ArrayLike, reduced_inertia: ArrayLike, line: DriveLine, final_speed: ArrayLike = 0.0
) -> FloatArray:
    """Least time in which the wheel turns by `phi` beyond its final speed [s]; inf: never.

    Args:
        phi: integral of the wheel's speed in excess of its final speed [rad], at least 0.
        reduced_inertia: I_red, effective inertia for the motor on the free trunk [kg m^2].
        line: of the drive at the wheel.
        final_speed: W_f [rad/s], at least 0.
    """
    drive, unit = in_units(line, reduced_inertia)
    final = np.asarray(final_speed) / drive.no_load_speed
    excess = np.asarray(phi) / (drive.no_load_speed * unit)
    excess, final = np.broadcast_arrays(excess, final)
    # Where friction takes all of the supply's power, no torque is left.
    moves = (drive.torque > 0.0) | ((excess == 0.0) & (final == 0.0))
    possible = (final < drive.highest) & np.isfinite(excess) & moves
    time = quickest_time(drive, np.where(possible, excess, 0.0), np.where(possible, final, 0.0))
    return np.where(possible, time * unit, np.inf)


def in_units(line: DriveLine, reduced_inertia: ArrayLike) -> tuple[UnitDrive, FloatArray]:
    """The shape of the drive, and its unit of time T_0 = I_red w_0 / a_0 [s].

    Without torque, the unit is that of 1 N m, and is not used.
    """
    drive = UnitDrive.of(line)
    torque = positive(drive.torque)
    return drive, np.asarray(np.asarray(reduced_inertia) * drive.no_load_speed / torque)


@dataclass(frozen=True, eq=False)
class SlewProfile:
    """Profile of the quickest slew from rest; arrays of one shape, NaN where infeasible.

    Attributes:
        brake_from, end: times of the start of braking and of the end [s].
        peak_speed: of the wheel [rad/s].
        peak_torque: of the motor at the wheel, at the start or where braking starts [N m]: the
            torque falls with speed while accelerating and rises with it while braking.
    """

    brake_from: FloatArray
    end: FloatArray
    peak_speed: FloatArray
    peak_torque: FloatArray


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
    up, known = rise_sweep(drive, slew.rise).time, np.where(possible, unit, np.nan)
    brake_from, end = (up + slew.coast) * known, np.where(possible, time, np.nan)
    pushes = np.where(up * known > 0.0, drive.accelerating(np.zeros_like(up)), 0.0)
    brakes = np.where(brake_from < end, drive.braking(slew.peak), 0.0)
    return SlewProfile(
        brake_from=brake_from,
        end=end,
        peak_speed=np.where(possible, slew.peak * drive.no_load_speed, np.nan),
        peak_torque=np.maximum(pushes, brakes) * drive.torque,
    )
