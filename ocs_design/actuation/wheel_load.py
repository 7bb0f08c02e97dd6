"""Wheels that turn a trunk about roll and pitch: the smallest spin inertia that is in time.

All wheels are equal; a_i are their axes about roll and pitch, W_i their speeds relative to the
trunk, h the spin inertia of each (momentum per speed, including the motor's rotor) and I_m = h +
armature the inertia that its motor accelerates. With J the inertia of the whole about roll and
pitch, wheels braked, momentum is

    J w + h sum_i a_i W_i = L

A turn that sweeps P, inertia times angle, and leaves L in the wheels, therefore requires of the
busiest wheel the angle phi(P) / h and the final speed phi(L) / h, where

    phi(b) = min |x|_inf subject to sum_i a_i x_i = b
           = max over facet normals m of |m . b| / sum_i |m . a_i|

is the gauge of the axes' zonotope. The others do their parts in proportion x_i / phi. The wheel's
own equation, d/dt (h a_i . w + I_m W_i) = tau, then reads I_red dW/dt = tau with

    I_red = h + armature - kappa h^2,        kappa = a_b . K P / x_b,        K = J^-1,

for that busiest wheel b which the trunk helps least. Less busy wheels need no more torque, and have
more available (docs/theory.md, Two wheels on a trunk). Where P and L are not proportional, the
parts are those of P.
"""

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_time
from ocs_design.actuation.spin_root import SweepDemand, smallest_root
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.actuation.unit_drive import UnitDrive, positive
from ocs_design.common.arrays import FloatArray

# |J_xy| over sqrt(I_xx I_yy) beyond which a bound is useless.
_LOOSE = 0.5

# Least trunk assistance, relative to that for a wheel that turns alone.
_UNHELPED = 1e-3

# Relative magnitude of products of unit vectors below which they are rounding.
_ROUNDING = 1e-12

# Relative difference of two facets' values at a demand that counts as lying on both.
_EDGE = 1e-9


class SlewReason(IntEnum):
    """Obstacle to a slew."""

    AXIS = 1
    """The wheels cannot control a required axis."""
    TORQUE = 2
    """Even the torques at the speed of the start, kept constant, are too slow with any wheel."""
    SPEED = 3
    """The torque suffices; the drive's speed determines how large its wheel must be."""


class Gauge(NamedTuple):
    """Distribution of a momentum over wheels that minimises the busiest one's share.

    Attributes:
        busiest: phi, momentum of the busiest wheel, shape (...); inf: the axes do not span it.
        sense: sign of the momentum of each wheel that is among the busiest, shape (..., n); 0: it
            may have less, or there is nothing to hold.
    """

    busiest: FloatArray
    sense: FloatArray


def gauge(axes: ArrayLike, momentum: ArrayLike) -> Gauge:
    """The gauge of the zonotope of axes in closed form; see the module's docstring.

    Every direction m gives a lower bound, |m . b| <= sum_i |m . a_i| |x_i|, so directions that are
    not normals of facets do no harm; for parallel or coplanar axes, directions along them are the
    normals.

    Args:
        axes: of the wheels as columns, in two or three dimensions, shape (..., d, n).
        momentum: to be held, shape (..., d).
    """
    axes, required = np.asarray(axes, np.float64), np.asarray(momentum, np.float64)
    required = required.reshape(*(1,) * (axes.ndim - required.ndim - 1), *required.shape)
    axes = _wheels_first(axes, required.ndim - 1)
    axes = np.where(np.abs(axes) > OUT_OF_REACH, axes, 0.0)
    required = np.ascontiguousarray(np.moveaxis(required, -1, 0))
    normals = _normals(axes)
    length = np.sqrt((normals**2).sum(axis=0))
    axis_length, momentum_length = (
        np.sqrt((vectors**2).sum(axis=0)) for vectors in (axes, required)
    )
    levers = (normals[:, :, None] * axes[:, None]).sum(axis=0)
    width = np.abs(levers).sum(axis=1)
    is_facet = width > _ROUNDING * length * axis_length.max(axis=0)
    projections = (normals * required[:, None]).sum(axis=0)
    projections = np.where(
        np.abs(projections) <= _ROUNDING * length * momentum_length, 0.0, projections
    )
    ratios = np.abs(projections) / np.where(is_facet, width, 1.0)
    ratios = np.where(is_facet | (projections == 0.0), ratios, np.inf)
    # Without any axis there is no facet either.
    without_axes = (axis_length.max(axis=0) == 0.0) & (momentum_length > 0.0)
    busiest = np.where(without_axes, np.inf, ratios.max(axis=0))
    touched = np.where(ratios >= busiest * (1.0 - _EDGE), np.sign(projections), 0.0)
    sense = (touched[:, None] * np.where(is_facet[:, None], np.sign(levers), 0.0)).sum(axis=0)
    return Gauge(busiest, np.moveaxis(np.sign(sense), 0, -1))


