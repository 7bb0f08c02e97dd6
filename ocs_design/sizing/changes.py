"""Changes of a specification, in words and as specifications, for the searches that size with them.

An option is a choice that the specification leaves open. A lever relaxes one figure.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TypeAlias

from ocs_design.common.units import format_quantity, round_outwards
from ocs_design.requirement.choices import BUS_VOLTAGES
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import AUTO, LIGHTEST, STEEL
from ocs_design.sizing.specified import specified_layout

MORE_ROOM, MORE_TIME = 20, 10
"""Changes of r_max and of the time of every maneuver [%]."""


@dataclass(frozen=True)
class Change:
    """One change of a specification.

    Attributes:
        text: in words. specification: with the change.
    """

    text: str
    specification: Specification


Lever: TypeAlias = Callable[[int], Change]
"""Relaxation of one figure by this percentage."""


@dataclass(frozen=True, eq=False)
class Option:
    """A choice that a specification leaves open.

    Attributes:
        text: in words. option: command line option, with its drawback.
        specified: makes this choice in a specification.
    """

    text: str
    option: str
    specified: Callable[[Specification], Specification]

    def on(self, change: Change) -> Change:
        """This choice in addition to another change."""
        text = f"{self.text} ({self.option})"
        joined = f"{change.text}, and {text}" if change.text else text
        return Change(joined, self.specified(change.specification))

    def beside(self, lever: Lever) -> Lever:
        """This choice in addition to the relaxation of a figure."""
        return lambda percent: self.on(lever(percent))


def options(task: Task) -> Iterator[Option]:
    """Choices that the specification of a task leaves open."""
    specification, offered = task.specification, task.resolved.choice
    assert offered is not None, "there are motors to choose from"
    specified, pairs = specification.ocs, specified_layout(specification).pairs
    if pairs and specified.alpha is None and specified.alpha_criterion != LIGHTEST:
        yield Option(
            "the incidence with which it is lightest",
            "--alpha-criterion lightest",
            lambda s: replace(s, ocs=replace(s.ocs, alpha_criterion=LIGHTEST)),
        )
    if specification.flywheel.material in {None, STEEL}:
        yield Option(
            "any material",
            "--material auto",
            lambda s: replace(s, flywheel=replace(s.flywheel, material=AUTO)),
        )
    if specification.motor.name in {None, AUTO} and not specification.motor.any:
        yield Option(
            "any motor of the catalogue",
            "--motors-any, not buildable",
            lambda s: replace(s, motor=replace(s.motor, any=True)),
        )
    more = min((v for v in BUS_VOLTAGES.values() if v > offered.supply.voltage), default=None)
    if more is not None:
        yield Option(
            f"a supply of {more:g} V",
            f"--bus-voltage {more:g}V",
            lambda s: replace(s, supply=replace(s.supply, voltage=more)),
        )


def changes(task: Task) -> Iterator[Change]:
    """Each choice that the specification leaves open, more power, more room and more time."""
    specified, offered = task.specification, task.resolved.choice
    assert offered is not None, "there are motors to choose from"
    yield from (Change(each.text, each.specified(specified)) for each in options(task))
    flips = [each for each in task.maneuvers if each.pitches_over]
    if specified_layout(specified).pairs and any(flip.incidence is None for flip in flips):
        by_hand = task.with_maneuvers(
            lambda flip: replace(flip, incidence=flip.incidence or 0.0),
            [flip.name for flip in flips],
        )
        yield Change("modules turned to 0 deg by hand for each flip", by_hand)
    power = offered.supply.power
    if isfinite(power):
        least = format_quantity(power, "kW" if power >= 1e3 else "W", 3)
        endless = replace(specified.supply, power_max=inf, current_max=inf)
        yield Change(f"a supply of more than {least}", replace(specified, supply=endless))
    yield _room(task)(MORE_ROOM)
    if task.maneuvers:
        yield _time(task)(MORE_TIME)


def levers(task: Task, owed: str) -> Iterator[Lever]:
    """Figures that can be relaxed: time, room, supply, and the requirement.

    For the maneuver that drives the mass (`owed`), its own time where there are several, and its
    tilt or push; a flip cannot be made smaller.
    """
    if task.maneuvers:
        yield _time(task)
    alone = next((each for each in task.maneuvers if each.name == owed), None)
    if alone is not None:

        def longer(percent: int) -> Change:
            later = alone.slower(1.0 + percent / 100.0, task.standing_height)
            text = f"{percent}% more time for one: {change_text(alone, later)}"
            return Change(text, task.with_maneuvers(lambda _: later, [owed]))

        def gentler(percent: int) -> Change:
            share = round_outwards(1.0 / (1.0 + percent / 100.0), upwards=False, digits=2)
            text = f"{share:.0%} of the {alone.reducible} of {owed}"
            return Change(text, task.with_maneuvers(lambda each: each.milder(share), [owed]))

        if len(task.maneuvers) > 1:
            yield longer
        if alone.reducible:
            yield gentler
    resolved = task.resolved
    yield _room(task)
    yield _key(task, "flywheel", "h_max", resolved.envelope.height_max, "mm")
    rate = resolved.requirement.rate_change
    if rate is not None:
        yield _key(task, "requirement", "rate_change", rate, "rad/s", upwards=False)
    if resolved.choice is not None:
        supply = resolved.choice.supply
        yield _key(task, "supply", "voltage", supply.voltage, "V")
        if isfinite(supply.power_max):
            yield _key(task, "supply", "power_max", supply.power_max, "W")


def _time(task: Task) -> Lever:
    """More time for all maneuvers."""

    def change(percent: int) -> Change:
        factor, height = 1.0 + percent / 100.0, task.standing_height
        names = [each.name for each in task.maneuvers]
        longer = task.with_maneuvers(lambda each: each.slower(factor, height), names)
        return Change(f"{percent}% more time for every maneuver", longer)

    return change


def _room(task: Task) -> Lever:
    """A larger outer radius of the rims."""
    return _key(task, "flywheel", "r_max", task.resolved.envelope.outer_radius_max, "mm")


def _key(
    task: Task, section: str, key: str, own: float, unit: str, *, upwards: bool = True
) -> Lever:
    """A looser value of one key, rounded to three digits towards the looser side."""

    def change(percent: int) -> Change:
        factor = 1.0 + percent / 100.0
        value = round_outwards(own * factor if upwards else own / factor, upwards=upwards)
        text = f"{key} {format_quantity(value, unit)} in place of {format_quantity(own, unit, 3)}"
        return Change(text, task.with_key(section, key, value))

    return change
