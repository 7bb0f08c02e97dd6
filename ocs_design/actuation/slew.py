"""The quickest slew of a wheel: its duration, peak speed and peak torque.

A wheel starts at rest relative to the trunk, or at a given speed. Its motor accelerates the reduced
inertia I_red with the torque min(tau_L, tau_s (1 - W / w_0)), holds the highest speed if it is
reached, brakes with min(tau_L, tau_s (1 + W / w_0)), full reverse voltage within the current limit,
and ends faster by W_f. The relevant quantity is the wheel's angle beyond that of its final speed:
phi, the integral of the difference over time (docs/theory.md, What a motor can do).

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
)
from ocs_design.common.arrays import FloatArray


def slew_time(
    phi: ArrayLike,
    reduced_inertia: ArrayLike,
    line: DriveLine,
    final_speed: ArrayLike = 0.0,
    initial_speed: ArrayLike = 0.0,
) -> FloatArray:
    """Least time in which the wheel turns by `phi` beyond its final speed [s]; inf: never.

    Args:
        phi: integral of the wheel's speed in excess of its final speed [rad], at least 0.
        reduced_inertia: I_red, effective inertia for the motor on the free trunk [kg m^2].
        line: of the drive at the wheel.
        final_speed: W_f, in addition to the speed at the start [rad/s], at least 0.
        initial_speed: speed at the start, positive in the direction of the slew [rad/s].
    """
    drive, unit = in_units(line, reduced_inertia, initial_speed)
    final = drive.initial_speed + np.asarray(final_speed) / drive.no_load_speed
    excess = np.asarray(phi) / (drive.no_load_speed * unit)
    excess, final = np.broadcast_arrays(excess, final)
    # Where friction takes all of the supply's power, no torque is left.
    moves = (drive.torque > 0.0) | ((excess == 0.0) & (final == drive.initial_speed))
    possible = (final < drive.highest) & np.isfinite(excess) & moves
    final = np.where(possible, final, drive.initial_speed)
    time = quickest_time(drive, np.where(possible, excess, 0.0), final)
    return np.where(possible, time * unit, np.inf)


def in_units(
    line: DriveLine, reduced_inertia: ArrayLike, initial_speed: ArrayLike = 0.0
) -> tuple[UnitDrive, FloatArray]:
    """The shape of the drive, and its unit of time T_0 = I_red w_0 / a_0 [s].

    Without torque, the unit is that of 1 N m, and is not used.
    """
    drive = UnitDrive.of(line, initial_speed)
    torque = positive(drive.torque)
    return drive, np.asarray(np.asarray(reduced_inertia) * drive.no_load_speed / torque)


@dataclass(frozen=True, eq=False)
class SlewProfile:
    """Profile of the quickest slew; arrays of one shape, NaN where infeasible.

    Attributes:
        brake_from, end: times of the start of braking and of the end [s].
        peak_speed: of the wheel [rad/s].
        peak_torque: of the motor at the wheel [N m]: the torque falls with speed while
            accelerating, and while braking rises with it up to where the supply limits that.
    """

    brake_from: FloatArray
    end: FloatArray
    peak_speed: FloatArray
    peak_torque: FloatArray


def slew_profile(
    phi: ArrayLike,
    reduced_inertia: ArrayLike,
    line: DriveLine,
    final_speed: ArrayLike = 0.0,
    initial_speed: ArrayLike = 0.0,
) -> SlewProfile:
    """The quickest slew by `phi` beyond the final speed; arguments as for `slew_time`."""
    drive, unit = in_units(line, reduced_inertia, initial_speed)
    time = slew_time(phi, reduced_inertia, line, final_speed, initial_speed)
    possible = np.isfinite(time)
    gain = np.where(possible, np.asarray(final_speed) / drive.no_load_speed, 0.0)
    final = drive.initial_speed + gain
    slew = farthest_slew(drive, np.where(possible, time, 0.0) / unit, final)
    known = np.where(possible, unit, np.nan)
    brake_from, end = (slew.up + slew.coast) * known, np.where(possible, time, np.nan)
    # The speed at which most torque slows the wheel, first one way, then the other.
    strongest = -drive.regenerating
    pushes = drive.forward_torque(np.clip(strongest, drive.initial_speed, slew.peak))
    brakes = drive.forward_torque(np.clip(strongest, -slew.peak, -final))
    pushes = np.where(slew.up * known > 0.0, pushes, 0.0)
    brakes = np.where(brake_from < end, brakes, 0.0)
    return SlewProfile(
        brake_from=brake_from,
        end=end,
        peak_speed=np.where(possible, slew.peak * drive.no_load_speed, np.nan),
        peak_torque=np.maximum(pushes, brakes) * drive.torque,
    )
