"""Reasons why motors are rejected, one each, at the most promising gear and incidence."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import missing_figures
from ocs_design.actuation.motor import DIRECT
from ocs_design.actuation.spin_root import capability
from ocs_design.actuation.wheel_load import (
    SlewReason,
    slew_reason,
    smallest_spin_inertia,
    spin_demand,
    wheel_slew_time,
)
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import Constraint, Infeasible
from ocs_design.common.units import format_quantity
from ocs_design.parts.housing import PlainDrum
from ocs_design.parts.rim import cylinder_spin_inertia
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.bound.rim_problem import BORE_SHARE, RimLimits, smallest_rim_inertia
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.selection.bounds import PairBounds, incidence_intervals, least_inertia
from ocs_design.sizing.selection.candidates import Candidates, drives_of
from ocs_design.sizing.selection.demand import (
    column,
    columns,
    rate_change_spin_inertia,
    roll_cancelling_momentum,
    wheel_task,
)
from ocs_design.sizing.selection.drives import Drives
from ocs_design.sizing.selection.problem import Reason, Rejection, SelectionProblem

_NEVER = 1e9
"""Score larger than any finite one."""

_NOTHING = 1e-15
"""A spin inertia smaller than any wheel's [kg m^2]."""

CONSTRAINTS = MappingProxyType(
    {
        Reason.FIGURES: Constraint.FIGURES,
        Reason.HEAVIER: Constraint.OWN_WEIGHT,
        Reason.TORQUE: Constraint.TORQUE,
        Reason.SPEED: Constraint.SPEED,
        Reason.ENVELOPE: Constraint.ENVELOPE,
        Reason.MASS: Constraint.WHEEL_MASS_MAX,
        Reason.STRESS: Constraint.HOOP_STRESS,
        Reason.INCIDENCE: Constraint.INCIDENCE,
        Reason.OWN_WEIGHT: Constraint.OWN_WEIGHT,
    }
)
"""What stands in the way of a motor that was rejected for a reason."""

NO_ROOM = frozenset({Reason.ENVELOPE, Reason.STRESS, Reason.MASS})
"""Reasons that concern the wheel rather than the motor."""


class Refused(Infeasible):
    """No motor can do it; remedies are not included, as finding them takes longer than the search.

    Attributes:
        problem: problem that no motor solves. nearest: the motor that comes closest.
    """

    def __init__(self, problem: SelectionProblem, rejections: Iterable[Rejection]) -> None:
        # By distance from feasibility; motors with missing data last.
        nearest = min(rejections, key=lambda one: (one.reason is Reason.FIGURES, one.shortfall))
        largest = nearest.largest
        count, voltage = len(problem.motors), f"{problem.supply.voltage:g} V"
        if (wheels := len(problem.layout)) != 2:
            voltage += " with one wheel" if wheels == 1 else f" with {wheels} wheels"
        who = (
            f"Motor {nearest.motor} cannot do it at {voltage}"
            if count == 1
            else f"None of {count} motors can do it at {voltage}; {nearest.motor} comes closest"
        )
        super().__init__(
            f"{who}: {nearest.detail}.",
            binding=[CONSTRAINTS[nearest.reason]],
            required_spin_inertia=nearest.needed,
            largest_spin_inertia=(
                largest_wheel(problem, problem.envelope) if largest is None else largest
            ),
        )
        self.problem, self.nearest = problem, nearest

    @property
    def for_reserve(self) -> bool:
        """Whether a reserve that a device must keep may be the only obstacle."""
        return any(kept.short for kept in self.problem.requirement.reserves.values())


def rejections(bounds: PairBounds, ranked: Collection[int]) -> tuple[Rejection, ...]:
    """Reasons for all motors except the ranked indices, in the order of the problem."""
    reasons: dict[int, Rejection | None] = {}
    for index, motor in enumerate(bounds.problem.motors):
        if index in ranked:
            continue
        if not bounds.known[index].any():
            gears = bounds.problem.gears
            fewest = min((missing_figures(motor, gear) for gear in gears), key=len, default=())
            detail = f"its source gives no {', '.join(fewest)}"
            reasons[index] = Rejection(motor.name, Reason.FIGURES, detail, np.inf)
        elif np.isfinite(bounds.least[index, _lightest_gear(bounds, index)]):
            detail = _mass_bound_text(bounds, index)
            reasons[index] = Rejection(motor.name, Reason.HEAVIER, detail, 0.0)
        else:
            reasons[index] = None
    unable = _infeasible_motors(
        bounds, [index for index, reason in reasons.items() if reason is None]
    )
    return tuple(reason or unable[index] for index, reason in reasons.items())


