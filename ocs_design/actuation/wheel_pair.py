"""Two wheels that turn a trunk about roll and pitch: the smallest spin inertia that is in time.

Per wheel, at its speed W relative to the trunk, h is its spin inertia (momentum per speed, the
motor's rotor included) and I_m = h + armature what its motor accelerates. With s, c = sin, cos of
the incidence and J of the whole about roll and pitch with its wheels braked, momentum is

    J w + h (s (W_1 - W_2), c (W_1 + W_2)) = L

so that a turn that sweeps P, inertia times angle, and leaves L in the wheels, asks the busier wheel
for

    phi = (|P_x| / s + |P_y| / c) / (2 h)        W_f = (|L_x| / s + |L_y| / c) / (2 h)

while the other one does its k-th part, k = (|P_y| / c - |P_x| / s) / (|P_y| / c + |P_x| / s). The
wheel's own equation, d/dt (h (s w_x + c w_y) + I_m W) = tau, then reads I_red dW/dt = tau with

    I_red = h + armature - kappa h^2,
    kappa = s^2 K_xx (1 - k) + c^2 K_yy (1 + k) + 2 s c K_xy sign(P_x P_y),        K = J^-1.

The less busy wheel needs no more torque than the busier one, and has more
(docs/theory.md, Two wheels on a trunk). Where P and L are not in proportion, k is that of P.
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_time
from ocs_design.actuation.spin_root import SpinDemand, smallest_roots
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.actuation.unit_drive import UnitDrive, positive
from ocs_design.common.arrays import FloatArray

# |J_xy| over sqrt(I_xx I_yy) beyond which a bound says nothing.
_LOOSE = 0.5


class SlewReason(IntEnum):
    """What stands in the way of a slew."""

    AXIS = 1
    """The incidence leaves an axis out of reach that is asked for."""
    TORQUE = 2
    """The torque at rest, all the time, is too slow with any wheel."""
    SPEED = 3
    """The torque would do; how fast the drive turns decides how large its wheel must be."""


@dataclass(frozen=True, eq=False)
class WheelPairTask:
    """A turn that two wheels must do; arrays that broadcast but for their last axis of two.

    Attributes:
        swept: P, momentum over time that must pass the wheels about roll and pitch [N m s^2],
            shape (..., 2); its sign counts.
        momentum: L, that they hold at the end [N m s], shape (..., 2).
        duration: T [s], shape (...).
        inertia: of the whole, wheels braked.
        incidence: between wheel axes and lateral direction [rad], shape (...).
    """

    swept: ArrayLike
    momentum: ArrayLike
    duration: ArrayLike
    inertia: TiltInertia
    incidence: ArrayLike

    def load(self) -> "WheelLoad":
        """What it asks of the busier wheel; see the module's text."""
        shares = self._shares()
        excess, held = _per_share(self.swept, shares), _per_share(self.momentum, shares)
        turning = excess.sum(axis=-1, keepdims=True) > 0.0
        asked = np.where(turning, self.swept, self.momentum)

        # k, the speed of the less busy wheel over that of the busier one.
        part = np.where(turning, excess, held)
        whole = part.sum(axis=-1)
        usable = (whole > 0.0) & np.isfinite(whole)
        ahead = np.where(usable, part[..., 1] - part[..., 0], 0.0)
        balance = ahead / np.where(usable, whole, 1.0)

        # kappa; where only one axis is asked for, of the wheel that the trunk helps less.
        diagonal, product = self.inertia
        sense = np.sign(asked.prod(axis=-1))
        determinant = diagonal.prod(axis=-1) - product**2
        compliance = shares**2 * diagonal[..., ::-1] / determinant[..., None]
        across = compliance[..., 1] - compliance[..., 0]
        mixed = -2.0 * shares.prod(axis=-1) * product / determinant
        mixed = np.where(sense == 0.0, -np.abs(mixed), sense * mixed)
        coupling = np.asarray(compliance.sum(axis=-1) + balance * across + mixed)
        return WheelLoad(excess.sum(axis=-1), held.sum(axis=-1), coupling)

    def _shares(self) -> FloatArray:
        """Share of a wheel's momentum on roll and on pitch, 0 out of reach, shape (..., 2)."""
        shares = np.stack([np.sin(self.incidence), np.cos(self.incidence)], axis=-1)
        return np.where(shares > OUT_OF_REACH, shares, 0.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelPairBound(WheelPairTask):
    """What no turn is below, on any trunk that is no lighter and about as much coupled.

    Attributes:
        swept: P without the coupling [N m s^2], shape (..., 2).
        inertia: no larger than theirs about either axis.
        incidence: sine and cosine, each by itself, no smaller than theirs.
        turn: theta, that P comes from; 0: a push left it [rad], shape (..., 2).
        spread: that J_xy differs by from theirs at most [kg m^2], shape (...).
        reached: whether the wheels reach roll and pitch at every incidence of theirs, or the
            trunk may drift there, shape (..., 2).
    """

    turn: ArrayLike
    spread: FloatArray
    reached: NDArray[np.bool_]

    def load(self) -> "WheelLoad":
        """No more than is asked of the busier wheel (docs/theory.md, The selection)."""
        diagonal, product = self.inertia
        most = TiltInertia(diagonal, np.abs(product) + self.spread)
        share = most.share[..., None]
        known = share < _LOOSE

        # Coupling takes from the sweep at most; an axis that may be left to itself adds none, and
        # takes from the other one.
        turn, uncoupled = np.asarray(self.turn), np.abs(self.swept)
        both = turn.prod(axis=-1)
        sense = np.where(both == 0.0, 1.0, np.sign(both * product))
        coupled = sense * np.abs(product) - self.spread
        least = np.maximum(uncoupled + coupled[..., None] * np.abs(turn[..., ::-1]), 0.0)
        left = np.where(self.reached[..., ::-1], 1.0, 1.0 - share**2)
        least = np.where(self.reached | (turn != 0.0), least, uncoupled) * left

        swept, momentum = np.where(known, least, 0.0), np.where(known, self.momentum, 0.0)
        alone = TiltInertia.uncoupled(diagonal)
        load = WheelPairTask(swept, momentum, self.duration, alone, self.incidence).load()
        gives = 2.0 * (self._shares() ** 2 / diagonal).max(axis=-1)
        gives = gives / (1.0 - np.minimum(most.share, _LOOSE))
        return replace(load, coupling=np.where(most.product > 0.0, gives, load.coupling))


@dataclass(frozen=True, eq=False)
class WheelLoad:
    """What a turn asks of the busier of two wheels, shape (...) each.

    Attributes:
        excess: |P_x| / s + |P_y| / c [N m s^2]; inf: an axis is out of reach.
        held: |L_x| / s + |L_y| / c [N m s]; likewise.
        coupling: kappa [1 / (kg m^2)].
    """

    excess: FloatArray
    held: FloatArray
    coupling: FloatArray

    def angle(self, spin_inertia: ArrayLike) -> FloatArray:
        """phi, by which a wheel of that spin inertia turns beyond its final speed [rad]."""
        return np.asarray(self.excess / (2.0 * np.asarray(spin_inertia)))

    def final_speed(self, spin_inertia: ArrayLike) -> FloatArray:
        """W_f [rad/s]."""
        return np.asarray(self.held / (2.0 * np.asarray(spin_inertia)))

    def reduced_inertia(self, spin_inertia: ArrayLike, armature: ArrayLike = 0.0) -> FloatArray:
        """I_red, what the motor accelerates while the trunk gives way [kg m^2]."""
        h = np.asarray(spin_inertia)
        return np.asarray(h + np.asarray(armature) - self.coupling * h**2)


def pair_slew_time(
    task: WheelPairTask, spin_inertia: ArrayLike, line: DriveLine, armature: ArrayLike = 0.0
) -> FloatArray:
    """How long wheels of that spin inertia take for the turn [s], shape (...); inf: for ever.

    Args:
        task: its duration is not used.
        spin_inertia: h of each wheel [kg m^2], shape (...); 0 or inf: no wheel. Wheels of more
            than 1 / (2 kappa) would carry most of the inertia that they turn, and count as that.
        line: of the drive at the wheel, shape (...).
        armature: I_m - h [kg m^2], shape (...).
    """
    load, asked_of = task.load(), np.asarray(spin_inertia, dtype=np.float64)
    there = (asked_of > 0.0) & np.isfinite(asked_of)
    half = 1.0 / (2.0 * load.coupling)
    h = np.where(there, np.minimum(asked_of, half), half)
    time = slew_time(load.angle(h), load.reduced_inertia(h, armature), line, load.final_speed(h))
    return np.where(there | (load.excess + load.held == 0.0), time, np.inf)


def smallest_spin_inertia(
    task: WheelPairTask, line: DriveLine, armature: ArrayLike = 0.0, least: ArrayLike = 0.0
) -> FloatArray:
    """The smallest h per wheel that does the turn in time [kg m^2], shape (...); inf: none does.

    The time falls as h grows, up to h = 1 / (2 kappa), where the wheels carry half the inertia that
    they turn and the search ends. Only a negative armature (a gear that speeds the wheel up) lets
    the time rise again for a while. A larger h, which another turn needs, must then be tried anew,
    as `least`.

    Args:
        task: the inertia is taken as given, whatever h.
        line: of the drive at the wheel, shape (...).
        armature: I_m - h [kg m^2], shape (...).
        least: smallest h to consider [kg m^2], shape (...).
    """
    return smallest_roots([spin_demand(task, line, armature, least)])[0]


def spin_demand(
    task: WheelPairTask, line: DriveLine, armature: ArrayLike = 0.0, least: ArrayLike = 0.0
) -> SpinDemand:
    """What `smallest_spin_inertia` solves for; arguments as there."""
    load = task.load()
    duration = np.asarray(task.duration, dtype=np.float64)
    return SpinDemand(
        sweep=load.excess + load.held * np.maximum(duration, 0.0),
        momentum=load.held,
        duration=duration,
        coupling=load.coupling,
        armature=np.asarray(armature, dtype=np.float64),
        least=np.asarray(least, dtype=np.float64),
        drive=UnitDrive.of(line),
    )


def slew_reason(task: WheelPairTask, line: DriveLine) -> NDArray[np.int_]:
    """Why there is no wheel for a turn, or none that fits, as values of `SlewReason`, shape (...).

    The time falls as the wheel grows, towards that of the torque at rest, there and back. A wheel
    so large that it takes much of the given inertia upon itself (I_red falls short of h) may still
    beat that; it counts as out of reach for want of torque.
    """
    load, torque = task.load(), UnitDrive.of(line).torque
    duration = np.maximum(np.asarray(task.duration, dtype=np.float64), 0.0)
    final = load.held / 2.0
    with np.errstate(invalid="ignore"):
        # Constant torque raises a wheel's momentum by tau t to its peak, and back to the final one.
        peak = (torque * duration + final) / 2.0
        swept = 2.0 * (peak**2 - final**2 / 2.0) / positive(torque)
        done = np.where(torque > 0.0, swept, 0.0) - load.held * duration
        weak = np.where(peak >= final, done, -np.inf) < load.excess
    reason = np.where(weak, SlewReason.TORQUE, SlewReason.SPEED)
    return np.where(np.isinf(load.excess + load.held), SlewReason.AXIS, reason)


def _per_share(asked: ArrayLike, shares: FloatArray) -> FloatArray:
    """|asked| / share; nothing where nothing is asked, inf where a share of zero is."""
    amount, shares = np.broadcast_arrays(np.abs(np.asarray(asked, dtype=np.float64)), shares)
    ratio = np.divide(amount, shares, out=np.full(amount.shape, np.inf), where=shares > 0.0)
    return np.where(amount > 0.0, ratio, 0.0)
