"""The selection with the incidence by a criterion of the robot that carries the device."""

from dataclasses import replace
from math import pi

from ocs_design.exceptions import Infeasible
from ocs_design.sizing.incidence import Criterion, incidence_by_criterion
from ocs_design.sizing.selection.momenta import design_momenta
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.select import select

_SETTLED = 1e-10
_ITERATIONS_MAX = 50
_WINNERS_MAX = 8


def select_by(
    problem: SelectionProblem, criterion: Criterion | None, *, advise: bool = True
) -> Selection:
    """The lightest devices at the incidence that a criterion sets.

    The criterion looks at robot and device together, so that the incidence is settled for one
    device at a time: for the lightest, then the selection is made anew at that incidence until the
    same device wins.

    Args:
        problem: its own incidence goes first.
        criterion: None: whatever makes the device lightest.
        advise: see `select`.

    Raises:
        Infeasible, UsageError: see `select`.
    """
    if problem.incidence is not None or criterion is None:
        return select(problem, advise=advise)
    angle = incidence_by_criterion(problem.robot.inertia)[criterion]
    selection = select(replace(problem, incidence=angle), advise=advise)
    for _ in range(_WINNERS_MAX):
        winner = selection.best
        angle = _settled_angle(problem, winner, criterion)
        selection = select(replace(problem, incidence=angle), advise=advise)
        if _same(selection.best, winner):
            break
    return selection


def _settled_angle(problem: SelectionProblem, winner: Candidate, criterion: Criterion) -> float:
    """The incidence [rad] that the criterion sets for the device that it makes of these parts.

    Where they make no device on the way there, it is the first one at which they do not.
    """
    alone = replace(
        problem, motors=(winner.motor,), gears=(winner.gear,), materials=(winner.material,)
    )
    found, angle = winner, winner.incidence
    for _ in range(_ITERATIONS_MAX):
        momenta = design_momenta(problem.requirement, found.total.inertia)
        following = incidence_by_criterion(found.total.inertia, momenta)[criterion]
        change, angle = abs(following - angle), following
        if change < _SETTLED:
            break
        try:
            found = select(replace(alone, incidence=min(angle, pi / 2.0)), advise=False).best
        except Infeasible:
            # Not of these parts, then: whether of others, the whole selection tells.
            break
    return angle


def _same(one: Candidate, other: Candidate) -> bool:
    return (one.motor, one.gear, one.material) == (other.motor, other.gear, other.material)
