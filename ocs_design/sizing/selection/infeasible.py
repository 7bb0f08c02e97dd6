"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from ocs_design.exceptions import Infeasible
from ocs_design.requirement.slower import told_change
from ocs_design.sizing.limits import TIME, Limit, told_changes
from ocs_design.sizing.selection.attempt import largest_wheel
from ocs_design.sizing.selection.possibility import Field
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import rejections
from ocs_design.sizing.selection.result import Reason, Rejection
from ocs_design.sizing.selection.search import Found
from ocs_design.sizing.selection.single_changes import (
    MOST_CHANGE,
    Progress,
    single_changes,
    slowed_maneuvers,
    unseen,
)

_STATE_FIGURES = (
    "Choose another motor (`ocs-design catalogue motors` marks what is missing), or state its "
    "figures in a file of your own with --motors."
)


class Refused(Infeasible):
    """No motor can do it; what would do is not looked for yet, which takes longer than the search.

    Attributes:
        problem: that no motor solves. nearest: the motor that comes closest.
    """

    def __init__(self, found: Found) -> None:
        reasons = rejections(found, ())
        nearest = min(reasons, key=_distance)
        problem, largest = found.problem, nearest.largest
        super().__init__(
            f"{_verdict(problem, nearest)}: {nearest.detail}.",
            binding=[str(nearest.reason)],
            required_spin_inertia=nearest.needed,
            largest_spin_inertia=(
                largest_wheel(problem, problem.envelope) if largest is None else largest
            ),
            relaxations={},
        )
        self.problem, self.nearest = problem, nearest

    def advised(self, progress: Progress = unseen) -> Infeasible:
        """The same with the single changes that would do.

        Args:
            progress: is told the share that is done.
        """
        reason = self.nearest.reason
        if reason is Reason.FIGURES:
            return self._with({}, [_STATE_FIGURES])
        field = Field.of(self.problem)
        # No change of a limit mends an incidence.
        changes = {} if reason is Reason.INCIDENCE else single_changes(field, progress)
        return self._with(changes, _advice(field, reason, changes))

    def _with(self, changes: Mapping[Limit, float], advice: Iterable[str]) -> Infeasible:
        return Infeasible(
            self.message,
            binding=self.binding,
            required_spin_inertia=self.required_spin_inertia,
            largest_spin_inertia=self.largest_spin_inertia,
            relaxations={limit.name: value for limit, value in changes.items()},
            hint=" ".join(advice),
        )


def _verdict(problem: SelectionProblem, nearest: Rejection) -> str:
    """Who cannot do it, and who comes closest."""
    count, voltage = len(problem.motors), f"{problem.bus_voltage:g} V"
    if count == 1:
        return f"Motor {nearest.motor} cannot do it at {voltage}"
    return f"None of {count} motors can do it at {voltage}; {nearest.motor} comes closest"


def _distance(rejection: Rejection) -> tuple[bool, float]:
    """How far a motor is from being possible."""
    return rejection.reason is Reason.FIGURES, rejection.shortfall


def _told(field: Field, limit: Limit, value: float) -> str:
    """A change as the user states it: time is a matter of each maneuver's own keys."""
    if limit is not TIME:
        return limit.loose_text(value)
    before = field.problem.requirement.maneuvers
    after = slowed_maneuvers(field, value).requirement.maneuvers
    both = zip(before, after, strict=True)
    return " with ".join(told_change(old, new) for old, new in both if old is not new)


def _advice(field: Field, reason: Reason, changes: Mapping[Limit, float]) -> Iterator[str]:
    """What would do, in sentences."""
    if changes:
        yield told_changes([_told(field, limit, value) for limit, value in changes.items()])
    free = replace(field.problem, incidence=None)
    if field.problem.incidence is not None and field.changed(free).possible:
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
