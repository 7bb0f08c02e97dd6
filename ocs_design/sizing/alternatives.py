"""What would make a device lighter: single changes of the specification, and what they save.

A selection on the present device's footing quickly finds the lightest drive after a change; the
changed specification is then sized in full with that drive (docs/theory.md, The selection:
Alternatives, Trade-offs). Where the mass to save is specified, each answer is the smallest
change that saves it.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import combinations
from math import inf, isfinite
from typing import Any

from ocs_design.actuation.motor import build_gaps
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import strong_materials
from ocs_design.common.errors import Infeasible, OcsError, SpecificationError
from ocs_design.common.units import format_quantity, round_outwards
from ocs_design.common.wording import degrees
from ocs_design.device.records.selection import SAVES_NOTHING, Alternative, Owed
from ocs_design.requirement.choices import BUS_VOLTAGES, any_motors, motor_choice
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import AUTO, DISC, LIGHTEST, RING, STEEL
from ocs_design.sizing.design import design_device
from ocs_design.sizing.limits import BUS_VOLTAGE, LIMITS, TIME, Progress, unseen
from ocs_design.sizing.on_robot import OnRobot
from ocs_design.sizing.selection.problem import (
    Candidate,
    SelectionProblem,
    devices_by_mass,
    with_limit,
)
from ocs_design.sizing.selection.select import devices_at, lightest_below
from ocs_design.sizing.sized import Choice
from ocs_design.sizing.specified import other_construction

MORE_ROOM, MORE_TIME = 1.2, 1.1
"""Factors on r_max and on the time of every maneuver."""

_GAPS_TOLD = 2
"""Number of a motor's missing figures that fit on a line."""

_OVER = 1.05
"""Ratio of the supply to a motor's rated voltage above which the note mentions it."""

_WORTH = 0.005
"""Fraction of the mass below which a saving is not reported."""


@dataclass(frozen=True, eq=False)
class Relaxation:
    """A choice that the specification leaves open.

    Attributes:
        text: in words. option: command line option, with its drawback.
        stated: applies it to a specification. problem: applies it to a problem.
    """

    text: str
    option: str
    stated: Callable[[Specification], Specification]
    problem: Callable[[SelectionProblem], SelectionProblem]

    @property
    def told(self) -> str:
        """The text with the option."""
        return f"{self.text} ({self.option})"


def relaxations(specification: Specification, asked: SelectionProblem) -> Iterator[Relaxation]:
    """Choices that a specification leaves open; `asked` is the problem that it defines."""
    stated = specification.ocs
    if asked.layout.pairs and stated.alpha is None and stated.alpha_criterion != LIGHTEST:
        yield Relaxation(
            "the incidence with which it is lightest",
            "--alpha-criterion lightest",
            lambda s: replace(s, ocs=replace(s.ocs, alpha_criterion=LIGHTEST)),
            lambda p: replace(p, incidence=None, requirement=replace(p.requirement, free=True)),
        )
    if specification.flywheel.material in {None, STEEL}:
        yield Relaxation(
            "any material",
            "--material auto",
            lambda s: replace(s, flywheel=replace(s.flywheel, material=AUTO)),
            lambda p: replace(p, materials=strong_materials()),
        )
    if specification.motor.name in {None, AUTO} and not specification.motor.any:
        # A motor slowed below its maker's speed stays so (`specified`).
        own = {motor.name: motor for motor in asked.motors}
        motors = tuple(own.get(motor.name, motor) for motor in any_motors(specification))
        yield Relaxation(
            "any motor of the catalogue",
            "--motors-any, not buildable",
            lambda s: replace(s, motor=replace(s.motor, any=True)),
            lambda p: replace(p, motors=motors),
        )
    more = min((v for v in BUS_VOLTAGES.values() if v > asked.bus_voltage), default=None)
    if more is not None:
        yield Relaxation(
            f"a supply of {more:g} V",
            f"--bus-voltage {more:g}V",
            lambda s: replace(s, supply=replace(s.supply, voltage=more)),
            lambda p: with_limit(p, BUS_VOLTAGE, more),
        )


def lighter_otherwise(
    task: Task, choice: Choice | None, call: Callable[..., Callable[[], Any]] = partial
) -> Callable[[], tuple[tuple[Alternative, ...], Owed | None]]:
    """Start computing what each relaxation would save, and which maneuver drives the mass.

    Args:
        task: the design task; what its specification already relaxes is not offered again.
        choice: the device, and what it was chosen from; None: it has no motor.
        call: starts a call and returns the function that waits for its answer, like `Beside.call`.

    Returns:
        Function that waits for the answers; both are empty without a motor.
    """
    if choice is None:
        return lambda: ((), None)
    # The other construction takes longest.
    begun = [call(built_otherwise, task, choice)]
    begun += [call(Change.saved, change, choice) for change in changes(task, choice)]
    begun.append(call(owed_to, task, choice))

    def answers() -> tuple[tuple[Alternative, ...], Owed | None]:
        # Last one first: it is the least likely to have been started by another process.
        built, *found, owed = [each() for each in reversed(begun)][::-1]
        return (*found, *built), owed

    return answers


