"""Reasons why no rim, or no device of two rims, meets its limits, and single changes that help."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import degrees, isfinite, isinf

import numpy as np

from ocs_design.common.errors import Constraint, Infeasible
from ocs_design.common.units import round_outwards
from ocs_design.sizing.bound.device_problem import (
    DeviceFixedPoint,
    DeviceProblem,
    find_fixed_point,
)
from ocs_design.sizing.bound.rim_problem import RimProblem, lightest_rim, smallest_rim_inertia
from ocs_design.sizing.limits import (
    LARGEST_CHANGE,
    PRECISION,
    RIM_LIMITS,
    STRESS,
    TOP_SPEED,
    Limit,
    Problem,
    advice,
    narrowed,
    smallest_changes,
)

DEVICE_PRECISION = 1e-4
"""Relative precision of a device's changes: they are reported to three digits, and each step of the
search sizes a whole device."""


def infeasible_rim(problem: RimProblem, solve: Callable[[RimProblem], object]) -> Infeasible:
    """The error for an infeasible rim.

    Args:
        problem: of the rim.
        solve: verifies each change by solving with it; raises where that fails.
    """
    changes = _changes(problem, limits_set(problem), is_feasible, PRECISION)
    return _infeasible(problem, problem, changes, solve, binding=conflicting_limits(problem))


def infeasible_device(
    problem: DeviceProblem, dead_end: DeviceFixedPoint, solve: Callable[[DeviceProblem], object]
) -> Infeasible:
    """The error for an infeasible device.

    Args:
        problem: of the device.
        dead_end: where its iteration ended.
        solve: verifies each change by sizing with it; raises where that fails.
    """
    demands = dead_end.demands
    if isinf(dead_end.spin_inertia):
        blind = next(demand for demand in demands if isinf(demand.spin_inertia))
        axes = " and ".join(blind.unreachable_axes)
        # The largest of the others: JSON has no infinity.
        finite = filter(isfinite, (demand.spin_inertia for demand in demands))
        return Infeasible(
            f"{capitalised(blind.source)} requires {axes} momentum, which wheels at an incidence "
            f"of {degrees(blind.incidence):.4g} deg cannot provide.",
            binding=[Constraint.INCIDENCE],
            required_spin_inertia=max(finite, default=0.0),
            largest_spin_inertia=largest_spin_inertia(problem.rim_problem(1.0)),
            hint="Choose an incidence between 0 and 90 deg, another criterion, "
            "or drop the requirement about that axis.",
        )
    rim = problem.rim_problem(dead_end.spin_inertia)
    limits, asked_by = limits_set(rim), ""
    if problem.requirement.spin_inertia is None:
        # The wheel speed is a limit only where it affects the spin inertia.
        limits = (*limits, TOP_SPEED)
        if largest_spin_inertia(rim) > 0.0:
            most = max(demands, key=lambda demand: demand.spin_inertia)
            asked_by = f"{most.source} requires too much: "

    def possible(changed: DeviceProblem) -> bool:
        return find_fixed_point(changed).shape is not None

    changes = _changes(problem, limits, possible, DEVICE_PRECISION)
    return _infeasible(problem, rim, changes, solve, binding=in_the_way(rim), asked_by=asked_by)


def _changes(
    problem: Problem,
    limits: Sequence[Limit],
    possible: Callable[[Problem], bool],
    precision: float,
) -> dict[Limit, float]:
    """Values of single limits that just make the problem feasible [SI]."""
    found = smallest_changes(problem, limits, possible, precision=precision / 3.0)
    # A little looser, as no solver can verify a value at the edge.
    return {limit: limit.loosened(value, 1.0 + precision / 3.0) for limit, value in found.items()}


def _infeasible(
    problem: Problem,
    rim: RimProblem,
    changes: Mapping[Limit, float],
    solve: Callable[[Problem], object],
    *,
    binding: Sequence[Limit],
    asked_by: str = "",
) -> Infeasible:
    """The error with the changes that would help, each verified by solving with it."""
    texts, relaxations = [], {}
    for limit, value in changes.items():
        solve(problem.with_limit(limit, value))
        text, relaxations[limit.name] = limit.loose_text(value), value
        if limit is STRESS:
            safety = rim.envelope.stress_safety
            # The stress to allow is reported [Pa].
            relaxations[limit.name] = rim.hoop_stress_max * safety / value
            needed = round_outwards(relaxations[limit.name] * safety / 1e6, upwards=True)
            stronger = f"a material that yields at {needed:g} MPa"
            text = stronger if value < 1.0 else f"{text} or {stronger}"
        texts.append(text)
    return Infeasible(
        f"{capitalised(asked_by + shortfall(rim))}.",
        binding=[limit.name for limit in binding],
        required_spin_inertia=rim.spin_inertia,
        largest_spin_inertia=largest_spin_inertia(rim),
        relaxations=relaxations,
        hint=advice(texts, "loosen several, or require less."),
    )


def is_feasible(problem: RimProblem) -> bool:
    """Whether any rim meets the limits."""
    return bool(lightest_rim(problem.spin_inertia, problem.limits).mass > 0.0)


def limits_set(problem: RimProblem) -> tuple[Limit, ...]:
    """Limits of a rim that have an effect."""
    limited = np.isfinite(problem.hoop_stress_max)
    return tuple(
        limit
        for limit in RIM_LIMITS
        if 0.0 < limit.value(problem.envelope) < np.inf and (limit is not STRESS or limited)
    )


def conflicting_limits(problem: RimProblem) -> tuple[Limit, ...]:
    """An irreducible set of limits that makes the rim infeasible.

    The deletion filter: loosen one after the other and leave it loose if still no rim fits
    (Chinneck, Feasibility and Infeasibility in Optimization, 2008, section 6.1).
    """
    needed = []
    for limit in reversed(limits_set(problem)):
        loosest = limit.loosened(limit.value(problem.envelope), LARGEST_CHANGE)
        without = problem.with_limit(limit, loosest)
        if is_feasible(without):
            needed.append(limit)
        else:
            problem = without
    return tuple(reversed(needed))


def largest_spin_inertia(problem: RimProblem) -> float:
    """Largest spin inertia that the limits allow [kg m^2]; 0 if they allow no rim at all.

    The spin inertias that the limits allow form an interval: from any rim, a lower height and
    then a thinner wall and a smaller bore lead to the smallest one without leaving the limits.
    """
    limits = problem.limits
    ceiling = np.pi * limits.density * limits.height_max * limits.outer_radius_max**4 / 2.0
    smallest = float(smallest_rim_inertia(limits)) * (1.0 + 1e-9)
    reached = max(smallest, float(ceiling) * 1e-9)
    beyond = float(ceiling) * (1.0 + 1e-9)
    if not is_feasible(replace(problem, spin_inertia=reached)):
        return 0.0

    def fails(inertia: float) -> bool:
        return not is_feasible(replace(problem, spin_inertia=inertia))

    return narrowed(fails, reached, beyond, 1e-12)[0]


def shortfall(problem: RimProblem) -> str:
    """Clause on what is required, which limits conflict with it and how much is possible."""
    asked = f"{problem.spin_inertia:.5g} kg m^2"
    texts = [limit.text(limit.value(problem.envelope)) for limit in in_the_way(problem)]
    room = " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))
    largest = largest_spin_inertia(problem)
    if largest == 0.0:
        return f"no rim at all fits within {room}, whatever its spin inertia"
    if largest > problem.spin_inertia:
        least = float(smallest_rim_inertia(problem.limits))
        return f"every rim within {room} has more spin inertia than {asked}: at least {least:.5g}"
    return (
        f"no rim of {problem.material.name} within {room} has the spin inertia of {asked}; "
        f"the limits allow {largest:.5g} kg m^2 at most"
    )


def in_the_way(problem: RimProblem) -> Sequence[Limit]:
    """The conflicting limits; all limits where the conflict is below numerical resolution."""
    return conflicting_limits(problem) or limits_set(problem)


def capitalised(text: str) -> str:
    """Text with a capital first letter and the rest as it is."""
    return text[:1].upper() + text[1:]
