"""What single changes of the specification would save: each a selection with the rest as it was.

An answer is good to about 1.5 %. The reserve for what is uncertain stays what it is but for another
incidence, though a device of its own would keep a little more or less. The incidence stays, though
a lighter device would move it by a fraction of a degree, and so does the material, where it is not
what changes.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite

from ocs_design.actuation.motor import build_gaps
from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import Infeasible
from ocs_design.common.units import format_quantity
from ocs_design.device.records.selection import SAVES_NOTHING, Alternative, Owed
from ocs_design.requirement.maneuver import Flip
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import AUTO, LIGHTEST
from ocs_design.robot.robot import Robot
from ocs_design.sizing.design import design_device
from ocs_design.sizing.limits import LIMITS, TIME
from ocs_design.sizing.on_robot import with_plate
from ocs_design.sizing.selection.problem import SelectionProblem, with_limit
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.selection.select import lightest_below
from ocs_design.sizing.sized import Choice
from ocs_design.sizing.specified import other_construction, relaxations

MORE_ROOM, MORE_TIME = 1.2, 1.1
"""Factors on r_max and on the time of every maneuver."""

_GAPS_TOLD = 2
"""Missing figures of a motor that a line has room for."""

_OVER = 1.05
"""Supply over a motor's rated voltage from which the note says so."""

_WORTH = 0.005
"""Share of the mass below which a saving is not worth telling."""


@dataclass(frozen=True, eq=False)
class _Change:
    """One change of what is asked: in words, the changed problem, and what speaks against it."""

    text: str
    problem: SelectionProblem
    note: str = ""


def lighter_otherwise(
    specification: Specification, resolved: Resolved, choice: Choice | None, robot: Robot
) -> tuple[tuple[Alternative, ...], Owed | None]:
    """What each relaxation would save, and to which maneuver the mass is owed.

    Args: see `alternatives` and `owed_to`.
    """
    found = alternatives(specification, resolved, choice, robot)
    return found, owed_to(choice, robot)


def alternatives(
    specification: Specification, resolved: Resolved, choice: Choice | None, robot: Robot
) -> tuple[Alternative, ...]:
    """What each relaxation of the defaults and of the limits would save; empty without a motor.

    Args:
        specification: what was stated: what it relaxes already is not offered again.
        resolved: the same with nothing left open.
        choice: the device, and what it was chosen from; None: it has no motor.
        robot: that carries it.
    """
    if choice is None:
        return ()
    below = (1.0 - _WORTH) * choice.chosen.modules_mass

    def lightest(change: _Change) -> Candidate | None:
        found = lightest_below(change.problem, below)
        if found is None or change.problem.incidence is not None:
            return None if found is None else with_plate(found, choice.problem, robot)
        # At another incidence another reserve is kept: a design of its own, of those parts.
        free = replace(specification, ocs=replace(specification.ocs, alpha_criterion=LIGHTEST))
        assert resolved.choice is not None, "wheels without motors have no alternatives"
        # Steels make much the same device; of all materials another may be the lightest there.
        any_material = specification.flywheel.material == AUTO
        parts = replace(
            resolved.choice,
            motors=(found.motor,),
            gears=(found.gear,),
            materials=resolved.choice.materials if any_material else (found.material,),
        )
        offered = replace(resolved, choice=parts)
        try:
            own = design_device(free, robot, offered, ranked=False)
        except Infeasible:
            return None
        return None if own.choice is None else own.choice.chosen

    changes = _changes(specification, choice)
    found = [_answer(change, lightest(change), choice) for change in changes]
    return (*found, *_constructions(specification, resolved, choice, robot))


def owed_to(choice: Choice | None, robot: Robot) -> Owed | None:
    """The maneuver without which the device would be lightest; None: none is asked for.

    Args:
        choice: the device, and what it was chosen from; None: it has no motor.
        robot: that carries it.
    """
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
        mass = with_plate(lighter, problem, robot).mass
        if mass < best:
            best, owed = mass, Owed(maneuver=maneuver.name, mass_without=mass)
    return owed


