"""What limits cost, against optimising the module anew on another path."""

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
"""Relative, of a limit: central differences are then right to about its square."""


def stressed(problem, safety):
    """Of steel alone, and that far from its strength."""
    room = replace(problem.envelope, stress_safety=safety)
    return replace(problem, envelope=room, materials=(STEEL,))


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
def answer(request):
    problem = replace(PROBLEMS[request.param], incidence=0.4)
    best = lightest(problem)
    return problem, best, sized_selection(problem, best, problem.robot)


def lightest_mass(problem, device, room, stress):
    """Of one rim with its housing, over outer and inner radius in parts of the design's."""
    drive, chamfer = Drive(problem, device.motor, device.gear), chamfer_of(problem)
    density, nu = device.material.density, device.material.poisson_ratio
    of_web = drive.web_density(density)
    disc = (of_web, drive.web, drive.in_web) if drive.webbed else ()
    inertia = device.spin_inertia - drive.rotor_momentum - of_web * drive.hub[1]
    radius = device.outer_radius

    def rims(x):
        outer, inner = radius * x
        web = Rims(outer, inner, 0.0, density).web(*disc)[1] if drive.webbed else 0.0
        edges = Rims(outer, inner, 0.0, density, chamfer).body[1]
        height = 2.0 * (inertia - web - edges) / (np.pi * density * (outer**4 - inner**4))
        return Rims(outer, inner, height, density, chamfer)

    def mass(x):
        rim = rims(x)
        web = rim.web(*disc) + of_web * drive.hub if drive.webbed else np.zeros(3)
        one = Rims(*np.array([[rim.outer], [rim.inner], [rim.height]]), density, chamfer)
        return rim.body[0] + web[0] + drive.standing(one)[0, 0]

    def spare(x):
        rim = rims(x)
        squares = (3.0 + nu) * rim.outer**2 + (1.0 - nu) * rim.inner**2
        stressed = density * drive.proof_speed**2 / 4.0 * squares
        return np.array(
            [
                1.0 - rim.outer / room.outer_radius_max,
                rim.inner / max(room.inner_radius_min, drive.hub_radius) - 1.0,
                1.0 - rim.height / room.height_max,
                rim.height / max(room.height_min, drive.seat(density)) - 1.0,
                (rim.outer - rim.inner) / room.wall_min - 1.0,
                1.0 - rim.body[0] / room.mass_max,
                1.0 - stressed / stress,
            ]
        )

    whole = mass(np.array([1.0, device.inner_radius / radius]))
    starts = ([1.0, device.inner_radius / radius], [0.97, 0.8], [0.97, 0.5])
    found = [
        minimize(
            lambda x: mass(x) / whole,
            start,
            method="SLSQP",
            constraints={"type": "ineq", "fun": spare},
            options={"ftol": 1e-15, "maxiter": 500},
        )
        for start in starts
    ]
    return whole * min(each.fun for each in found if spare(each.x).min() > -1e-9)


def allowed_stress(problem, device):
    return device.material.yield_strength / problem.envelope.stress_safety


def masses_around(problem, device, name):
    """With the limit a little less and a little more, and the limit's own value."""
    room, stress = problem.envelope, allowed_stress(problem, device)
    factors = (1.0 - STEP, 1.0 + STEP)
    if name == "hoop_stress":
        found = [lightest_mass(problem, device, room, stress * by) for by in factors]
        return found, stress
    value = getattr(room, FIELD[name])
    rooms = [replace(room, **{FIELD[name]: value * by}) for by in factors]
    return [lightest_mass(problem, device, each, stress) for each in rooms], value


@pytest.mark.slow
def test_prices_are_what_one_more_of_a_limit_is_worth(answer):
    problem, device, sized = answer
    assert sized.optimum.shadow_prices
    for name, price in sized.optimum.shadow_prices.items():
        (less, more), value = masses_around(problem, device, name)
        expected = (more - less) / (2.0 * STEP * value)
        assert price == pytest.approx(expected, rel=1e-4), name


def test_what_binds_has_a_price_if_it_is_a_limit(answer):
    _, device, sized = answer
    assert set(sized.optimum.shadow_prices) == set(device.binding) - {"housing"}


def test_the_wheel_may_turn_as_fast_as_reserve_and_mechanics_allow(answer):
    problem, device, sized = answer
    top = Drive(problem, device.motor, device.gear).top
    assert sized.wheel_speed_max == pytest.approx(top, rel=1e-12)


def test_demands_are_those_of_the_inertia_with_the_device(answer):
    """Turns: 2 I theta / T and 4 I theta / T^2, of the busier wheel (docs/theory.md)."""
    problem, device, sized = answer
    turns = [turn for turn in problem.requirement.maneuvers if isinstance(turn, (Drop, Flip))]
    demands = {demand.source: demand for demand in sized.demands}
    assert turns
    for turn in turns:
        angle = device.incidence if turn.incidence is None else turn.incidence
        # A cosine of 1e-17 is no lever, and of no use either.
        levers = 2.0 * np.maximum([np.sin(angle), np.cos(angle)], 1e-12)
        shares = np.array([[np.sin(angle)], [np.cos(angle)]])
        inertia, coupling = worked_out(problem, device, angle)
        # Whole turns and small ones may be left to themselves where the wheels do not reach.
        inertia, coupling = release_unreached(inertia, coupling, shares, 0.0)
        height = problem.requirement.standing_height
        swept, _, time = demand_of(turn, inertia, coupling, height)
        momentum = 2.0 * np.abs(swept[:, 0]) / time
        np.testing.assert_allclose(demands[turn.name].momentum, momentum, rtol=1e-9, atol=1e-15)
        torque = (2.0 * momentum / time / levers).sum()
        assert demands[turn.name].torque == pytest.approx(torque, rel=1e-9)


def worked_out(problem, device, angle):
    """Inertia about roll and pitch with the device on and turned to this angle, by hand."""
    drive = Drive(problem, device.motor, device.gear)
    sizes = (device.outer_radius, device.inner_radius, device.height)
    edges = chamfer_of(problem)
    rims = Rims(*(np.array([size]) for size in sizes), device.material.density, edges)
    at = np.array([angle])
    return inertia_on(problem, drive, rims, at), coupling_on(problem, drive, rims, at)


def test_a_rate_change_is_a_demand_of_each_axis(answer):
    problem, _, _ = answer
    asking = replace(problem, requirement=replace(problem.requirement, rate_change=0.1))
    device = lightest(asking)
    demands = {each.source: each for each in sized_selection(asking, device, asking.robot).demands}
    _, coupling = worked_out(asking, device, device.incidence)
    for axis, name in enumerate(("roll", "pitch")):
        expected = np.full(2, 0.1 * abs(coupling.item()))
        expected[axis] = 0.1 * device.total.inertia[axis, axis]
        found = demands[f"rate change, {name}"].momentum
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-15)
