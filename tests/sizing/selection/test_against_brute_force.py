"""The selection against every device on a grid, on a physics of its own (`naive_device`).

Robots from 1 kg to 80 kg with random specifications and catalogues, from two sources. Neither may
be heavier than the other by more than 0.1 %: the selection because it claims the lightest, the grid
because it was refined until it has it; a grid that finds nothing lighter than what it cannot do
proves little.
"""

from dataclasses import replace

import numpy as np
import pytest
from naive_device import (
    Drive,
    coupling_on,
    device_mass,
    fits_envelope,
    inertia_on,
    is_buildable,
    margin,
)
from naive_search import Device, refine, search
from naive_wheel import Rims
from random_cases import random_case
from selections import random_problem, with_offset_load

from ocs_design.common.errors import Infeasible
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.selection.select import select

FAST = (2, 12)
SLOW = (1, 3, 6, 4, 5, 7, 8, 10, 11, 14)
ON_THE_EDGE = (9, 15, 21)
"""Few wheels will do, and only at few incidences: a little heavier, and none is large enough."""
TOO_HEAVY_FOR_ITSELF = (0, 11, 17, 22)
"""The lightest module is too large to be carried; a smaller one, or none, may be."""
AGREED = 1e-3
LOPSIDED = (3, 9, 12, 16, 20)


def selected(problem):
    """The lightest device that was drawn; None if there is none."""
    try:
        return select(problem).best
    except Infeasible:
        return None


def rims_of(chosen):
    shape = (chosen.outer_radius, chosen.inner_radius, chosen.height)
    sizes = (np.array([value]) for value in shape)
    return Rims(*sizes, chosen.material.density, chosen.cuts.chamfer if chosen.hub else 0.0)


def drive_of(problem, chosen, points=100_000):
    return Drive(problem, chosen.motor, chosen.gear, points)


def check_nothing_lighter(problem, *, exact=True):
    grid, chosen = search(problem), selected(problem)
    if chosen is None:
        assert grid is None, f"select misses {grid}"
        return
    assert grid is not None
    assert chosen.mass <= grid.mass * (1.0 + AGREED), grid
    if exact:
        assert grid.mass <= chosen.mass * (1.0 + AGREED)
    check_by_itself(problem, chosen)
    check_neighbours(problem, chosen)


def check_by_itself(problem, chosen):
    """It is what it says, and can do what it must."""
    drive, rims = drive_of(problem, chosen), rims_of(chosen)
    angle = np.array([chosen.incidence])
    assert fits_envelope(problem, rims, slack=1e-6).all()
    assert is_buildable(problem, drive, rims, chosen.material, slack=1e-6).all()
    assert margin(problem, drive, rims, angle).item() >= 1.0 - 1e-6
    assert device_mass(drive, rims).item() == pytest.approx(chosen.mass, rel=1e-9)
    inertia = inertia_on(problem, drive, rims, angle)[:, 0]
    whole = chosen.total.inertia
    np.testing.assert_allclose(np.diag(whole)[:2], inertia, rtol=1e-9)
    coupling = coupling_on(problem, drive, rims, angle).item()
    assert whole[0, 1] - whole[0, 2] * whole[1, 2] / whole[2, 2] == pytest.approx(
        coupling, rel=1e-9, abs=1e-12 * inertia.max()
    )
    spin = drive.wheel(rims)[1].item() + drive.rotor_momentum
    assert spin == pytest.approx(chosen.spin_inertia, rel=1e-9)


def check_neighbours(problem, chosen):
    """Finer and finer grids around it find nothing lighter."""
    point = [chosen.incidence, chosen.outer_radius, chosen.height]
    point = np.array([*point, chosen.outer_radius - chosen.inner_radius])
    names = (chosen.motor.name, chosen.gear.name, chosen.material.name)
    drive = drive_of(problem, chosen, points=10_000)
    start = Device(chosen.mass, drive, chosen.material, names, point)
    assert refine(problem, start).mass >= chosen.mass * (1.0 - AGREED)


def drawn(seed, **changes):
    return replace(random_case(seed).problem, **changes)


def uneven(seed):
    """Roll and pitch are coupled by percents to tenths of what they take."""
    return with_offset_load(random_problem(seed), seed)


MORE = [
    *((drawn(seed), True) for seed in SLOW),
    (drawn(10, lightenings=(6,)), True),
    (random_problem(16), True),
    *((uneven(seed), True) for seed in LOPSIDED),
    # There a grid may miss what the selection finds, but never the other way round.
    *((drawn(seed), False) for seed in ON_THE_EDGE),
    *((random_problem(seed), False) for seed in TOO_HEAVY_FOR_ITSELF),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problem", "exact"),
    [
        *((drawn(seed), True) for seed in FAST),
        # Wheels, cages and screws of the same drive on feet of 5 mm are others.
        (drawn(FAST[0], foot_plate=0.0084), True),
        (drawn(12, lightenings=(6,)), True),
        *(pytest.param(*each, marks=pytest.mark.exhaustive) for each in MORE),
    ],
)
def test_nothing_lighter_is_on_a_grid(problem, exact):
    check_nothing_lighter(problem, exact=exact)


@pytest.mark.parametrize(
    "seed", [LOPSIDED[0], pytest.param(LOPSIDED[1], marks=pytest.mark.exhaustive)]
)
def test_a_lopsided_robots_device_is_what_it_says(seed):
    """Its worst maneuver is just in time, which it would not be without the coupling."""
    problem = uneven(seed)
    chosen = selected(problem)
    check_by_itself(problem, chosen)
    drive, rims = drive_of(problem, chosen), rims_of(chosen)
    asked = margin(problem, drive, rims, np.array([chosen.incidence])).item()
    assert asked == pytest.approx(1.0, abs=1e-6)
    symmetric = replace(problem, robot=uncoupled(problem.robot))
    without = margin(symmetric, drive, rims, np.array([chosen.incidence])).item()
    assert abs(without - 1.0) > 0.01


def uncoupled(robot):
    """With its centre of mass in the middle."""
    forward, _, up = robot.com
    return MassProperties(robot.mass, [forward, 0.0, up], np.diag(np.diag(robot.inertia)))
