"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import sqrt

from ocs_design.common.errors import Infeasible
from ocs_design.requirement.maneuver import Balance, Maneuver
from ocs_design.requirement.sweep import change_text
from ocs_design.robot.links import listed
from ocs_design.sizing.changes import Progress, advice, smallest_changes, unseen
from ocs_design.sizing.limits import TIME, Limit
from ocs_design.sizing.selection.feasibility import Field, largest_wheel
from ocs_design.sizing.selection.needed_motor import needed_motor
from ocs_design.sizing.selection.problem import SelectionProblem, limits_of, with_limit, with_time
from ocs_design.sizing.selection.rejections import rejections
from ocs_design.sizing.selection.result import Reason
from ocs_design.sizing.selection.search import Found

PRECISION = 0.03
"""Precision of the changes, relative: with less by more than that none of the drives that
`Field.possible` tries can do it."""

MOST_CHANGE = 10.0
"""A limit changed by more than this factor is another project."""

_MOST_CHANGES = {"wheel_mass_max": MOST_CHANGE**3, "r_max": 7.0, "time": 3.0}
"""Other factors: a mass goes with the cube of every length. Three times the time of a jump is nine
times its height: beyond, a humanoid is told to fall from 145 m. A radius, with whose fourth power
the inertia goes, is changed less: wheels beyond may couple roll and pitch by anything, and no bound
of what they need survives that."""

NO_ROOM = frozenset({Reason.ENVELOPE, Reason.STRESS, Reason.MASS})
"""Reasons that are a wheel's, not a motor's."""

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
        # How far a motor is from being possible; last, those whose figures are missing.
        nearest = min(
            rejections(found, ()), key=lambda one: (one.reason is Reason.FIGURES, one.shortfall)
        )
        problem, largest = found.problem, nearest.largest
        count, voltage = len(problem.motors), f"{problem.bus_voltage:g} V"
        if (wheels := len(problem.layout)) != 2:
            voltage += " with one wheel" if wheels == 1 else f" with {wheels} wheels"
        who = (
            f"Motor {nearest.motor} cannot do it at {voltage}"
            if count == 1
            else f"None of {count} motors can do it at {voltage}; {nearest.motor} comes closest"
        )
        super().__init__(
            f"{who}: {nearest.detail}.",
            binding=[str(nearest.reason)],
            required_spin_inertia=nearest.needed,
            largest_spin_inertia=(
                largest_wheel(problem, problem.envelope) if largest is None else largest
            ),
            relaxations={},
        )
        self.problem, self.nearest = problem, nearest

    def advised(self, progress: Progress = unseen, *, default: bool = False) -> Infeasible:
        """The error with the single changes that would do.

        Args:
            progress: is told the share that is done.
            default: whether nobody asked for these maneuvers.
        """
        reason = self.nearest.reason
        changes: dict[Limit, float] = {}
        hints: Iterable[str] = [_STATE_FIGURES]
        if reason is not Reason.FIGURES:
            field = Field.of(self.problem)
            # No change of a limit mends an incidence.
            if reason is not Reason.INCIDENCE:
                changes = single_changes(field, progress)
            hints = [*_caught(field), *self._motor_hint(), *_hints(field, reason, changes)]
            if default:
                hints = [_default_hint(field, changes.get(TIME)), *hints]
        if any(kept.demand > 1.0 for kept in self.problem.requirement.reserves.values()):
            hints = [*hints, "A lower --reliability keeps less in reserve."]
        return Infeasible(
            self.message,
            binding=self.binding,
            required_spin_inertia=self.required_spin_inertia,
            largest_spin_inertia=self.largest_spin_inertia,
            relaxations={limit.name: value for limit, value in changes.items()},
            hint=" ".join(hints),
        )

    def _motor_hint(self) -> Iterator[str]:
        """What motor would do, as heavy for its torque as the nearest."""
        model = next(each for each in self.problem.motors if each.name == self.nearest.motor)
        needed = needed_motor(self.problem, model)
        if needed is not None:
            yield needed.text


