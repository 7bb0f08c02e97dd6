"""The smallest single changes of a limit with which there is a device, of all motors and gears."""

from collections.abc import Callable
from math import inf, log10, sqrt
from typing import TypeAlias

from ocs_design.sizing.limits import Limit
from ocs_design.sizing.selection.changed_limits import limits_of, with_limit, with_time
from ocs_design.sizing.selection.possibility import Field
from ocs_design.sizing.selection.problem import SelectionProblem

PRECISION = 0.03
"""Of the changes, relative: with less by more than that none of the drives that `Field.possible`
tries can do it."""

# A limit changed more than this is another project...
MOST_CHANGE = 10.0
# ... so is a mass changed more than by ten times every length. A radius, with whose fourth power
# the inertia goes, is changed less: wheels beyond may couple roll and pitch by anything, and no
# bound of what they need survives that.
_MOST_CHANGES = {"wheel_mass_max": MOST_CHANGE**3, "r_max": 7.0}


Progress: TypeAlias = Callable[[float], None]
"""Is told the share that is done."""


def unseen(share: float) -> None:
    """Progress that nobody looks at."""


def single_changes(field: Field, progress: Progress = unseen) -> dict[Limit, float]:
    """For each limit that can mend it alone the value that just does, gentlest first [SI].

    Each is proved by looking for a device again, among all motors and gears of the problem; what
    only an unlikely one of them could do may be missed (`Field.possible`).
    """
    limits = limits_of(field.problem)
    helpful = {}
    for index, (limit, now) in enumerate(limits.items()):
        value = _smallest(field, limit, now)
        if value is not None:
            helpful[limit] = value
        progress((index + 1) / len(limits))
    return dict(sorted(helpful.items(), key=lambda item: abs(log10(item[1] / limits[item[0]]))))


def slowed_maneuvers(field: Field, factor: float) -> SelectionProblem:
    """With `factor` times the time for those maneuvers that need it.

    Args:
        field: of a problem that has a solution if all have so much more time.
        factor: above 1.
    """
    problem = field.problem
    slow = [maneuver.name for maneuver in problem.requirement.maneuvers]
    for name in tuple(slow):
        fewer = set(slow) - {name}
        if fewer and field.changed(with_time(problem, factor, fewer)).possible:
            slow.remove(name)
    return with_time(problem, factor, set(slow))


def _smallest(field: Field, limit: Limit, now: float) -> float | None:
    """The value of one limit that just mends the problem; None: none does."""

    def loosened(factor: float) -> Field:
        """The problem with this limit looser by a factor."""
        value = limit.loosened(now, factor)
        return field.changed(with_limit(field.problem, limit, value))

    if not 0.0 < now < inf:
        return None
    most = _MOST_CHANGES.get(limit.name, MOST_CHANGE)
    if not loosened(most).possible:
        return None
    # Bounds are quick to tell and leave little above them to be looked for.
    ruled_out, _ = _bracket(lambda factor: loosened(factor).conceivable, 1.0, most)
    low, high = _stepped_out(lambda factor: loosened(factor).possible, ruled_out, most)
    return limit.loosened(now, _bracket(lambda factor: loosened(factor).possible, low, high)[1])


def _bracket(mends: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """Two factors next to each other, of which the larger mends and the smaller does not.

    Between one that does not, or is not tried, and one that does.
    """
    while high > (1.0 + PRECISION) * low:
        middle = sqrt(low * high)
        low, high = (low, middle) if mends(middle) else (middle, high)
    return low, high


def _stepped_out(mends: Callable[[float], bool], low: float, most: float) -> tuple[float, float]:
    """Likewise, by steps that double, from a factor that does not mend up to `most`, which does."""
    step = 1.0 + PRECISION
    while low * step < most and not mends(low * step):
        low, step = low * step, step**2
    return low, min(low * step, most)
