"""The farthest slew in a time and the quickest over an angle, in the units of the drive.

Times are in units of T_0 = I_red w_0 / a_0, wheel angles in units of w_0 T_0 (`unit_drive` has the
others), so that dx/dt = a(x) up and -b(x) down. Up to the peak x the wheel takes the time r + l z:
first r = min(x, x_c) at the current limit, then l z on the voltage line, x = x_c + l (1 - e^-z).
Then it may coast, at its cap, and it brakes to the final speed f. z is what is solved for: close to
w_0 it tells speeds apart that x cannot.

With A the largest angle within the time t, dA/dt = x: a little more time is a little more time at
the peak. So A is convex in t, and Newton's method finds the time for an angle from any start.
"""

from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.remainders import exp_remainder, log_remainder
from ocs_design.drive.unit_drive import UnitDrive, positive

# Newton's steps: six and four bring every digit, whatever the drive. More cannot mend the rounding
# where the peak is hardly above the final speed.
_TIME_STEPS = 8
_LINE_STEPS = 4
_DIGITS = 1e-13


class Rise(NamedTuple):
    """An acceleration from rest.

    Attributes:
        ramp: r, at the current limit [T_0].
        line: z, on the voltage line [l T_0].
    """

    ramp: FloatArray
    line: FloatArray


class Sweep(NamedTuple):
    """What a part of a slew takes.

    Attributes:
        time: [T_0].
        angle: of the wheel [w_0 T_0].
    """

    time: FloatArray
    angle: FloatArray


class UnitSlew(NamedTuple):
    """A slew from rest to its final speed.

    Attributes:
        rise: up to the peak.
        peak: x [w_0].
        coast: at the cap [T_0].
        angle: of the wheel, all in all [w_0 T_0].
    """

    rise: Rise
    peak: FloatArray
    coast: FloatArray
    angle: FloatArray


def risen_speed(drive: UnitDrive, rise: Rise) -> FloatArray:
    """x at the end of a rise [w_0]."""
    speed: FloatArray = rise.ramp - drive.knee * np.expm1(-rise.line)
    return speed


def rise_sweep(drive: UnitDrive, rise: Rise) -> Sweep:
    """Time and angle of a rise."""
    knee, z = drive.knee, rise.line
    on_line = knee * (drive.end_of_limit * z + knee * exp_remainder(z))
    return Sweep(rise.ramp + knee * z, rise.ramp**2 / 2.0 + on_line)


def brake_sweep(drive: UnitDrive, peak: FloatArray, final: FloatArray) -> Sweep:
    """From the peak to the final speed, first at the current limit, then on the voltage line."""
    middle = np.minimum(np.maximum(drive.clamp, final), peak)
    ratio = (middle - final) / (1.0 + final)
    excess = log_remainder(ratio)
    clamped = drive.brake * (peak - middle)
    return Sweep(
        clamped + drive.knee * (ratio - excess),
        clamped * (peak + middle) / 2.0 + drive.knee * (final * ratio + excess),
    )


def rise_for(drive: UnitDrive, time: FloatArray) -> Rise:
    """All of `time` [T_0], without a cap."""
    ramp = np.minimum(time, drive.end_of_limit)
    return Rise(ramp, np.where(drive.knee > 0.0, (time - ramp) / positive(drive.knee), 0.0))


def rise_to(drive: UnitDrive, speed: FloatArray) -> Rise:
    """Up to `speed` [w_0]; an endless line phase where that is not below 1."""
    ramp = np.minimum(speed, drive.end_of_limit)
    span = np.where(drive.knee > 0.0, (speed - ramp) / positive(drive.knee), 0.0)
    with np.errstate(divide="ignore"):
        return Rise(ramp, -np.log1p(-np.minimum(span, 1.0)))


def farthest_slew(drive: UnitDrive, time: FloatArray, final: FloatArray) -> UnitSlew:
    """How to turn the wheel farthest in `time` [T_0], ending at `final` [w_0].

    The time must be enough to get to the final speed at all.
    """
    capped = rise_to(drive, drive.cap)
    ramp = np.minimum((time + final) / 2.0, drive.end_of_limit)
    line = np.where(time + final > 2.0 * drive.end_of_limit, _line_phase(drive, time, final), 0.0)
    rise = Rise(np.minimum(ramp, capped.ramp), np.minimum(line, capped.line))
    peak = risen_speed(drive, rise)
    up, down = rise_sweep(drive, rise), brake_sweep(drive, peak, final)
    at_cap = (rise.ramp >= capped.ramp) & (rise.line >= capped.line)
    coast = np.where(at_cap, np.maximum(time - up.time - down.time, 0.0), 0.0)
    return UnitSlew(rise, peak, coast, up.angle + coast * peak + down.angle)


def quickest_time(drive: UnitDrive, excess: FloatArray, final: FloatArray) -> FloatArray:
    """Least time [T_0] in which the wheel turns by `excess` [w_0 T_0] more than at `final` speed.

    Newton's method on the convex A(t) - f t; see the module's text. It starts from below, with the
    time that torque alone would take from the final speed on if the wheel braked as hard as at
    no-load speed all the time, and overshoots once.
    """
    start = rise_sweep(drive, rise_to(drive, final))
    deficit = np.maximum(final * start.time - start.angle, 0.0)
    weight = 1.0 + np.maximum(drive.brake, 0.5)
    time = start.time + np.sqrt(2.0 * weight * (excess + deficit))
    for _ in range(_TIME_STEPS):
        slew = farthest_slew(drive, time, final)
        margin = slew.peak - final
        missing = excess + final * time - slew.angle
        step = np.where(margin > 0.0, missing / positive(margin), 0.0)
        time = time + step
        if (np.abs(step) <= _DIGITS * time).all():
            break
    return time


def _line_phase(drive: UnitDrive, time: FloatArray, final: FloatArray) -> FloatArray:
    """z without a cap where the peak is beyond the knee."""
    # All braking on the line: e^z (2 - e^-z) = (1 + f) e^t.
    unclamped = time + np.log1p((final + np.expm1(-time)) / 2.0)
    middle = np.maximum(drive.clamp, final)
    fixed = drive.end_of_limit + drive.brake * (drive.end_of_limit - middle)
    fixed = fixed + drive.knee * np.log1p((middle - final) / (1.0 + final))
    clamped = _clamped_line_phase((time - fixed) / positive(drive.knee), drive.brake)
    line: FloatArray = np.where(-np.expm1(-unclamped) <= drive.clamp, unclamped, clamped)
    return np.maximum(line, 0.0)


def _clamped_line_phase(time: FloatArray, brake: FloatArray) -> FloatArray:
    """z >= 0 of z + q (1 - e^-z) = t: a concave rise, so that Newton's method climbs it."""
    time = np.maximum(time, 0.0)
    z = np.maximum(time - brake, time / (1.0 + brake))
    for _ in range(_LINE_STEPS):
        shrinking = brake * np.expm1(-z)
        z = z - (z - shrinking - time) / (1.0 + brake + shrinking)
    return z
