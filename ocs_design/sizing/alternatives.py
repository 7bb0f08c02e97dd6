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
from ocs_design.device.records.selection import SAVES_NOTHING, Alternative, DrivingManeuver
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import DISC, RING
from ocs_design.sizing.changes import Change, Lever, changes, levers, options
from ocs_design.sizing.design import design_device
from ocs_design.sizing.limits import Progress, ignore_progress, narrowed, smallest_factor
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

_GAPS_SHOWN = 2
"""Number of a motor's missing figures that a note names."""

_OVERVOLTAGE_NOTED = 1.05
"""Ratio of supply voltage to rated voltage above which a note mentions the rating."""

_LEAST_SAVING = 0.005
"""Savings below this fraction of the device's mass are not reported."""


def start_alternatives(
    task: Task, choice: DriveChoice | None, call: Callable[..., Callable[[], Any]] = partial
) -> Callable[[], tuple[tuple[Alternative, ...], DrivingManeuver | None]]:
    """Start computing what each change would save, and which maneuver drives the mass.

    What the task's specification already states is not offered again. `call` starts a call and
    returns the function that waits for its answer, like `WorkerPool.call`; the result is such a
    function too. Both answers are empty without a motor.
    """
    if choice is None:
        return lambda: ((), None)
    # The other construction takes longest.
    pending = [call(alternative_construction, task, choice)]
    pending += [call(Variant.alternative, variant) for variant in variants(task, choice)]
    pending.append(call(find_driving_maneuver, task, choice))

    def answers() -> tuple[tuple[Alternative, ...], DrivingManeuver | None]:
        # Last one first: it is the least likely to have been started by another process.
        construction, *changes, driving_maneuver = [wait() for wait in reversed(pending)][::-1]
        return (*changes, *construction), driving_maneuver

    return answers


