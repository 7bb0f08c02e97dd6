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
        apply: makes this choice in a specification.
    """

    text: str
    option: str
    apply: Callable[[Specification], Specification]

    def added_to(self, change: Change) -> Change:
        """This choice in addition to another change."""
        text = f"{self.text} ({self.option})"
        joined = f"{change.text}, and {text}" if change.text else text
        return Change(joined, self.apply(change.specification))

    def with_lever(self, lever: Lever) -> Lever:
        """This choice in addition to the relaxation of a figure."""
        return lambda percent: self.added_to(lever(percent))


def options(task: Task) -> Iterator[Option]:
    """Choices that the specification of a task leaves open."""
    specification, offered = task.specification, task.resolved.choice
    assert offered is not None, "there are motors to choose from"
    specified, pairs = specification.ocs, specified_layout(specification).pairs
    if pairs and specified.alpha is None and specified.alpha_criterion != LIGHTEST:
        yield Option(
            "the incidence of the lightest device",
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
    yield from (Change(option.text, option.apply(specified)) for option in options(task))
    flips = [flip for flip in task.maneuvers if flip.pitches_over]
    if specified_layout(specified).pairs and any(flip.incidence is None for flip in flips):
        at_zero = task.with_maneuvers(
            lambda flip: replace(flip, incidence=flip.incidence or 0.0),
            [flip.name for flip in flips],
        )
        yield Change("modules turned to 0 deg by hand for each flip", at_zero)
    power = offered.supply.power
    if isfinite(power):
        present = format_quantity(power, "kW" if power >= 1e3 else "W", 3)
        unlimited = replace(specified.supply, power_max=inf, current_max=inf)
        yield Change(f"a supply of more than {present}", replace(specified, supply=unlimited))
    yield _radius_lever(task)(MORE_ROOM)
    if task.maneuvers:
        yield _time_lever(task)(MORE_TIME)


def levers(task: Task, driving_maneuver: str) -> Iterator[Lever]:
    """Figures that can be relaxed: time, room, supply, and the requirement.

    Of the maneuver that drives the mass, its own time where there are several maneuvers, and its
    tilt or push; a flip cannot be made smaller.
    """
    if task.maneuvers:
        yield _time_lever(task)
    driving = next(
        (maneuver for maneuver in task.maneuvers if maneuver.name == driving_maneuver), None
    )
    if driving is not None:

        def longer(percent: int) -> Change:
            slower = driving.slower(1.0 + percent / 100.0)
            text = f"{percent}% more time for one: {change_text(driving, slower)}"
            return Change(text, task.with_maneuvers(lambda _: slower, [driving_maneuver]))

        def gentler(percent: int) -> Change:
            share = round_outwards(1.0 / (1.0 + percent / 100.0), upwards=False, digits=2)
            text = f"{share:.0%} of the {driving.reducible} of {driving_maneuver}"
            return Change(
                text,
                task.with_maneuvers(lambda maneuver: maneuver.milder(share), [driving_maneuver]),
            )

        if len(task.maneuvers) > 1:
            yield longer
        if driving.reducible:
            yield gentler
    resolved = task.resolved
    yield _radius_lever(task)
    yield _key_lever(task, "flywheel", "h_max", resolved.envelope.height_max, "mm")
    rate = resolved.requirement.rate_change
    if rate is not None:
        yield _key_lever(task, "requirement", "rate_change", rate, "rad/s", upwards=False)
    if resolved.choice is not None:
        supply = resolved.choice.supply
        yield _key_lever(task, "supply", "voltage", supply.voltage, "V")
        if isfinite(supply.power_max):
            yield _key_lever(task, "supply", "power_max", supply.power_max, "W")


def _time_lever(task: Task) -> Lever:
    """More time for all maneuvers."""

    def change(percent: int) -> Change:
        factor = 1.0 + percent / 100.0
        names = [maneuver.name for maneuver in task.maneuvers]
        longer = task.with_maneuvers(lambda maneuver: maneuver.slower(factor), names)
        return Change(f"{percent}% more time for every maneuver", longer)

    return change


def _radius_lever(task: Task) -> Lever:
    """A larger outer radius of the rims."""
    return _key_lever(task, "flywheel", "r_max", task.resolved.envelope.outer_radius_max, "mm")


def _key_lever(
    task: Task, section: str, key: str, present: float, unit: str, *, upwards: bool = True
) -> Lever:
    """A looser value of one key, rounded to three digits towards the looser side."""

    def change(percent: int) -> Change:
        factor = 1.0 + percent / 100.0
        value = round_outwards(present * factor if upwards else present / factor, upwards=upwards)
        text = (
            f"{key} {format_quantity(value, unit)} instead of {format_quantity(present, unit, 3)}"
        )
        return Change(text, task.with_key(section, key, value))

    return change
