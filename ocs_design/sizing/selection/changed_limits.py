"""A selection with one of its limits changed."""

from dataclasses import replace

from ocs_design.requirement.slower import slower
from ocs_design.sizing.limits import BUS_VOLTAGE, RIM_LIMITS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.selection.problem import SelectionProblem


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Every limit that may be in the way, as it is [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.bus_voltage,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The same problem with one limit changed."""
    if limit is BUS_VOLTAGE:
        return replace(problem, bus_voltage=value)
    if limit is WHEEL_SPEED:
        return replace(problem, wheel_speed_max=value)
    if limit is TIME:
        names = {maneuver.name for maneuver in problem.requirement.maneuvers}
        return with_time(problem, value, names)
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def with_time(problem: SelectionProblem, factor: float, names: set[str]) -> SelectionProblem:
    """The same problem with `factor` times the time for the maneuvers of these names."""
    requirement = problem.requirement
    maneuvers = tuple(
        slower(maneuver, factor, requirement.standing_height)
        if maneuver.name in names
        else maneuver
        for maneuver in requirement.maneuvers
    )
    return replace(problem, requirement=replace(requirement, maneuvers=maneuvers))
