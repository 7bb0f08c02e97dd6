"""From a resolved specification to a device, by the bound alone or with a real motor."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ocs_design.assembly import assemble, assemble_selected
from ocs_design.design import Device
from ocs_design.exceptions import Infeasible
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import LIGHTEST, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.device_sizing import size_device
from ocs_design.sizing.free_place import stated_place
from ocs_design.sizing.incidence import Criterion
from ocs_design.sizing.limits import DEVICE_MASS
from ocs_design.sizing.selection.by_criterion import select_by
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.sized import sized_selection
from ocs_design.sizing.selection.stated import selection_problem, stated_criterion
from ocs_design.sizing.sized import Sized, sized_by_bound

if TYPE_CHECKING:
    from ocs_design.sizing.co_design.problem import CoDesign

BY_HAND = "by hand"
"""Criterion of an incidence, or source of a spin inertia, that the user gave."""


@dataclass(frozen=True, eq=False)
class Choice:
    """How motor, gear and material were chosen.

    Attributes:
        problem: what there was to choose from. selection: what came of it.
        chosen: the lightest one, or what the co-design made of it.
        co_design: None: not asked for.
    """

    problem: SelectionProblem
    selection: Selection
    chosen: Candidate
    co_design: "CoDesign | None"


@dataclass(frozen=True, eq=False)
class Designed:
    """A device and the figures behind it.

    Attributes:
        device: see `Device`. sized: see `Sized`.
        criterion: that the incidence goes by.
        choice: None where no motor was wanted.
    """

    device: Device
    sized: Sized
    criterion: str
    choice: Choice | None


def design_device(
    specification: Specification, robot: Robot, resolved: Resolved, *, advise: bool = True
) -> Designed:
    """The lightest device that meets the specification.

    Args:
        specification: what was stated. robot: that carries it. resolved: what was meant.
        advise: see `select`.

    Raises:
        Infeasible: there is none.
        UsageError: nothing is asked for, or a limit is no positive number.
    """
    designed = _lightest(specification, robot, resolved, advise=advise)
    if specification.ocs.mass_max is not None:
        _check_mass(designed.device, specification.ocs.mass_max)
    return designed


def _check_mass(device: Device, most: float) -> None:
    """Nothing is lighter than the lightest: no search is needed."""
    if device.mass <= most:
        return
    raise Infeasible(
        f"The lightest device that does everything weighs {DEVICE_MASS.figure(device.mass)}, both "
        f"modules: ocs.mass_max allows {DEVICE_MASS.figure(most)}.",
        binding=[DEVICE_MASS.name],
        required_spin_inertia=device.flywheel.spin_inertia,
        largest_spin_inertia=device.flywheel.spin_inertia,
        relaxations={DEVICE_MASS.name: device.mass},
        hint=f"{DEVICE_MASS.loose_text(device.mass)} would do. Without this limit `size` tells "
        "what makes it lighter: more room, voltage or time.",
    )


def _lightest(
    specification: Specification, robot: Robot, resolved: Resolved, *, advise: bool
) -> Designed:
    """Whatever it weighs."""
    problem = selection_problem(specification, robot, resolved)
    if problem is None:
        return _by_bound(specification, robot, resolved)
    criterion = stated_criterion(specification)
    selection = select_by(problem, criterion, advise=advise)
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    choice = _choice(problem, selection, refine=bool(specification.ocs.co_design))
    name = LIGHTEST if criterion is None else str(criterion)
    return Designed(
        device=assemble_selected(choice.chosen, problem.bus_voltage),
        sized=sized_selection(problem, choice.chosen),
        criterion=BY_HAND if specification.ocs.alpha is not None else name,
        choice=choice,
    )


def _by_bound(specification: Specification, robot: Robot, resolved: Resolved) -> Designed:
    """Wheels alone, for the highest speed stated or assumed.

    See docs/theory.md, Lower bound on the wheels' inertia.
    """
    stated = specification.ocs
    criterion = Criterion(stated.alpha_criterion or Criterion.EQUAL_RATE)
    sizing = size_device(
        robot.mass_properties,
        resolved.requirement,
        resolved.envelope,
        resolved.material,
        stated_place(stated.position, robot, resolved.envelope),
        incidence=stated.alpha,
        criterion=criterion,
    )
    return Designed(
        device=assemble(sizing, resolved),
        sized=sized_by_bound(sizing, resolved.requirement.wheel_speed_max),
        criterion=BY_HAND if stated.alpha is not None else str(criterion),
        choice=None,
    )


def _choice(problem: SelectionProblem, selection: Selection, *, refine: bool) -> Choice:
    if not refine:
        return Choice(problem, selection, selection.best, None)
    # CasADi takes a third of a second to import.
    from ocs_design.sizing.co_design.adopted import adopted  # noqa: PLC0415
    from ocs_design.sizing.co_design.problem import CoDesignProblem  # noqa: PLC0415
    from ocs_design.sizing.co_design.solving import co_design  # noqa: PLC0415

    question = CoDesignProblem(problem, selection.best)
    found = co_design(question)
    return Choice(problem, selection, adopted(question, found), found)
