"""Lightening holes in a selection: they are made as they are counted, and never make it heavier."""

from dataclasses import replace

import numpy as np
import pytest
from random_cases import random_case

from ocs_design.common.errors import Infeasible
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import wheel_parts
from ocs_design.sizing.assembly import assemble_selected
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.select import select

SEEDS = (4, 16)
"""Of drawn problems with webs of one piece."""


def problem_of(seed: int) -> SelectionProblem:
    return replace(random_case(seed).problem, incidence=0.6, lightenings=(0, 6))


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_the_selected_wheel_is_the_made_one(seed):
    problem = problem_of(seed)
    best = select(problem).best
    wheel = assemble_selected(best).flywheel
    assert best.hub is not None
    assert (wheel.web.holes is not None) == (best.hub.lightening == 6)
    made = total(wheel_parts(wheel.shape))
    assert made.mass == pytest.approx(best.wheel_mass, rel=1e-9)
    assert made.mass == pytest.approx(wheel.mass, rel=1e-9)
    spin = made.inertia[2, 2] + best.drive.rotor_inertia
    assert spin == pytest.approx(best.spin_inertia, rel=1e-9)
    assert made.inertia[0, 0] == pytest.approx(wheel.transverse_inertia, rel=1e-9)


@pytest.mark.slow
def test_where_their_room_holds_the_device_back_the_web_is_solid():
    """Wheels of the least spin inertia, in webs that are smaller than the holes ask for."""
    problem = problem_of(SEEDS[0])
    little = replace(problem.requirement, maneuvers=(), rate_change=None, spin_inertia=None)
    solid = select(replace(problem, lightenings=(0,))).best
    asked = replace(little, spin_inertia=0.1 * solid.spin_inertia)
    try:
        found = select(replace(problem, requirement=asked)).best
        alone = select(replace(problem, requirement=asked, lightenings=(0,))).best
    except Infeasible:
        pytest.skip("no wheel is that small")
    assert found.mass <= alone.mass * (1.0 + 1e-6)
    assert np.isfinite(found.mass)
