"""The selection against brute force on a grid with an independent model (`naive_device`).

Robots from 1 kg to 80 kg with random specifications and catalogues, from two sources. The results
must agree to 0.1 %: the selection claims the lightest device, and the grid is refined until it has
found it, since a coarse grid without a lighter device would prove little.
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
"""Few wheels are feasible, and at few incidences only: slightly heavier ones are too small."""
TOO_HEAVY_FOR_ITSELF = (0, 11, 17, 22)
"""The lightest module is too heavy for the robot; a smaller one may be feasible, or none."""
MASS_TOLERANCE = 1e-3
OFFSET_LOAD = (3, 9, 12, 16, 20)


def selected(problem):
    """The lightest device of a problem; None if infeasible."""
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
    assert chosen.mass <= grid.mass * (1.0 + MASS_TOLERANCE), grid
    if exact:
        assert grid.mass <= chosen.mass * (1.0 + MASS_TOLERANCE)
    check_device(problem, chosen)
    check_neighbours(problem, chosen)


def check_device(problem, chosen):
    """Mass, inertia and capability agree with the independent model."""
    drive, rims = drive_of(problem, chosen), rims_of(chosen)
    angle = np.array([chosen.incidence])
    assert fits_envelope(problem, rims, slack=1e-6).all()
    assert is_buildable(problem, drive, rims, chosen.material, slack=1e-6).all()
    assert margin(problem, drive, rims, angle).item() >= 1.0 - 1e-6
    assert device_mass(drive, rims).item() == pytest.approx(chosen.mass, rel=1e-9)
    inertia = inertia_on(problem, drive, rims, angle)[:, 0]
    total = chosen.total.inertia
    np.testing.assert_allclose(np.diag(total)[:2], inertia, rtol=1e-9)
    coupling = coupling_on(problem, drive, rims, angle).item()
    assert total[0, 1] - total[0, 2] * total[1, 2] / total[2, 2] == pytest.approx(
        coupling, rel=1e-9, abs=1e-12 * inertia.max()
    )
    spin = drive.wheel(rims)[1].item() + drive.rotor_momentum
    assert spin == pytest.approx(chosen.spin_inertia, rel=1e-9)


def check_neighbours(problem, chosen):
    """Grids that get finer around the device have nothing lighter."""
    point = [chosen.incidence, chosen.outer_radius, chosen.height]
    point = np.array([*point, chosen.outer_radius - chosen.inner_radius])
    names = (chosen.motor.name, chosen.gear.name, chosen.material.name)
    drive = drive_of(problem, chosen, points=10_000)
    start = Device(chosen.mass, drive, chosen.material, names, point)
    assert refine(problem, start).mass >= chosen.mass * (1.0 - MASS_TOLERANCE)


def random_case_problem(seed, **changes):
    return replace(random_case(seed).problem, **changes)


def with_coupling(seed):
    """A random problem whose roll and pitch are coupled by 1 % to 10 % of their inertia."""
    return with_offset_load(random_problem(seed), seed)


MORE = [
    *((random_case_problem(seed), True) for seed in SLOW),
    (random_case_problem(10, lightenings=(6,)), True),
    (random_problem(16), True),
    *((with_coupling(seed), True) for seed in OFFSET_LOAD),
    # Here a grid may miss what the selection finds, but not the reverse.
    *((random_case_problem(seed), False) for seed in ON_THE_EDGE),
    *((random_problem(seed), False) for seed in TOO_HEAVY_FOR_ITSELF),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problem", "exact"),
    [
        *((random_case_problem(seed), True) for seed in FAST),
        # Thicker feet change the wheel, cage and screws of the same drive.
        (random_case_problem(FAST[0], foot_plate=0.0084), True),
        (random_case_problem(12, lightenings=(6,)), True),
        *(pytest.param(*each, marks=pytest.mark.exhaustive) for each in MORE),
    ],
)
def test_nothing_lighter_is_on_a_grid(problem, exact):
    check_nothing_lighter(problem, exact=exact)


@pytest.mark.parametrize(
    "seed", [OFFSET_LOAD[0], pytest.param(OFFSET_LOAD[1], marks=pytest.mark.exhaustive)]
)
def test_the_device_of_a_robot_with_an_offset_load_is_consistent(seed):
    """Its worst maneuver is just feasible, which depends on the coupling."""
    problem = with_coupling(seed)
    chosen = selected(problem)
    check_device(problem, chosen)
    drive, rims = drive_of(problem, chosen), rims_of(chosen)
    coupled = margin(problem, drive, rims, np.array([chosen.incidence])).item()
    assert coupled == pytest.approx(1.0, abs=1e-6)
    symmetric = replace(problem, robot=uncoupled(problem.robot))
    uncoupled_margin = margin(symmetric, drive, rims, np.array([chosen.incidence])).item()
    assert abs(uncoupled_margin - 1.0) > 0.01


def uncoupled(robot):
    """The robot without coupling, its centre of mass in the sagittal plane."""
    forward, _, up = robot.com
    return MassProperties(robot.mass, [forward, 0.0, up], np.diag(np.diag(robot.inertia)))
