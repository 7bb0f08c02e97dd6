"""The co-design: symbols against numbers, never heavier, and its gains in 3-D."""

from dataclasses import replace
from functools import cache

import casadi as ca
import numpy as np
import pytest
from gyrostats import attitude_error, end_rate
from naive_wheel import wheel_body
from selections import lightest, random_problem

from ocs_design.device.device import braked
from ocs_design.device.layout import module_axes
from ocs_design.sizing.trajectory import program
from ocs_design.sizing.trajectory.co_design import (
    LEAST_GAIN,
    FreeDevice,
    co_design,
    with_wheels,
)
from ocs_design.sizing.trajectory.flight import DEFECT_MAX
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Motion

pytestmark = pytest.mark.slow

ROLL_AND_PITCH, GEARED, FLIPPING, CHANGING_RATE = 0, 21, 8, 16
"""Seeds of random problems, named by what drives the device."""


@cache
def problem_and_selection(seed, **changes):
    # The mass has kinks where a mount's holes limit the foot's plate: see docs/parts.md.
    problem = random_problem(seed, mounted=False)
    problem = replace(problem, requirement=replace(problem.requirement, **changes))
    return problem, lightest(problem)


@cache
def co_designed(seed):
    return co_design(*problem_and_selection(seed))


@pytest.fixture(
    scope="module",
    params=[
        ROLL_AND_PITCH,
        GEARED,
        *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (FLIPPING, CHANGING_RATE)),
    ],
)
def solved(request):
    return (*problem_and_selection(request.param), co_designed(request.param))


@pytest.mark.parametrize("seed", [0, 21])
def test_symbolic_and_numeric_device_agree(seed):
    problem, selected = problem_and_selection(seed)
    device, rng = FreeDevice.of(problem, selected), np.random.default_rng(seed)
    symbols = ca.MX.sym("dimensions", 3)
    mass, start = device.dimensions().objective(symbols), device.dimensions().start
    plant = ca.Function("plant", [symbols], [*device.plant(symbols), mass])
    nodes = np.linspace(device.lower, device.upper, 21)
    at_nodes = rng.integers(21, size=(5, 2))
    between = rng.uniform([0.9, 0.9], [1.1, 1.0], (5, 2)) * start[:2]
    # A spline is exact at its nodes; where a limit of the rim becomes active it smooths the kink,
    # by little more than the tolerance of the flight.
    cases = [(np.array([nodes[i, 0], nodes[k, 1]]), 1e-12, 1e-12) for i, k in at_nodes]
    cases += [(point, 1.5 * DEFECT_MAX, 1e-3) for point in between]
    for point, inertia_tolerance, mass_tolerance in cases:
        dimensions = np.append(point, rng.uniform(0.0, 1.57))
        result = device.at(*dimensions)
        inertia, axes, spin_inertia, armature, mass = plant(dimensions)
        atol = inertia_tolerance * result.total.inertia.max()
        np.testing.assert_allclose(inertia, result.total.inertia, rtol=0, atol=atol)
        np.testing.assert_allclose(axes, module_axes(dimensions[2]), rtol=0, atol=1e-15)
        assert float(spin_inertia) == pytest.approx(result.spin_inertia, rel=1e-12)
        assert float(armature) == selected.drive.armature
        assert float(mass) * selected.mass == pytest.approx(result.mass, rel=mass_tolerance)


def with_selected_wheels(problem, selected):
    """The co-design's device with the wheels of the selection."""
    return next(with_wheels(problem, selected, np.ones(1), np.ones(1)))


@pytest.mark.parametrize("seed", [ROLL_AND_PITCH, GEARED, FLIPPING, CHANGING_RATE])
def test_the_search_starts_at_the_selected_device(seed):
    """It may be slightly lighter, as flatter modules of the selected radius are allowed."""
    problem, selected = problem_and_selection(seed)
    result = with_selected_wheels(problem, selected)
    assert result.spin_inertia == pytest.approx(selected.spin_inertia, rel=1e-12)
    assert result.outer_radius == pytest.approx(selected.outer_radius, rel=1e-12)
    assert result.mass <= selected.mass * (1.0 + 1e-9)
    assert result.mass == pytest.approx(selected.mass, rel=1e-4)


def test_the_co_design_is_never_heavier_and_explains_its_result(solved):
    _, selected, result = solved
    assert result.status == "Solve_Succeeded"
    assert result.device.mass <= selected.mass
    assert result.adopted == (result.gain > LEAST_GAIN)
    assert result.remark.count(".") <= 1
    assert ("the selected device is kept" in result.remark) != result.adopted