def _mass_bound_text(bounds: PairBounds, motor: int) -> str:
    gear = int(np.argmin(bounds.least[motor]))
    return f"{1e3 * bounds.least[motor, gear]:.0f} g at least{_with_gear(bounds.problem, gear)}"


def _with_gear(problem: SelectionProblem, gear: int) -> str:
    """Ending of a reason that names its gear; empty where the problem has only one."""
    if len(problem.gears) == 1:
        return ""
    chosen = problem.gears[gear]
    return " (without a gear)" if chosen == DIRECT else f" ({chosen.name})"


def _lightest_gear(bounds: PairBounds, motor: int) -> int:
    """Index of the lightest gear with known data for this motor; usually direct drive."""
    mass = np.array([gear.mass for gear in bounds.problem.gears])
    return int(np.argmin(np.where(bounds.known[motor], mass, np.inf)))


def promising_gears(bounds: PairBounds, motor: int) -> Iterable[int]:
    """The lightest gear; if none will do, also those of the smallest wheel and most torque."""
    lightest = _lightest_gear(bounds, motor)
    if np.isfinite(bounds.least[motor]).any():
        return {lightest}
    known = np.flatnonzero(bounds.known[motor]).tolist()
    gears = bounds.problem.gears
    wheel = min(known, key=lambda gear: float(bounds.spin_inertia[motor, gear]))
    gain = max(known, key=lambda gear: gears[gear].ratio * gears[gear].efficiency)
    return {lightest, wheel, gain}


class RequirementPart(NamedTuple):
    """One part of the requirement, done by the lightest modules with n drives at k incidences.

    Attributes:
        name: of the maneuver, or "the rate change".
        incidence: at which it is done [rad], shape (k,).
        time: time given [s]; inf: no limit.
        needed: smallest spin inertia that does it [kg m^2], shape (n, k); inf: none does.
        demand_ratio: ratio of the time with the largest wheel to that given, shape (n, k), or of
            the required momentum to that of the largest wheel, or of a tilt to balance to the tilt
            that this wheel can recover.
        reason: see `SlewReason`, shape (n, k).
    """

    name: str
    incidence: FloatArray
    time: float
    needed: FloatArray
    demand_ratio: FloatArray
    reason: NDArray[np.int_]

    def at(self, row: int, angle: int) -> "RequirementPart":
        """The part for one drive at one incidence, as scalars."""
        _, incidence, _, *of_each = self
        return RequirementPart(
            self.name, incidence[angle], self.time, *(one[row, angle] for one in of_each)
        )


def _infeasible_motors(bounds: PairBounds, motors: Sequence[int]) -> dict[int, Rejection]:
    """Reasons for motors that fail with promising gears; with the mass if another works."""
    if not motors:
        return {}
    problem = bounds.problem
    pairs = [(motor, gear) for motor in motors for gear in promising_gears(bounds, motor)]
    drives = drives_of(problem, np.array(pairs))
    unlimited = replace(problem.envelope, mass_max=np.inf)
    largest_of_any_mass = largest_wheel(problem, unlimited) + drives.inertia_beside_rim
    largest = largest_wheel(problem, problem.envelope) + drives.inertia_beside_rim
    if problem.requirement.spin_inertia is not None:
        largest = np.full_like(largest, problem.requirement.spin_inertia)
    parts = tuple(_parts(problem, drives, largest))
    demand_ratio = np.max([part.demand_ratio for part in parts], axis=0)
    needed = np.max([part.needed for part in parts], axis=0)
    # The least late; among those never in time, the one that needs the smallest wheel.
    score = np.where(np.isfinite(demand_ratio), demand_ratio, _NEVER * (1.0 + needed))
    reasons = {}
    for motor in motors:
        rows = np.flatnonzero(drives.motor == motor)
        first, angle = np.unravel_index(np.argmin(score[rows]), score[rows].shape)
        row = int(rows[first])
        part = max(
            (part.at(row, int(angle)) for part in parts), key=lambda part: float(part.demand_ratio)
        )
        fits = float(largest[row]) if largest[row] > drives.inertia_beside_rim[row] else 0.0
        drive = drives.take(np.array([row]))
        reason, detail = _reason(problem, drive, part, (fits, float(largest_of_any_mass[row])))
        detail += _with_gear(problem, drives.gear[row])
        if np.isfinite(bounds.least[motor]).any():
            detail = f"{detail}; {_mass_bound_text(bounds, motor)}"
        wheel_ratio = float(needed[row, angle] / max(largest[row], _NOTHING))
        # Inertia scales with the fourth power of the radius.
        limits = Candidates.of_each_material(problem, drive).limits
        radius_ratio = (_narrowest(limits)[1] / problem.envelope.outer_radius_max) ** 4
        reasons[motor] = Rejection(
            motor=problem.motors[motor].name,
            reason=reason,
            detail=detail,
            shortfall=max(min(float(demand_ratio[row, angle]), wheel_ratio), radius_ratio) - 1.0,
            needed=float(part.needed) if np.isfinite(part.needed) else None,
            largest=fits,
        )
    return reasons