def without_each(axes: FloatArray) -> tuple[FloatArray, ...]:
    """Axes with each column in turn set to zero: n arrays of shape (..., d, n).

    A zero axis contributes nothing: the zonotope is that of the others.
    """
    return tuple(axes * row for row in 1.0 - np.eye(axes.shape[-1]))


def reach(axes: FloatArray) -> FloatArray:
    """Largest momentum about roll, pitch and yaw, each alone, relative to one wheel's, shape (3,).

    The wheels' axes are columns, shape (3, n).
    """
    return np.asarray(1.0 / gauge(axes, np.eye(3)).busiest)


def reach_without_one(axes: FloatArray) -> FloatArray:
    """Reach with any one of the wheels lost; see `reach`."""
    return np.asarray(np.min([reach(left) for left in without_each(axes)], axis=0))


def momentum_of_each(axes: FloatArray, momentum: FloatArray) -> FloatArray:
    """Momentum of each wheel with least effort of the busiest, shape (..., n).

    Wheels that are not among the busiest are parallel, and share the rest. The axes, shape (..., 2,
    n), are those about roll and pitch and span the momentum, shape (..., 2).
    """
    busiest, sense = gauge(axes, momentum)
    of_busiest = sense * busiest[..., None]
    rest = momentum - (axes * of_busiest[..., None, :]).sum(axis=-1)
    other_axes = np.where(sense[..., None, :] == 0.0, axes, 0.0)
    squares = (other_axes**2).sum(axis=(-2, -1))
    scale = np.where(squares > 0.0, squares, 1.0)[..., None]
    share = (other_axes * rest[..., None]).sum(axis=-2) / scale
    return np.asarray(of_busiest + share)


def _wheels_first(axes: FloatArray, depth: int) -> FloatArray:
    """Axes with `depth` trailing dimensions, (d, n, ...), as short last axes are slow."""
    axes = axes.reshape(*(1,) * (depth + 2 - axes.ndim), *axes.shape)
    return np.ascontiguousarray(np.moveaxis(axes, (-2, -1), (0, 1)))


def _normals(axes: FloatArray) -> FloatArray:
    """Directions that include the normals of all facets of the axes' zonotope, (d, m, ...)."""
    if len(axes) == 2:
        across = np.stack([-axes[1], axes[0]])
        parallel = np.abs(across[0, 0] * axes[0] + across[1, 0] * axes[1]).max(axis=0)
        flat = (parallel <= OUT_OF_REACH).any()
        return np.concatenate([across, axes], axis=1) if flat else across
    first, second = np.triu_indices(axes.shape[1], 1)
    across = np.cross(axes[:, first], axes[:, second], axis=0)
    # For nearly parallel axes, only rounding is left.
    across = np.where(np.abs(across).max(axis=0) > OUT_OF_REACH, across, 0.0)
    in_plane = np.cross(across[:, :, None], axes[:, None], axis=0)
    in_plane = in_plane.reshape(3, -1, *axes.shape[2:])
    # Directions across a single axis, which it does not span.
    beside = np.stack([np.cross(axis, axes, axis=0) for axis in np.eye(3)], axis=1)
    beside = beside.reshape(3, -1, *axes.shape[2:])
    return np.concatenate([across, in_plane, axes, beside], axis=1)


