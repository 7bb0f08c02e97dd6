"""Shadow prices and demands of a selection, against an independent optimization."""

from dataclasses import replace

import numpy as np
import pytest
from naive_device import Drive, chamfer_of, coupling_on, demand_of, inertia_on, release_unreached
from naive_wheel import Rims
from random_cases import random_case
from rims import STEEL
from scipy.optimize import minimize
from selections import lightest

from ocs_design.requirement.turns import Drop, Flip
from ocs_design.sizing.sized import sized_selection

FIELD = {
    "r_max": "outer_radius_max",
    "h_max": "height_max",
    "wall_min": "wall_min",
    "h_min": "height_min",
}
STEP = 1e-3
"""Relative step of a limit: the error of central differences is about its square."""


def stressed(problem, safety):
    """The problem with steel only, and this safety of the stress."""
    envelope = replace(problem.envelope, stress_safety=safety)
    return replace(problem, envelope=envelope, materials=(STEEL,))


PROBLEMS = {
    "wide and tall": random_case(2).problem,
    "thin": random_case(4).problem,
    "stressed": stressed(random_case(1).problem, 8.0),
    "crowded": stressed(random_case(4).problem, 15.0),
}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param("wide and tall", marks=pytest.mark.slow),
        pytest.param("thin", marks=pytest.mark.slow),
        "stressed",
        pytest.param("crowded", marks=pytest.mark.exhaustive),
    ],
)
def solution(request):
    problem = replace(PROBLEMS[request.param], incidence=0.4)
    best = lightest(problem)
    return problem, best, sized_selection(problem, best, problem.robot)


def lightest_mass(problem, device, envelope, stress):
    """Least mass of one rim with its housing, over both radii relative to the device's."""
    drive, chamfer = Drive(problem, device.motor, device.gear), chamfer_of(problem)
    density, nu = device.material.density, device.material.poisson_ratio
    web_density = drive.web_density(density)
    disc = (web_density, drive.web_thickness, drive.web_hub) if drive.has_web else ()
    inertia = device.spin_inertia - drive.rotor_momentum - web_density * drive.hub[1]
    radius = device.outer_radius

    def rims(x):
        outer, inner = radius * x
        web = Rims(outer, inner, 0.0, density).web(*disc)[1] if drive.has_web else 0.0
        edges = Rims(outer, inner, 0.0, density, chamfer).body[1]
        height = 2.0 * (inertia - web - edges) / (np.pi * density * (outer**4 - inner**4))
        return Rims(outer, inner, height, density, chamfer)

    def mass(x):
        rim = rims(x)
        web = rim.web(*disc) + web_density * drive.hub if drive.has_web else np.zeros(3)
        one = Rims(*np.array([[rim.outer], [rim.inner], [rim.height]]), density, chamfer)
        return rim.body[0] + web[0] + drive.carrier(one)[0, 0]

    def margins(x):
        rim = rims(x)
        squares = (3.0 + nu) * rim.outer**2 + (1.0 - nu) * rim.inner**2
        hoop_stress = density * drive.proof_speed**2 / 4.0 * squares
        return np.array(
            [
                1.0 - rim.outer / envelope.outer_radius_max,
                rim.inner / max(envelope.inner_radius_min, drive.hub_radius) - 1.0,
                1.0 - rim.height / envelope.height_max,
                rim.height / max(envelope.height_min, drive.height_min(density)) - 1.0,
                (rim.outer - rim.inner) / envelope.wall_min - 1.0,
                1.0 - rim.body[0] / envelope.mass_max,
                1.0 - hoop_stress / stress,
            ]
        )

    scale = mass(np.array([1.0, device.inner_radius / radius]))
    starts = ([1.0, device.inner_radius / radius], [0.97, 0.8], [0.97, 0.5])
    solutions = [
        minimize(
            lambda x: mass(x) / scale,
            start,
            method="SLSQP",
            constraints={"type": "ineq", "fun": margins},
            options={"ftol": 1e-15, "maxiter": 500},
        )
        for start in starts
    ]
    return scale * min(each.fun for each in solutions if margins(each.x).min() > -1e-9)


