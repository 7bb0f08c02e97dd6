"""Why no device meets its requirement, and the smallest single changes that would do."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import degrees, isfinite, isinf

from ocs_design.exceptions import Infeasible
from ocs_design.requirement.bound import SpinDemand
from ocs_design.sizing.device_iteration import DeadEnd, FixedPoint, find_fixed_point
from ocs_design.sizing.device_problem import DeviceProblem
from ocs_design.sizing.limits import WHEEL_SPEED, Limit, smallest_changes
from ocs_design.sizing.relaxation import (
    advice,
    capitalised,
    in_the_way,
    largest_spin_inertia,
    limits_set,
    relaxations,
    shortfall,
)

PRECISION = 1e-4
"""Of the changes, relative: they are told to three digits, and each step sizes a whole device."""


def infeasible_device(
    problem: DeviceProblem, dead_end: DeadEnd, solve: Callable[[DeviceProblem], object]
) -> Infeasible:
    """The error for a device that cannot be.

    Args:
        problem: of the device.
        dead_end: where its iteration ended.
        solve: proves each change by sizing again with it; raises where it fails.
    """
    if isinf(dead_end.spin_inertia):
        return _out_of_reach(problem, dead_end.demands)
    rim_problem = problem.rim_problem(dead_end.spin_inertia)
    largest = largest_spin_inertia(rim_problem)
    asked_by = _asked_by(problem, dead_end.demands) if largest > 0.0 else ""
    changes = device_changes(problem)
    for limit, value in changes.items():
        solve(with_limit(problem, limit, value))
    return Infeasible(
        f"{capitalised(asked_by + shortfall(rim_problem))}.",
        binding=[limit.name for limit in in_the_way(rim_problem)],
        required_spin_inertia=dead_end.spin_inertia,
        largest_spin_inertia=largest,
        relaxations=relaxations(rim_problem, changes),
        hint=advice(rim_problem, changes),
    )


def device_changes(problem: DeviceProblem) -> dict[Limit, float]:
    """For each limit that can mend the device alone, the value that just does (SI)."""

    def mends(limit: Limit, value: float) -> bool:
        """Whether there is a device with this limit changed."""
        return isinstance(find_fixed_point(with_limit(problem, limit, value)), FixedPoint)

    values = {limit: _value(problem, limit) for limit in _limits_set(problem)}
    return smallest_changes(values, mends, PRECISION)


def with_limit(problem: DeviceProblem, limit: Limit, value: float) -> DeviceProblem:
    """The same problem with one limit changed."""
    if limit is WHEEL_SPEED:
        return replace(problem, requirement=limit.replaced(problem.requirement, value))
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def _limits_set(problem: DeviceProblem) -> tuple[Limit, ...]:
    """Those that limit anything; the wheel speed only where it decides on the spin inertia."""
    of_rim = limits_set(problem.rim_problem(1.0))
    return of_rim if problem.requirement.spin_inertia is not None else (*of_rim, WHEEL_SPEED)


def _value(problem: DeviceProblem, limit: Limit) -> float:
    if limit is WHEEL_SPEED:
        return limit.value(problem.requirement)
    return limit.value(problem.envelope)


def _asked_by(problem: DeviceProblem, demands: Sequence[SpinDemand]) -> str:
    """Who asks for the most, if it is not the user directly."""
    if problem.requirement.spin_inertia is not None:
        return ""
    most = max(demands, key=lambda demand: demand.spin_inertia)
    return f"{most.source} asks for too much: "


def _out_of_reach(problem: DeviceProblem, demands: Sequence[SpinDemand]) -> Infeasible:
    """The error for wheels that have no authority about an axis that needs momentum."""
    blind = next(demand for demand in demands if isinf(demand.spin_inertia))
    axes = " and ".join(blind.unreachable_axes)
    rim_problem = problem.rim_problem(1.0)
    return Infeasible(
        f"{capitalised(blind.source)} asks for {axes} momentum, which wheels at an incidence of "
        f"{degrees(blind.incidence):.4g} deg cannot give.",
        binding=["incidence"],
        # The largest of the others: infinity is no number in JSON.
        required_spin_inertia=max(filter(isfinite, (d.spin_inertia for d in demands)), default=0.0),
        largest_spin_inertia=largest_spin_inertia(rim_problem),
        relaxations={},
        hint="Choose an incidence between 0 and 90 deg, another criterion, "
        "or drop what asks for that axis.",
    )
