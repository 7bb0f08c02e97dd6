"""From a resolved specification to a device, by the bound alone or with a real motor."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import Infeasible
from ocs_design.device.device import Device
from ocs_design.device.layout import Criterion
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import LIGHTEST, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.assembly import assemble, assemble_selected
from ocs_design.sizing.bound.device_sizing import size_device
from ocs_design.sizing.footing import Footing, footing_under, stand_on_trunk
from ocs_design.sizing.limits import DEVICE_MASS
from ocs_design.sizing.placement import specified_place
from ocs_design.sizing.selection.device import braked
from ocs_design.sizing.selection.problem import (
    SelectionProblem,
    selection_problem,
    specified_criterion,
)
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.select import at_own_incidence, lightest_by, same_parts, select_by
from ocs_design.sizing.sized import Sized, sized_by_bound, sized_selection

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.co_design import CoDesign

BY_HAND = "by hand"
"""Criterion of an incidence, or source of a spin inertia, that the user gave."""


_FOOTINGS_MAX = 6

_SETTLED = 1e-3
"""Change of a plate's mass over its device's that is none: a device's follows by a hundredth."""


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
        designed = _by_selection(specification, problem, robot, advise=advise)
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
    specification: Specification, problem: SelectionProblem, robot: Robot, *, advise: bool
) -> Designed:
    """Modules with a motor of the catalogue each, co-designed where that is asked for."""
    criterion, stated = specified_criterion(specification), specification.ocs.position is not None
    problem, selection = _on_its_footing(problem, criterion, robot, stated=stated, advise=advise)
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    choice = Choice(problem, selection, selection.best, None)
    if specification.ocs.co_design:
        # CasADi takes a third of a second to import.
        from ocs_design.sizing.trajectory.co_design import co_design  # noqa: PLC0415

        found = _with_its_plate(
            co_design(problem, selection.best), problem, selection.best, robot, stated=stated
        )
        choice = Choice(problem, selection, found.device, found)
    name = LIGHTEST if criterion is None else str(criterion)
    designed = Designed(
        device=assemble_selected(choice.chosen, problem.supply),
        sized=sized_selection(problem, choice.chosen),
        criterion=BY_HAND if specification.ocs.alpha is not None else name,
        choice=choice,
    )
    return _on_trunk(designed, robot, stated=stated)


def with_plate(candidate: Candidate, supply: Supply, robot: Robot, *, stated: bool) -> Candidate:
    """A selected device with the plate that it stands on, where the trunk does not hold it.

    Args:
        candidate: as selected; its plate is not looked at. supply: of its motors.
        robot: that carries it.
        stated: whether the modules' places are.
    """
    device = stand_on_trunk(assemble_selected(candidate, supply), robot, stated=stated)
    return replace(candidate, plate=device.plate)


def _with_plates(
    selection: Selection,
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
    *,
    stated: bool,
) -> Selection:
    """The selection with the plates that its devices stand on, the lightest with its plate first.

    Every device has a plate of its own size: that of a smaller one is lighter.

    Args:
        problem: that was solved. criterion: see `select_by`; the first is at its own incidence.
    """

    def standing(entry: Candidate) -> Candidate:
        return with_plate(entry, problem.supply, robot, stated=stated)

    plated = [standing(entry) for entry in selection.ranking]
    first, lightest = plated[0], min(plated, key=lambda entry: entry.mass)
    if lightest is not first and criterion is not None and problem.incidence is None:
        _, own = at_own_incidence(problem, lightest, criterion)
        lightest = first if own is None else standing(own)
    others = [entry for entry in plated if not same_parts(entry, lightest)]
    others.sort(key=lambda entry: entry.mass)
    return replace(selection, ranking=(lightest, *others))


def _on_its_footing(
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
    *,
    stated: bool,
    advise: bool,
) -> tuple[SelectionProblem, Selection]:
    """The selection on the footing that its best device has, and the problem that this is.

    The problem is for the plate and the place of the largest modules that there may be. The
    selection is for those of its lightest device, then only the best drive's for its own, until
    they stay. What cannot be done on its own footing, under a heavier plate, stays as it was: its
    flights and margins judge it.

    Args:
        problem: to solve. criterion, advise: see `select_by`. robot, stated: see `with_plate`.

    Raises:
        Infeasible: see `select_by`.
    """

    def own_footing(best: Candidate) -> SelectionProblem:
        """The problem for the plate and the place of this device."""
        device = assemble_selected(best, problem.supply)
        footing = footing_under(device, robot, stated=stated) or Footing(problem.place, None)
        carried = footing.carried(robot.mass_properties)
        return replace(problem, robot=carried, place=problem.place if stated else footing.place)

    first, widest = lightest_by(problem, criterion), problem
    if first is not None:
        problem = own_footing(first)
    try:
        selection = select_by(problem, criterion, advise=False)
    except Infeasible:
        problem = widest
        selection = select_by(problem, criterion, advise=advise)
    selection = _with_plates(selection, problem, criterion, robot, stated=stated)
    for _ in range(_FOOTINGS_MAX):
        best = selection.best
        own = own_footing(best)
        change = abs(own.robot.mass - problem.robot.mass)
        if own.place == problem.place and change <= _SETTLED * best.mass:
            break
        alone = replace(own, motors=(best.motor,), gears=(best.gear,))
        try:
            again = select_by(alone, criterion, advise=False)
        except Infeasible:
            break
        again, problem = _with_plates(again, alone, criterion, robot, stated=stated), own
        others = (
            entry
            for entry in selection.ranking
            if (entry.motor, entry.gear) != (best.motor, best.gear)
        )
        later = sorted((*again.ranking[1:], *others), key=lambda entry: entry.mass)
        selection = replace(selection, ranking=(again.best, *later))
    return problem, selection


def _with_its_plate(
    found: "CoDesign", problem: SelectionProblem, selected: Candidate, robot: Robot, *, stated: bool
) -> "CoDesign":
    """What the co-design found, which counted the selected device's plate, with its own one."""
    if not found.adopted:
        return found
    device = with_plate(found.device, problem.supply, robot, stated=stated)
    found = replace(found, device=device, found_mass=device.mass)
    if device.mass < selected.mass:
        return found
    note = "the selection stands: a heavier plate takes up what the wheels would save"
    return replace(found, adopted=False, note=note, device=selected)


def _on_trunk(designed: Designed, robot: Robot, *, stated: bool) -> Designed:
    """The device on the trunk itself or on a plate of its own size, and what both weigh together.

    A co-design makes the selected device smaller, and its plate with it.
    """
    assert designed.choice is not None, "wheels without motors have no feet"
    device, chosen = stand_on_trunk(designed.device, robot, stated=stated), designed.choice.chosen
    centers = np.stack([module.position for module in device.modules])
    carried = device.plated(robot.mass_properties)
    total = braked(carried, (chosen.wheel, chosen.carrier), centers, device.incidence)
    return replace(designed, device=device, sized=replace(designed.sized, total=total))


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
