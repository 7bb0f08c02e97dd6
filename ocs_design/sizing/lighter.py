"""What must change for a device that is lighter by a stated mass.

Each answer is the smallest change of one figure, in whole percent, or one or two other choices;
where none of these does, one figure with one choice. It is searched for as an alternative is, and
the changed question is then sized as a whole.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from math import isfinite
from typing import Any

from ocs_design.common.errors import Infeasible, OcsError
from ocs_design.common.units import format_quantity, round_outwards
from ocs_design.device.records.selection import Alternative
from ocs_design.requirement.kinds import change_text, slower
from ocs_design.requirement.maneuver import Disturbance, Drop, Maneuver, Shove
from ocs_design.requirement.pivoted import StandUp
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import AUTO, LIGHTEST
from ocs_design.sizing.design import design_device
from ocs_design.sizing.limits import Progress, unseen
from ocs_design.sizing.on_robot import with_plate
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.selection.select import lightest_below
from ocs_design.sizing.sized import Choice
from ocs_design.sizing.specified import Relaxation, relaxations

MOST = 200
"""Largest change that is looked for [%]."""

_LOOSER = (0, 1, 3, 7, 15, 31)
"""By how much an answer is loosened [%], one after the other, until its whole design agrees."""


@dataclass(frozen=True, eq=False)
class _Lever:
    """One figure that can give way by a share [%]: the changed question, and its words."""

    changed: Callable[[int], Specification]
    text: Callable[[int], str]

    def beside(self, choice: Relaxation) -> "_Lever":
        """Lever on the same figure, where another choice is made too."""
        return _Lever(
            lambda percent: choice.stated(self.changed(percent)),
            lambda percent: f"{self.text(percent)}, and {_told(choice)}",
        )


def _told(choice: Relaxation) -> str:
    """A choice with the option for it."""
    return f"{choice.text} ({choice.option})"


def lighter_by(
    mass: float, task: Task, choice: Choice, owed: str, progress: Progress = unseen
) -> tuple[Alternative, ...]:
    """Changes of the question, each of which makes the device lighter by so much.

    Args:
        mass: by which [kg].
        task: that the device was designed for. choice: how it was.
        owed: maneuver that the mass is owed to, which may give way alone; empty: none.
        progress: told the share that is done.
    """
    target = choice.chosen.mass - mass
    if target <= 0.0:
        return ()
    search = _Search(task, choice, target)
    stated, levers = task.specification, list(_levers(task, owed))
    options = list(relaxations(stated, choice.problem))
    found = [search.answer(_told(each), each.stated(stated)) for each in options]
    vain = [option for option, answer in zip(options, found, strict=True) if answer is None]
    for first, second in combinations(vain, 2):
        both = second.stated(first.stated(stated))
        found.append(search.answer(f"{_told(first)}, and {_told(second)}", both))
    for index, lever in enumerate(levers):
        found.append(search.smallest(lever))
        progress((index + 1) / len(levers))
    if not any(found):
        # No figure and no choice does it alone: one of each together may.
        found += [search.smallest(lever.beside(each)) for each in options for lever in levers]
    return tuple(answer for answer in found if answer is not None)


@dataclass(frozen=True, eq=False)
class _Search:
    """Devices of changed questions, as light as the target [kg]."""

    task: Task
    choice: Choice
    target: float

    def smallest(self, lever: _Lever) -> Alternative | None:
        """The smallest change that does: the more gives way, the lighter the device."""
        low, high = 0, MOST
        if self._selected(lever.changed(high)) is None:
            return None
        while high > low + 1:
            middle = (low + high) // 2
            if self._selected(lever.changed(middle)) is None:
                low = middle
            else:
                high = middle
        tried, answer = low, None
        for percent in (high + looser for looser in _LOOSER):
            answer = self.answer(lever.text(percent), lever.changed(percent))
            if answer is not None:
                break
            tried = percent
        while answer is not None and percent > tried + 1:
            middle = (tried + percent) // 2
            smaller = self.answer(lever.text(middle), lever.changed(middle))
            if smaller is None:
                tried = middle
            else:
                percent, answer = middle, smaller
        return answer

    def answer(self, text: str, changed: Specification) -> Alternative | None:
        """The device of a changed question, sized as a whole with the motor that does."""
        selected = self._selected(changed)
        if selected is None:
            return None
        motor = replace(changed.motor, name=selected.motor.name)
        named = replace(changed, motor=motor, ocs=replace(changed.ocs, co_design=None))
        try:
            task = self.task.with_specification(named)
            device = design_device(named, task.robot, task.resolved).device
        except Infeasible:
            return None
        if device.mass > self.target:
            return None
        return Alternative(change=text, mass_total=device.mass, motor=device.motor.name)

    def _selected(self, changed: Specification) -> Candidate | None:
        """The lightest device of a changed question; None: it is too heavy, or there is none."""
        problem = self._problem(changed)
        found = None if problem is None else lightest_below(problem, self.target)
        if found is None or problem is None:
            return None
        found = with_plate(found, problem, self.task.robot)
        return found if found.mass <= self.target else None

    def _problem(self, changed: Specification) -> SelectionProblem | None:
        """The problem of a changed question, on the footing of the device that there is."""
        chosen, stated = self.choice.chosen, changed.ocs
        try:
            resolved = self.task.with_specification(changed).resolved
        except OcsError:
            return None
        offered = resolved.choice
        assert offered is not None, "wheels without motors are not made lighter"
        any_material = changed.flywheel.material == AUTO
        free = stated.alpha is None and stated.alpha_criterion == LIGHTEST
        return replace(
            self.choice.problem,
            requirement=resolved.requirement.on(chosen.total),
            envelope=resolved.envelope,
            supply=offered.supply,
            motors=offered.motors if changed.motor.any else self.choice.problem.motors,
            materials=offered.materials if any_material else (chosen.material,),
            incidence=None if free else chosen.incidence,
        )


def _levers(task: Task, owed: str) -> Iterator[_Lever]:
    """Figures that can give way: time, room, supply, and what is asked."""
    names = [maneuver.name for maneuver in task.maneuvers]
    if names:
        yield _Lever(
            lambda percent: _with_maneuvers(task, _slower_by(percent), names),
            lambda percent: f"{percent}% more time for every maneuver",
        )
    for maneuver in task.maneuvers:
        if maneuver.name == owed:
            if len(names) > 1:
                yield _slower_lever(task, maneuver)
            yield from _milder_lever(task, maneuver)
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
    """A key of the file, rounded to three digits on its loose side."""

    def value(percent: int) -> float:
        """Value of the key [SI]."""
        factor = 1.0 + percent / 100.0
        return round_outwards(own * factor if upwards else own / factor, upwards=upwards)

    def changed(percent: int) -> Specification:
        """The specification with it."""
        section_of: Any = getattr(task.specification, section)
        changes: dict[str, Any] = {section: replace(section_of, **{key: value(percent)})}
        return replace(task.specification, **changes)

    return _Lever(
        changed,
        lambda percent: (
            f"{key} {format_quantity(value(percent), unit)} in place of "
            f"{format_quantity(own, unit, 3)}"
        ),
    )


def _slower_by(percent: int) -> Callable[[Maneuver, float], Maneuver]:
    return lambda maneuver, height: slower(maneuver, 1.0 + percent / 100.0, height)


def _slower_lever(task: Task, maneuver: Maneuver) -> _Lever:
    """More time for one maneuver."""

    def text(percent: int) -> str:
        """Words for it, with the keys that give the time."""
        after = _slower_by(percent)(maneuver, task.standing_height)
        return f"{percent}% more time for one: {change_text(maneuver, after)}"

    return _Lever(lambda percent: _with_maneuvers(task, _slower_by(percent), [maneuver.name]), text)


def _milder_lever(task: Task, maneuver: Maneuver) -> Iterator[_Lever]:
    """Less of what one maneuver asks: part of a flip is none."""
    what = {Drop: "tilt", StandUp: "tilt", Disturbance: "push", Shove: "push"}.get(type(maneuver))
    if what is None:
        return

    def share(percent: int) -> float:
        """Share of it that is left."""
        return round_outwards(1.0 / (1.0 + percent / 100.0), upwards=False, digits=2)

    def milder(percent: int) -> Callable[[Maneuver, float], Maneuver]:
        """The maneuver with that share."""
        return lambda asked, _: _milder(asked, share(percent))

    yield _Lever(
        lambda percent: _with_maneuvers(task, milder(percent), [maneuver.name]),
        lambda percent: f"{share(percent):.0%} of the {what} of {maneuver.name}",
    )


def _milder(maneuver: Maneuver, share: float) -> Maneuver:
    match maneuver:
        case Drop() | StandUp():
            return replace(maneuver, roll=maneuver.roll * share, pitch=maneuver.pitch * share)
        case Disturbance(torque=(x, y, z), velocity_change=(u, v, w), impulse=(a, b, c)):
            return replace(
                maneuver,
                torque=(x * share, y * share, z * share),
                velocity_change=(u * share, v * share, w * share),
                impulse=(a * share, b * share, c * share),
            )
        case Shove(torque=(x, y, z)):
            return replace(maneuver, torque=(x * share, y * share, z * share))
        case _:
            return maneuver


def _with_maneuvers(
    task: Task, change: Callable[[Maneuver, float], Maneuver], names: list[str]
) -> Specification:
    """The specification with these maneuvers changed, and all of them written out."""
    stated, height = task.specification, task.standing_height
    maneuvers = tuple(
        change(maneuver, height) if maneuver.name in names else maneuver
        for maneuver in task.maneuvers
    )
    asked = replace(stated.requirement.without_words(), maneuvers=None)
    return replace(stated, requirement=asked, maneuvers=maneuvers)
