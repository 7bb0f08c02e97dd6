"""From a resolved specification to a device, by the bound alone or with a real motor."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.errors import Infeasible
from ocs_design.device.device import Device
from ocs_design.device.joints import burst_of
from ocs_design.device.layout import Criterion
from ocs_design.device.records import ReserveRecord
from ocs_design.device.solids import foot_of
from ocs_design.parts.foot import plate_thickness
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import CONTAINING, LIGHTEST, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.assembly import assemble, assemble_selected
from ocs_design.sizing.bound.device_sizing import size_device
from ocs_design.sizing.footing import Footing, footing_under, stand_on_trunk
from ocs_design.sizing.limits import DEVICE_MASS
from ocs_design.sizing.placement import specified_place
from ocs_design.sizing.reserve import Reality, Reserve, account
from ocs_design.sizing.selection.device import braked, of_parts, with_demands
from ocs_design.sizing.selection.problem import (
    SelectionProblem,
    selection_problem,
    specified_criterion,
)
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.select import (
    at_own_incidence,
    device_at,
    lightest_by,
    same_parts,
    select_by,
)
from ocs_design.sizing.sized import Sized, sized_by_bound, sized_selection

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.co_design import CoDesign

BY_HAND = "by hand"
"""Criterion of an incidence, or source of a spin inertia, that the user gave."""


_FOOTINGS_MAX, _RINGS_MAX = 6, 16

_SETTLED = 1e-3
"""Change of a plate's mass over its device's that is none: a device's follows by a hundredth."""

