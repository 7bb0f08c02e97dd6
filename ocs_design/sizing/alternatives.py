"""What would make a device lighter: single changes of the specification, and what they save.

A selection on the present device's footing quickly finds the lightest drive after a change; the
changed specification is then sized in full with that drive (docs/theory.md, The selection:
Alternatives, Trade-offs). Where the mass to save is specified, each answer is the smallest
change that saves it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import combinations, product
from math import ceil
from typing import Any

from ocs_design.actuation.motor import build_gaps
from ocs_design.common.errors import Infeasible, OcsError
from ocs_design.common.wording import degrees
from ocs_design.device.records.selection import SAVES_NOTHING, Alternative, Owed
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import DISC, RING
from ocs_design.sizing.changes import Change, Lever, changes, levers, options
from ocs_design.sizing.design import design_device
from ocs_design.sizing.limits import Progress, narrowed, smallest_factor, unseen
from ocs_design.sizing.on_robot import OnRobot
from ocs_design.sizing.selection.problem import (
    Candidate,
    SelectionProblem,
    devices_by_mass,
)
from ocs_design.sizing.selection.select import devices_at, lightest_below
from ocs_design.sizing.sized import DriveChoice
from ocs_design.sizing.specified import (
    other_construction,
    specified_criterion,
    specified_requirement,
)

_GAPS_TOLD = 2
"""Number of a motor's missing figures that fit on a line."""

_OVER = 1.05
"""Ratio of the supply to a motor's rated voltage above which the note mentions it."""

_WORTH = 0.005
"""Fraction of the mass below which a saving is not reported."""


def lighter_otherwise(
    task: Task, choice: DriveChoice | None, call: Callable[..., Callable[[], Any]] = partial
) -> Callable[[], tuple[tuple[Alternative, ...], Owed | None]]:
    """Start computing what each change would save, and which maneuver drives the mass.

    Args:
        task: the design task; what its specification already states is not offered again.
        choice: the device, and what it was chosen from; None: it has no motor.
        call: starts a call and returns the function that waits for its answer, like `Beside.call`.

    Returns:
        Function that waits for the answers; both are empty without a motor.
    """
    if choice is None:
        return lambda: ((), None)
    # The other construction takes longest.
    begun = [call(built_otherwise, task, choice)]
    begun += [call(Variant.saved, variant) for variant in variants(task, choice)]
    begun.append(call(owed_to, task, choice))

    def answers() -> tuple[tuple[Alternative, ...], Owed | None]:
        # Last one first: it is the least likely to have been started by another process.
        built, *found, owed = [each() for each in reversed(begun)][::-1]
        return (*found, *built), owed

    return answers


def _answer(text: str, device: Candidate, note: str = "") -> Alternative:
    """The device after a change, with a note for or against it."""
    return Alternative(change=text, mass_total=device.mass, motor=device.motor.name, note=note)


