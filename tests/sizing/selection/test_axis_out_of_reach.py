"""Modules across the robot, which reach no roll, on robots that roll as they pitch."""

from dataclasses import replace

import numpy as np
import pytest
from selections import lightest, random_problem

from ocs_design.common.errors import Infeasible
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.selection.select import select
from ocs_design.sizing.sized import sized_selection

DROP = Drop(name="drop", height=3.0, pitch=np.radians(30.0))
WHOLE = Flip(name="flip", jump_height=3.0, angle=-2.0 * np.pi, duration=2.0)
HALF = replace(WHOLE, angle=np.pi)


def asking(share, *maneuvers):
    """Of a robot that drifts by that much roll per pitch, with wheels that only pitch."""
    problem = random_problem(12)
    inertia = np.diag(np.diag(problem.robot.inertia))
    inertia[0, 1] = inertia[1, 0] = share * inertia[0, 0]
    robot = MassProperties(problem.robot.mass, problem.robot.com, inertia)
    requirement = replace(problem.requirement, maneuvers=maneuvers, rate_change=None)
    return replace(problem, robot=robot, requirement=requirement, incidence=0.0)


@pytest.mark.slow
def test_a_little_drift_is_let_pass_and_lightens_the_pitch():
    """I_yy - I_xy^2 / I_xx is left of it, and no momentum about roll is asked for."""
    even, coupled = asking(0.0, WHOLE), asking(0.03, WHOLE)
    before, after = lightest(even), lightest(coupled)
    inertia = after.total.inertia
    left = inertia[1, 1] - inertia[0, 1] ** 2 / inertia[0, 0]
    (demand,) = sized_selection(coupled, after, coupled.robot).demands
    expected = [0.0, left * 2.0 * np.pi * 2.0 / WHOLE.duration]
    np.testing.assert_allclose(demand.momentum, expected, rtol=1e-9)
    assert after.demands[0].spin_inertia < before.demands[0].spin_inertia


def test_a_turn_that_ends_off_level_asks_for_the_axis():
    """0.1 of 30 deg are 3 deg; half a turn about an axis that leans leaves twice its lean."""
    for maneuver in (DROP, HALF):
        with pytest.raises(Infeasible, match="out of reach"):
            select(asking(0.1, maneuver))


def test_a_whole_turn_ends_where_it_began():
    found = select(asking(0.1, WHOLE)).best
    assert found.incidence == 0.0
