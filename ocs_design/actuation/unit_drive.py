"""A drive in its own units, and the farthest and quickest slews in these units.

Speeds x are in units of w_0, torques in units of a_0 = min(tau_L, tau_s), the torque at rest. With
lam = tau_L / tau_s,

    knee   l = min(1, lam)      accelerating   a(x) = min(1, (1 - x) / l)
    brake  q = min(1, 1 / lam)  braking        b(x) = min(1 / q, (1 + x) / l)

The current limits the acceleration up to x_c = 1 - l, and the braking from x_b = lam - 1 up.

Times are in units of T_0 = I_red w_0 / a_0, wheel angles in units of w_0 T_0 (`unit_drive` has the
others), so that dx/dt = a(x) up and -b(x) down. Up to the peak x the wheel takes the time r + l z:
first r = min(x, x_c) at the current limit, then l z on the voltage line, x = x_c + l (1 - e^-z).
Then it may coast, at its cap, and it brakes to the final speed f. z is what is solved for: close to
w_0 it tells speeds apart that x cannot.

With A the largest angle within the time t, dA/dt = x: a little more time is a little more time at
the peak. So A is convex in t, and Newton's method finds the time for an angle from any start.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray, Table

# Below this the series is used; above it the cancellation costs less than one digit.
_SMALL = 0.3
_EXP_TERMS = tuple(1.0 / n for n in range(13, 2, -1))
_LOG_TERMS = tuple(1.0 / n for n in range(19, 1, -2))


def exp_remainder(z: FloatArray) -> FloatArray:
    """`e^-z - 1 + z` for z >= 0: z^2/2 - z^3/6 + ..."""
    small = np.minimum(z, _SMALL)
    series = np.ones_like(small)
    for term in _EXP_TERMS:
        series = 1.0 - term * small * series
    return np.where(z < _SMALL, small**2 / 2.0 * series, z + np.expm1(-z))


def log_remainder(y: FloatArray) -> FloatArray:
    """`y - log(1 + y)` for y >= 0, with log(1 + y) = 2 artanh(r), r = y / (2 + y)."""
    small = np.minimum(y, _SMALL)
    ratio = small / (2.0 + small)
    square = ratio * ratio
    series = np.zeros_like(square)
    for term in _LOG_TERMS:
        series = square * (term + series)
    return np.where(y < _SMALL, ratio * (small - 2.0 * series), y - np.log1p(y))


# Stands for a torque without limit: its square is finite, and its times are zero to all digits.
_UNLIMITED = 1e100


@dataclass(frozen=True, eq=False)
class UnitDrive(Table):
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
    """Braking from the peak to the final speed: at the current limit, then on the voltage line."""
    middle = np.minimum(np.maximum(drive.clamp, final), peak)
    ratio = (middle - final) / (1.0 + final)
    excess = log_remainder(ratio)
    clamped = drive.brake * (peak - middle)
    return Sweep(
        clamped + drive.knee * (ratio - excess),
        clamped * (peak + middle) / 2.0 + drive.knee * (final * ratio + excess),
    )


def rise_for(drive: UnitDrive, time: FloatArray) -> Rise:
    """Rise that takes all of `time` [T_0], without a cap."""
    ramp = np.minimum(time, drive.end_of_limit)
    return Rise(ramp, np.where(drive.knee > 0.0, (time - ramp) / positive(drive.knee), 0.0))


def rise_to(drive: UnitDrive, speed: FloatArray) -> Rise:
    """Rise to `speed` [w_0]; an endless line phase where that is not below 1."""
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
    # Else z + q (1 - e^-z) = the rest: a concave rise, so that Newton's method climbs it.
    rest = np.maximum((time - fixed) / positive(drive.knee), 0.0)
    z = np.maximum(rest - drive.brake, rest / (1.0 + drive.brake))
    for _ in range(_LINE_STEPS):
        shrinking = drive.brake * np.expm1(-z)
        z = z - (z - shrinking - rest) / (1.0 + drive.brake + shrinking)
    line: FloatArray = np.where(-np.expm1(-unclamped) <= drive.clamp, unclamped, z)
    return np.maximum(line, 0.0)
