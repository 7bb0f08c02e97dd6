"""What one change of the question would save: each a selection of its own, the rest as it was.

An answer is good to about 1 %. The incidence stays what it is, though a lighter device would move
it by a fraction of a degree, and so does the material, where it is not what changes.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite

from ocs_design.actuation.motor import build_gaps
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import strong_materials
from ocs_design.common.units import format_quantity
from ocs_design.device.bell_ring import ring_on_bell
from ocs_design.device.records import Alternative
from ocs_design.requirement.choices import any_motors
from ocs_design.requirement.froude import BUS_VOLTAGES
from ocs_design.requirement.maneuver import Flip
from ocs_design.requirement.specification import AUTO, LIGHTEST, STEEL, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.design import Choice, Designed, with_plate
from ocs_design.sizing.limits import BUS_VOLTAGE, LIMITS, TIME
from ocs_design.sizing.selection.device import device_of
from ocs_design.sizing.selection.problem import SelectionProblem, with_limit
from ocs_design.sizing.selection.refinement import refine
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.selection.search import search_lightest

MORE_ROOM, MORE_TIME = 1.2, 1.1
"""Factors on r_max and on the time of every maneuver."""

_GAPS_TOLD = 2
"""What a motor lacks that a line has room for."""

_OVER = 1.05
"""Supply over a motor's rated voltage that is told."""

_WORTH = 0.005
"""Share of the mass below which a change saves nothing that is worth telling."""


@dataclass(frozen=True, eq=False)
class _Change:
    """One change of the question: in words, the question, and what speaks against it."""

    text: str
    problem: SelectionProblem
    note: str = ""


def alternatives(
    specification: Specification, designed: Designed, robot: Robot
) -> tuple[Alternative, ...]:
    """What each relaxation of the defaults and of the limits would save; empty without a motor.

    Args:
        specification: what was stated: what it relaxes already is not offered again.
        designed: the device, and what it was chosen from.
        robot: that carries it.
    """
    choice = designed.choice
    if choice is None:
        return ()

    def standing(candidate: Candidate) -> Candidate:
        stated = specification.ocs.position is not None
        return with_plate(candidate, choice.problem.supply, robot, stated=stated)

    found = [_answer(change, choice, standing) for change in _changes(specification, choice)]
    return (*found, *_constructions(designed))


def _answer(
    change: _Change, choice: Choice, standing: Callable[[Candidate], Candidate]
) -> Alternative:
    """The device after a change, or that there is none that is worth it."""
    chosen = choice.chosen
    lighter = _lightest(change.problem, (1.0 - _WORTH) * chosen.modules_mass)
    # What is lighter may be wider, and so may its plate.
    lighter = None if lighter is None else standing(lighter)
    if lighter is None or lighter.mass > (1.0 - _WORTH) * chosen.mass:
        return Alternative(
            change=change.text,
            mass_total=chosen.mass,
            motor=chosen.motor.name,
            note="saves nothing",
        )
    return Alternative(
        change=change.text,
        mass_total=lighter.mass,
        motor=lighter.motor.name,
        note="; ".join(_notes(change, lighter, choice.problem)),
    )


def _lightest(problem: SelectionProblem, below: float) -> Candidate | None:
    """The lightest device, if there is one that is lighter than this [kg]."""
    found = search_lightest(problem, below)
    if not found.places:
        return None
    solved = found.devices[0]
    if problem.incidence is None:
        # There a search leaves up to 3 % of the mass.
        point = refine(solved.candidates, solved.point)
        better = replace(solved, point=point)
        solved = better if better.mass[0] < solved.mass[0] else solved
    return device_of(solved) if solved.mass[0] < below else None


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
    elif found.motor not in asked.motors:
        yield "not buildable: its threads or shaft do not hold the wheel or the motor"
    if change.note:
        yield change.note


def _changes(specification: Specification, choice: Choice) -> Iterator[_Change]:
    """Each relaxation that is none already, the question about it alone changed."""
    chosen, stated = choice.chosen, specification.ocs
    problem = replace(choice.problem, incidence=chosen.incidence, materials=(chosen.material,))
    if stated.alpha is None and stated.alpha_criterion != LIGHTEST:
        yield _Change("the incidence with which it is lightest", replace(problem, incidence=None))
    if specification.flywheel.material in {None, STEEL}:
        yield _Change("any material", replace(problem, materials=strong_materials()))
    turned = tuple(
        replace(maneuver, incidence=0.0)
        if isinstance(maneuver, Flip) and maneuver.incidence is None
        else maneuver
        for maneuver in problem.requirement.maneuvers
    )
    if turned != problem.requirement.maneuvers:
        yield _Change(
            "modules turned to 0 deg by hand for each flip",
            replace(problem, requirement=replace(problem.requirement, maneuvers=turned)),
        )
    if specification.motor.name in {None, AUTO} and not specification.motor.any:
        every = any_motors(specification)
        yield _Change("any motor of the catalogue", replace(problem, motors=every))
    yield from _looser_limits(problem)


def _looser_limits(problem: SelectionProblem) -> Iterator[_Change]:
    """More voltage, power, room and time."""
    more = min((v for v in BUS_VOLTAGES.values() if v > problem.bus_voltage), default=None)
    if more is not None:
        yield _Change(f"a supply of {more:g} V", with_limit(problem, BUS_VOLTAGE, more))
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
    if problem.requirement.maneuvers:
        yield _Change(
            f"{MORE_TIME - 1.0:.0%} more time for every maneuver",
            with_limit(problem, TIME, MORE_TIME),
        )


def _constructions(designed: Designed) -> Iterator[Alternative]:
    """The other way to join rim and rotor."""
    ring = ring_on_bell(designed.device)
    if ring is not None:
        yield Alternative(
            change="a ring bonded around each motor's bell in place of the disc",
            mass_total=designed.device.mass + 2.0 * ring.beyond,
            motor=designed.device.motor.name,
            note="housing as it is",
        )