_TOO_THICK = 0.2e-3
"""Of feet that are left as they are [m]: 0.5 g each."""


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
        reserve: that it keeps; None likewise. kept: what that comes to, and costs; None without
            maneuvers too.
    """

    device: Device
    sized: Sized
    criterion: str
    choice: Choice | None
    reserve: Reserve | None = None
    kept: ReserveRecord | None = None


def design_device(
    specification: Specification,
    robot: Robot,
    resolved: Resolved,
    *,
    advise: bool = True,
    reserve: Reserve | None = None,
) -> Designed:
    """The lightest device that meets the specification.

    Args:
        specification: what was stated. robot: that carries it. resolved: what was meant.
        advise: see `select`.
        reserve: to keep for what is drawn; None: for the reliability that is specified.

    Raises:
        Infeasible: there is none.
        UsageError: nothing is asked for, or a limit is no positive number.
    """
    problem = selection_problem(specification, robot, resolved)
    if problem is None:
        designed = _by_bound(specification, robot, resolved)
    else:
        assert resolved.reliability is not None, "there are motors to choose from"
        reserve = reserve or Reserve(resolved.reliability)
        designed = _by_selection(specification, problem, robot, reserve, advise=advise)
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
    specification: Specification,
    problem: SelectionProblem,
    robot: Robot,
    reserve: Reserve,
    *,
    advise: bool,
) -> Designed:
    """Modules with a motor of the catalogue each, co-designed where that is asked for."""
    criterion = specified_criterion(specification)
    reality = Reality.of(
        specification.reality,
        robot,
        problem.requirement.standing_height,
        ballistic=specification.validation.ballistic is True,
    )
    asked = problem.requirement
    problem, selection, reserve, nominal = _on_its_footing(
        problem, criterion, robot, (reality, reserve), advise=advise
    )
    if specification.ocs.guard == CONTAINING:
        problem, selection = _in_rings(problem, selection.best, criterion, robot)
        best = selection.best
        nominal = device_at(replace(problem, requirement=asked), best, best.incidence) or best
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    # The lightest on its plate need not be the one that led the search.
    best = with_demands(problem, selection.best)
    selection = replace(selection, ranking=(best, *selection.ranking[1:]))
    choice = Choice(problem, selection, best, None)
    if specification.ocs.co_design:
        # CasADi takes a third of a second to import.
        from ocs_design.sizing.trajectory.co_design import co_design  # noqa: PLC0415

        found = _with_its_plate(co_design(problem, selection.best), problem, selection.best, robot)
        choice = Choice(problem, selection, found.device, found)
    name = LIGHTEST if criterion is None else str(criterion)
    chosen = choice.chosen

    def resized(other: Reserve) -> float | None:
        """Mass of the selected parts and the plate with another reserve [kg]."""
        asked = other.kept(problem.requirement, free=False)
        found = device_at(replace(problem, requirement=asked), selection.best, chosen.incidence)
        return None if found is None else found.modules_mass + chosen.plate_mass

    spends = any(each.demand > 1.0 for each in reserve.maneuvers.values())
    least = with_plate(nominal, problem, robot) if spends else chosen
    designed = Designed(
        device=assemble_selected(choice.chosen, problem.supply),
        sized=sized_selection(problem, choice.chosen),
        criterion=BY_HAND if specification.ocs.alpha is not None else name,
        choice=choice,
        reserve=reserve,
        kept=account(reserve, reality, problem, chosen, resized, nominal=least.mass),
    )
    return _on_trunk(designed, robot)


def with_plate(candidate: Candidate, problem: SelectionProblem, robot: Robot) -> Candidate:
    """A selected device with the plate that it stands on, where the trunk does not hold it.

    Args:
        candidate: as selected; its plate is not looked at. problem: that it was selected for.
        robot: that carries it.
    """
    device = assemble_selected(candidate, problem.supply)
    device = stand_on_trunk(device, robot, stated=problem.place.stated)
    return replace(candidate, plate=device.plate)


def _with_plates(
    selection: Selection,
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
) -> Selection:
    """The selection with the plates that its devices stand on, the lightest with its plate first.

    Every device has a plate of its own size: that of a smaller one is lighter.

    Args:
        problem: that was solved. criterion: see `select_by`; the first is at its own incidence.
    """
    plated = [with_plate(entry, problem, robot) for entry in selection.ranking]
    first, lightest = plated[0], min(plated, key=lambda entry: entry.mass)
    if lightest is not first and criterion is not None and problem.incidence is None:
        _, own = at_own_incidence(problem, lightest, criterion)
        lightest = first if own is None else with_plate(own, problem, robot)
    others = [entry for entry in plated if not same_parts(entry, lightest)]
    others.sort(key=lambda entry: entry.mass)
    return replace(selection, ranking=(lightest, *others))


def _on_its_footing(
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
    kept: tuple[Reality, Reserve],
    *,
    advise: bool,
) -> tuple[SelectionProblem, Selection, Reserve, Candidate]:
    """The selection on the footing that its best device has, with the problem that this is.

    Last come the reserve that it keeps and the lightest device without one.

    The problem is for the plate and the place of the largest modules that there may be. The
    selection is for those of its lightest device, then only the best drive's for its own, until
    they stay. What cannot be done on its own footing, under a heavier plate, stays as it was: its
    flights and margins judge it.

    Args:
        problem: to solve. criterion, advise: see `select_by`. robot: that carries it.
        kept: what is drawn and the reserve for it, which the lightest device without one settles.

    Raises:
        Infeasible: see `select_by`.
    """

    def settled(best: Candidate) -> tuple[SelectionProblem, Candidate]:
        """The problem for the footing of this device, and the device for that, until both stay."""
        at = problem
        for _ in range(_FOOTINGS_MAX):
            own = _own_footing(problem, best, robot)
            change = abs(own.robot.mass - at.robot.mass)
            same = own.place == at.place and own.foot_plate == at.foot_plate
            if same and change <= _SETTLED * best.mass:
                break
            again = device_at(own, best, best.incidence)
            if again is not None and criterion is not None and own.incidence is None:
                _, again = at_own_incidence(own, again, criterion)
            if again is None:
                break
            at, best = own, again
        return at, best

    first, widest = lightest_by(problem, criterion), problem
    if first is not None:
        problem, first = settled(first)
    nominal = select_by(problem, criterion, advise=advise).best if first is None else first
    reality, reserve = kept
    reserve = reserve.settled(reality, problem, nominal)
    free = problem.incidence is None and criterion is None
    problem, widest = (
        replace(each, requirement=reserve.kept(each.requirement, free=free))
        for each in (problem, widest)
    )
    first = device_at(problem, nominal, nominal.incidence)
    try:
        selection = select_by(problem, criterion, advise=False, winner=first)
    except Infeasible:
        problem = widest
        selection = select_by(problem, criterion, advise=advise)
    selection = _with_plates(selection, problem, criterion, robot)
    for _ in range(_FOOTINGS_MAX):
        best = selection.best
        own, _ = settled(best)
        if own is problem:
            break
        try:
            again = select_by(of_parts(own, best), criterion, advise=False)
        except Infeasible:
            break
        again, problem = _with_plates(again, own, criterion, robot), own
        others = [entry for entry in selection.ranking[1:] if not same_parts(entry, best)]
        selection = replace(selection, ranking=(again.best, *others))
    return problem, selection, reserve, nominal


def _own_footing(problem: SelectionProblem, best: Candidate, robot: Robot) -> SelectionProblem:
    """The problem for the plate, the place and the feet of this device."""
    device, stated = assemble_selected(best, problem.supply), problem.place.stated
    least, feet = plate_thickness(foot_of(device), best.modules_mass / 2.0), best.foot_plate
    # Thicker feet are a little heavier, and ask for more.
    if not least <= feet <= least + _TOO_THICK:
        feet = least
    footing = footing_under(device, robot, stated=stated) or Footing(problem.place, None)
    carried = footing.carried(robot.mass_properties)
    place = problem.place if stated else footing.place
    return replace(problem, robot=carried, place=place, foot_plate=feet)


def _in_rings(
    problem: SelectionProblem,
    best: Candidate,
    criterion: Criterion | None,
    robot: Robot,
) -> tuple[SelectionProblem, Selection]:
    """The selection with guard rings that hold the wheels of its best device, and its problem.

    All drives are weighed with rings of one wall, then the lightest with those of its own wheels,
    until no other is lighter.

    Args:
        problem: without rings. best: its lightest device, whose rings are the first wall.
        criterion: see `select_by`. robot: that carries it.

    Raises:
        Infeasible: every device is too heavy with its rings.
    """

    def ringed(best: Candidate, least: float) -> SelectionProblem:
        burst = burst_of(assemble_selected(best, problem.supply))
        own = _own_footing(problem, best, robot)
        return replace(own, guard_wall=max(least, burst.built_wall))

    at, tried = ringed(best, 0.0), set[tuple[str, str]]()
    try:
        selection = select_by(at, criterion, advise=False)
    except Infeasible as error:
        raise _unheld(at.guard_wall, error) from error
    selection = _with_plates(selection, at, criterion, robot)
    for _ in range(_RINGS_MAX):
        best = selection.best
        drive = best.motor.name, best.gear.name
        # The rings of a drive only grow, so that the last ones hold its wheels.
        own = ringed(best, best.guard_wall if drive in tried else 0.0)
        tried.add(drive)
        change = abs(own.robot.mass - at.robot.mass)
        walls = own.guard_wall == best.guard_wall and own.foot_plate == best.foot_plate
        same = own.place == at.place and walls
        if same and change <= _SETTLED * best.mass:
            break
        others = [
            entry
            for entry in selection.ranking
            if (entry.motor, entry.gear) != (best.motor, best.gear)
        ]
        alone = replace(own, motors=(best.motor,), gears=(best.gear,))
        try:
            again = select_by(alone, criterion, advise=False)
        except Infeasible as error:
            if not others:
                raise _unheld(own.guard_wall, error) from error
            selection = replace(selection, ranking=tuple(others))
            continue
        again, at = _with_plates(again, alone, criterion, robot), own
        ranking = sorted((*again.ranking, *others), key=lambda entry: entry.mass)
        selection = replace(selection, ranking=tuple(ranking))
    return at, selection


def _unheld(wall: float, error: Infeasible) -> Infeasible:
    """The error where every device is too heavy with rings that hold its wheels."""
    return Infeasible(
        f"With guard rings of {1e3 * wall:.1f} mm of steel no motor does everything: {error}",
        binding=["ocs.guard", *error.binding],
        required_spin_inertia=error.required_spin_inertia,
        largest_spin_inertia=error.largest_spin_inertia,
        relaxations=error.relaxations,
        hint="Leave out --guard containing and run it behind a wall, or allow more voltage, room "
        "or time.",
    )


def _with_its_plate(
    found: "CoDesign", problem: SelectionProblem, selected: Candidate, robot: Robot
) -> "CoDesign":
    """What the co-design found, which counted the selected device's plate, with its own one."""
    if not found.adopted:
        return found
    device = with_plate(found.device, problem, robot)
    found = replace(found, device=device, found_mass=device.mass)
    if device.mass < selected.mass:
        return found
    note = "the selection stands: a heavier plate takes up what the wheels would save"
    return replace(found, adopted=False, note=note, device=selected)


def _on_trunk(designed: Designed, robot: Robot) -> Designed:
    """The device on the trunk itself or on a plate of its own size, and what both weigh together.

    A co-design makes the selected device smaller, and its plate with it.
    """
    assert designed.choice is not None, "wheels without motors have no feet"
    chosen, place = designed.choice.chosen, designed.choice.problem.place
    device = stand_on_trunk(designed.device, robot, stated=place.stated)
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