def _parts(
    problem: SelectionProblem, drives: Drives, largest: FloatArray
) -> Iterator[RequirementPart]:
    """Parts of the requirement with the largest wheels that fit, their spin inertias [kg m^2]."""
    requirement, intervals = problem.requirement, incidence_intervals(problem.incidence)
    angles = np.array([(interval.low + interval.high) / 2.0 for interval in intervals])
    inertia = column(least_inertia(problem, drives, np.zeros(len(drives))).inertia)
    line, armature, wheels = columns(drives.line), drives.armature[:, None], len(problem.layout)
    shape, yaw_inertia = (len(drives), len(intervals)), problem.robot.inertia[2:, 2]
    for maneuver in requirement.maneuvers:
        incidences = (
            angles if maneuver.incidence is None else np.full(angles.shape, maneuver.incidence)
        )
        axes = np.broadcast_to(problem.layout.axes(incidences), (*shape, 3, wheels))
        task = wheel_task([maneuver], requirement, inertia, yaw_inertia, axes)
        time = float(np.asarray(task.duration).item())
        needed = smallest_spin_inertia(task, line, armature)[0]
        time_taken = wheel_slew_time(task, largest[:, None], line, armature)[0]
        demand_ratio = np.divide(
            time_taken, time, out=np.full(time_taken.shape, np.inf), where=time > 0.0
        )
        if maneuver.disturbance_text:
            # The whole demand is proportional to the tilt, and the time is not set by the user.
            demand = spin_demand(task, line, armature)
            wheel = np.minimum(largest[:, None], 0.5 / demand.coupling)
            capacity = capability(demand, np.maximum(wheel, _NOTHING)).sweep
            demand_ratio = np.divide(
                demand.sweep, capacity, out=np.full(capacity.shape, np.inf), where=capacity > 0.0
            )[0]
        if maneuver.estimated:
            # The closed forms treat a full loop as part of it in part of the time, and a swing as a
            # turn there and back.
            time = maneuver.boundary().duration
        yield RequirementPart(
            maneuver.name, incidences, time, needed, demand_ratio, slew_reason(task, line)[0]
        )
        reserve = requirement.reserve(maneuver)
        if reserve.roll > 0.0:
            axes = problem.layout.axes(incidences)
            momentum = roll_cancelling_momentum(
                reserve.roll, inertia, yaw_inertia, axes, requirement
            )
            needed = momentum / drives.top_speed[:, None]
            demand_ratio, reason = needed / largest[:, None], np.full(shape, SlewReason.SPEED)
            yield RequirementPart(
                f"a roll at lift-off in {maneuver.name}",
                incidences,
                np.inf,
                needed,
                demand_ratio,
                reason,
            )
    if requirement.rate_change is not None:
        axes = problem.layout.axes(angles)[..., :2, :]
        one_stops = requirement.detection is not None
        needed = rate_change_spin_inertia(
            requirement.rate_change, drives, inertia, axes, one_stops=one_stops
        )
        reason = np.where(np.isinf(needed), SlewReason.AXIS, SlewReason.SPEED)
        demand_ratio = needed / largest[:, None]
        yield RequirementPart("the rate change", angles, np.inf, needed, demand_ratio, reason)


