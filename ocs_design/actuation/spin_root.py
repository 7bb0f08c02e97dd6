"""Root finding for the smallest spin inertia h with which the busiest wheel is in time.

Within the time T a wheel of spin inertia h turns by at most Phi(h), ending faster by W_f =
momentum / h, and sweeps M(h) = h Phi. It must sweep phi(P) + phi(L) T (`wheel_load`), the excess
plus the sweep of the final speed itself. From `dA/dt = x` (`unit_drive`) the slope is exact,

    dM/dh = Phi + h w_0 T_0 (A - x t) (1 - 2 kappa h) / I_red - w_0 T_0 f (x - f) / b(f).

1/M as a function of 1/h is convex, from its level at full torque to its slope at full speed, so
Newton's method on it climbs, without overshooting, from the least h that speed alone would need to
the smallest root. It is bracketed nevertheless, by the largest h below and the smallest above.
"""

from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.unit_drive import UnitDrive, farthest_slew, positive, reachable_speed
from ocs_design.common.arrays import FloatArray, Table

_STEPS = 80
_DIGITS = 1e-14


@dataclass(frozen=True, eq=False)
class SweepDemand(Table):
    """Demand on the busiest wheel; all fields broadcast.

    Attributes:
        sweep: time integral of its momentum [N m s^2]; inf: out of reach.
        momentum: left in it at the end [N m s].
        duration: T [s].
        coupling: kappa [1 / (kg m^2)].
        armature: I_m - h [kg m^2].
        least: smallest spin inertia to consider [kg m^2].
        drive: drive of each wheel.
    """

    sweep: FloatArray
    momentum: FloatArray
    duration: FloatArray
    coupling: FloatArray
    armature: FloatArray
    least: FloatArray
    drive: UnitDrive


class Capability(NamedTuple):
    """Capability of a wheel of a spin inertia within the time of the demand.

    Attributes:
        sweep: M [N m s^2].
        slope: dM/dh [rad s].
    """

    sweep: FloatArray
    slope: FloatArray


def capability(demand: SweepDemand, spin_inertia: FloatArray) -> Capability:
    """Sweep of wheels of that spin inertia; see the module's docstring.

    Where the final speed cannot be reached in time, they accelerate all the time.
    """
    h, drive = spin_inertia, demand.drive
    reduced = h + demand.armature - demand.coupling * h**2
    unit = reduced * drive.no_load_speed / drive.torque
    time = demand.duration / unit
    gain = demand.momentum / (h * drive.no_load_speed)
    final = reachable_speed(drive, time, drive.initial_speed + gain)
    slew = farthest_slew(drive, time, final)
    angle = slew.angle - drive.initial_speed * time
    by_inertia = h * (slew.angle - slew.peak * time) * (1.0 - 2.0 * demand.coupling * h) / reduced
    by_final_speed = (
        (final - drive.initial_speed) * (slew.peak - final) / drive.forward_torque(-final)
    )
    slope = angle + by_inertia - by_final_speed
    scale = drive.no_load_speed * unit
    return Capability(scale * h * angle, scale * slope)


def newton_step(
    demand: SweepDemand, spin_inertia: FloatArray, capability_there: Capability
) -> FloatArray:
    """Newton step of 1/M over 1/h [kg m^2]; inf where it would go beyond every h."""
    # Where nothing is to be swept, the lack is minus infinity, and the step leads to zero.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        missing = capability_there.sweep * (1.0 - capability_there.sweep / demand.sweep)
        gain = missing / (capability_there.slope * spin_inertia)
        ahead = (capability_there.slope > 0.0) & (gain < 1.0)
        return np.where(ahead, spin_inertia / (1.0 - gain), np.inf)


def smallest_root(demand: SweepDemand) -> FloatArray:
    """The smallest spin inertia that meets the demand [kg m^2]; inf where none does."""
    names = [field.name for field in fields(demand) if field.name != "drive"]
    values = [getattr(demand, name) for name in names]
    values += [getattr(demand.drive, field.name) for field in fields(demand.drive)]
    parts = np.broadcast_arrays(*values)
    flat = [part.reshape(-1) for part in parts]
    columns: dict[str, Any] = dict(zip(names, flat, strict=False))
    drive = UnitDrive(*flat[len(names) :])
    demand = replace(demand, **columns, drive=drive)
    high = 1.0 / (2.0 * demand.coupling)

    # Below this h the speed alone is too low, or there is nothing to accelerate.
    gain = (drive.highest - drive.initial_speed) * drive.no_load_speed
    by_speed = demand.sweep / (gain * positive(demand.duration))
    negative_armature = np.maximum(-demand.armature, 0.0)
    root = np.sqrt(np.maximum(1.0 - 4.0 * demand.coupling * negative_armature, 0.0))
    least_with_inertia = 2.0 * negative_armature / (1.0 + root) * (1.0 + 1e-9)
    low = np.maximum(np.maximum(by_speed, demand.least), least_with_inertia)

    is_required = (demand.sweep > 0.0) | (demand.momentum > 0.0)
    answer = np.where(is_required, np.inf, demand.least)
    can_move = (drive.torque > 0.0) & (demand.duration > 0.0)
    lane = np.flatnonzero(is_required & can_move & (low <= high))
    start, top = low[lane], high[lane]
    search = _Search(lane, demand.take(lane), start, start, top, top, np.zeros(lane.shape, bool))
    for _ in range(_STEPS):
        if not search.lane.size:
            break
        search = search.advance(answer)
    answer[search.lane] = search.h
    return answer.reshape(parts[0].shape)


@dataclass(frozen=True, eq=False)
class _Search(Table):
    """Demands that are not solved yet, one lane each.

    Attributes:
        lane: index of each in the answer. demand: of each.
        h: value to try. low: largest known to be too small, or the start.
        high: smallest known to suffice, or the top. top: largest allowed.
        bracketed: whether any h is known to suffice.
    """

    lane: NDArray[np.intp]
    demand: SweepDemand
    h: FloatArray
    low: FloatArray
    high: FloatArray
    top: FloatArray
    bracketed: NDArray[np.bool_]

    def advance(self, answer: FloatArray) -> "_Search":
        """Try h, write solved lanes into `answer`, and keep the undecided ones."""
        capacity = capability(self.demand, self.h)
        enough = capacity.sweep >= self.demand.sweep
        low, high = np.where(enough, self.low, self.h), np.where(enough, self.h, self.high)
        bracketed = self.bracketed | enough
        newton = newton_step(self.demand, self.h, capacity)
        inside = (newton > low) & (newton < high)
        next_h = np.where(bracketed & ~inside, np.sqrt(low * high), np.minimum(newton, self.top))
        # Nothing below the start is considered; a closed bracket's upper end is the root.
        closed = (enough & (self.h <= low)) | (bracketed & (high - low <= _DIGITS * high))
        solved = closed | (np.abs(newton - self.h) <= _DIGITS * self.h)
        answer[self.lane[solved]] = np.where(closed, high, newton)[solved]
        keep = ~(solved | (~enough & (self.h >= self.top)))
        return replace(self, h=next_h, low=low, high=high, bracketed=bracketed).take(keep)