def allowed_stress(problem, device):
    return device.material.yield_strength / problem.envelope.stress_safety


def masses_around(problem, device, name):
    """Least masses with a slightly smaller and larger limit, and the value of the limit."""
    envelope, stress = problem.envelope, allowed_stress(problem, device)
    factors = (1.0 - STEP, 1.0 + STEP)
    if name == "hoop_stress":
        masses = [lightest_mass(problem, device, envelope, stress * by) for by in factors]
        return masses, stress
    value = getattr(envelope, FIELD[name])
    envelopes = [replace(envelope, **{FIELD[name]: value * by}) for by in factors]
    return [lightest_mass(problem, device, each, stress) for each in envelopes], value


@pytest.mark.slow
def test_shadow_prices_are_derivatives_of_the_mass(solution):
    problem, device, sized = solution
    assert sized.optimum.shadow_prices
    for name, price in sized.optimum.shadow_prices.items():
        (less, more), value = masses_around(problem, device, name)
        expected = (more - less) / (2.0 * STEP * value)
        assert price == pytest.approx(expected, rel=1e-4), name


def test_active_limits_have_a_price(solution):
    _, device, sized = solution
    assert set(sized.optimum.shadow_prices) == set(device.binding) - {"housing"}


def test_the_wheel_speed_is_limited_by_reserve_and_mechanics(solution):
    problem, device, sized = solution
    top = Drive(problem, device.motor, device.gear).speed_max
    assert sized.wheel_speed_max == pytest.approx(top, rel=1e-12)


def test_demands_use_the_inertia_with_the_device(solution):
    """For turns 2 I theta / T and 4 I theta / T^2 of the wheel with more load (docs/theory.md)."""
    problem, device, sized = solution
    turns = [turn for turn in problem.requirement.maneuvers if isinstance(turn, (Drop, Flip))]
    demands = {demand.source: demand for demand in sized.demands}
    assert turns
    for turn in turns:
        angle = device.incidence if turn.incidence is None else turn.incidence
        # A cosine of 1e-17 counts as zero.
        levers = 2.0 * np.maximum([np.sin(angle), np.cos(angle)], 1e-12)
        shares = np.array([[np.sin(angle)], [np.cos(angle)]])
        inertia, coupling = inertia_at(problem, device, angle)
        # Full and small turns may leave an axis that the wheels do not control free.
        inertia, coupling = release_unreached(inertia, coupling, shares, 0.0)
        swept, _, time = demand_of(turn, inertia, coupling)
        momentum = 2.0 * np.abs(swept[:, 0]) / time
        np.testing.assert_allclose(demands[turn.name].momentum, momentum, rtol=1e-9, atol=1e-15)
        torque = (2.0 * momentum / time / levers).sum()
        assert demands[turn.name].torque == pytest.approx(torque, rel=1e-9)


def inertia_at(problem, device, angle):
    """Inertia about roll and pitch, and coupling, with the device at this incidence."""
    drive = Drive(problem, device.motor, device.gear)
    sizes = (device.outer_radius, device.inner_radius, device.height)
    edges = chamfer_of(problem)
    rims = Rims(*(np.array([size]) for size in sizes), device.material.density, edges)
    at = np.array([angle])
    return inertia_on(problem, drive, rims, at), coupling_on(problem, drive, rims, at)


def test_a_rate_change_is_a_demand_of_each_axis(solution):
    problem, _, _ = solution
    with_rate = replace(problem, requirement=replace(problem.requirement, rate_change=0.1))
    device = lightest(with_rate)
    demands = {
        each.source: each for each in sized_selection(with_rate, device, with_rate.robot).demands
    }
    _, coupling = inertia_at(with_rate, device, device.incidence)
    for axis, name in enumerate(("roll", "pitch")):
        expected = np.full(2, 0.1 * abs(coupling.item()))
        expected[axis] = 0.1 * device.total.inertia[axis, axis]
        momentum = demands[f"rate change, {name}"].momentum
        np.testing.assert_allclose(momentum, expected, rtol=1e-9, atol=1e-15)
