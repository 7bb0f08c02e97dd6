"""Why motors fell out: one reason each, at the most promising gear and incidence, with figures."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import missing_figures
from ocs_design.drive.wheel_pair import SlewReason
from ocs_design.sizing.housing import PlainDrum
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.rim_problem import RimLimits
from ocs_design.sizing.selection.attempt import Attempt, Part, attempt
from ocs_design.sizing.selection.drive_table import drive_table
from ocs_design.sizing.selection.lot import rim_limits
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Reason, Rejection
from ocs_design.sizing.selection.search import Found
from ocs_design.units import format_quantity

# Beyond any time that is finite.
_NEVER = 1e9
# Smaller than any wheel [kg m^2].
_NOTHING = 1e-15


def rejections(found: Found, ranked: Collection[int]) -> tuple[Rejection, ...]:
    """Of all motors but those of these indices, in the order of the problem."""
    others = [index for index in range(len(found.problem.motors)) if index not in ranked]
    unknown = [index for index in others if not found.known[index].any()]
    heavier = [
        index for index in others if np.isfinite(found.least[index, _lightest_gear(found, index)])
    ]
    reasons = {index: _unknown(found.problem, index) for index in unknown}
    reasons |= {index: _heavier(found, index) for index in heavier}
    reasons |= _impossible(found, [index for index in others if index not in reasons])
    return tuple(reasons[index] for index in others)


def promising_gears(found: Found, motor: int) -> Iterable[int]:
    """The lightest; if no gear will do, also those that ask for the least wheel or push hardest."""
    lightest = _lightest_gear(found, motor)
    if np.isfinite(found.least[motor]).any():
        return {lightest}
    known = np.flatnonzero(found.known[motor]).tolist()
    gears = found.problem.gears
    wheel = min(known, key=lambda gear: float(found.spin_inertia[motor, gear]))
    gain = max(known, key=lambda gear: gears[gear].ratio * gears[gear].efficiency)
    return {lightest, wheel, gain}


def _lightest_gear(found: Found, motor: int) -> int:
    """Of those whose figures are known with this motor; as a rule, none: direct drive."""
    mass = np.array([gear.mass for gear in found.problem.gears])
    return int(np.argmin(np.where(found.known[motor], mass, np.inf)))


def _unknown(problem: SelectionProblem, index: int) -> Rejection:
    """Its source does not give what any of the gears needs."""
    motor = problem.motors[index]
    fewest = min((missing_figures(motor, gear) for gear in problem.gears), key=len, default=())
    return Rejection(motor.name, Reason.FIGURES, f"its source gives no {', '.join(fewest)}", np.inf)


def _heavier(found: Found, index: int) -> Rejection:
    """It may be able to do it, but not as lightly."""
    return Rejection(found.problem.motors[index].name, Reason.HEAVIER, _at_least(found, index), 0.0)


def _at_least(found: Found, index: int) -> str:
    gear = int(np.argmin(found.least[index]))
    mass = 1e3 * found.least[index, gear]
    return f"{mass:.0f} g at least ({found.problem.gears[gear].name})"


def _impossible(found: Found, motors: Sequence[int]) -> dict[int, Rejection]:
    """Of motors that cannot do it with their lightest gear; what others might weigh is added."""
    if not motors:
        return {}
    pairs = [(m, g) for m in motors for g in promising_gears(found, m)]
    tried = attempt(found.problem, found.floor, drive_table(found.problem, np.array(pairs)))
    # The least late; of those that are never in time, what needs the least wheel.
    score = np.where(np.isfinite(tried.late), tried.late, _NEVER * (1.0 + tried.needed))
    reasons = {}
    for motor in motors:
        rows = np.flatnonzero(tried.drives.motor == motor)
        row, angle = np.unravel_index(np.argmin(score[rows]), score[rows].shape)
        reasons[motor] = _rejection(found.problem, tried, int(rows[row]), int(angle))
        if np.isfinite(found.least[motor]).any():
            detail = f"{reasons[motor].detail}; {_at_least(found, motor)}"
            reasons[motor] = replace(reasons[motor], detail=detail)
    return reasons


def _rejection(problem: SelectionProblem, tried: Attempt, row: int, angle: int) -> Rejection:
    """Of the drive of this row at this incidence."""
    part = max(tried.parts, key=lambda part: float(part.late[row, angle]))
    reason, detail = _reason(problem, tried, part, row, angle)
    motor, gear = (problem.motors[tried.drives.motor[row]], problem.gears[tried.drives.gear[row]])
    beyond = float(tried.needed[row, angle] / max(tried.largest[row], _NOTHING))
    needed = float(part.needed[row, angle])
    return Rejection(
        motor=motor.name,
        reason=reason,
        detail=f"{detail} ({gear.name})",
        shortfall=min(float(tried.late[row, angle]), beyond) - 1.0,
        needed=needed if np.isfinite(needed) else None,
        largest=_largest(tried, row),
    )


def _largest(tried: Attempt, row: int) -> float:
    """Spin inertia of the largest wheel that fits [kg m^2]; 0 where not even a rim does."""
    largest = float(tried.largest[row])
    return largest if largest > float(tried.drives.beside_rim[row]) else 0.0


def _reason(
    problem: SelectionProblem, tried: Attempt, part: Part, row: int, angle: int
) -> tuple[Reason, str]:
    """The first thing that is in the way of this part."""
    needed, late = float(part.needed[row, angle]), float(part.late[row, angle])
    wheel = f"{part.name} needs a wheel of {needed:.3g} kg m^2"
    if part.reason[row, angle] == SlewReason.AXIS:
        at = np.degrees(part.incidence[angle])
        return Reason.INCIDENCE, f"{part.name} asks for an axis out of reach at {at:.4g} deg"
    if not late > 1.0:
        return _too_fast_or_heavy(problem, tried, row, wheel, needed)
    weak = part.reason[row, angle] == SlewReason.TORQUE
    if np.isfinite(needed) and not weak:
        light = needed > tried.weighty[row]
        largest = _largest(tried, row)
        room = f"{wheel}, " + (f"{largest:.3g} fits" if largest > 0.0 else "and no rim fits at all")
        return Reason.ENVELOPE if light else Reason.MASS, room
    best = f"{late * part.time:.3g} s at best" if np.isfinite(late) else "never in time"
    detail = f"{best} for {part.name}, {part.time:.3g} s given"
    return Reason.TORQUE if weak else Reason.SPEED, detail


def _too_fast_or_heavy(
    problem: SelectionProblem, tried: Attempt, row: int, wheel: str, needed: float
) -> tuple[Reason, str]:
    """A wheel would fit, but for its hoop stress, or for what it adds to the robot's inertia."""
    kinds = np.arange(len(problem.materials))
    overspeed = np.full(kinds.size, tried.drives.overspeed[row])
    hub, mount = (
        np.full(kinds.size, radius[row])
        for radius in (tried.drives.hub_radius, tried.drives.mount_reach)
    )
    limits = rim_limits(problem, kinds, overspeed, hub, mount)
    least = smallest_spin_inertia(limits) * (1.0 + 1e-9)
    rims = np.maximum(needed - tried.drives.beside_rim[row], least)
    if not _any_rim(rims, replace(limits, stretch_max=np.inf)):
        return Reason.ENVELOPE, f"{wheel}, and no rim of that size fits{_too_narrow(limits)}"
    if not _any_rim(rims, limits):
        rpm = overspeed[0] * 30.0 / np.pi
        return Reason.STRESS, f"{wheel}, and no rim of that size stands {rpm:,.0f} rpm"
    return Reason.OWN_WEIGHT, f"{wheel} on the robot alone, and none that fits with its device"


def _any_rim(spin_inertia: FloatArray, limits: RimLimits) -> bool:
    """Of any material."""
    return bool((lightest_module(spin_inertia, limits, PlainDrum()).mass > 0.0).any())


def _too_narrow(limits: RimLimits) -> str:
    """What leaves no radius below the largest, as a clause; empty where something does."""
    least, most = np.asarray(limits.outer_radius_min), float(np.asarray(limits.outer_radius_max))
    around = np.asarray(limits.inner_radius_min) + limits.wall_min
    narrowest = {"around its motor's mount": least.min(), "around its hub and bore": around.min()}
    where, radius = max(narrowest.items(), key=lambda item: float(item[1]))
    if radius <= most:
        return ""
    return (
        f": {where} it has a radius of {format_quantity(float(radius), 'mm')} at the least, r_max "
        f"is {format_quantity(most, 'mm')}"
    )
