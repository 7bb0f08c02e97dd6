"""Total inertia of many devices, and lower bounds on their mass and spin inertia."""

from dataclasses import astuple, fields, replace

import numpy as np
import pytest
from selections import random_problem, with_offset_load
from subsets import fast_subset

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import smallest_spin_inertia
from ocs_design.device.device import braked
from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.parts.moments import MassMoments, point, round_body
from ocs_design.parts.solids import Carrier
from ocs_design.requirement.requirement import ManeuverReserve
from ocs_design.requirement.turns import Catch
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.place import Place, Size, place_around
from ocs_design.sizing.selection.bounds import (
    Interval,
    RimFloor,
    bound_task,
    incidence_intervals,
    least_masses,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidates import Candidates, drives_of
from ocs_design.sizing.selection.composite_inertia import (
    CompositeInertia,
    LeastInertia,
    ModuleBounds,
    least_composite_inertia,
)
from ocs_design.sizing.selection.demand import columns, wheel_task
from ocs_design.sizing.selection.fixed_point import Design, Tolerance, fixed_point

ROBOT = MassProperties(
    5.0, [0.02, 0.003, -0.04], [[0.06, 0.001, 0.004], [0.001, 0.1, -0.003], [0.004, -0.003, 0.13]]
)
PLACE = Place(
    origins=((0.05, 0.01, 0.02), (0.05, -0.01, 0.02)),
    outward=((0.0, 1.1, -0.8), (0.0, -1.1, -0.8)),
    upright=True,
)
TRIAD = Layout(LayoutName.TRIAD)
TILTED = Layout(LayoutName.BY_HAND, ((0.6, 0.0, 0.8), (0.0, 1.0, 0.0)))
NAMED = [Layout(name) for name in LayoutName if name is not LayoutName.BY_HAND]
AROUND = {layout: place_around((0.05, 0.01, 0.02), layout) for layout in (*NAMED, TILTED)} | {
    PAIR: PLACE
}


def random_modules(rng, count):
    """Random wheels and housings about their centres, motors behind them and feet below."""
    wheel = round_body(*rng.uniform([[0.05], [1e-5], [1e-5]], [[0.5], [1e-3], [1e-3]], (3, count)))
    motor = point(rng.uniform(0.02, 0.5, count))
    foot = point(rng.uniform(0.005, 0.1, count))
    depth, below = rng.uniform(0.01, 0.06, count), rng.uniform(0.01, 0.05, count)
    size = Size(rng.uniform(0.01, 0.1, count), rng.uniform(0.01, 0.1, count))
    zero = np.zeros(count)
    return wheel, motor, depth, foot.shifted(zero, -below), size


def module_of(wheel, motor, depth, foot, size):
    return wheel + motor.shifted(-depth, np.zeros_like(depth)) + foot, size


@pytest.mark.parametrize("layout", AROUND)
def test_total_inertia_equals_the_sum_of_bodies(layout):
    module, size = module_of(*random_modules(np.random.default_rng(0), 20))
    angles, place = np.linspace(0.0, np.pi / 2.0, 7), AROUND[layout]
    composite = CompositeInertia(ROBOT, layout, module, place.centers(size) - ROBOT.com)
    inertia, yaw = composite.at(np.tile(angles, (20, 1)))
    for row in range(20):
        body = Carrier.of(module.take(row))
        centers = place.centers(Size(*(float(values[row]) for values in size)))
        expected = [braked(ROBOT, (body,), centers, a, layout).inertia for a in angles]
        np.testing.assert_allclose(
            inertia.diagonal[row], [np.diag(total)[:2] for total in expected], rtol=1e-12
        )
        products = [total[0, 1] - total[0, 2] * total[1, 2] / total[2, 2] for total in expected]
        np.testing.assert_allclose(inertia.product[row], products, rtol=1e-12)
        np.testing.assert_allclose(yaw[row], [total[2, 2] for total in expected], rtol=1e-12)


@pytest.mark.parametrize("layout", AROUND)
def test_no_larger_or_heavier_module_has_less_inertia_than_the_bound(layout):
    """Also where a larger module moves past the robot's centre of mass."""
    rng = np.random.default_rng(1)
    wheel, motor, depth, foot, size = random_modules(rng, 500)
    largest = Size(*(2.0 * values for values in size))
    wheel_inertia = np.minimum(wheel.xx + wheel.zz, wheel.yy + wheel.zz)
    heaviest, place = 2.0 * (wheel.mass + motor.mass + foot.mass), AROUND[layout]
    zero = np.zeros_like(depth)
    bounds = ModuleBounds(
        wheel.mass, wheel_inertia, motor.mass, depth, zero, size, largest, heaviest
    )
    grown = Size(*(values * rng.uniform(1.0, 2.0, 500) for values in size))
    factors, shares = rng.uniform(1.0, 2.0, 500), rng.uniform(0.3, 1.0, 500)
    module, _ = module_of(scaled(wheel, factors), motor, shares * depth, foot, grown)
    bound = least_composite_inertia(ROBOT, place, bounds, layout)
    angles = rng.uniform(0.0, np.pi / 2.0, (500, 1))
    if layout.angle is not None:
        angles[:] = layout.angle
    centers = place.centers(grown) - ROBOT.com
    inertia, _ = CompositeInertia(ROBOT, layout, module, centers).at(angles)
    assert (bound.inertia.diagonal <= inertia.diagonal[:, 0] * (1.0 + 1e-12)).all()
    assert np.median(bound.inertia.diagonal / inertia.diagonal[:, 0]) > 0.6
    assert (np.abs(inertia.product[:, 0] - bound.inertia.product) <= bound.spread).all()


def scaled(bodies, factors):
    """Bodies with all mass moments multiplied by factors."""
    return MassMoments(*(getattr(bodies, f.name) * factors for f in fields(bodies)))


@pytest.mark.parametrize("coupled", [0.0, 1e-4, 0.2, -0.05])
@pytest.mark.parametrize("seed", fast_subset(3, range(3), pytest.mark.exhaustive))
@pytest.mark.parametrize(
    "kept", [None, ManeuverReserve(demand=1.3), ManeuverReserve(rate=(0.1, 0.02))]
)
@pytest.mark.parametrize("layout", [PAIR, TRIAD, TILTED], ids=lambda layout: layout.name)
def test_more_inertia_and_smaller_shares_require_no_less(layout, kept, seed, coupled):
    """The premise of `selection.bounds`, also where an axis is not controlled."""
    rng = np.random.default_rng(seed)
    problem = random_problem(seed)
    pairs = np.array([(m, g) for m in range(3) for g in range(3)])
    drives = drives_of(problem, pairs)
    # With a gear that speeds up, a wheel may be feasible where a larger one is not.
    drives = drives.take(drives.armature >= 0.0)
    n, required = len(drives), problem.requirement
    if kept is not None:
        names = (maneuver.name for maneuver in required.maneuvers)
        required = replace(required, reserves=dict.fromkeys(names, kept))
    intervals = (
        Interval(0.0, 0.1),
        Interval(0.1, 0.2),
        Interval(0.5, 0.7),
        Interval(0.6, 0.6),
        Interval(1.4, np.pi / 2.0),
    )
    robot = np.diag(problem.robot.inertia)[:2] * rng.uniform(1.0, 1.5, (n, 2))
    center = coupled * np.sqrt(robot.prod(axis=1))
    least = LeastInertia(TiltInertia(robot, center), 0.3 * np.abs(center))
    angle = np.stack(
        [rng.uniform(interval.low, interval.high, (n, 40)) for interval in intervals], axis=1
    )
    angle[:, 0, 0], angle[:, -1, 0] = 0.0, np.pi / 2.0
    shape = (n, len(intervals), 40)
    growth, change = rng.uniform(1.0, 1.1, (*shape, 2)), rng.uniform(0.7, 1.3, shape)
    # The least inertia, with the least and the largest coupling, as the bound assumes them.
    growth[..., :20, :], change[..., :10], change[..., 10:20] = 1.0, 0.7, 1.3
    total = TiltInertia(robot[:, None, None, :] * growth, center[:, None, None] * change)
    line = DriveLine(*(np.asarray(values)[:, None, None] for values in astuple(drives.line)))
    drop = replace(problem.requirement.maneuvers[0], roll=0.3, pitch=0.3)
    catch = Catch(name="catch", gravity=0.0, jump_height=0.0, duration=0.5, rate=(1.0, 1.0, 0.0))
    for maneuver in (*problem.requirement.maneuvers, drop, catch):
        # Wheels that turn beforehand, in the required sense or against it.
        initial_speed = 30.0 * (seed - 1)
        tasks = replace(
            bound_task(maneuver, required, least, intervals, layout), initial_speed=initial_speed
        )
        bound = smallest_spin_inertia(tasks, columns(drives.line), drives.armature[:, None])
        task = wheel_task([maneuver], required, total, 0.0, layout.axes(angle))
        task = replace(task, initial_speed=initial_speed)
        required_spin = smallest_spin_inertia(task, line, drives.armature[:, None, None])[0]
        finite = np.isfinite(required_spin)
        assert finite.any()
        # The search ends at half the body's inertia: only smaller wheels may be out of range.
        allowed = np.where(finite, required_spin, np.inf).min(axis=-1) * (1.0 + 1e-9)
        assert (bound <= allowed).all()


def test_axes_longer_than_one_bound_those_of_a_range():
    problem, interval = random_problem(0), Interval(np.arccos(0.9), np.arcsin(0.8))
    drives, shares = drives_of(problem, np.array([[0, 0]])), np.array([0.8, 0.9])
    maneuver = problem.requirement.maneuvers[0]
    inertia = TiltInertia.uncoupled([[0.05, 0.05]])
    least = LeastInertia(inertia, np.zeros(1))
    task = bound_task(maneuver, problem.requirement, least, [interval], PAIR)
    load = task.load()
    slew = maneuver.slew(inertia)
    roll, pitch = (np.abs(slew.swept) / shares)[0]
    assert load.excess[0, 0] == pytest.approx((roll + pitch) / 2.0, rel=1e-12)
    compliance = shares**2 / 0.05
    assert load.coupling[0, 0] == pytest.approx(2.0 * compliance.sum(), rel=1e-12)
    exact = 2.0 * (compliance[0] * roll + compliance[1] * pitch) / (roll + pitch)
    assert exact < load.coupling[0, 0]
    assert np.isfinite(smallest_spin_inertia(task, drives.line)).all()


@pytest.mark.parametrize("share", [1.0, 0.1], ids=["robot", "light robot"])
@pytest.mark.parametrize(
    ("seed", "layout"), [*((seed, PAIR) for seed in range(8)), (0, TRIAD), (1, TRIAD), (3, TILTED)]
)
def test_no_device_falls_below_its_bound(seed, layout, share):
    """Devices of random radius and incidence, each at its own fixed point.

    The wheels hold a tenth of the inertia of a light robot.
    """
    rng = np.random.default_rng(100 + seed)
    problem = random_problem(seed)
    if seed % 2:
        problem = replace(with_offset_load(problem, seed), foot_plate=0.0084)
        maneuvers = problem.requirement.maneuvers
        reserves = dict.fromkeys((m.name for m in maneuvers), ManeuverReserve(demand=1.3))
        problem = replace(problem, requirement=replace(problem.requirement, reserves=reserves))
    robot = problem.robot
    robot = MassProperties(share * robot.mass, robot.com, share * robot.inertia)
    problem = replace(problem, robot=robot)
    if layout != PAIR:
        place = place_around((0.0, 0.0, 0.1), layout)
        problem = replace(problem, layout=layout, place=place, incidence=layout.angle)
    floor = RimFloor.of(problem)
    pairs = np.array([(m, g) for m in range(3) for g in range(3)])
    drives = drives_of(problem, pairs)
    spin = np.zeros(len(drives))
    for count in (1, 18, 18):
        intervals = incidence_intervals(problem.incidence, count)
        needed = least_spin_inertias(problem, drives, intervals, spin)
        spin = needed.min(axis=1)
    masses = least_masses(floor, drives, spin)

    rows = np.repeat(np.arange(len(drives)), 60)
    material = rng.integers(0, 2, rows.size)
    candidates = Candidates(problem, drives.take(rows), material)
    angle = rng.uniform(0.0, np.pi / 2.0, rows.size)
    if problem.incidence is not None:
        angle[:] = problem.incidence
    design = Design(
        radius=problem.envelope.outer_radius_max * rng.uniform(0.2, 1.0, rows.size),
        angle=angle,
        width=np.zeros(rows.size),
    )
    start = np.zeros(rows.size)
    point = fixed_point(candidates, start, design, Tolerance(1e-10, 1.0))
    feasible = point.feasible
    mass = len(layout) * (candidates.drives.mass + point.shapes.mass)
    assert (point.spin_inertia[feasible] >= spin[rows][feasible] * (1.0 - 1e-9)).all()
    assert (mass[feasible] >= masses[material, rows][feasible] * (1.0 - 1e-9)).all()
    interval = np.searchsorted([c.high for c in intervals], angle).clip(max=len(intervals) - 1)
    assert (point.spin_inertia[feasible] >= needed[rows, interval][feasible] * (1.0 - 1e-9)).all()