def test_its_maneuvers_are_feasible_on_the_fine_grid(solved):
    problem, selected, result = solved
    assert len(result.flights) == len(problem.requirement.maneuvers)
    line = selected.line.reserved()
    for maneuver, flight in zip(problem.requirement.maneuvers, result.flights, strict=True):
        angle = result.device.incidence if maneuver.incidence is None else maneuver.incidence
        wheels = Gyrostat(np.eye(3), module_axes(angle), 1.0)
        assert flight.violation < 1e-6
        assert attitude_error(maneuver.boundary(), flight.trajectory) < 1e-4
        assert end_rate(wheels, flight.trajectory) < 1e-4
        assert flight.defect < 1e-4
        assert np.abs(flight.trajectory.wheel_torque).max() <= line.torque_limit * (1.0 + 1e-6)


def test_its_rim_is_within_the_limits(solved):
    _, selected, result = solved
    limits, rim = selected.limits, result.device
    nu, slack = limits.poisson_ratio, 1.0 + 1e-9
    assert rim.outer_radius <= limits.outer_radius_max * slack
    assert rim.inner_radius * slack >= limits.inner_radius_min
    assert limits.height_min <= rim.height * slack
    assert rim.height <= limits.height_max * slack
    assert rim.outer_radius - rim.inner_radius >= limits.wall_min / (1.0 + 1e-6)
    stretch = (3.0 + nu) * rim.outer_radius**2 + (1.0 - nu) * rim.inner_radius**2
    assert stretch <= limits.stretch_max * (1.0 + 1e-6)


def test_an_adopted_device_is_consistent(solved):
    problem, selected, result = solved
    device = result.device
    if not result.adopted:
        assert device is selected
        return
    assert device.mass == pytest.approx(result.mass, rel=1e-12)
    spin = wheel_body(device)[1] + device.drive.rotor_inertia
    assert device.spin_inertia == pytest.approx(spin, rel=1e-9)
    bodies = (device.wheel, device.carrier)
    total = braked(problem.robot, bodies, device.centers, device.incidence)
    np.testing.assert_allclose(device.total.inertia, total.inertia, rtol=1e-12, atol=1e-15)
    assert [each.source for each in device.demands] == [each.source for each in selected.demands]
    line = selected.line.reserved()
    for demand in device.demands:
        assert demand.spin_inertia <= device.spin_inertia * (1.0 + 1e-6)
        assert demand.peak_speed <= min(line.no_load_speed, line.speed_max) * (1.0 + 1e-6)


def test_roll_and_pitch_at_once_gain_in_3d():
    """The closed form fixes the axis and the ratio of the wheels; in 3-D both are free."""
    result = co_designed(ROLL_AND_PITCH)
    assert result.adopted
    assert result.gain > 0.007


def test_a_rate_change_gains_nothing():
    """No maneuver in 3-D makes it easier."""
    _, selected = problem_and_selection(CHANGING_RATE)
    assert selected.binding_maneuver.startswith("rate change")
    assert abs(co_designed(CHANGING_RATE).gain) < 3e-4


def test_a_specified_spin_inertia_is_kept():
    problem, selected = problem_and_selection(ROLL_AND_PITCH)
    specified = replace(problem.requirement, spin_inertia=selected.spin_inertia)
    result = co_design(replace(problem, requirement=specified), selected)
    assert not result.adopted
    assert result.device is selected
    assert "is specified" in result.remark


def test_limits_that_leave_one_wheel_keep_the_selection():
    problem, selected = problem_and_selection(ROLL_AND_PITCH)
    size = {
        "outer_radius_max": selected.outer_radius,
        "inner_radius_min": selected.inner_radius,
        "height_max": selected.height,
        "height_min": selected.height,
        "wall_min": 0.999 * (selected.outer_radius - selected.inner_radius),
    }
    result = co_design(problem, replace(selected, limits=replace(selected.limits, **size)))
    assert not result.adopted
    assert "no choice" in result.remark


def test_a_failure_of_ipopt_keeps_the_selection(monkeypatch):
    monkeypatch.setattr(program, "ITERATIONS_MAX", 3)
    _, selected = problem_and_selection(ROLL_AND_PITCH)
    result = co_design(*problem_and_selection(ROLL_AND_PITCH))
    assert not result.adopted
    assert result.status == "Maximum_Iterations_Exceeded"
    assert result.status in result.remark
    assert result.device is selected


@pytest.mark.exhaustive
def test_the_coarse_mesh_counts_where_the_finer_one_fails(monkeypatch):
    """The second pass has two iterations only."""
    refined = Motion.refined

    def second_pass(motion, intervals):
        monkeypatch.setattr(program, "ITERATIONS_MAX", 2)
        return refined(motion, intervals)

    monkeypatch.setattr(Motion, "refined", second_pass)
    result = co_design(*problem_and_selection(ROLL_AND_PITCH))
    assert result.status == "Solve_Succeeded"
    assert result.adopted


@pytest.mark.exhaustive
def test_a_specified_incidence_is_kept():
    problem = replace(random_problem(ROLL_AND_PITCH, mounted=False), incidence=0.5)
    selected = lightest(problem)
    assert co_design(problem, selected).device.incidence == 0.5