def _answer(text: str, device: Candidate, note: str) -> Alternative:
    """The device after a change, with a note for or against it."""
    return Alternative(change=text, mass_total=device.mass, motor=device.motor.name, note=note)


@dataclass(frozen=True, eq=False)
class Change:
    """One change of the specification.

    Attributes:
        text: in words. task: the task with it.
        problem: the same with the present device's footing and reserve.
    """

    text: str
    task: Task
    problem: SelectionProblem

    @property
    def turns(self) -> bool:
        """Whether the incidence is chosen again."""
        return self.problem.incidence is None

    def saved(self, choice: Choice) -> Alternative:
        """The device with this change; the present one where it would save next to nothing."""
        # Searching for a mount takes longest where there is none, and sizing a device in full
        # repeats that search several times.
        found = self.lighter(choice, quick=choice.hangs)
        # A lighter device may be wider, and so may its plate.
        if found is None or found.mass > (1.0 - _WORTH) * choice.chosen.mass:
            return _answer(self.text, choice.chosen, SAVES_NOTHING)
        quick = ["by a quick look"] if choice.hangs and not self.turns else []
        return _answer(self.text, found, "; ".join([*quick, *self.notes(found, choice)]))

    def lighter(self, choice: Choice, *, quick: bool) -> Candidate | None:
        """The device with this change; None: a quick selection finds no drive that saves mass.

        It is sized in full with the lightest of those drives.

        Args:
            choice: the present device.
            quick: whether a device at the same incidence is returned as the quick selection finds
                it, without a mount.
        """
        found = lightest_below(self.problem, (1.0 - _WORTH) * choice.chosen.modules_mass)
        offered = self.task.resolved.choice
        if found is None or offered is None:
            return None
        if quick and not self.turns:
            return found
        parts = replace(offered, motors=(found.motor,), gears=(found.gear,))
        if self.problem.materials != parts.materials:
            # Devices of different steels are much alike; trying all with every drive is slow.
            each = [replace(found, material=material) for material in parts.materials]
            built = devices_at(self.problem, each, found.incidence)
            found = devices_by_mass([found, *filter(None, built)])[0]
        parts = replace(parts, materials=(found.material,))
        asked = replace(self.task, resolved=replace(self.task.resolved, choice=parts))
        return _whole(asked, near=found)

    def notes(self, found: Candidate, choice: Choice) -> Iterator[str]:
        """Notes on the device found, besides its mass and motor."""
        if self.turns:
            yield f"alpha {degrees(found.incidence)}"
        if found.material != choice.chosen.material:
            yield found.material.name
        rated = found.motor.rated_voltage
        if rated is not None and self.problem.bus_voltage > _OVER * rated:
            yield f"the motor is rated for {rated:g} V"
        gaps = build_gaps(found.motor)
        if gaps:
            yield f"not buildable: {', '.join(gaps[:_GAPS_TOLD])} not known"
        elif found.motor.name not in {motor.name for motor in choice.problem.motors}:
            yield "not buildable: its threads or shaft do not hold the wheel or the motor"


def _whole(task: Task, near: Candidate | None = None) -> Candidate | None:
    """The lightest device, with its own footing and reserve; None: none is feasible."""
    try:
        own = design_device(task, ranked=False, near=near)
    except Infeasible:
        return None
    return None if own.choice is None else own.choice.chosen


def built_otherwise(task: Task, choice: Choice | None) -> tuple[Alternative, ...]:
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
    stated = task.specification
    built = replace(stated, ocs=replace(stated.ocs, wheel=wheel, co_design=None))
    found = _whole(replace(task, specification=built))
    return () if found is None else (_answer(text, found, f"--wheel {wheel}"),)


