"""Lightening holes in a selection: parts agree with masses, and no device gets heavier."""

from dataclasses import replace

import numpy as np
import pytest
from random_cases import random_case

from ocs_design.common.errors import Infeasible
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import wheel_parts
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.select import select

SEEDS = (4, 16)
"""Seeds of random cases with one-piece webs."""


def problem_of(seed: int) -> SelectionProblem:
    return replace(random_case(seed).problem, incidence=0.6, lightenings=(0, 6))


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_the_selected_wheel_has_the_mass_of_its_parts(seed):
    problem = problem_of(seed)
    best = select(problem).best
    wheel = best.flywheel
    assert best.hub is not None
    assert (wheel.web.holes is not None) == (best.hub.lightening == 6)
    parts = total(wheel_parts(wheel.shape))
    assert parts.mass == pytest.approx(best.wheel_mass, rel=1e-9)
    assert parts.mass == pytest.approx(wheel.mass, rel=1e-9)
    spin = parts.inertia[2, 2] + best.drive.rotor_inertia
    assert spin == pytest.approx(best.spin_inertia, rel=1e-9)
    assert parts.inertia[0, 0] == pytest.approx(wheel.transverse_inertia, rel=1e-9)


@pytest.mark.slow
def test_webs_too_small_for_holes_are_solid():
    """A wheel so small that its web has no room for holes."""
    problem = problem_of(SEEDS[0])
    solid = select(replace(problem, lightenings=(0,))).best
    requirement = replace(
        problem.requirement,
        maneuvers=(),
        rate_change=None,
        spin_inertia=0.1 * solid.spin_inertia,
    )
    small = replace(problem, requirement=requirement)
    try:
        best = select(small).best
        without_holes = select(replace(small, lightenings=(0,))).best
    except Infeasible:
        pytest.skip("no wheel is that small")
    assert best.mass <= without_holes.mass * (1.0 + 1e-6)
    assert np.isfinite(best.mass)
