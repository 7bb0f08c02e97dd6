"""Modules that control pitch only, on robots whose roll is coupled with pitch."""

from dataclasses import replace

import numpy as np
import pytest
from selections import lightest, random_problem

from ocs_design.common.errors import Infeasible
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.selection.select import select
from ocs_design.sizing.sized import sized_selection

DROP = Drop(name="drop", standing_height=0.25, height=3.0, pitch=np.radians(30.0))
FULL_FLIP = Flip(name="flip", jump_height=3.0, angle=-2.0 * np.pi, duration=2.0)
HALF_FLIP = replace(FULL_FLIP, angle=np.pi)


def coupled_problem(share, *maneuvers):
    """Problem of a robot with this much roll per pitch, and wheels that control pitch only."""
    problem = random_problem(12)
    inertia = np.diag(np.diag(problem.robot.inertia))
    inertia[0, 1] = inertia[1, 0] = share * inertia[0, 0]
    robot = MassProperties(problem.robot.mass, problem.robot.com, inertia)
    requirement = replace(problem.requirement, maneuvers=maneuvers, rate_change=None)
    return replace(problem, robot=robot, requirement=requirement, incidence=0.0)


@pytest.mark.slow
def test_small_roll_drift_is_accepted_and_reduces_the_inertia_about_pitch():
    """To I_yy - I_xy^2 / I_xx, and no momentum about roll is required."""
    even, coupled = coupled_problem(0.0, FULL_FLIP), coupled_problem(0.03, FULL_FLIP)
    before, after = lightest(even), lightest(coupled)
    inertia = after.total.inertia
    reduced = inertia[1, 1] - inertia[0, 1] ** 2 / inertia[0, 0]
    (demand,) = sized_selection(coupled, after, coupled.robot).demands
    expected = [0.0, reduced * 2.0 * np.pi * 2.0 / FULL_FLIP.duration]
    np.testing.assert_allclose(demand.momentum, expected, rtol=1e-9)
    assert after.demands[0].spin_inertia < before.demands[0].spin_inertia


def test_a_turn_that_would_end_off_level_is_infeasible():
    """0.1 of 30 deg are 3 deg; half a turn about a tilted axis ends at twice its tilt."""
    for maneuver in (DROP, HALF_FLIP):
        with pytest.raises(Infeasible, match="out of reach"):
            select(coupled_problem(0.1, maneuver))


def test_a_full_flip_ends_level_despite_the_coupling():
    assert select(coupled_problem(0.1, FULL_FLIP)).best.incidence == 0.0
