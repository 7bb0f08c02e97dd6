"""The inertia of the whole for many devices, and bounds that no device falls below."""

from dataclasses import fields

import numpy as np
import pytest
from selections import random_problem

from ocs_design.drive.wheel_pair import smallest_spin_inertia
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.mass_moments import MassMoments, point, round_body, rows_of
from ocs_design.sizing.placement import Place, Size
from ocs_design.sizing.selection.bounds import (
    RimFloor,
    cells_of,
    least_masses,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidate import braked
from ocs_design.sizing.selection.demand import needed_by_maneuvers, pair_task, shares_of
from ocs_design.sizing.selection.drive_table import drive_table
from ocs_design.sizing.selection.fixed_point import Design, Tolerance, fixed_point
from ocs_design.sizing.selection.lot import lot_of
from ocs_design.sizing.selection.trunk import (
    Least,
    Modules,
    least_trunk_inertia,
    trunk_inertia,
)

ROBOT = MassProperties(
    5.0, [0.02, 0.003, -0.04], [[0.06, 0.001, 0.0], [0.001, 0.1, 0.0], [0.0, 0.0, 0.13]]
)
PLACE = Place(origin=(0.05, 0.01, 0.02), outward=(0.0, 1.1, -0.8), upright=True)


def random_modules(rng, count):
    """Wheels and drums about their centres, motors behind them and feet below."""
    wheel = round_body(*rng.uniform([[0.05], [1e-5], [1e-5]], [[0.5], [1e-3], [1e-3]], (3, count)))
    motor = point(rng.uniform(0.02, 0.5, count))
    foot = point(rng.uniform(0.005, 0.1, count))
    depth, below = rng.uniform(0.01, 0.06, count), rng.uniform(0.01, 0.05, count)
    size = Size(rng.uniform(0.01, 0.1, count), rng.uniform(0.01, 0.1, count))
    zero = np.zeros(count)
    return wheel, motor, depth, foot.shifted(zero, -below), size


def whole_of(wheel, motor, depth, foot, size):
    whole = wheel + motor.shifted(-depth, np.zeros_like(depth)) + foot
    return whole, Modules.of(whole, size)


def test_inertia_as_joined_body_by_body():
    whole, modules = whole_of(*random_modules(np.random.default_rng(0), 20))
    angles = np.linspace(0.0, np.pi / 2.0, 7)
    found = trunk_inertia(ROBOT, PLACE, modules).at(shares_of(np.tile(angles, (20, 1))))
    for row in range(20):
        body = Carrier.of(rows_of(whole, row))
        centers = PLACE.centers(Size(*(float(values[row]) for values in modules.size)))
        expected = [np.diag(braked(ROBOT, (body,), centers, a).inertia)[:2] for a in angles]
        np.testing.assert_allclose(found[row], expected, rtol=1e-12)


def test_no_larger_or_heavier_module_has_less_inertia():
    """Also where a larger module moves past the robot's centre of mass."""
    rng = np.random.default_rng(1)
    wheel, motor, depth, foot, size = random_modules(rng, 500)
    largest = Size(*(2.0 * values for values in size))
    own = np.minimum(wheel.xx + wheel.zz, wheel.yy + wheel.zz)
    least = Least(wheel.mass, own, motor.mass, depth, np.zeros_like(depth), size, largest)
    grown = Size(*(values * rng.uniform(1.0, 2.0, 500) for values in size))
    more, ahead = rng.uniform(1.0, 2.0, 500), rng.uniform(0.3, 1.0, 500)
    _, modules = whole_of(each(wheel, more), motor, ahead * depth, foot, grown)
    bound = least_trunk_inertia(ROBOT, PLACE, least)
    angles = shares_of(rng.uniform(0.0, np.pi / 2.0, (500, 1)))
    whole = trunk_inertia(ROBOT, PLACE, modules).at(angles)[:, 0]
    assert (bound <= whole * (1.0 + 1e-12)).all()
    assert np.median(bound / whole) > 0.7


def each(bodies, factors):
    """Every body so many times as heavy."""
    return MassMoments(*(getattr(bodies, f.name) * factors for f in fields(bodies)))


@pytest.mark.parametrize("seed", range(6))
def test_more_inertia_and_smaller_shares_ask_for_no_less(seed):
    """What the bounds rest on (`selection.bounds`)."""
    rng = np.random.default_rng(seed)
    problem = random_problem(seed)
    pairs = np.array([(m, g) for m in range(3) for g in range(3)])
    drives = drive_table(problem, pairs)
    # With a gear that speeds up, a wheel may do that a larger one does not.
    drives = drives.take(drives.armature >= 0.0)
    n, height = len(drives), problem.requirement.standing_height
    maneuvers = problem.requirement.maneuvers
    robot = np.diag(problem.robot.inertia)[:2]
    shares = shares_of(rng.uniform(0.05, 1.5, (n, 50)))
    inertia = robot * rng.uniform(1.0, 1.5, (n, 50, 2))
    asked = needed_by_maneuvers(maneuvers, height, drives, inertia, shares)
    heavier = inertia * rng.uniform(1.0, 1.5, inertia.shape)
    more = needed_by_maneuvers(maneuvers, height, drives, heavier, shares)
    assert np.isfinite(asked).any()
    # The search for a wheel ends at half the inertia given, so that only less may be out of reach.
    finite = np.isfinite(asked)
    assert (more[finite] >= asked[finite] * (1.0 - 1e-9)).all()
    larger = shares * rng.uniform(1.0, 1.3, shares.shape)
    less = needed_by_maneuvers(maneuvers, height, drives, inertia, larger)
    both = np.isfinite(asked) & np.isfinite(less)
    assert both.any()
    assert (less[both] <= asked[both] * (1.0 + 1e-9)).all()


def test_shares_beyond_the_unit_circle_are_as_on_it():
    problem = random_problem(0)
    drives = drive_table(problem, np.array([[0, 0]]))
    inertia, shares = np.full((1, 1, 2), 0.05), np.array([[[0.5, 0.7]]])
    maneuvers = problem.requirement.maneuvers[:1]
    task = pair_task(maneuvers, problem.requirement.standing_height, inertia, shares)
    load = task.load()
    slew = maneuvers[0].slew(inertia, problem.requirement.standing_height)
    excess = (np.abs(slew.swept) / shares).sum(axis=-1)
    assert load.excess[0, 0, 0] == pytest.approx(excess[0, 0], rel=1e-12)
    roll, pitch = (np.abs(slew.swept) / shares)[0, 0]
    way = shares[0, 0] ** 2 / 0.05
    expected = 2.0 * (way[0] * roll + way[1] * pitch) / (roll + pitch)
    assert load.coupling[0, 0, 0] == pytest.approx(expected, rel=1e-12)
    assert np.isfinite(smallest_spin_inertia(task, drives.line)).all()


@pytest.mark.parametrize("seed", range(8))
def test_no_device_falls_below_its_bound(seed):
    """Devices of random radii, flatness and incidence, each at its own fixed point."""
    rng = np.random.default_rng(100 + seed)
    problem, floor = random_problem(seed), None
    floor = RimFloor.of(problem)
    pairs = np.array([(m, g) for m in range(3) for g in range(3)])
    drives = drive_table(problem, pairs)
    spin = np.zeros(len(drives))
    for count in (1, 18, 18):
        cells = cells_of(problem.incidence, count)
        needed = least_spin_inertias(problem, floor, drives, cells, spin)
        spin = needed.min(axis=1)
    masses = least_masses(floor, drives, spin)

    rows = np.repeat(np.arange(len(drives)), 60)
    material = rng.integers(0, 2, rows.size)
    lot = lot_of(problem, drives.take(rows), material)
    angle = rng.uniform(0.0, np.pi / 2.0, rows.size)
    if problem.incidence is not None:
        angle[:] = problem.incidence
    design = Design(
        radius=problem.envelope.outer_radius_max * rng.uniform(0.2, 1.0, rows.size),
        flatness=rng.uniform(1.0, 4.0, rows.size),
        angle=angle,
        width=np.zeros(rows.size),
    )
    start = np.zeros(rows.size)
    point, _ = fixed_point(problem, lot, start, design, Tolerance(1e-10, 1.0))
    can = point.possible
    mass = 2.0 * (lot.drives.mass + point.shapes.mass)
    assert (point.spin_inertia[can] >= spin[rows][can] * (1.0 - 1e-9)).all()
    assert (mass[can] >= masses[material, rows][can] * (1.0 - 1e-9)).all()
    cell = np.searchsorted([c.high for c in cells], angle).clip(max=len(cells) - 1)
    assert (point.spin_inertia[can] >= needed[rows, cell][can] * (1.0 - 1e-9)).all()
