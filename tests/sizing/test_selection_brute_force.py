"""The selection against every device on a grid, by a physics of its own (`brute_selection`)."""

from math import inf

import numpy as np
import pytest
from brute_selection import Drive, brute_force, does_all, fits
from selections import random_problem

from ocs_design.exceptions import Infeasible
from ocs_design.sizing.selection.select import select

FAST = (16,)
"""Of the others, in 0, 11, 17 and 22 the lightest module is too large to be carried."""


def compare(seed):
    problem = random_problem(seed)
    grid, choice = brute_force(problem)
    try:
        found = select(problem, advise=False).best
    except Infeasible:
        assert grid == inf, f"missed {choice}"
        return
    # A grid misses the optimum by its steps, and may miss what hardly can be.
    assert found.mass <= grid * (1.0 + 1e-5), choice
    drive = Drive(found.motor, found.gear, problem.bus_voltage, problem.wheel_speed_max)
    angle, inner, outer, height = np.array(
        [[found.incidence], [found.inner_radius], [found.outer_radius], [found.height]]
    )
    assert fits(problem, drive, found.material, inner, outer, height, slack=1e-8).all()
    # The tables of `Drive` have five digits.
    rim = (inner, outer, height)
    assert does_all(problem, drive, found.material, angle, *rim, slack=2e-5).all()


OWN_WEIGHT = (0, 11, 17, 22)
"""Problems near the edge, where a device can hardly carry itself."""


@pytest.mark.parametrize("seed", FAST)
def test_no_lighter_device_on_a_grid(seed):
    compare(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [seed for seed in OWN_WEIGHT if seed not in FAST])
def test_no_lighter_device_on_many_grids(seed):
    compare(seed)