@dataclass(frozen=True, eq=False)
class WheelTask:
    """A turn that wheels must do; arrays that broadcast except for their last axes.

    Attributes:
        swept: P, time integral of the wheels' momentum about roll and pitch [N m s^2], shape (...,
            2); its sign matters.
        momentum: L, held by the wheels at the end [N m s], shape (..., 2).
        duration: T [s], shape (...).
        inertia: of the whole, wheels braked.
        axes: of the wheels about roll and pitch, as columns, shape (..., 2, n).
        one_stops: whether the others must do it with any one of the wheels missing.
        yaw_inertia: I_zz of the whole [kg m^2], shape (...), where a heading is required too and
            the wheels control it; swept, momentum and axes then have a third component. None: the
            heading is free.
        initial_speed: of all wheels, in their direction for swept and momentum [rad/s], shape
            (...).
        one_way: whether the wheels do not really return to that speed, shape (...).
    """

    swept: ArrayLike
    momentum: ArrayLike
    duration: ArrayLike
    inertia: TiltInertia
    axes: FloatArray
    one_stops: bool = False
    yaw_inertia: FloatArray | None = None
    initial_speed: ArrayLike = 0.0
    one_way: ArrayLike = False

    def load(self) -> "WheelLoad":
        """Load on the busiest wheel; see the module's docstring.

        With any one wheel missing, each figure is the worst over the missing wheels.
        """
        if self.one_stops:
            remaining = without_each(self.axes)
            loads = [replace(self, axes=left, one_stops=False).load() for left in remaining]
            return WheelLoad(
                excess=np.max([load.excess for load in loads], axis=0),
                momentum=np.max([load.momentum for load in loads], axis=0),
                coupling=np.min([load.coupling for load in loads], axis=0),
                initial_speed=np.max([load.initial_speed for load in loads], axis=0),
                one_way=self.one_way,
            )
        swept, momentum, _ = np.broadcast_arrays(self.swept, self.momentum, self.axes[..., 0])
        (sweep, final_momentum), senses = gauge(self.axes, np.stack([swept, momentum]))
        has_sweep = sweep > 0.0
        sense = np.where(has_sweep[..., None], senses[0], senses[1])
        largest = np.where(has_sweep, sweep, final_momentum)
        vector = np.where(has_sweep[..., None], swept, momentum)

        (x, y), product = np.moveaxis(self.inertia.diagonal, -1, 0), self.inertia.product
        determinant = x * y - product**2
        rolled, pitched, *about_yaw = np.moveaxis(vector, -1, 0)
        rates = y * rolled - product * pitched, x * pitched - product * rolled
        roll, pitch, *yaw_parts = _wheels_first(self.axes, largest.ndim)
        of_each_wheel = roll**2 * y + pitch**2 * x - 2.0 * (roll * pitch) * product
        of_each_wheel = of_each_wheel / determinant
        if self.yaw_inertia is not None:
            of_each_wheel = of_each_wheel + yaw_parts[0] ** 2 / self.yaw_inertia
        largest_alone = of_each_wheel.max(axis=0)
        usable = (largest > 0.0) & np.isfinite(largest)
        sense = np.moveaxis(sense, -1, 0)
        assistance = rates[0] / determinant * roll + rates[1] / determinant * pitch
        if self.yaw_inertia is not None:
            assistance = assistance + about_yaw[0] / self.yaw_inertia * yaw_parts[0]
        assistance = sense * assistance / np.where(usable, largest, 1.0)
        least_assistance = np.where(sense == 0.0, np.inf, assistance).min(axis=0)
        # Treat opposing trunk motion as no help.
        coupling = np.maximum(
            np.where(usable, least_assistance, largest_alone), _UNHELPED * largest_alone
        )
        initial_speed = np.zeros(())
        if np.any(self.initial_speed):
            # Of the busiest wheels, the one farthest along its change has the least capability
            # left.
            initial_speed = np.where(sense == 0.0, -np.inf, sense * self.initial_speed).max(axis=0)
            initial_speed = np.where(np.isfinite(initial_speed), initial_speed, 0.0)
        return WheelLoad(sweep, final_momentum, coupling, initial_speed, self.one_way)


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelBound(WheelTask):
    """Lower bound of a turn's demand, over trunks no lighter and of similar coupling.

    Attributes:
        swept, momentum: least magnitudes of P and L over these trunks, shape (..., 2).
        inertia: no larger than theirs about either axis.
        axes: of a zonotope that contains theirs and is symmetric in roll and in pitch.
        spread: largest difference of J_xy from theirs [kg m^2], shape (...).
        reached: whether the wheels control roll and pitch at all of their incidences; where not,
            the trunk may drift, shape (..., 2).
    """

    spread: FloatArray
    reached: NDArray[np.bool_]

    def load(self) -> "WheelLoad":
        """Lower bound of the load on the busiest wheel (docs/theory.md, The selection)."""
        diagonal, product = self.inertia
        bound_inertia = TiltInertia(diagonal, np.abs(product) + self.spread)
        share = bound_inertia.share[..., None]

        # An axis that may be left free reduces the inertia about the other one.
        reduction = np.where(self.reached[..., ::-1], 1.0, 1.0 - share**2)
        reduction = np.where(share < _LOOSE, reduction, 0.0)
        swept, momentum = self.swept * reduction, self.momentum * reduction
        uncoupled_inertia = TiltInertia.uncoupled(diagonal)
        load = WheelTask(swept, momentum, self.duration, uncoupled_inertia, self.axes).load()
        # |a . K b| for the longest axis a about roll and pitch, and any b of the zonotope.
        lengths = np.abs(self.axes) / np.sqrt(diagonal)[..., None]
        longest, whole, rho = lengths.max(axis=-1), lengths.sum(axis=-1), np.minimum(share, _LOOSE)
        coupling = (longest * (whole + rho * whole[..., ::-1]) / (1.0 - rho**2)).sum(axis=-1)
        initial_speed = -np.abs(self.initial_speed)
        return replace(load, coupling=coupling, initial_speed=initial_speed, one_way=self.one_way)