@dataclass(frozen=True, eq=False)
class Variant:
    """A design task with a change, and the present device that it is compared with.

    Attributes:
        text: of the change. task: with the change.
        choice: the present device, and what it was chosen from.
    """

    text: str
    task: Task
    choice: DriveChoice

    @classmethod
    def of(cls, change: Change, task: Task, choice: DriveChoice) -> "Variant | None":
        """A task with a change; None: it contradicts the task, or no motor suits it."""
        try:
            changed = task.with_specification(change.specification)
        except OcsError:
            return None
        # Kicks about the centre of mass with a device, which hardly moves.
        requirement = changed.resolved.requirement.on(choice.chosen.total)
        variant = cls(change.text, changed.asking(requirement), choice)
        return variant if variant.problem.motors else None

    @property
    def turns(self) -> bool:
        """Whether the incidence is chosen again."""
        return self.problem.incidence is None

    @cached_property
    def problem(self) -> SelectionProblem:
        """The selection's problem on the present device's footing, with its reserve.

        Without a change that concerns them, incidence, material and motors are those that the
        present device has or was chosen from.
        """
        present, chosen = self.choice.problem, self.choice.chosen
        specified, offered = self.task.specification, self.task.resolved.choice
        assert offered is not None, "there are motors to choose from"
        asked = specified_requirement(self.task)
        turns = specified_criterion(specified) is None and present.incidence is not None
        reserves = dict(present.requirement.reserves)
        for each in asked.maneuvers:
            if each.incidence == 0.0 and each.name in reserves:
                # At 0 deg no wheel takes up a rate of roll.
                kept = reserves[each.name]
                reserves[each.name] = replace(kept, rate=(0.0, kept.rate[1]), roll=0.0)
        # A motor slowed below its maker's speed stays so (`specified`).
        known = {motor.name: motor for motor in present.motors}
        motors = (known.get(motor.name, motor) for motor in offered.motors)
        same = tuple(offered.materials) == tuple(present.materials)
        return replace(
            present,
            requirement=replace(asked, reserves=reserves, free=turns),
            envelope=self.task.resolved.envelope,
            supply=offered.supply,
            motors=tuple(each for each in motors if specified.motor.any or each.name in known),
            materials=(chosen.material,) if same else offered.materials,
            incidence=None if turns else chosen.incidence,
        )

    def saved(self) -> Alternative:
        """The device with this change; the present one where it would save next to nothing."""
        chosen, hangs = self.choice.chosen, self.choice.hangs
        # Searching for a mount takes longest where there is none, and sizing a device in full
        # repeats that search several times.
        quick, most = hangs and not self.turns, (1.0 - _WORTH) * chosen.mass
        found = self.selected(most) if quick else self.lighter(most)
        if found is None:
            return _answer(self.text, chosen, SAVES_NOTHING)
        notes = ["by a quick look"] if quick else []
        return _answer(self.text, found, "; ".join([*notes, *self.notes(found)]))

    def selected(self, most: float) -> Candidate | None:
        """The lightest device on the present footing; None: it is heavier than `most` [kg]."""
        found = lightest_below(self.problem, most)
        if found is not None and not self.choice.hangs:
            found = OnRobot(self.task.robot).with_plate(found, self.problem)
        return found if found is not None and found.mass <= most else None

    def lighter(self, most: float) -> Candidate | None:
        """The device in full, with the lightest drive; None: it is heavier than `most` [kg]."""
        found, offered = self.selected(most), self.task.resolved.choice
        if found is None or offered is None:
            return None
        parts = replace(offered, motors=(found.motor,), gears=(found.gear,))
        if self.problem.materials != parts.materials:
            # Devices of different steels are much alike; trying all with every drive is slow.
            each = [replace(found, material=material) for material in parts.materials]
            built = devices_at(self.problem, each, found.incidence)
            found = devices_by_mass([found, *filter(None, built)])[0]
        parts = replace(parts, materials=(found.material,))
        asked = replace(self.task, resolved=replace(self.task.resolved, choice=parts))
        # A lighter device may be wider, and so may its plate.
        device = _whole(asked, near=found)
        return device if device is not None and device.mass <= most else None

    def notes(self, found: Candidate) -> Iterator[str]:
        """Notes on the device found, besides its mass and motor."""
        if self.turns:
            yield f"alpha {degrees(found.incidence)}"
        if found.material != self.choice.chosen.material:
            yield found.material.name
        rated = found.motor.rated_voltage
        if rated is not None and self.problem.bus_voltage > _OVER * rated:
            yield f"the motor is rated for {rated:g} V"
        gaps = build_gaps(found.motor)
        if gaps:
            yield f"not buildable: {', '.join(gaps[:_GAPS_TOLD])} not known"
        elif found.motor.name not in {motor.name for motor in self.choice.problem.motors}:
            yield "not buildable: its threads or shaft do not hold the wheel or the motor"


def _whole(task: Task, near: Candidate | None = None) -> Candidate | None:
    """The lightest device, with its own footing and reserve; None: none is feasible."""
    try:
        own = design_device(task, ranked=False, near=near)
    except Infeasible:
        return None
    return None if own.choice is None else own.choice.chosen


def built_otherwise(task: Task, choice: DriveChoice | None) -> tuple[Alternative, ...]:
    """The device with rings in place of discs, or discs in place of rings; empty if infeasible.

    It is reported whether lighter or not, unless the device has no mount. All drives are tried:
    each stands higher or lower than with the present construction, on other feet and another plate,
    so a quick selection on the present footing says little.
    """
    if choice is None or choice.hangs:
        return ()
    other = other_construction(task, choice.problem)
    if other is None:
        return ()
    text = "a disc on each motor in place of the ring around its bell"
    if other.on_bell:
        text = "a ring bonded around each motor's bell in place of the disc"
    wheel = RING if other.on_bell else DISC
    # The bell fixes the bore, which a co-design would change.
    specified = task.specification
    built = replace(specified, ocs=replace(specified.ocs, wheel=wheel, co_design=None))
    found = _whole(replace(task, specification=built))
    return () if found is None else (_answer(text, found, f"--wheel {wheel}"),)


