"""The lightest device that does everything that is required."""

from ocs_design.exceptions import UsageError
from ocs_design.sizing.rim_problem import check_limits
from ocs_design.sizing.selection.candidate import candidate
from ocs_design.sizing.selection.cells import cells_of
from ocs_design.sizing.selection.infeasible import Refused
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import rejections
from ocs_design.sizing.selection.result import Selection
from ocs_design.sizing.selection.search import search


def select(problem: SelectionProblem, *, advise: bool = True) -> Selection:
    """The lightest devices, those of the best motors among them, and why the others fell out.

    Exact for the closed forms that it rests on: no lighter device of these motors, gears and
    materials does every maneuver in time, at any incidence, with any rim within the envelope
    (docs/theory.md, The selection).

    Args:
        problem: what to choose from, and for what.
        advise: where no motor can do it, whether to look for single changes that would do, which
            takes longer than the selection; `Refused` can do so later.

    Raises:
        Infeasible: no motor can do it; says what is missing, and which single change would do.
        Refused: the same, not advised.
        UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
    """
    _check(problem)
    found = search(problem)
    if not found.places:
        refused = Refused(found)
        raise refused.advised() if advise else refused
    ranking = tuple(candidate(problem, found.lots[at.lot], at.row) for at in found.places)
    names = {ranked.motor.name for ranked in ranking}
    fallen = [i for i, motor in enumerate(problem.motors) if motor.name in names]
    angles = len(cells_of(problem.incidence))
    return Selection(
        ranking=ranking,
        rejections=rejections(found, fallen),
        candidates=int(found.known.sum()) * len(problem.materials) * angles,
    )


def _check(problem: SelectionProblem) -> None:
    """Refuse what is no question."""
    for name in ("motors", "gears", "materials"):
        if not getattr(problem, name):
            raise UsageError(f"there are no {name} to choose from")
    requirement = problem.requirement
    asked = (requirement.maneuvers, requirement.rate_change, requirement.spin_inertia)
    if not any(asked):
        raise UsageError(
            "nothing is asked of the wheels",
            hint="Ask for a rate change, for a maneuver, or for a spin inertia.",
        )
    speed = 1.0 if problem.wheel_speed_max is None else problem.wheel_speed_max
    for material in problem.materials:
        check_limits(problem.envelope, material, speed)