@dataclass(frozen=True, eq=False)
class WheelLoad:
    """Load of a turn on the busiest wheel, each of shape (...).

    Attributes:
        excess: phi(P) [N m s^2]; inf: an axis is out of reach.
        momentum: phi(L) [N m s]; inf: an axis is out of reach.
        coupling: kappa [1 / (kg m^2)].
        initial_speed: of that wheel, positive in the direction of its change [rad/s].
        one_way: whether it does not really return to that speed.
    """

    excess: FloatArray
    momentum: FloatArray
    coupling: FloatArray
    initial_speed: FloatArray
    one_way: ArrayLike

    def from_initial_speed(self, line: DriveLine) -> tuple[DriveLine, FloatArray]:
        """Line of the wheel's drive, and the speed [rad/s] on it at which the wheel starts.

        That of a wheel which does not return is the line for the change of speed: what it really
        does on the way back is not in the load, and the line is as good there as for a wheel that
        starts at rest (docs/theory.md, About a pivot).
        """
        offset = np.where(self.one_way, self.initial_speed, 0.0)
        return line.from_speed(offset), self.initial_speed - offset

    def angle(self, spin_inertia: ArrayLike) -> FloatArray:
        """Angle by which a wheel of that spin inertia turns beyond its final speed [rad]."""
        return np.asarray(self.excess / np.asarray(spin_inertia))

    def final_speed(self, spin_inertia: ArrayLike) -> FloatArray:
        """W_f, final speed in addition to that at the start [rad/s]."""
        return np.asarray(self.momentum / np.asarray(spin_inertia))

    def reduced_inertia(self, spin_inertia: ArrayLike, armature: ArrayLike = 0.0) -> FloatArray:
        """I_red, effective inertia that the motor accelerates on the free trunk [kg m^2]."""
        h = np.asarray(spin_inertia)
        return np.asarray(h + np.asarray(armature) - self.coupling * h**2)


