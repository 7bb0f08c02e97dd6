"""Size both wheels on the robot that carries them: incidence, spin inertia and rim at once.

Where no rim meets the limits, the error says why, and which single changes would help.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, isfinite, isinf

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import Constraint, Infeasible
from ocs_design.common.units import round_outwards
from ocs_design.device.layout import Criterion
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_problem import (
    DeviceFixedPoint,
    DeviceProblem,
    best_incidences,
    braked_total,
    find_fixed_point,
)
from ocs_design.sizing.bound.rim_problem import (
    RimProblem,
    check_limits,
    lightest_rim,
    smallest_rim_inertia,
)
from ocs_design.sizing.bound.rim_program import RimSolution, solve_rim
from ocs_design.sizing.limits import (
    LARGEST_CHANGE,
    RIM_LIMITS,
    STRESS,
    TOP_SPEED,
    Limit,
    advice,
    narrowed,
    smallest_changes,
)


@dataclass(frozen=True, eq=False, kw_only=True)
class DeviceSizing(DeviceFixedPoint):
    """Two sized wheels on their robot, at the converged fixed point.

    Attributes:
        total: robot and wheels, braked, in B.
        incidence_by_criterion: the best one under each criterion, with the device [rad].
        incidence_by_criterion_robot: the same for the robot alone.
        rim: of each wheel.
        centers: of the left and the right wheel in B [m], shape (2, 3).
    """

    total: MassProperties
    incidence_by_criterion: Mapping[Criterion, float]
    incidence_by_criterion_robot: Mapping[Criterion, float]
    rim: RimSolution
    centers: FloatArray


def size_device(problem: DeviceProblem) -> DeviceSizing:
    """The lightest wheels that meet the requirement on their robot.

    The fixed point is in closed form; the convex program proves its rim.

    Raises:
        Infeasible: no rim within the envelope will do, or an axis is out of the wheels' reach.
        UsageError: the requirement is empty, or a limit is not a positive number.
    """
    check_limits(problem.envelope, problem.material, problem.requirement.wheel_speed_max)
    found = find_fixed_point(problem)
    if found.shape is None:
        raise _infeasible(problem, found)
    rim = solve_rim(problem.rim_problem(found.spin_inertia))
    return DeviceSizing(
        **vars(found),
        total=braked_total(problem, found.shape, found.incidence),
        incidence_by_criterion=best_incidences(problem, found.shape, found.incidence),
        incidence_by_criterion_robot=best_incidences(problem, None, found.incidence),
        rim=rim,
        centers=problem.place(rim.outer_radius, rim.height),
    )


PRECISION = 1e-6
"""Relative precision of the changes."""


def _infeasible(problem: DeviceProblem, dead_end: DeviceFixedPoint) -> Infeasible:
    """The error for an infeasible device, whose iteration ended there.

    It names single changes of limits that help, each verified by sizing with it.
    """
    demands = dead_end.demands
    if isinf(dead_end.spin_inertia):
        blind = next(demand for demand in demands if isinf(demand.spin_inertia))
        axes = " and ".join(blind.unreachable_axes)
        # The largest of the others: JSON has no infinity.
        finite = filter(isfinite, (demand.spin_inertia for demand in demands))
        return Infeasible(
            f"{_capitalised(blind.source)} requires {axes} momentum, which wheels at an incidence "
            f"of {degrees(blind.incidence):.4g} deg cannot provide.",
            binding=[Constraint.INCIDENCE],
            required_spin_inertia=max(finite, default=0.0),
            largest_spin_inertia=largest_spin_inertia(problem.rim_problem(1.0)),
            hint="Choose an incidence between 0 and 90 deg, another criterion, "
            "or drop the requirement about that axis.",
        )
    rim = problem.rim_problem(dead_end.spin_inertia)
    largest = largest_spin_inertia(rim)
    limits, asked_by = limits_set(rim), ""
    if problem.requirement.spin_inertia is None:
        # The wheel speed is a limit only where it affects the spin inertia.
        limits = (*limits, TOP_SPEED)
        if largest > 0.0:
            most = max(demands, key=lambda demand: demand.spin_inertia)
            asked_by = f"{most.source} requires too much: "
    found = smallest_changes(
        {limit: problem.value_of(limit) for limit in limits},
        lambda limit, value: find_fixed_point(problem.with_limit(limit, value)).shape is not None,
        precision=PRECISION / 3.0,
    )
    texts, relaxations = [], {}
    for limit, edge in found.items():
        # A little looser, as no solver can verify a value at the edge.
        value = limit.loosened(edge, 1.0 + PRECISION / 3.0)
        size_device(problem.with_limit(limit, value))
        text, relaxations[limit.name] = limit.loose_text(value), value
        if limit is STRESS:
            safety = rim.envelope.stress_safety
            # The stress to allow is reported [Pa].
            relaxations[limit.name] = rim.hoop_stress_max * safety / value
            needed = round_outwards(relaxations[limit.name] * safety / 1e6, upwards=True)
            stronger = f"a material that yields at {needed:g} MPa"
            text = stronger if value < 1.0 else f"{text} or {stronger}"
        texts.append(text)
    # All limits where the conflict is below numerical resolution.
    binding = conflicting_limits(rim) or limits_set(rim)
    return Infeasible(
        f"{_capitalised(asked_by + _shortfall(rim, binding, largest))}.",
        binding=[limit.name for limit in binding],
        required_spin_inertia=rim.spin_inertia,
        largest_spin_inertia=largest,
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
    ceiling = float(np.pi * limits.density * limits.height_max * limits.outer_radius_max**4 / 2.0)
    reached = max(float(smallest_rim_inertia(limits)) * (1.0 + 1e-9), ceiling * 1e-9)

    def fails(inertia: float) -> bool:
        return not is_feasible(replace(problem, spin_inertia=inertia))

    return 0.0 if fails(reached) else narrowed(fails, reached, ceiling * (1.0 + 1e-9), 1e-12)[0]


def _shortfall(problem: RimProblem, binding: Sequence[Limit], largest: float) -> str:
    """Clause on what is required, which limits conflict with it and how much is possible."""
    asked = f"{problem.spin_inertia:.5g} kg m^2"
    texts = [limit.text(limit.value(problem.envelope)) for limit in binding]
    room = " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))
    if largest == 0.0:
        return f"no rim at all fits within {room}, whatever its spin inertia"
    if largest > problem.spin_inertia:
        least = float(smallest_rim_inertia(problem.limits))
        return f"every rim within {room} has more spin inertia than {asked}: at least {least:.5g}"
    return (
        f"no rim of {problem.material.name} within {room} has the spin inertia of {asked}; "
        f"the limits allow {largest:.5g} kg m^2 at most"
    )


def _capitalised(text: str) -> str:
    """Text with a capital first letter and the rest as it is."""
    return text[:1].upper() + text[1:]