def _caught(field: Field) -> Iterator[str]:
    """The largest part of what is to be balanced that the drives catch, the rest as asked."""
    requirement = field.problem.requirement
    asked = [each for each in requirement.maneuvers if isinstance(each, Balance)]

    def does(part: float) -> bool:
        """Whether there is a device for this part of it."""
        maneuvers = tuple(
            each.times(part) if isinstance(each, Balance) else each
            for each in requirement.maneuvers
        )
        less = replace(requirement, maneuvers=maneuvers)
        return field.changed(replace(field.problem, requirement=less)).possible

    low, high = 1.0 / MOST_CHANGE, 1.0
    if not asked or not does(low):
        return
    while high > (1.0 + PRECISION) * low:
        middle = sqrt(low * high)
        low, high = (middle, high) if does(middle) else (low, middle)
    told = listed([f"{each.times(low).upset} for {each.name}" for each in asked])
    yield f"With {told} there is a device."


def single_changes(field: Field, progress: Progress = unseen) -> dict[Limit, float]:
    """Values of the limits that can mend it alone and just do, gentlest first [SI].

    Each is proved by looking for a device again, among all motors and gears of the problem; what
    only an unlikely one of them could do may be missed (`Field.possible`).
    """

    def changed(limit: Limit, value: float) -> Field:
        """The drives with one limit at another value."""
        return field.changed(with_limit(field.problem, limit, value))

    return smallest_changes(
        limits_of(field.problem),
        lambda limit, value: changed(limit, value).possible,
        precision=PRECISION,
        most=lambda limit: _MOST_CHANGES.get(limit.name, MOST_CHANGE),
        conceivable=lambda limit, value: changed(limit, value).conceivable,
        progress=progress,
    )


def slowed_maneuvers(field: Field, factor: float) -> SelectionProblem:
    """The problem with `factor` times the time for those maneuvers that need it.

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


def _hints(field: Field, reason: Reason, changes: Mapping[Limit, float]) -> Iterator[str]:
    """Sentences on what would do."""
    if changes:
        texts = [_change_text(field, limit, value) for limit, value in changes.items()]
        yield advice(texts, MOST_CHANGE, "")
    layout = field.problem.layout
    if not layout.pairs and reason is Reason.INCIDENCE:
        yield (
            f"The wheels of {layout.text} do not reach every axis that is asked for: ask for "
            "less, or take another layout (--layout pair)."
        )
        return
    free = replace(field.problem, incidence=None)
    stated = layout.pairs and field.problem.incidence is not None
    if stated and field.changed(free).possible:
        yield (
            "At another incidence there is a device: leave out --alpha and choose "
            "--alpha-criterion lightest."
        )
    elif reason is Reason.INCIDENCE:
        yield (
            "Wheels at 0 deg cannot roll the trunk, wheels at 90 deg cannot pitch it: ask for one "
            "of both, or for another incidence, here or of that maneuver."
        )
    elif not changes:
        yield advice([], MOST_CHANGE, "loosen several, ask for less, or add stronger motors.")


def _default_hint(field: Field, factor: float | None) -> str:
    """Which maneuvers nobody asked for, which of them can be done, and how slowly the others.

    Args:
        field: of the problem.
        factor: times their time in which all can be done; None: not known.
    """
    problem = field.problem
    asked = problem.requirement
    fine = [
        each.name
        for each in asked.maneuvers
        if field.changed(replace(problem, requirement=replace(asked, maneuvers=(each,)))).possible
    ]
    slow = () if factor is None else slowed_maneuvers(field, factor).requirement.maneuvers
    able = [f"{each.name} ({each.summary})" for each in slow if each not in asked.maneuvers]
    texts = [
        unasked(asked.maneuvers),
        f"{listed(fine)} can be done as it is." if len(fine) == 1 else "",
        f"{listed(fine)} can be done, each by itself." if len(fine) > 1 else "",
        f"All can be done with {listed(able)}." if able else "",
    ]
    return " ".join(filter(None, texts))


def unasked(maneuvers: Sequence[Maneuver]) -> str:
    """That these are the default, and how to ask for others."""
    names = listed([each.name for each in maneuvers])
    return (
        f"Nobody asked for {names}: they are the default. State what you need with --jump-height, "
        "--tilt, --fall or --kick, and only that is asked."
    )


def _change_text(field: Field, limit: Limit, value: float) -> str:
    """A change as the user states it: time is a matter of each maneuver's own keys."""
    if limit is not TIME:
        return limit.loose_text(value)
    before = field.problem.requirement.maneuvers
    after = slowed_maneuvers(field, value).requirement.maneuvers
    both = zip(before, after, strict=True)
    return " together with ".join(change_text(old, new) for old, new in both if old is not new)