def _reason(
    problem: SelectionProblem, drive: Drives, part: RequirementPart, fitting: tuple[float, float]
) -> tuple[Reason, str]:
    """The first obstacle to a single drive in the worst part for it, with figures.

    Args:
        fitting: spin inertia of the largest wheel that fits, 0 where not even a rim does, and the
            same without a mass limit [kg m^2].
    """
    fits, largest_of_any_mass = fitting
    wheel = f"{part.name} needs a wheel of {part.needed:.3g} kg m^2"
    if part.reason == SlewReason.AXIS:
        at = np.degrees(part.incidence)
        place = f"at {at:.4g} deg" if problem.layout.pairs else f"of {problem.layout.text}"
        if not problem.layout.pairs:
            place += ", whatever the motor"
        return (
            Reason.INCIDENCE,
            f"{part.name} requires momentum about an axis out of reach {place}",
        )
    if not part.demand_ratio > 1.0:
        # A wheel would fit except for its hoop stress, or for what it adds to the robot's inertia.
        limits = Candidates.of_each_material(problem, drive).limits
        rims = np.maximum(
            part.needed - drive.inertia_beside_rim, smallest_rim_inertia(limits) * (1.0 + 1e-9)
        )
        if not _any_rim(rims, replace(limits, stretch_max=np.inf)):
            # The part that the rim is too narrow to go around, if any.
            (where, radius), most = _narrowest(limits), float(np.max(limits.outer_radius_max))
            narrow = ""
            if radius > most:
                bonded = np.isfinite(limits.inner_radius_max).any()
                largest = "its bond and r_max allow" if bonded else "r_max allows"
                narrow = (
                    f": {where} its radius is at least {format_quantity(radius, 'mm')}, and "
                    f"{largest} {format_quantity(most, 'mm')}"
                )
            return Reason.ENVELOPE, f"{wheel}, and no rim of that size fits{narrow}"
        if not _any_rim(rims, limits):
            rpm = drive.overspeed[0] * 30.0 / np.pi
            return Reason.STRESS, f"{wheel}, and no rim of that size withstands {rpm:,.0f} rpm"
        return (
            Reason.OWN_WEIGHT,
            f"{wheel} on the robot alone, and with the device on it no wheel that fits suffices",
        )
    lacks_torque = part.reason == SlewReason.TORQUE
    if np.isfinite(part.needed) and not lacks_torque:
        reason = Reason.ENVELOPE if part.needed > largest_of_any_mass else Reason.MASS
        which = f"at most {fits:.3g} fits" if fits > 0.0 else "and no rim fits at all"
        return reason, f"{wheel}, {which}"
    maneuver = next(
        (maneuver for maneuver in problem.requirement.maneuvers if maneuver.name == part.name), None
    )
    best, given = f"takes {part.demand_ratio * part.time:.3g} s at best", f"{part.time:.3g} s"
    if maneuver is not None and maneuver.disturbance_text:
        milder = maneuver.milder(float(1.0 / part.demand_ratio)).disturbance_text
        best, given = f"recovers from {milder} at best", maneuver.disturbance_text
    elif np.isinf(part.demand_ratio):
        best = "is never completed"
    detail = f"{part.name} {best}, {given} given"
    return Reason.TORQUE if lacks_torque else Reason.SPEED, detail


def largest_wheel(problem: SelectionProblem, room: Envelope) -> float:
    """Spin inertia of the largest rim of any material, whatever its hoop stress [kg m^2].

    With its web, without its hub and less its cuts. It is as wide and tall as allowed, and as thick
    as its mass allows; if it must be thicker, it is lower.
    """
    density = np.array([material.density for material in problem.materials])
    outer, layer = room.outer_radius_max, np.pi * density * room.height_max
    bore = max(room.inner_radius_min, BORE_SHARE * outer)
    square = np.maximum(outer**2 - room.mass_max / layer, bore**2)
    inner = np.minimum(np.sqrt(square), outer - room.wall_min)
    mass = np.minimum(layer * (outer**2 - inner**2), room.mass_max)
    beside = np.zeros_like(inner)
    if problem.web:
        cut = problem.cuts.axial_inertia(inner, np.full_like(inner, outer), 1.0)
        web = cylinder_spin_inertia(0.0, inner, problem.web_thickness, problem.web_densities)
        beside = web - density * cut
    inertia = np.where(inner >= bore, mass * (outer**2 + inner**2) / 2.0 + beside, 0.0)
    return float(inertia.max(initial=0.0))


def _any_rim(spin_inertia: FloatArray, limits: RimLimits) -> bool:
    """Whether a rim of any material is feasible."""
    return bool((lightest_module(spin_inertia, limits, PlainDrum()).mass > 0.0).any())


def _narrowest(limits: RimLimits) -> tuple[str, float]:
    """The part that a rim must go around, and the least outer radius that results [m]."""
    around = np.asarray(limits.inner_radius_min) + limits.wall_min
    hub = "around its hub or the smallest bore allowed"
    least = {
        "around its motor's mount": float(np.asarray(limits.outer_radius_min).min()),
        hub: float(around.min()),
    }
    if np.isfinite(limits.inner_radius_max).any():
        least["around its motor's bell"] = least.pop(hub)
    return max(least.items(), key=lambda item: item[1])