def _alternative(text: str, device: Candidate, note: str = "") -> Alternative:
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
        variant = cls(change.text, changed.with_requirement(requirement), choice)
        return variant if variant.problem.motors else None

    @property
    def incidence_is_free(self) -> bool:
        """Whether the change leaves the incidence to be chosen again."""
        return self.problem.incidence is None

    @cached_property
    def problem(self) -> SelectionProblem:
        """The selection's problem on the present device's footing, with its reserve.

        Without a change that concerns them, incidence, material and motors are those that the
        present device has or was chosen from.
        """
        present, chosen = self.choice.problem, self.choice.chosen
        specified, parts = self.task.specification, self.task.resolved.choice
        assert parts is not None, "there are motors to choose from"
        requirement = specified_requirement(self.task)
        incidence_is_free = specified_criterion(specified) is None and present.incidence is not None
        reserves = dict(present.requirement.reserves)
        for maneuver in requirement.maneuvers:
            if maneuver.incidence == 0.0 and maneuver.name in reserves:
                # At 0 deg no wheel takes up a rate of roll.
                reserve = reserves[maneuver.name]
                reserves[maneuver.name] = replace(reserve, rate=(0.0, reserve.rate[1]), roll=0.0)
        # A motor slowed below its maker's speed stays so (`specified`).
        present_motors = {motor.name: motor for motor in present.motors}
        motors = (present_motors.get(motor.name, motor) for motor in parts.motors)
        same_materials = tuple(parts.materials) == tuple(present.materials)
        return replace(
            present,
            requirement=replace(
                requirement, reserves=reserves, incidence_is_free=incidence_is_free
            ),
            envelope=self.task.resolved.envelope,
            supply=parts.supply,
            motors=tuple(
                motor for motor in motors if specified.motor.any or motor.name in present_motors
            ),
            materials=(chosen.material,) if same_materials else parts.materials,
            incidence=None if incidence_is_free else chosen.incidence,
        )

    def alternative(self) -> Alternative:
        """Device with this change; the present one where the change saves next to nothing."""
        chosen = self.choice.chosen
        # Searching for a mount takes longest where there is none, and sizing a device in full
        # repeats that search several times.
        quick = self.choice.lacks_mount and not self.incidence_is_free
        mass_max = (1.0 - _LEAST_SAVING) * chosen.mass
        device = self.quick_selection(mass_max) if quick else self.full_design(mass_max)
        if device is None:
            return _alternative(self.text, chosen, SAVES_NOTHING)
        notes = ["by a quick look"] if quick else []
        return _alternative(self.text, device, "; ".join([*notes, *self.notes(device)]))

    def quick_selection(self, mass_max: float) -> Candidate | None:
        """The lightest device on the present footing; None: heavier than `mass_max` [kg]."""
        device = lightest_below(self.problem, mass_max)
        if device is not None and not self.choice.lacks_mount:
            device = OnRobot(self.task.robot).with_plate(device, self.problem)
        return device if device is not None and device.mass <= mass_max else None

    def full_design(self, mass_max: float) -> Candidate | None:
        """The device sized in full, with the lightest drive; None: heavier than `mass_max` [kg]."""
        found, offered = self.quick_selection(mass_max), self.task.resolved.choice
        if found is None or offered is None:
            return None
        parts = replace(offered, motors=(found.motor,), gears=(found.gear,))
        if self.problem.materials != parts.materials:
            # Devices of different steels are much alike; trying all with every drive is slow.
            of_each_material = [replace(found, material=material) for material in parts.materials]
            built = devices_at(self.problem, of_each_material, found.incidence)
            found = devices_by_mass([found, *filter(None, built)])[0]
        parts = replace(parts, materials=(found.material,))
        task = replace(self.task, resolved=replace(self.task.resolved, choice=parts))
        # Place and plate are searched again: a lighter device may need more room.
        device = _full_design(task, near=found)
        return device if device is not None and device.mass <= mass_max else None

    def notes(self, device: Candidate) -> Iterator[str]:
        """Notes on the device found, besides its mass and motor."""
        if self.incidence_is_free:
            yield f"alpha {degrees(device.incidence)}"
        if device.material != self.choice.chosen.material:
            yield device.material.name
        rated = device.motor.rated_voltage
        if rated is not None and self.problem.supply.voltage > _OVERVOLTAGE_NOTED * rated:
            yield f"the motor is rated for {rated:g} V"
        missing = build_gaps(device.motor)
        if missing:
            yield f"not buildable: {', '.join(missing[:_GAPS_SHOWN])} not known"
        elif device.motor.name not in {motor.name for motor in self.choice.problem.motors}:
            yield "not buildable: its threads or shaft do not hold the wheel or the motor"


def _full_design(task: Task, near: Candidate | None = None) -> Candidate | None:
    """The lightest device, with its own footing and reserve; None: none is feasible."""
    try:
        designed = design_device(task, ranked=False, near=near)
    except Infeasible:
        return None
    return None if designed.choice is None else designed.choice.chosen


def alternative_construction(task: Task, choice: DriveChoice | None) -> tuple[Alternative, ...]:
    """The device with rings in place of discs, or discs in place of rings; empty if infeasible.

    It is reported whether lighter or not, unless the device has no mount. All drives are tried:
    each stands higher or lower than with the present construction, on other feet and another plate,
    so a quick selection on the present footing says little.
    """
    if choice is None or choice.lacks_mount:
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
    changed = replace(specified, ocs=replace(specified.ocs, wheel=wheel, co_design=None))
    device = _full_design(replace(task, specification=changed))
    return () if device is None else (_alternative(text, device, f"--wheel {wheel}"),)


def variants(task: Task, choice: DriveChoice) -> Iterator[Variant]:
    """The task with each single change of its specification."""
    found = (Variant.of(change, task, choice) for change in changes(task))
    return (variant for variant in found if variant is not None)


