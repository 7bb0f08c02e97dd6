"""One candidate from anywhere near: the same device to all digits, or none."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_selections import draw

from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.selection.drive_table import drive_table
from ocs_design.sizing.selection.fixed_point import FixedPoint
from ocs_design.sizing.selection.lot import lot_of
from ocs_design.sizing.selection.polishing import polish
from ocs_design.sizing.selection.select import select


def lot_for(problem, chosen):
    """The chosen drive and material alone."""
    pair = np.array([[problem.motors.index(chosen.motor), problem.gears.index(chosen.gear)]])
    material = np.array([problem.materials.index(chosen.material)])
    return lot_of(problem, drive_table(problem, pair), material)


def beside(chosen, factors, turn):
    """A start with other radii and height, turned by an angle [rad]; its masses do not matter."""
    bore, radius, height = factors
    sizes = (chosen.inner_radius * bore, chosen.outer_radius * radius, chosen.height * height)
    shapes = ModuleShape(*(np.array([size]) for size in (*sizes, 1.0, 0.0, 1.0)))
    nothing = np.zeros(1)
    angle = np.array([chosen.incidence + turn])
    return FixedPoint(nothing, angle, shapes, np.zeros(1, dtype=bool), nothing, nothing)


@pytest.mark.parametrize(
    "seed", [2, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (15, 21, 53))]
)
@pytest.mark.parametrize(
    ("factors", "turn"),
    [((1.0, 1.0, 1.0), 0.0), ((0.97, 0.98, 0.95), 0.01), ((1.0, 1.02, 1.1), -0.02)],
)
def test_the_start_does_not_matter(seed, factors, turn):
    problem = draw(seed).problem
    chosen = select(problem, advise=False).best
    turn = turn if problem.incidence is None else 0.0
    found = polish(problem, lot_for(problem, chosen), beside(chosen, factors, turn))
    assert found.possible.all()
    hub = 0.0 if chosen.hub is None else chosen.hub.mass
    mass = 2.0 * (found.shapes.mass[0] + chosen.motor.mass + chosen.gear.mass + hub)
    assert mass == pytest.approx(chosen.mass, rel=1e-9)
    assert found.margin[0] >= 1.0 - 1e-9
    assert found.residual[0] < 1e-9


def test_what_cannot_be_is_not_possible():
    problem = draw(2).problem
    chosen = select(problem, advise=False).best
    small = replace(problem.envelope, outer_radius_max=0.3 * problem.envelope.outer_radius_max)
    less = replace(problem, envelope=small)
    assert not polish(less, lot_for(less, chosen), beside(chosen, (1.0, 1.0, 1.0), 0.0)).possible


def test_a_stated_incidence_and_spin_inertia_are_kept():
    problem = draw(2).problem
    chosen = select(problem, advise=False).best
    more = replace(problem.requirement, spin_inertia=1.1 * chosen.spin_inertia)
    stated = replace(problem, incidence=chosen.incidence, requirement=more)
    found = polish(stated, lot_for(stated, chosen), beside(chosen, (0.99, 1.0, 1.0), 0.0))
    assert found.possible.all()
    assert found.angle[0] == chosen.incidence
    assert found.spin_inertia[0] == pytest.approx(1.1 * chosen.spin_inertia, rel=1e-9)