def _answer(change: _Change, lighter: Candidate | None, choice: Choice) -> Alternative:
    """The device after a change, or that no device is lighter by enough to be worth telling.

    What is lighter may be wider, and so may its plate.
    """
    chosen = choice.chosen
    if lighter is None or lighter.mass > (1.0 - _WORTH) * chosen.mass:
        return Alternative(
            change=change.text,
            mass_total=chosen.mass,
            motor=chosen.motor.name,
            note=SAVES_NOTHING,
        )
    return Alternative(
        change=change.text,
        mass_total=lighter.mass,
        motor=lighter.motor.name,
        note="; ".join(_notes(change, lighter, choice.problem)),
    )


def _notes(change: _Change, found: Candidate, asked: SelectionProblem) -> Iterator[str]:
    if change.problem.incidence is None:
        yield f"alpha {format_quantity(found.incidence, 'deg', 3)}"
    if len(change.problem.materials) > 1:
        yield found.material.name
    rated, voltage = found.motor.rated_voltage, change.problem.bus_voltage
    if rated is not None and voltage > _OVER * rated:
        yield f"the motor is rated for {rated:g} V"
    gaps = build_gaps(found.motor)
    if gaps:
        yield f"not buildable: {', '.join(gaps[:_GAPS_TOLD])} not known"
    elif found.motor.name not in {motor.name for motor in asked.motors}:
        yield "not buildable: its threads or shaft do not hold the wheel or the motor"
    if change.note:
        yield change.note


def _changes(specification: Specification, choice: Choice) -> Iterator[_Change]:
    """Each relaxation, and more power, room and time: the question about it alone changed."""
    chosen = choice.chosen
    problem = replace(choice.problem, incidence=chosen.incidence, materials=(chosen.material,))
    for each in relaxations(specification, problem):
        yield _Change(each.text, each.problem(problem))
    asked = problem.requirement
    turned = tuple(
        replace(maneuver, incidence=0.0)
        if isinstance(maneuver, Flip) and maneuver.incidence is None
        else maneuver
        for maneuver in asked.maneuvers
    )
    if problem.layout.pairs and turned != asked.maneuvers:
        kept = dict(asked.reserves)
        for flip in turned:
            if isinstance(flip, Flip) and flip.incidence == 0.0 and flip.name in kept:
                # At 0 deg no wheel takes up a rate of roll.
                own = kept[flip.name]
                kept[flip.name] = replace(own, rate=(0.0, own.rate[1]), roll=0.0)
        by_hand = replace(asked, maneuvers=turned, reserves=kept)
        yield _Change(
            "modules turned to 0 deg by hand for each flip", replace(problem, requirement=by_hand)
        )
    if isfinite(problem.supply.power):
        endless = Supply(problem.supply.voltage, inf, inf)
        power = problem.supply.power
        least = format_quantity(power, "kW" if power >= 1e3 else "W", 3)
        yield _Change(f"a supply of more than {least}", replace(problem, supply=endless))
    room = LIMITS["r_max"]
    radius = MORE_ROOM * room.value(problem.envelope)
    yield _Change(
        f"r_max {format_quantity(radius, 'mm', 3)}, {MORE_ROOM - 1.0:.0%} more",
        with_limit(problem, room, radius),
    )
    if asked.maneuvers:
        yield _Change(
            f"{MORE_TIME - 1.0:.0%} more time for every maneuver",
            with_limit(problem, TIME, MORE_TIME),
        )


def _constructions(
    specification: Specification, resolved: Resolved, choice: Choice, robot: Robot
) -> Iterator[Alternative]:
    """The other way to join rim and rotor, heavier or lighter."""
    asked = replace(choice.problem, incidence=choice.chosen.incidence)
    other = other_construction(specification, resolved, asked)
    found = None if other is None else lightest_below(other, inf)
    if other is None or found is None:
        return
    device = with_plate(found, other, robot)
    yield Alternative(
        change="a ring bonded around each motor's bell in place of the disc"
        if other.on_bell
        else "a disc on each motor in place of the ring around its bell",
        mass_total=device.mass,
        motor=device.motor.name,
        note=f"--wheel {'ring' if other.on_bell else 'disc'}",
    )
