"""Choices that a specification leaves open: what `size` and `--lighter-by` try in their place."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ocs_design.catalogue.materials import strong_materials
from ocs_design.requirement.choices import BUS_VOLTAGES, any_motors
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import AUTO, LIGHTEST, STEEL
from ocs_design.sizing.limits import BUS_VOLTAGE
from ocs_design.sizing.selection.problem import SelectionProblem, with_limit


@dataclass(frozen=True, eq=False)
class Relaxation:
    """A choice that is open still.

    Attributes:
        text: in words. option: of the command line, with what speaks against it.
        stated: the specification with it. problem: the problem with it.
    """

    text: str
    option: str
    stated: Callable[[Specification], Specification]
    problem: Callable[[SelectionProblem], SelectionProblem]


def relaxations(specification: Specification, asked: SelectionProblem) -> Iterator[Relaxation]:
    """Choices that a specification leaves open; `asked` is the problem that it states."""
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
        yield Relaxation(
            "any motor of the catalogue",
            "--motors-any, not buildable",
            lambda s: replace(s, motor=replace(s.motor, any=True)),
            lambda p: replace(p, motors=any_motors(specification)),
        )
    more = min((v for v in BUS_VOLTAGES.values() if v > asked.bus_voltage), default=None)
    if more is not None:
        yield Relaxation(
            f"a supply of {more:g} V",
            f"--bus-voltage {more:g}V",
            lambda s: replace(s, supply=replace(s.supply, voltage=more)),
            lambda p: with_limit(p, BUS_VOLTAGE, more),
        )
