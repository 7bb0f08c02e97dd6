"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from ocs_design.exceptions import Infeasible
from ocs_design.requirement.slower import told_change
from ocs_design.sizing.limits import TIME, Limit
from ocs_design.sizing.selection.attempt import largest_wheel
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import rejections
from ocs_design.sizing.selection.result import Reason, Rejection
from ocs_design.sizing.selection.search import Found, is_possible
from ocs_design.sizing.selection.single_changes import (
    MOST_CHANGE,
    single_changes,
    slowed_maneuvers,
)

# What no change of a limit mends.
_NO_LIMIT = {Reason.FIGURES, Reason.INCIDENCE}


def infeasible(found: Found, *, advise: bool) -> Infeasible:
    """The error for a problem that no motor solves; looks for changes that would do if asked to."""
    problem = found.problem
    reasons = rejections(found, ())
    nearest = min(reasons, key=_distance)
    looking = advise and nearest.reason not in _NO_LIMIT
    changes = single_changes(problem) if looking else {}
    many = f"none of {len(reasons)} motors" if len(reasons) > 1 else f"motor {nearest.motor}"
    verdict = "can do it" if len(reasons) > 1 else "cannot do it"
    comes = f"; {nearest.motor} comes closest" if len(reasons) > 1 else ""
    largest = nearest.largest
    if largest is None:
        largest = largest_wheel(problem, problem.envelope)
    return Infeasible(
        f"{many[0].upper()}{many[1:]} {verdict} at {problem.bus_voltage:g} V{comes}: "
        f"{nearest.detail}.",
        binding=[str(nearest.reason)],
        required_spin_inertia=nearest.needed,
        largest_spin_inertia=largest,
        relaxations={limit.name: value for limit, value in changes.items()},
        hint=" ".join(_advice(problem, nearest.reason, changes)) if advise else "",
    )


def _distance(rejection: Rejection) -> tuple[bool, float]:
    """How far a motor is from being possible."""
    return rejection.reason is Reason.FIGURES, rejection.shortfall


def _told(problem: SelectionProblem, limit: Limit, value: float) -> str:
    """A change as the user states it: time is a matter of each maneuver's own keys."""
    if limit is not TIME:
        return limit.loose_text(value)
    before = problem.requirement.maneuvers
    after = slowed_maneuvers(problem, value).requirement.maneuvers
    both = zip(before, after, strict=True)
    return " with ".join(told_change(old, new) for old, new in both if old is not new)


def _advice(
    problem: SelectionProblem, reason: Reason, changes: Mapping[Limit, float]
) -> Iterator[str]:
    """What would do, in sentences."""
    if reason is Reason.FIGURES:
        yield (
            "Choose another motor (`ocs-design catalogue motors` marks what is missing), or state "
            "its figures in a file of your own with --motors."
        )
        return
    if changes:
        texts = [_told(problem, limit, value) for limit, value in changes.items()]
        yield f"Any one of these alone would do: {'; '.join(texts)}."
    freed = problem.incidence is not None and is_possible(replace(problem, incidence=None))
    if freed:
        yield (
            "At another incidence there is a device: leave out --alpha and --alpha-criterion, or "
            "choose --alpha-criterion lightest."
        )
    elif reason is Reason.INCIDENCE:
        yield (
            "Wheels at 0 deg cannot roll the trunk, wheels at 90 deg cannot pitch it: ask for one "
            "of both, or for another incidence, here or of that maneuver."
        )
    elif not changes:
        yield (
            f"No single limit would do, not even changed {MOST_CHANGE:.0f}-fold: "
            "loosen several, ask for less, or add stronger motors."
        )