def wheel_slew_time(
    task: WheelTask, spin_inertia: ArrayLike, line: DriveLine, armature: ArrayLike = 0.0
) -> FloatArray:
    """Time that wheels of that spin inertia take for the turn [s], shape (...); inf: never done.

    Args:
        task: its duration is not used.
        spin_inertia: h of each wheel [kg m^2], shape (...); 0 or inf: no wheel. Values are clipped
            to 1 / (2 kappa), beyond which wheels would hold most of the inertia that they turn.
        line: of the drive at the wheel, shape (...).
        armature: I_m - h [kg m^2], shape (...).
    """
    load, requested = task.load(), np.asarray(spin_inertia, dtype=np.float64)
    has_wheel = (requested > 0.0) & np.isfinite(requested)
    largest = 1.0 / (2.0 * load.coupling)
    h = np.where(has_wheel, np.minimum(requested, largest), largest)
    shifted_line, initial_speed = load.from_initial_speed(line)
    reduced = load.reduced_inertia(h, armature)
    time = slew_time(load.angle(h), reduced, shifted_line, load.final_speed(h), initial_speed)
    return np.where(has_wheel | (load.excess + load.momentum == 0.0), time, np.inf)


def smallest_spin_inertia(
    task: WheelTask, line: DriveLine, armature: ArrayLike = 0.0
) -> FloatArray:
    """The smallest h per wheel that does the turn in time [kg m^2], shape (...); inf: none does.

    The time falls as h grows, up to h = 1 / (2 kappa), where the wheels hold half the inertia that
    they turn and the search ends. Only a negative armature (a gear that speeds the wheel up) can
    make the time rise again temporarily, or a wheel that turns against the turn at the start: a
    smaller one gets away from that speed, at which it has less torque on the way back. A larger h,
    required by another turn, must then be checked again, as `least` of `spin_demand`. The task's
    inertia is fixed, independent of h; `armature`: I_m - h [kg m^2], shape (...).
    """
    return smallest_root(spin_demand(task, line, armature))


def spin_demand(
    task: WheelTask, line: DriveLine, armature: ArrayLike = 0.0, least: ArrayLike = 0.0
) -> SweepDemand:
    """Demand that `smallest_spin_inertia` solves for; arguments as there.

    `least` is the smallest h to consider [kg m^2], shape (...).
    """
    load = task.load()
    duration = np.asarray(task.duration, dtype=np.float64)
    return SweepDemand(
        sweep=load.excess + load.momentum * np.maximum(duration, 0.0),
        momentum=load.momentum,
        duration=duration,
        coupling=load.coupling,
        armature=np.asarray(armature, dtype=np.float64),
        least=np.asarray(least, dtype=np.float64),
        drive=UnitDrive.of(*load.from_initial_speed(line)),
    )


def slew_reason(task: WheelTask, line: DriveLine) -> NDArray[np.int_]:
    """Reason why no wheel, or none that fits, does a turn, as `SlewReason` values, shape (...).

    The time falls as the wheel grows, towards that of the torques at its speed at the start, there
    and back, which differ for a wheel that turns. A wheel so large that it holds much of the given
    inertia itself (I_red below h) may still be faster; this is ignored, and the reason is lack of
    torque.
    """
    load = task.load()
    drive = UnitDrive.of(*load.from_initial_speed(line))
    there, back = (
        drive.torque * drive.forward_torque(at)
        for at in (drive.initial_speed, -drive.initial_speed)
    )
    duration = np.maximum(np.asarray(task.duration, dtype=np.float64), 0.0)
    final = load.momentum
    with np.errstate(invalid="ignore"):
        # Constant torques change a wheel's momentum by tau t, up to its peak and back down.
        peak = there * (back * duration + final) / positive(there + back)
        swept = peak**2 / (2.0 * positive(there)) + (peak**2 - final**2) / (2.0 * positive(back))
        done = np.where(drive.torque > 0.0, swept, 0.0) - final * duration
        lacks_torque = np.where(peak >= final, done, -np.inf) < load.excess
    reason = np.where(lacks_torque, SlewReason.TORQUE, SlewReason.SPEED)
    return np.where(np.isinf(load.excess + load.momentum), SlewReason.AXIS, reason)