def variants(task: Task, choice: DriveChoice) -> Iterator[Variant]:
    """The task with each single change of its specification."""
    found = (Variant.of(change, task, choice) for change in changes(task))
    return (variant for variant in found if variant is not None)


def owed_to(task: Task, choice: DriveChoice | None) -> Owed | None:
    """The maneuver without which the device would be lightest; None: there are no maneuvers."""
    if choice is None:
        return None
    chosen, asked = choice.chosen, choice.problem.requirement
    problem = replace(choice.problem, incidence=chosen.incidence, materials=(chosen.material,))
    best = (1.0 - _WORTH) * chosen.mass
    owed = Owed(maneuver="", mass_without=chosen.mass) if asked.maneuvers else None
    for maneuver in asked.maneuvers:
        rest = tuple(each for each in asked.maneuvers if each is not maneuver)
        if not rest and asked.rate_change is None and asked.spin_inertia is None:
            return Owed(maneuver=maneuver.name, mass_without=None)
        without = replace(problem, requirement=replace(asked, maneuvers=rest))
        lighter = lightest_below(without, best)
        if lighter is None:
            continue
        mass = (lighter if choice.hangs else OnRobot(task.robot).with_plate(lighter, problem)).mass
        if mass < best:
            best, owed = mass, Owed(maneuver=maneuver.name, mass_without=mass)
    return owed


MOST = 200
"""Largest change that is tried [%]."""

_BEYOND = 1.5
"""Largest factor beyond the change with which a selection is light enough until its full design is,
too."""

_SHARP = 0.005
"""Relative precision of the search for a change in whole per cent."""


def lighter_by(
    mass: float, task: Task, choice: DriveChoice, owed: str, progress: Progress = unseen
) -> tuple[Alternative, ...]:
    """Changes of the specification, each of which saves the given mass.

    Args:
        mass: mass to save [kg].
        task: task that the device was designed for. choice: the device, and what it was chosen
            from.
        owed: maneuver that drives the mass, which may be relaxed alone; empty: none.
        progress: called with the fraction done.
    """
    target = choice.chosen.mass - mass
    if target <= 0.0:
        return ()
    specified = task.specification
    task = replace(
        task, specification=replace(specified, ocs=replace(specified.ocs, co_design=None))
    )

    def answer(change: Change) -> Alternative | None:
        variant = Variant.of(change, task, choice)
        found = None if variant is None else variant.lighter(target)
        return None if found is None else _answer(change.text, found)

    def smallest(lever: Lever) -> Alternative | None:
        """The smallest sufficient change: the more is relaxed, the lighter the device."""

        @cache
        def is_light(percent: int) -> bool:
            """Whether a device on the present footing is light enough, which is quick to find."""
            variant = Variant.of(lever(percent), task, choice)
            return variant is not None and variant.selected(target) is not None

        @cache
        def at(percent: int) -> Alternative | None:
            return answer(lever(percent)) if is_light(percent) else None

        if not is_light(MOST):
            return None
        most = 1.0 + MOST / 100.0
        start, light = narrowed(lambda factor: is_light(_percent(factor)), 1.0, most, _SHARP)
        far = min(_BEYOND * light, most)
        found = smallest_factor(lambda factor: bool(at(_percent(factor))), start, far, _SHARP)
        return None if found is None else at(_percent(found))

    nothing, figures = Change("", task.specification), list(levers(task, owed))
    open_choices = list(options(task))
    found = [answer(each.on(nothing)) for each in open_choices]
    vain = [each for each, alone in zip(open_choices, found, strict=True) if alone is None]
    found += [answer(second.on(first.on(nothing))) for first, second in combinations(vain, 2)]
    for index, lever in enumerate(figures):
        found.append(smallest(lever))
        progress((index + 1) / len(figures))
    if not any(found):
        # No single figure or choice saves enough: one of each together may.
        for each, lever in product(open_choices, figures):
            found.append(smallest(each.beside(lever)))
    return tuple(answer for answer in found if answer is not None)


def _percent(factor: float) -> int:
    """A factor on a limit as a change in whole per cent, rounded up."""
    return ceil(100.0 * (factor - 1.0) - 1e-9)
