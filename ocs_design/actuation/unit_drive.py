"""A drive in normalised units, and the farthest and quickest slews in these units.

Speeds x are in units of w_0, torques in units of a_0 = min(tau_L, tau_s), the torque at rest. With
lam = tau_L / tau_s,

    knee   l = min(1, lam)      accelerating   a(x) = min(1, (1 - x) / l)
    brake  q = min(1, 1 / lam)  braking        b(x) = min(1 / q, (1 + x) / l)

The current limits the acceleration up to x_c = 1 - l, and the braking from x_b = lam - 1 up.

Times are in units of T_0 = I_red w_0 / a_0, wheel angles in units of w_0 T_0, so that dx/dt = a(x)
up and -b(x) down. Up to the peak x the wheel takes the time r + l z: first r = min(x, x_c) at the
current limit, then l z on the voltage line, x = x_c + l (1 - e^-z). Then it may coast, at
its cap, and brakes to the final speed f. The unknown is z: close to w_0 it resolves speeds that x
cannot.

A supply delivers at most the power p, in units of tau_s w_0: a current j, in units of that at
stall, draws j^2 + x j to accelerate a wheel, and returns x j - j^2 as it slows down. At the limit
p, with c = sqrt(p),

    up    x = 2 c sinh u   j = c e^-u   dt = l (e^2u + 1) du   t = l (e^2u / 2 + u)
    down  x = 2 c cosh u   j = c e^-u   dt = l (e^2u - 1) du   t = l (e^2u / 2 - u)

and in both cases the angle is l c (e^3u / 3 + e^-u). Accelerating, this applies where p < l, from
p / l - l to where the line takes over at 1 - p; braking, from p / k + k upwards, with k the current
limit. At rest the power is all heat, so a current above c is never used.

A slew that begins or ends at another speed is part of one from rest. To stop a wheel that turns
backwards is to brake one that turns forwards, mirrored: with U(x) the time from rest to x and U(-x)
that of braking from x, negative, a slew from x_0 to f < 0 in the time t has the peak of one from
rest to rest in t + U(x_0) - U(-f). If that is negative, so is the peak.

With A the largest angle within the time t, dA/dt = x: a little more time is spent at the peak. So A
is convex in t, and Newton's method finds the time for an angle from any start.
"""

from dataclasses import dataclass, fields
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import wrightomega

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray, Table

# Below this a series is used; above it, cancellation costs less than one digit.
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


_SLOWER = 1.0 - 1e-9
"""Largest initial speed of a wheel, as a fraction of the highest speed."""

# Represents an unlimited torque: its square is finite, and its times are zero to all digits.
_UNLIMITED = 1e100