def changes(task: Task, choice: Choice) -> Iterator[Change]:
    """Each relaxation, and more power, room and time, as a task with that change alone."""
    specification, resolved = task.specification, task.resolved
    offered, chosen = resolved.choice, choice.chosen
    assert offered is not None, "there are motors to choose from"
    problem = replace(choice.problem, incidence=chosen.incidence, materials=(chosen.material,))

    def changed(text: str, to: SelectionProblem) -> Change:
        # The rest stays as resolved: factors on turns that were found too small, and kicks about
        # the centre of mass with a device.
        requirement = replace(resolved.requirement, maneuvers=to.requirement.maneuvers)
        own = replace(offered, supply=to.supply)
        own_resolved = replace(resolved, requirement=requirement, envelope=to.envelope, choice=own)
        return Change(text, replace(task, resolved=own_resolved), to)

    for each in relaxations(specification, problem):
        stated = each.stated(specification)
        try:
            own = motor_choice(stated, task.robot)
        except SpecificationError:  # No motor is rated for so much.
            continue
        assert own is not None, "there are motors to choose from"
        names, relaxed = {motor.name for motor in own.motors}, each.problem(problem)
        motors = tuple(motor for motor in relaxed.motors if motor.name in names)
        if motors:
            relaxed = replace(relaxed, motors=motors)
            asked_for = replace(task, specification=stated, resolved=replace(resolved, choice=own))
            yield Change(each.text, asked_for, relaxed)
    asked = problem.requirement
    flips = [each for each in asked.maneuvers if each.turns_over]
    if problem.layout.pairs and any(flip.incidence is None for flip in flips):
        turned = asked.changed(
            lambda m: replace(m, incidence=m.incidence or 0.0) if m.turns_over else m
        )
        kept = dict(asked.reserves)
        for flip in flips:
            if not flip.incidence and flip.name in kept:
                # At 0 deg no wheel takes up a rate of roll.
                own_reserve = kept[flip.name]
                kept[flip.name] = replace(own_reserve, rate=(0.0, own_reserve.rate[1]), roll=0.0)
        by_hand = replace(turned, reserves=kept)
        text = "modules turned to 0 deg by hand for each flip"
        yield changed(text, replace(problem, requirement=by_hand))
    power = problem.supply.power
    if isfinite(power):
        least = format_quantity(power, "kW" if power >= 1e3 else "W", 3)
        endless = Supply(problem.supply.voltage, inf, inf)
        yield changed(f"a supply of more than {least}", replace(problem, supply=endless))
    room = LIMITS["r_max"]
    radius = MORE_ROOM * room.value(problem.envelope)
    text = f"r_max {format_quantity(radius, 'mm', 3)}, {MORE_ROOM - 1.0:.0%} more"
    yield changed(text, with_limit(problem, room, radius))
    if asked.maneuvers:
        text = f"{MORE_TIME - 1.0:.0%} more time for every maneuver"
        yield changed(text, with_limit(problem, TIME, MORE_TIME))


def owed_to(task: Task, choice: Choice | None) -> Owed | None:
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

_LOOSER = (0, 1, 3, 7, 15, 31)
"""Amounts by which an answer is loosened in turn until its full design confirms it [%]."""


@dataclass(frozen=True, eq=False)
class _Lever:
    """One figure that can be relaxed by a percentage: the changed specification, and its text."""

    changed: Callable[[int], Specification]
    text: Callable[[int], str]

    def beside(self, choice: Relaxation) -> "_Lever":
        """Lever on the same figure combined with another choice."""
        return _Lever(
            lambda percent: choice.stated(self.changed(percent)),
            lambda percent: f"{self.text(percent)}, and {choice.told}",
        )


