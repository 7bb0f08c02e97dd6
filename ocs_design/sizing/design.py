"""From a resolved specification to a device, by the bound alone or with a real motor."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ocs_design.common.errors import Infeasible
from ocs_design.device.device import Device
from ocs_design.device.layout import Criterion
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import LIGHTEST, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.assembly import assemble, assemble_selected
from ocs_design.sizing.bound.device_sizing import size_device
from ocs_design.sizing.limits import DEVICE_MASS
from ocs_design.sizing.placement import specified_place
from ocs_design.sizing.selection.problem import (
    SelectionProblem,
    selection_problem,
    specified_criterion,
)
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.select import select_by
from ocs_design.sizing.sized import Sized, sized_by_bound, sized_selection

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.co_design import CoDesign

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
    problem = selection_problem(specification, robot, resolved)
    if problem is None:
        designed = _by_bound(specification, robot, resolved)
    else:
        designed = _by_selection(specification, problem, advise=advise)
    device, most = designed.device, specification.ocs.mass_max
    # Nothing is lighter than the lightest: no search is needed.
    if most is None or device.mass <= most:
        return designed
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


def _by_selection(
    specification: Specification, problem: SelectionProblem, *, advise: bool
) -> Designed:
    """Modules with a motor of the catalogue each, co-designed where that is asked for."""
    criterion = specified_criterion(specification)
    selection = select_by(problem, criterion, advise=advise)
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    choice = Choice(problem, selection, selection.best, None)
    if specification.ocs.co_design:
        # CasADi takes a third of a second to import.
        from ocs_design.sizing.trajectory.co_design import co_design  # noqa: PLC0415

        found = co_design(problem, selection.best)
        choice = Choice(problem, selection, found.device, found)
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
        specified_place(stated.position, robot, resolved.envelope),
        incidence=stated.alpha,
        criterion=criterion,
    )
    return Designed(
        device=assemble(sizing, resolved),
        sized=sized_by_bound(sizing, resolved.requirement.wheel_speed_max),
        criterion=BY_HAND if stated.alpha is not None else str(criterion),
        choice=None,
    )