@dataclass(frozen=True, eq=False)
class UnitDrive(Table):
    """The shape of a drive's line, and its units; arrays that broadcast.

    Attributes:
        no_load_speed: w_0, the unit of speed [rad/s].
        torque: a_0, the unit of torque [N m]; 0: nothing moves, and the other fields are
            meaningless.
        knee: l, ratio of the torque at rest to tau_s, 0..1; 0: no line.
        brake: q, ratio of the torque at rest to the current limit, 0..1; 0: no current limit.
        clamp: x_b, above which the current limits the braking; at most 1, like every peak.
        cap: highest speed [w_0]; at most 1 without a line, inf: not limited below 1.
        power: p [tau_s w_0]; inf: not limited, as without a line.
        initial_speed: x_0, speed at the start, positive in the direction of the slew [w_0].
    """

    no_load_speed: FloatArray
    torque: FloatArray
    knee: FloatArray
    brake: FloatArray
    clamp: FloatArray
    cap: FloatArray
    power: FloatArray
    initial_speed: FloatArray

    @classmethod
    def of(cls, line: DriveLine, initial_speed: ArrayLike = 0.0) -> "UnitDrive":
        """The shape of `line`, of a wheel with this `initial_speed` [rad/s]."""
        stall = np.asarray(line.stall_torque, dtype=np.float64)
        limit = np.asarray(line.torque_limit, dtype=np.float64)
        speed = np.asarray(line.no_load_speed, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            power = np.where(np.isinf(stall), np.inf, line.power_max / (stall * speed))
            limit = np.where(np.isfinite(power), np.minimum(limit, np.sqrt(power) * stall), limit)
        # Without torque, as where friction takes all the power, the shape is meaningless.
        without_line = np.isinf(stall) | (limit == 0.0)
        power = np.where(without_line, np.inf, power)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(without_line, 0.0, limit / stall)
            brake = np.where(without_line, 1.0, np.minimum(1.0, stall / limit))
        cap = np.asarray(line.speed_max / speed)
        highest = _SLOWER * np.minimum(cap, 1.0)
        return cls(
            no_load_speed=speed,
            torque=np.minimum(np.minimum(stall, limit), _UNLIMITED),
            knee=np.minimum(1.0, ratio),
            brake=brake,
            clamp=np.clip(ratio - 1.0, 0.0, 1.0),
            cap=np.where(without_line, np.minimum(cap, 1.0), np.where(cap < 1.0, cap, np.inf)),
            power=power,
            initial_speed=np.clip(np.asarray(initial_speed) / speed, -highest, highest),
        )

    @property
    def highest(self) -> FloatArray:
        """Upper bound of the speed of any slew [w_0]."""
        return np.minimum(self.cap, 1.0)

    @cached_property
    def end_of_limit(self) -> FloatArray:
        """x_c, below which the current limits the acceleration."""
        limited = self.power < self.knee
        by_power = np.where(limited, self.power, 0.0) / positive(self.knee) - self.knee
        return np.where(limited, by_power, 1.0 - self.knee)

    @cached_property
    def line_spare(self) -> FloatArray:
        """1 - x at the point where the voltage line takes over."""
        return np.minimum(self.power, self.knee)

    @cached_property
    def regenerating(self) -> FloatArray:
        """Speed above which the supply limits the braking [w_0]; inf: nowhere."""
        finite = np.isfinite(self.power)
        current = self.knee / positive(self.brake)
        limited = np.where(finite, self.power, 0.0) / positive(current) + current
        return np.where(finite & (current > 0.0), limited, np.inf)

    @cached_property
    def entry(self) -> FloatArray:
        """w + e^w, w = 2u, where the power limit takes over; 1 where it has no effect."""
        first = np.arcsinh(self.end_of_limit / (2.0 * self.current))
        return np.where(self.power < self.knee, np.exp(2.0 * first) + 2.0 * first, 1.0)

    @cached_property
    def to_line(self) -> FloatArray:
        """Time from rest to where the line takes over from the power limit [T_0]."""
        begin = self.end_of_limit
        gain = np.maximum(1.0 - self.line_spare - begin, 0.0)
        return rise_sweep(self, Rise(begin, gain, 0.0 * begin)).time

    @cached_property
    def current(self) -> FloatArray:
        """c, current whose heat takes all the power; 1 without a power limit."""
        return np.sqrt(np.where(np.isfinite(self.power), self.power, 1.0))

    def accelerating(self, speed: FloatArray) -> FloatArray:
        """Torque while accelerating, a(x) [a_0]."""
        c, knee = self.current, positive(self.knee)
        on_line = np.where(speed > 1.0 - self.line_spare, (1.0 - speed) / knee, 1.0)
        by_power = 2.0 * c**2 / (speed + np.sqrt(speed**2 + 4.0 * c**2)) / knee
        limited_by_power = (self.power < self.knee) & (speed > self.end_of_limit)
        return np.where(limited_by_power, np.minimum(by_power, on_line), on_line)

    def forward_torque(self, speed: FloatArray) -> FloatArray:
        """Largest torque in the direction of the slew at a speed of either sign [a_0]."""
        braking = self.braking(np.maximum(-speed, 0.0))
        return np.where(speed < 0.0, braking, self.accelerating(np.maximum(speed, 0.0)))

    def braking(self, speed: FloatArray) -> FloatArray:
        """Braking torque b(x), positive [a_0]."""
        c, knee = self.current, positive(self.knee)
        reverse = (1.0 + speed) / knee
        braked = np.where(speed < self.clamp, reverse, 1.0 / positive(self.brake))
        root = np.sqrt(np.maximum(speed**2 - 4.0 * c**2, 0.0))
        by_power = 2.0 * c**2 / positive(speed + root) / knee
        return np.where(speed > self.regenerating, by_power, braked)


def positive(value: FloatArray) -> FloatArray:
    """`value`, or 1 where it is not positive and the quotient is not used."""
    return np.where(value > 0.0, value, 1.0)


# Newton steps: six and four give all digits for any drive. More cannot reduce the rounding error
# where the peak is barely above the final speed.
_TIME_STEPS = 8
_LINE_STEPS = 4
_POWER_STEPS = 12
_DIGITS = 1e-13
# Relative size of the last Newton step; the remaining error is its square.
_LAST_STEP = 1e-8


class Rise(NamedTuple):
    """An acceleration from rest.

    Attributes:
        ramp: r, time at the current limit [T_0].
        gain: gain of speed at the power limit [w_0].
        line: z, time on the voltage line [l T_0].
    """

    ramp: FloatArray
    gain: FloatArray
    line: FloatArray


class SlewPart(NamedTuple):
    """Duration and angle of a part of a slew.

    Attributes:
        time: [T_0].
        angle: of the wheel [w_0 T_0].
    """

    time: FloatArray
    angle: FloatArray


class UnitSlew(NamedTuple):
    """A slew to its final speed.

    Attributes:
        up: time to the peak [T_0]. peak: x [w_0].
        coast: time at the cap [T_0].
        angle: total angle of the wheel [w_0 T_0].
    """

    up: FloatArray
    peak: FloatArray
    coast: FloatArray
    angle: FloatArray


def risen_speed(drive: UnitDrive, rise: Rise) -> FloatArray:
    """x at the end of a rise [w_0]."""
    speed: FloatArray = rise.ramp + rise.gain - drive.line_spare * np.expm1(-rise.line)
    return speed


def rise_sweep(drive: UnitDrive, rise: Rise) -> SlewPart:
    """Time and angle of a rise."""
    knee, line_spare, z = drive.knee, drive.line_spare, rise.line
    on_line = knee * ((1.0 - line_spare) * z + line_spare * exp_remainder(z))
    begin, c = drive.end_of_limit, 2.0 * drive.current
    first, last = np.arcsinh(begin / c), np.arcsinh((begin + rise.gain) / c)
    powered = _powered_sweep(drive, first, last, 1.0)
    time, angle = (np.where(rise.gain > 0.0, part, 0.0) for part in powered)
    return SlewPart(rise.ramp + time + knee * z, rise.ramp**2 / 2.0 + angle + on_line)


def _powered_sweep(drive: UnitDrive, first: FloatArray, last: FloatArray, sense: float) -> SlewPart:
    """Sweep at the power limit from one u to another; `sense` is 1 up and -1 down."""

    def sweep_to(u: FloatArray) -> SlewPart:
        """Sweep since u = 0, up to a constant."""
        exponential = np.exp(u)
        return SlewPart(
            exponential**2 / 2.0 + sense * u,
            drive.current * (exponential**3 / 3.0 + 1.0 / exponential),
        )

    return SlewPart(
        *(
            drive.knee * (after - before)
            for after, before in zip(sweep_to(last), sweep_to(first), strict=True)
        )
    )


def brake_sweep(drive: UnitDrive, peak: FloatArray, final: FloatArray) -> SlewPart:
    """Braking from peak to final speed, limited by the power, the current, then the voltage."""
    top = np.minimum(np.maximum(drive.regenerating, final), peak)
    c, fed_back = 2.0 * drive.current, peak > top
    first, last = (np.arccosh(np.maximum(speed / c, 1.0)) for speed in (top, peak))
    powered = _powered_sweep(drive, first, last, -1.0)
    time, angle = (np.where(fed_back, part, 0.0) for part in powered)
    middle = np.minimum(np.maximum(drive.clamp, final), top)
    ratio = (middle - final) / (1.0 + final)
    excess = log_remainder(ratio)
    clamped = drive.brake * (top - middle)
    return SlewPart(
        time + clamped + drive.knee * (ratio - excess),
        angle + clamped * (top + middle) / 2.0 + drive.knee * (final * ratio + excess),
    )


def rise_for(drive: UnitDrive, time: FloatArray) -> Rise:
    """Rise that takes all of `time` [T_0], without a cap."""
    begin, knee = drive.end_of_limit, positive(drive.knee)
    ramp = np.minimum(time, begin)
    limited = drive.power < drive.knee
    # At the power limit e^w + w = 2 t / l with w = 2u, so that e^w is the Wright omega of it.
    omega_argument = drive.entry + np.where(limited, 2.0 * (time - ramp) / knee, 0.0)
    exponential = np.sqrt(wrightomega(np.minimum(omega_argument, _UNLIMITED)))
    gain = drive.current * (exponential - 1.0 / exponential) - begin
    gain = np.clip(gain, 0.0, np.maximum(1.0 - drive.line_spare - begin, 0.0))
    gain = np.where(limited & (time > ramp), gain, 0.0)
    time_left = np.maximum(time - np.where(limited, drive.to_line, ramp), 0.0)
    return Rise(ramp, gain, np.where(drive.knee > 0.0, time_left / knee, 0.0))


def rise_to(drive: UnitDrive, speed: FloatArray) -> Rise:
    """Rise to `speed` [w_0]; an infinite line phase where that is not below 1."""
    begin, line_spare = drive.end_of_limit, drive.line_spare
    ramp = np.minimum(speed, begin)
    gain = np.where(drive.power < drive.knee, np.minimum(speed, 1.0 - line_spare) - ramp, 0.0)
    span = np.where(line_spare > 0.0, (speed - ramp - gain) / positive(line_spare), 0.0)
    with np.errstate(divide="ignore"):
        return Rise(ramp, gain, -np.log1p(-np.minimum(span, 1.0)))


def since_rest(drive: UnitDrive, speed: FloatArray) -> SlewPart:
    """Time and angle since rest of a wheel that accelerates through `speed` [w_0].

    The time is negative below rest.
    """
    up = rise_sweep(drive, rise_to(drive, np.maximum(speed, 0.0)))
    down = brake_sweep(drive, np.maximum(-speed, 0.0), np.zeros_like(speed))
    back = speed < 0.0
    return SlewPart(np.where(back, -down.time, up.time), np.where(back, down.angle, up.angle))


def reachable_speed(drive: UnitDrive, time: FloatArray, final: FloatArray) -> FloatArray:
    """`final` speed, or one reached in `time` if that is not, the highest from rest up [w_0]."""
    if not drive.initial_speed.any():
        return np.minimum(final, risen_speed(drive, rise_for(drive, time)))
    time_left = time + since_rest(drive, drive.initial_speed).time
    risen = risen_speed(drive, rise_for(drive, np.maximum(time_left, 0.0)))
    below = np.minimum(final, _SLOWER * drive.highest)
    reached = (final <= below) & (since_rest(drive, below).time <= time_left)
    return np.where(
        reached, final, np.where(time_left > 0.0, np.minimum(final, risen), drive.initial_speed)
    )


def farthest_slew(drive: UnitDrive, time: FloatArray, final: FloatArray) -> UnitSlew:
    """Slew that turns the wheel farthest in `time` [T_0], ending at `final` [w_0].

    The time must suffice to reach the final speed. See the module's docstring.
    """
    if not drive.initial_speed.any():
        return _slew_from_rest(drive, time, final)
    lead, tail = since_rest(drive, drive.initial_speed), since_rest(drive, np.maximum(-final, 0.0))
    time_from_rest = time + lead.time - tail.time
    slew = _slew_from_rest(drive, np.abs(time_from_rest), np.maximum(final, 0.0))
    peak = np.copysign(slew.peak, time_from_rest)
    up = (
        np.where(time_from_rest < 0.0, since_rest(drive, np.minimum(peak, 0.0)).time, slew.up)
        - lead.time
    )
    return UnitSlew(up, peak, slew.coast, slew.angle - lead.angle - tail.angle)


def _slew_from_rest(drive: UnitDrive, time: FloatArray, final: FloatArray) -> UnitSlew:
    """Farthest slew of a wheel that begins at rest; arguments as for `farthest_slew`."""
    capped = rise_to(drive, drive.cap)
    ramp = np.minimum((time + final) / 2.0, drive.end_of_limit)
    line = np.where(time + final > 2.0 * drive.end_of_limit, _line_phase(drive, time, final), 0.0)
    rise = Rise(ramp, np.zeros_like(ramp), line)
    beyond_knee = np.isfinite(time) & (time + final > 2.0 * drive.end_of_limit)
    # A limit that applies only to braking from a higher peak has no effect.
    limited = (drive.power < drive.knee) | (risen_speed(drive, rise) > drive.regenerating)
    affected = limited & beyond_knee
    if affected.any():
        rise = _powered_rise(drive, time, final, affected, rise)
    rise = Rise(*(np.minimum(own, most) for own, most in zip(rise, capped, strict=True)))
    peak = risen_speed(drive, rise)
    up, down = rise_sweep(drive, rise), brake_sweep(drive, peak, final)
    at_cap = np.all([own >= most for own, most in zip(rise, capped, strict=True)], axis=0)
    coast = np.where(at_cap, np.maximum(time - up.time - down.time, 0.0), 0.0)
    return UnitSlew(up.time, peak, coast, up.angle + coast * peak + down.angle)


def _powered_rise(
    drive: UnitDrive, time: FloatArray, final: FloatArray, affected: NDArray[np.bool_], rise: Rise
) -> Rise:
    """Rises without a cap where the supply may limit the slew, by Newton's method.

    Others stay unchanged. The times up to the peak and down from it add up to the whole time. The
    time down grows by no more than the time up, so the sum's slope over the time up is between 1
    and 2.
    """
    shape = affected.shape

    def of_affected(values: FloatArray) -> FloatArray:
        """Values of the drives whose slew the supply limits."""
        return np.broadcast_to(values, shape)[affected]

    limited_drive = UnitDrive(*(of_affected(getattr(drive, field.name)) for field in fields(drive)))
    total_time, end = of_affected(time), of_affected(final)
    least = rise_sweep(limited_drive, rise_to(limited_drive, end)).time
    low, high = np.minimum(least, total_time), total_time
    up = (low + high) / 2.0
    for _ in range(_POWER_STEPS):
        peak = risen_speed(limited_drive, rise_for(limited_drive, up))
        excess = up + brake_sweep(limited_drive, np.maximum(peak, end), end).time - total_time
        low, high = np.where(excess < 0.0, up, low), np.where(excess < 0.0, high, up)
        next_up = up - excess / (
            1.0 + limited_drive.accelerating(peak) / limited_drive.braking(peak)
        )
        outside = (next_up < low) | (next_up > high)
        step = np.where(outside, (low + high) / 2.0, next_up) - up
        up = up + step
        if (np.abs(step) <= _LAST_STEP * total_time).all():
            break
    rises = rise_for(limited_drive, up)
    parts = []
    for values, improved in zip(rise, rises, strict=True):
        part = np.broadcast_to(values, shape).copy()
        part[affected] = improved
        parts.append(part)
    return Rise(*parts)


def quickest_time(drive: UnitDrive, excess: FloatArray, final: FloatArray) -> FloatArray:
    """Least time [T_0] in which the wheel turns by `excess` [w_0 T_0] more than at `final` speed.

    Newton's method on the convex A(t) - f t; see the module's docstring. It starts from below, with
    the time that torque alone would take from the final speed if the wheel always braked as hard as
    at no-load speed, and overshoots once.
    """
    to_final, lead = since_rest(drive, final), since_rest(drive, drive.initial_speed)
    least = to_final.time - lead.time
    missing_angle = np.maximum(final * least - (to_final.angle - lead.angle), 0.0)
    weight = 1.0 + np.maximum(drive.brake, 0.5)
    time = least + np.sqrt(2.0 * weight * (excess + missing_angle))
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
    # Otherwise z + q (1 - e^-z) = rest: increasing and concave, so Newton's method converges from
    # below.
    rest = np.maximum((time - fixed) / positive(drive.knee), 0.0)
    z = np.maximum(rest - drive.brake, rest / (1.0 + drive.brake))
    for _ in range(_LINE_STEPS):
        shrinking = drive.brake * np.expm1(-z)
        z = z - (z - shrinking - rest) / (1.0 + drive.brake + shrinking)
    line: FloatArray = np.where(-np.expm1(-unclamped) <= drive.clamp, unclamped, z)
    return np.maximum(line, 0.0)