def lighter_by(
    mass: float, task: Task, choice: Choice, owed: str, progress: Progress = unseen
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
    search = _Search(task, choice, target)
    stated, levers = task.specification, list(_levers(task, owed))
    options = list(relaxations(stated, choice.problem))
    found = [search.answer(each.told, each.stated(stated)) for each in options]
    vain = [option for option, answer in zip(options, found, strict=True) if answer is None]
    for first, second in combinations(vain, 2):
        both = second.stated(first.stated(stated))
        found.append(search.answer(f"{first.told}, and {second.told}", both))
    for index, lever in enumerate(levers):
        found.append(search.smallest(lever))
        progress((index + 1) / len(levers))
    if not any(found):
        # No single figure or choice saves enough: one of each together may.
        found += [search.smallest(lever.beside(each)) for each in options for lever in levers]
    return tuple(answer for answer in found if answer is not None)


@dataclass(frozen=True, eq=False)
class _Search:
    """Devices for changed specifications, no heavier than the target [kg]."""

    task: Task
    choice: Choice
    target: float

    def smallest(self, lever: _Lever) -> Alternative | None:
        """The smallest sufficient change: the more is relaxed, the lighter the device."""

        def does(percent: int) -> bool:
            return self._selected(lever.changed(percent)) is not None

        @cache
        def answer(percent: int) -> Alternative | None:
            return self.answer(lever.text(percent), lever.changed(percent))

        if not does(MOST):
            return None
        low = least = bisect_left(range(MOST), True, lo=1, key=does)
        for looser in _LOOSER:
            if answer(least + looser) is not None:
                tried = range(least + looser)
                return answer(bisect_left(tried, True, lo=low, key=lambda p: bool(answer(p))))
            low = least + looser + 1
        return None

    def answer(self, text: str, changed: Specification) -> Alternative | None:
        """The device for a changed specification, sized in full with the selected motor."""
        selected = self._selected(changed)
        if selected is None:
            return None
        motor = replace(changed.motor, name=selected.motor.name)
        named = replace(changed, motor=motor, ocs=replace(changed.ocs, co_design=None))
        try:
            asked = self.task.with_specification(named)
            device = design_device(asked, ranked=False, near=selected).device
        except Infeasible:
            return None
        if device.mass > self.target:
            return None
        return Alternative(change=text, mass_total=device.mass, motor=device.motor.name)

    def _selected(self, changed: Specification) -> Candidate | None:
        """The lightest device for a changed specification, on the present device's footing.

        None: it is too heavy, or none is feasible.
        """
        chosen, stated, asked = self.choice.chosen, changed.ocs, self.choice.problem
        try:
            resolved = self.task.with_specification(changed).resolved
        except OcsError:
            return None
        offered = resolved.choice
        assert offered is not None, "wheels without motors are not made lighter"
        motors = offered.motors
        if not changed.motor.any:
            # Those that the device was chosen from, as far as they are rated for the supply.
            names = {motor.name for motor in offered.motors}
            motors = tuple(motor for motor in asked.motors if motor.name in names)
        if not motors:
            return None
        any_material = changed.flywheel.material == AUTO
        free = stated.alpha is None and stated.alpha_criterion == LIGHTEST
        problem = replace(
            asked,
            requirement=resolved.requirement.on(chosen.total),
            envelope=resolved.envelope,
            supply=offered.supply,
            motors=motors,
            materials=offered.materials if any_material else (chosen.material,),
            incidence=None if free else chosen.incidence,
        )
        found = lightest_below(problem, self.target)
        if found is None:
            return None
        found = OnRobot(self.task.robot).with_plate(found, problem)
        return found if found.mass <= self.target else None


def _levers(task: Task, owed: str) -> Iterator[_Lever]:
    """Figures that can be relaxed: time, room, supply, and the requirement.

    For the maneuver that drives the mass (`owed`), its own time where there are several, and its
    tilt or push; a flip cannot be made smaller.
    """
    names, height = [maneuver.name for maneuver in task.maneuvers], task.standing_height

    def longer(maneuver: Maneuver, percent: int) -> Maneuver:
        return maneuver.slower(1.0 + percent / 100.0, height)

    def share(percent: int) -> float:
        return round_outwards(1.0 / (1.0 + percent / 100.0), upwards=False, digits=2)

    if names:
        yield _Lever(
            lambda percent: task.with_maneuvers(lambda each: longer(each, percent), names),
            lambda percent: f"{percent}% more time for every maneuver",
        )
    alone = next((each for each in task.maneuvers if each.name == owed), None)
    if alone is not None:
        if len(names) > 1:
            yield _Lever(
                lambda percent: task.with_maneuvers(lambda _: longer(alone, percent), [owed]),
                lambda percent: (
                    f"{percent}% more time for one: {change_text(alone, longer(alone, percent))}"
                ),
            )
        if alone.part:
            yield _Lever(
                lambda percent: task.with_maneuvers(lambda _: alone.milder(share(percent)), [owed]),
                lambda percent: f"{share(percent):.0%} of the {alone.part} of {owed}",
            )
    resolved = task.resolved
    envelope, rate = resolved.envelope, resolved.requirement.rate_change
    yield _key(task, "flywheel", "r_max", envelope.outer_radius_max, "mm")
    yield _key(task, "flywheel", "h_max", envelope.height_max, "mm")
    if rate is not None:
        yield _key(task, "requirement", "rate_change", rate, "rad/s", upwards=False)
    if resolved.choice is not None:
        supply = resolved.choice.supply
        yield _key(task, "supply", "voltage", supply.voltage, "V")
        if isfinite(supply.power_max):
            yield _key(task, "supply", "power_max", supply.power_max, "W")


def _key(
    task: Task, section: str, key: str, own: float, unit: str, *, upwards: bool = True
) -> _Lever:
    """Lever on a key of the file, rounded to three digits towards the looser side."""

    def value(percent: int) -> float:
        factor = 1.0 + percent / 100.0
        return round_outwards(own * factor if upwards else own / factor, upwards=upwards)

    return _Lever(
        lambda percent: task.with_key(section, key, value(percent)),
        lambda percent: (
            f"{key} {format_quantity(value(percent), unit)} in place of "
            f"{format_quantity(own, unit, 3)}"
        ),
    )
