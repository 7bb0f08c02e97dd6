"""Why no rim meets its limits, and the smallest single changes that would do."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ocs_design.exceptions import Infeasible
from ocs_design.sizing.limits import (
    MOST_CHANGE,
    RIM_LIMITS,
    Limit,
    smallest_changes,
    told_changes,
)
from ocs_design.sizing.rim_closed_form import lightest_rim, smallest_spin_inertia
from ocs_design.sizing.rim_problem import RimProblem
from ocs_design.units import round_outwards


def infeasible_rim(problem: RimProblem, solve: Callable[[RimProblem], object]) -> Infeasible:
    """The error for a problem without solution.

    Args:
        problem: of the rim.
        solve: proves each change by solving with it; raises where it fails.
    """
    changes = rim_changes(problem)
    for limit, value in changes.items():
        solve(with_limit(problem, limit, value))
    return Infeasible(
        f"{capitalised(shortfall(problem))}.",
        binding=[limit.name for limit in conflicting_limits(problem)],
        required_spin_inertia=problem.spin_inertia,
        largest_spin_inertia=largest_spin_inertia(problem),
        relaxations=relaxations(problem, changes),
        hint=advice(problem, changes),
    )


def rim_changes(problem: RimProblem) -> dict[Limit, float]:
    """For each limit that can mend the rim alone, the value that just does (SI)."""

    def mends(limit: Limit, value: float) -> bool:
        """Whether there is a rim with this limit changed."""
        return is_feasible(with_limit(problem, limit, value))

    values = {limit: limit.value(problem.envelope) for limit in limits_set(problem)}
    return smallest_changes(values, mends)


def is_feasible(problem: RimProblem) -> bool:
    """Whether any rim meets the limits."""
    return bool(lightest_rim(problem.spin_inertia, problem.limits).mass > 0.0)


def with_limit(problem: RimProblem, limit: Limit, value: float) -> RimProblem:
    """The same problem with one limit changed."""
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def limits_set(problem: RimProblem) -> tuple[Limit, ...]:
    """Those that limit anything."""
    limited = np.isfinite(problem.hoop_stress_max)
    return tuple(
        limit
        for limit in RIM_LIMITS
        if 0.0 < limit.value(problem.envelope) < np.inf and (limit.name != "hoop_stress" or limited)
    )


def conflicting_limits(problem: RimProblem) -> tuple[Limit, ...]:
    """A set of limits that forbids the rim and of which none can be spared.

    The deletion filter: loosen one after the other and leave it so if no rim fits even then
    (Chinneck, Feasibility and Infeasibility in Optimization, 2008, section 6.1).
    """
    needed = []
    for limit in reversed(limits_set(problem)):
        loosest = limit.loosened(limit.value(problem.envelope), MOST_CHANGE)
        without = with_limit(problem, limit, loosest)
        if is_feasible(without):
            needed.append(limit)
        else:
            problem = without
    return tuple(reversed(needed))


def largest_spin_inertia(problem: RimProblem) -> float:
    """The largest that the limits allow [kg m^2]; 0 if they allow no rim at all.

    The spin inertias that the limits allow form an interval: from any rim, a lower height and
    then a thinner wall and a smaller bore lead to the smallest one without leaving the limits.
    """
    limits = problem.limits
    ceiling = np.pi * limits.density * limits.height_max * limits.outer_radius_max**4 / 2.0
    smallest = float(smallest_spin_inertia(limits)) * (1.0 + 1e-9)
    reached = max(smallest, float(ceiling) * 1e-9)
    beyond = float(ceiling) * (1.0 + 1e-9)
    if not is_feasible(replace(problem, spin_inertia=reached)):
        return 0.0
    while beyond - reached > 1e-12 * reached:
        middle = (reached + beyond) / 2.0
        if not reached < middle < beyond:
            break
        if is_feasible(replace(problem, spin_inertia=middle)):
            reached = middle
        else:
            beyond = middle
    return reached


def shortfall(problem: RimProblem) -> str:
    """What is asked for, what stands against it and how much is possible, without a full stop."""
    asked = f"{problem.spin_inertia:.5g} kg m^2"
    room = _listed([limit.text(limit.value(problem.envelope)) for limit in in_the_way(problem)])
    largest = largest_spin_inertia(problem)
    if largest == 0.0:
        return f"no rim at all fits within {room}, whatever its spin inertia"
    if largest > problem.spin_inertia:
        least = float(smallest_spin_inertia(problem.limits))
        return f"every rim within {room} has more spin inertia than {asked}: at least {least:.5g}"
    return (
        f"no rim of {problem.material.name} within {room} has the spin inertia of {asked}; "
        f"the limits allow {largest:.5g} kg m^2 at most"
    )


def in_the_way(problem: RimProblem) -> Sequence[Limit]:
    """The limits that conflict; all of them where the demand is beyond what can be told apart."""
    return conflicting_limits(problem) or limits_set(problem)


def relaxations(problem: RimProblem, changes: Mapping[Limit, float]) -> dict[str, float]:
    """The changes by name in SI units; of the hoop stress, the stress to allow [Pa]."""
    return {
        limit.name: _allowed_stress(problem, value) if limit.name == "hoop_stress" else value
        for limit, value in changes.items()
    }


def advice(problem: RimProblem, changes: Mapping[Limit, float]) -> str:
    """The changes as a sentence."""
    if not changes:
        return (
            f"No single limit would do, not even changed {MOST_CHANGE:.0f}-fold: "
            "loosen several, or ask for less."
        )
    texts = [_change_text(problem, limit, value) for limit, value in changes.items()]
    return told_changes(texts)


def _change_text(problem: RimProblem, limit: Limit, value: float) -> str:
    if limit.name != "hoop_stress":
        return limit.loose_text(value)
    needed = _allowed_stress(problem, value) * problem.envelope.stress_safety
    stronger = f"a material that yields at {round_outwards(needed / 1e6, upwards=True):g} MPa"
    return stronger if value < 1.0 else f"{limit.loose_text(value)} or {stronger}"


def _allowed_stress(problem: RimProblem, stress_safety: float) -> float:
    return problem.hoop_stress_max * problem.envelope.stress_safety / stress_safety


def capitalised(text: str) -> str:
    """With a capital first letter and the rest as it is."""
    return text[:1].upper() + text[1:]


def _listed(words: Sequence[str]) -> str:
    """One, two and three."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))
