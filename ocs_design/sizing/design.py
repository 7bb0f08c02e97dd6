"""From a resolved specification to a device, by the bound alone or with a real motor."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import Infeasible
from ocs_design.device.device import Device
from ocs_design.device.layout import PAIR, Criterion
from ocs_design.device.records import ReserveRecord
from ocs_design.requirement.maneuver import Requirement
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import CONTAINING, LIGHTEST, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.assembly import assemble, assemble_selected
from ocs_design.sizing.bound.device_sizing import size_device
from ocs_design.sizing.footing import stand_on_trunk
from ocs_design.sizing.limits import DEVICE_MASS
from ocs_design.sizing.on_robot import in_rings, on_its_footing, with_plate
from ocs_design.sizing.placement import specified_place
from ocs_design.sizing.reserve import Reality, Reserve, account
from ocs_design.sizing.selection.device import braked, with_demands
from ocs_design.sizing.selection.problem import (
    SelectionProblem,
    selection_problem,
    specified_criterion,
)
from ocs_design.sizing.selection.result import Candidate, Selection
from ocs_design.sizing.selection.select import (
    device_at,
)
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
        reserve: that it keeps; None likewise. account: of what that comes to, and costs.
        requirement: what the robot is asked for with this device on it; None: not settled yet.
    """

    device: Device
    sized: Sized
    criterion: str
    choice: Choice | None
    reserve: Reserve | None = None
    account: Callable[[], ReserveRecord | None] = lambda: None
    requirement: Requirement | None = None

    @cached_property
    def kept(self) -> ReserveRecord | None:
        """What the reserve comes to, and costs: as long to find as the device.

        None without a motor or maneuvers.
        """
        return self.account()


KICK_ROUNDS, _KICK_SETTLED = 3, 0.01
"""How often a device is sized anew for kicks about the centre of mass that it leads to, and change
of their angular impulse, over the largest, that is none."""


def design_device(
    specification: Specification,
    robot: Robot,
    resolved: Resolved,
    *,
    advise: bool = True,
    reserve: Reserve | None = None,
) -> Designed:
    """The lightest device that meets the specification.

    A kick turns the robot about a centre of mass that the device has a part in, so that a device is
    sized for the kicks on robot and device before it, then by secants. Where they do not settle,
    the lightest device stands that was sized for no less than it has to bear.

    Args:
        specification: what was stated. robot: that carries it. resolved: what was meant.
        advise: see `select`.
        reserve: to keep for what is drawn; None: for the reliability that is specified.

    Raises:
        Infeasible: there is none.
        UsageError: nothing is asked for, or a limit is no positive number.
    """
    tried: list[tuple[float, float, Designed]] = []
    before: tuple[FloatArray, FloatArray] | None = None
    com = robot.com
    for _ in range(1 + KICK_ROUNDS):
        try:
            designed = _designed(specification, robot, resolved, advise=advise, reserve=reserve)
        except Infeasible:
            if all(short > 0.0 for short, _, _ in tried):
                raise
            break
        whole, asked = designed.sized.total, resolved.requirement
        own = asked.on(whole)
        most, change = np.abs(own.kicks).max(initial=0.0), np.abs(own.kicks - asked.kicks)
        settled = change.max(initial=0.0) <= _KICK_SETTLED * most
        short = max(most - (1.0 + _KICK_SETTLED) * np.abs(asked.kicks).max(initial=0.0), 0.0)
        designed = replace(designed, requirement=own)
        if settled:
            return designed
        tried.append((short, designed.device.mass, designed))
        found, off = whole.com, whole.com - com
        com = found
        if before is not None:
            bend = off - before[1]
            com = found - (found - before[0]) * (off @ bend) / (bend @ bend)
        before = found, off
        resolved = replace(resolved, requirement=asked.on(replace(whole, com=com)))
    return min(tried, key=lambda each: each[:2])[2]


def _designed(
    specification: Specification,
    robot: Robot,
    resolved: Resolved,
    *,
    advise: bool,
    reserve: Reserve | None,
) -> Designed:
    """The device for what is resolved; see `design_device`."""
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
        f"The lightest device that does everything weighs {DEVICE_MASS.figure(device.mass)}, all "
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
    problem, selection, reserve, nominal = on_its_footing(
        problem, criterion, robot, (reality, reserve), advise=advise
    )
    if specification.ocs.guard == CONTAINING:
        problem, selection = in_rings(problem, selection.best, criterion, robot)
        best = selection.best
        nominal = device_at(replace(problem, requirement=asked), best, best.incidence) or best
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    # The lightest on its plate need not be the one that led the search.
    best = with_demands(problem, selection.best)
    selection = replace(selection, ranking=(best, *selection.ranking[1:]))
    choice = Choice(problem, selection, best, None)
    stated = problem.layout != PAIR or specification.ocs.alpha is not None
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
        criterion=BY_HAND if stated else name,
        choice=choice,
        reserve=reserve,
        account=lambda: account(reserve, reality, problem, chosen, resized, nominal=least.mass),
    )
    return _on_trunk(designed, robot)


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
    bodies = chosen.wheel, chosen.carrier
    total = braked(carried, bodies, centers, device.incidence, device.layout)
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
