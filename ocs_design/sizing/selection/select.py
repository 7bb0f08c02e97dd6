"""The lightest device that does everything that is required, at the best or a stated incidence."""

from dataclasses import replace
from math import pi

from ocs_design.common.errors import Infeasible
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.sizing.bound.device_problem import design_momenta
from ocs_design.sizing.selection.advice import Refused
from ocs_design.sizing.selection.bounds import cells_of
from ocs_design.sizing.selection.device import device_of
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import rejections
from ocs_design.sizing.selection.result import Candidate, Reason, Rejection, Selection
from ocs_design.sizing.selection.search import search

_CONVERGED = 1e-10
_ITERATIONS_MAX = 50
_WINNERS_MAX = 8


def select(problem: SelectionProblem, *, advise: bool = True) -> Selection:
    """The lightest devices, those of the best motors among them, and why the others fell out.

    No device of these motors, gears and materials that does every maneuver in time is lighter by
    0.1 %, at any incidence, with any rim within the envelope (docs/theory.md, The selection).

    Args:
        problem: what to choose from, and for what.
        advise: where no motor can do it, whether to look for single changes that would do, which
            takes longer than the selection; `Refused` can do so later.

    Raises:
        Infeasible: no motor can do it; says what is missing, and which single change would do.
        Refused: the same, not advised.
        UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
    """
    problem.check()
    found = search(problem)
    if not found.places:
        refused = Refused(found)
        raise refused.advised() if advise else refused
    ranking = tuple(map(device_of, found.devices))
    ranked = {rank.motor for rank in found.places}
    return Selection(
        ranking=ranking,
        rejections=rejections(found, ranked),
        candidates=int(found.known.sum())
        * len(problem.materials)
        * len(cells_of(problem.incidence)),
    )


def select_by(
    problem: SelectionProblem, criterion: Criterion | None, *, advise: bool = True
) -> Selection:
    """The lightest devices at the incidence that a criterion sets.

    The criterion looks at robot and device together, so that the incidence is solved for one
    device at a time: for the lightest, then the selection is made anew at that incidence until the
    same device wins. Where none wins at its own incidence, the lightest of those that won at
    another's leads, each at its own; what would be lighter there is not at its own incidence, and
    has fallen out. Where none of them can be at its own, the last selection stands.

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
    winners: list[Candidate] = []
    own: list[Candidate] = []
    while len(winners) < _WINNERS_MAX and not any(
        _same(selection.best, winner) for winner in winners
    ):
        winner = selection.best
        angle, found = _at_own_incidence(problem, winner, criterion)
        selection = select(replace(problem, incidence=angle), advise=advise)
        if _same(selection.best, winner):
            return selection
        winners.append(winner)
        own += [] if found is None else [found]
    if not own:
        return selection
    lightest = min(own, key=lambda candidate: candidate.mass)
    there = select(replace(problem, incidence=lightest.incidence), advise=advise)
    return _led_by(lightest, there)


def _at_own_incidence(
    problem: SelectionProblem, winner: Candidate, criterion: Criterion
) -> tuple[float, Candidate | None]:
    """The incidence [rad] that the criterion sets for the device of these parts, and that device.

    Where they make no device on the way there, the first incidence at which they do not, and None.
    """
    alone = replace(
        problem, motors=(winner.motor,), gears=(winner.gear,), materials=(winner.material,)
    )
    found, angle = winner, winner.incidence
    for _ in range(_ITERATIONS_MAX):
        momenta = design_momenta(problem.requirement, found.total.inertia)
        following = incidence_by_criterion(found.total.inertia, momenta)[criterion]
        change, angle = abs(following - angle), following
        if change < _CONVERGED:
            break
        try:
            found = select(replace(alone, incidence=min(angle, pi / 2.0)), advise=False).best
        except Infeasible:
            # Not of these parts, then: whether of others, the whole selection tells.
            return angle, None
    return angle, found


def _led_by(chosen: Candidate, selection: Selection) -> Selection:
    """Selection with this device as the best; motors that are lighter there fall out.

    Args:
        chosen: at its own incidence.
        selection: at that incidence.
    """
    heavier = [entry for entry in selection.ranking if entry.mass > chosen.mass]
    ranking = (chosen, *(entry for entry in heavier if not _same(entry, chosen)))
    listed = {entry.motor.name for entry in ranking}
    lighter = {entry.motor.name: entry.mass for entry in reversed(selection.ranking)}
    fallen = [
        Rejection(name, Reason.INCIDENCE, f"{1e3 * mass:.0f} g, at another than its own", 0.0)
        for name, mass in lighter.items()
        if name not in listed
    ]
    others = [rejection for rejection in selection.rejections if rejection.motor not in listed]
    return replace(selection, ranking=ranking, rejections=(*fallen, *others))


def _same(one: Candidate, other: Candidate) -> bool:
    return (one.motor, one.gear, one.material) == (other.motor, other.gear, other.material)
