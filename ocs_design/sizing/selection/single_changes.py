"""The smallest single changes of a limit with which there is a device, of all motors and gears."""

from math import inf, log10, sqrt

from ocs_design.sizing.limits import Limit
from ocs_design.sizing.selection.changed_limits import limits_of, with_limit, with_time
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.search import is_possible

PRECISION = 0.03
"""Of the changes, relative: no motor can do it with less by more than that."""

# A limit changed more than this is another project...
MOST_CHANGE = 10.0
# ... and so is a mass changed more than by ten times every length.
_MOST_MASS_CHANGE = MOST_CHANGE**3


def single_changes(problem: SelectionProblem) -> dict[Limit, float]:
    """For each limit that can mend it alone the value that just does, gentlest first [SI].

    Each is proved by selecting again, among all motors and gears of the problem.
    """
    limits = limits_of(problem)
    found = {limit: _smallest(problem, limit, now) for limit, now in limits.items()}
    helpful = {limit: value for limit, value in found.items() if value is not None}
    return dict(sorted(helpful.items(), key=lambda item: abs(log10(item[1] / limits[item[0]]))))


def slowed_maneuvers(problem: SelectionProblem, factor: float) -> SelectionProblem:
    """With `factor` times the time for those maneuvers that need it.

    Args:
        problem: that has a solution if all have so much more time.
        factor: above 1.
    """
    slow = [maneuver.name for maneuver in problem.requirement.maneuvers]
    for name in tuple(slow):
        fewer = set(slow) - {name}
        if fewer and is_possible(with_time(problem, factor, fewer)):
            slow.remove(name)
    return with_time(problem, factor, set(slow))


def _smallest(problem: SelectionProblem, limit: Limit, now: float) -> float | None:
    """The value of one limit that just mends the problem; None: none does."""

    def mends(factor: float) -> bool:
        """Whether there is a device with this limit looser by a factor."""
        return is_possible(with_limit(problem, limit, limit.loosened(now, factor)))

    if not 0.0 < now < inf:
        return None
    low, high = 1.0, _MOST_MASS_CHANGE if limit.name == "wheel_mass_max" else MOST_CHANGE
    if not mends(high):
        return None
    while high > (1.0 + PRECISION) * low:
        middle = sqrt(low * high)
        low, high = (low, middle) if mends(middle) else (middle, high)
    return limit.loosened(now, high)