def find_driving_maneuver(task: Task, choice: DriveChoice | None) -> DrivingManeuver | None:
    """The maneuver without which the device would be lightest.

    None without a motor or maneuvers.
    """
    if choice is None:
        return None
    chosen, requirement = choice.chosen, choice.problem.requirement
    problem = replace(choice.problem, incidence=chosen.incidence, materials=(chosen.material,))
    mass_max = (1.0 - _LEAST_SAVING) * chosen.mass
    driving = None
    if requirement.maneuvers:
        driving = DrivingManeuver(maneuver="", mass_without=chosen.mass)
    for maneuver in requirement.maneuvers:
        others = tuple(other for other in requirement.maneuvers if other is not maneuver)
        if not others and requirement.rate_change is None and requirement.spin_inertia is None:
            return DrivingManeuver(maneuver=maneuver.name, mass_without=None)
        without = replace(problem, requirement=replace(requirement, maneuvers=others))
        device = lightest_below(without, mass_max)
        if device is None:
            continue
        if not choice.lacks_mount:
            device = OnRobot(task.robot).with_plate(device, problem)
        if device.mass < mass_max:
            mass_max = device.mass
            driving = DrivingManeuver(maneuver=maneuver.name, mass_without=mass_max)
    return driving


LARGEST_CHANGE = 200
"""Largest change that is tried [%]."""

_FULL_OVER_QUICK = 1.5
"""Largest ratio of the change with which a full design is light enough to that with which a quick
selection is."""

_PRECISION = 0.005
"""Relative precision of the smallest change, which is reported in whole per cent."""


def lighter_by(
    mass: float,
    task: Task,
    choice: DriveChoice,
    driving_maneuver: str,
    progress: Progress = ignore_progress,
) -> tuple[Alternative, ...]:
    """Changes of the specification, each of which saves the given mass.

    Args:
        mass: mass to save [kg].
        choice: the device, designed for the task, and what it was chosen from.
        driving_maneuver: maneuver that drives the mass, which may be relaxed alone; empty: none.
    """
    target = choice.chosen.mass - mass
    if target <= 0.0:
        return ()
    specified = task.specification
    task = replace(
        task, specification=replace(specified, ocs=replace(specified.ocs, co_design=None))
    )

    def with_change(change: Change) -> Alternative | None:
        variant = Variant.of(change, task, choice)
        device = None if variant is None else variant.full_design(target)
        return None if device is None else _alternative(change.text, device)

    def smallest_change(lever: Lever) -> Alternative | None:
        """The smallest sufficient change: the more is relaxed, the lighter the device."""

        @cache
        def is_light(percent: int) -> bool:
            """Whether a device on the present footing is light enough, which is quick to find."""
            variant = Variant.of(lever(percent), task, choice)
            return variant is not None and variant.quick_selection(target) is not None

        @cache
        def alternative_at(percent: int) -> Alternative | None:
            return with_change(lever(percent)) if is_light(percent) else None

        if not is_light(LARGEST_CHANGE):
            return None
        largest = 1.0 + LARGEST_CHANGE / 100.0
        start, light = narrowed(lambda factor: is_light(_percent(factor)), 1.0, largest, _PRECISION)
        largest = min(_FULL_OVER_QUICK * light, largest)
        factor = smallest_factor(
            lambda factor: bool(alternative_at(_percent(factor))), start, largest, _PRECISION
        )
        return None if factor is None else alternative_at(_percent(factor))

    unchanged, all_levers = Change("", task.specification), list(levers(task, driving_maneuver))
    open_choices = list(options(task))
    found = [with_change(option.added_to(unchanged)) for option in open_choices]
    insufficient = [
        option for option, alone in zip(open_choices, found, strict=True) if alone is None
    ]
    found += [
        with_change(second.added_to(first.added_to(unchanged)))
        for first, second in combinations(insufficient, 2)
    ]
    for index, lever in enumerate(all_levers):
        found.append(smallest_change(lever))
        progress((index + 1) / len(all_levers))
    if not any(found):
        # No single figure or choice saves enough: one of each together may.
        for option, lever in product(open_choices, all_levers):
            found.append(smallest_change(option.with_lever(lever)))
    return tuple(alternative for alternative in found if alternative is not None)


def _percent(factor: float) -> int:
    """A factor on a limit as a change in whole per cent, rounded up."""
    return ceil(100.0 * (factor - 1.0) - 1e-9)
