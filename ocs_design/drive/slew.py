"""The quickest slew of a wheel: how long it takes, how far it gets.

A wheel starts at rest relative to the trunk. Its motor accelerates the reduced inertia I_red on
min(tau_L, tau_s (1 - W / w_0)), holds it at the highest speed if it gets there, brakes with
min(tau_L, tau_s (1 + W / w_0)), full reverse voltage within the current limit, and ends at the
speed W_f. What counts is the wheel's angle beyond W_f: phi, the integral of (W - W_f) over time
(docs/theory.md, What a motor can do).

All functions take arrays that broadcast, with those of the line too.
"""

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.drive.unit_drive import UnitDrive
from ocs_design.drive.unit_slew import farthest_slew, quickest_time, rise_sweep, rise_to


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
    possible = (final < drive.highest) & np.isfinite(excess)
    time = quickest_time(drive, np.where(possible, excess, 0.0), np.where(possible, final, 0.0))
    return np.where(possible, time * unit, np.inf)


def slew_angle(
    time: ArrayLike, reduced_inertia: ArrayLike, line: DriveLine, final_speed: ArrayLike = 0.0
) -> FloatArray:
    """Largest phi within `time` [rad]: the inverse of `slew_time`.

    Negative where the wheel gets to its final speed, but late; NaN where it does not get there.

    Args:
        time: [s], at least 0.
        reduced_inertia: I_red [kg m^2]. line: of the drive at the wheel.
        final_speed: W_f [rad/s], at least 0.
    """
    drive, unit = in_units(line, reduced_inertia)
    final = np.asarray(final_speed) / drive.no_load_speed
    units, final = np.broadcast_arrays(np.asarray(time) / unit, final)
    attainable = final < drive.highest
    final = np.where(attainable, final, 0.0)
    attainable = attainable & (units >= rise_sweep(drive, rise_to(drive, final)).time)
    final = np.where(attainable, final, 0.0)
    angle = farthest_slew(drive, units, final).angle - final * units
    return np.where(attainable, angle * drive.no_load_speed * unit, np.nan)


def in_units(line: DriveLine, reduced_inertia: ArrayLike) -> tuple[UnitDrive, FloatArray]:
    """The shape of the drive, and its unit of time T_0 = I_red w_0 / a_0 [s]."""
    drive = UnitDrive.of(line)
    return drive, np.asarray(np.asarray(reduced_inertia) * drive.no_load_speed / drive.torque)
