"""Laws of the selection, on random problems."""

from dataclasses import replace
from functools import cache
from math import inf, pi

import numpy as np
import pytest
from random_cases import random_case
from subsets import fast_subset

from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import Infeasible
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.sizing.selection.select import select

FEASIBLE_SEEDS = (2, 6)
"""Two feasible cases that together have all kinds of maneuvers."""
ON_THE_EDGE = 15
"""A case whose lightest drive is feasible with few wheels, and at few incidences."""
EXACT = 1e-9
"""Relative tolerance of a mass."""


@pytest.fixture(
    scope="module",
    params=[FEASIBLE_SEEDS[0], pytest.param(FEASIBLE_SEEDS[1], marks=pytest.mark.exhaustive)],
)
def problem(request):
    return random_case(request.param).problem


chosen = cache(select)
"""The selection of a problem, computed once."""


def mass(problem):
    """Mass of the lightest device [kg]; inf if infeasible."""
    try:
        return chosen(problem).best.mass
    except Infeasible:
        return inf


def no_heavier(problem, *others):
    """Whether each problem's device is no heavier than that of the one before."""
    masses = [mass(each) for each in (problem, *others)]
    assert np.isfinite(masses[-1])
    pairs = zip(masses[1:], masses[:-1], strict=True)
    return all(after <= before * (1.0 + EXACT) for after, before in pairs)


def slower(maneuver, factor):
    """The same turn, or the same push, in a time longer by a factor."""
    match maneuver:
        case Drop():
            fall = maneuver.height - maneuver.standing_height
            return replace(maneuver, height=maneuver.standing_height + fall * factor**2)
        case Flip():
            return replace(maneuver, duration=maneuver.duration * factor)
        case Disturbance():
            forward, up = maneuver.takeoff_velocity
            return replace(maneuver, takeoff_velocity=(forward, up * factor))


def with_maneuvers(problem, maneuvers):
    return replace(problem, requirement=replace(problem.requirement, maneuvers=tuple(maneuvers)))


def test_more_time_is_no_heavier(problem):
    relaxed = [
        with_maneuvers(problem, [slower(each, factor) for each in problem.requirement.maneuvers])
        for factor in (1.05, 1.3)
    ]
    assert no_heavier(problem, *relaxed)


def test_fewer_requirements_are_no_heavier(problem):
    drop = with_maneuvers(problem, problem.requirement.maneuvers[:1])
    without_rate = replace(drop, requirement=replace(drop.requirement, rate_change=None))
    assert no_heavier(problem, drop, without_rate)


@pytest.mark.parametrize(
    ("name", "factors"),
    [
        ("outer_radius_max", (1.1, 1.5)),
        pytest.param("height_max", (1.1, 1.5), marks=pytest.mark.slow),
        *(
            pytest.param(name, (0.7,), marks=pytest.mark.slow)
            for name in ("inner_radius_min", "height_min", "wall_min")
        ),
        ("stress_safety", (0.7,)),
    ],
)
def test_looser_limits_are_no_heavier(problem, name, factors):
    envelope = problem.envelope
    looser = [replace(envelope, **{name: getattr(envelope, name) * by}) for by in factors]
    assert no_heavier(problem, *(replace(problem, envelope=each) for each in looser))


@pytest.mark.parametrize("name", fast_subset(3, ["motors", "gears", "materials"]))
def test_more_choices_are_no_heavier(problem, name):
    choices = getattr(problem, name)
    fewer = [replace(problem, **{name: choices[:count]}) for count in range(1, len(choices) + 1)]
    assert no_heavier(*fewer)


@pytest.mark.slow
def test_the_ranking_is_that_of_all_combinations(problem):
    check_ranking(problem)


@pytest.mark.exhaustive
def test_the_ranking_of_a_barely_feasible_problem():
    check_ranking(random_case(ON_THE_EDGE).problem)


def check_ranking(problem):
    """No combination of motor, gear and material that was pruned is lighter by itself."""
    alone = [
        mass(replace(problem, motors=[motor], gears=[gear], materials=[material]))
        for motor in problem.motors
        for gear in problem.gears
        for material in problem.materials
    ]
    ranked = [device.mass for device in chosen(problem).ranking]
    per_motor = np.array(alone).reshape(len(problem.motors), -1)
    leaders = sorted(each for each in per_motor.min(axis=1) if each < inf)[:5]
    ten = sorted(each for each in alone if each < inf)[:10]
    expected = sorted([*ten, *(each for each in leaders if each not in ten)])
    assert len(ranked) == len(expected)
    assert ranked[0] == pytest.approx(expected[0], rel=EXACT)
    # Below the first, masses may be a few percent above the least.
    assert np.all(np.array(ranked) >= np.array(expected) * (1.0 - EXACT))


def test_more_voltage_is_no_heavier_where_no_speed_is_limited(problem):
    """Neither speed nor stress is limited, since more voltage makes rims turn faster."""
    motors = [replace(motor, speed_max=1e6) for motor in problem.motors]
    gears = [replace(gear, motor_speed_max=inf, wheel_speed_max=inf) for gear in problem.gears]
    unlimited = replace(
        problem,
        motors=motors,
        gears=gears,
        wheel_speed_max=None,
        materials=[replace(kind, yield_strength=None) for kind in problem.materials],
    )
    volts = unlimited.supply.voltage
    higher = [replace(unlimited, supply=Supply(volts * by)) for by in (1.2, 2.0)]
    assert no_heavier(unlimited, *higher)


@pytest.mark.exhaustive
def test_a_free_incidence_is_no_heavier_than_a_fixed_one(problem):
    free = mass(replace(problem, incidence=None))
    fixed = [
        mass(replace(problem, incidence=float(angle))) for angle in np.linspace(0.0, pi / 2.0, 10)
    ]
    assert free <= min(fixed) * (1.0 + EXACT)


def test_the_ranking_is_sorted_unique_and_converged(problem):
    ranking = chosen(problem).ranking
    masses = [device.mass for device in ranking]
    assert masses == sorted(masses)
    names = {(d.motor.name, d.gear.name, d.material.name) for d in ranking}
    assert len(names) == len(ranking) <= 14
    for device in ranking:
        assert device.residual < 1e-9
        assert device.total.mass == pytest.approx(problem.robot.mass + device.mass, rel=1e-12)


@pytest.mark.parametrize("factor", [1.01, 1.05])
def test_a_specified_spin_inertia_is_kept(problem, factor):
    best = chosen(problem).best
    # With the same drive, as another one may have less momentum in the same wheel.
    alone = replace(problem, motors=[best.motor], gears=[best.gear], materials=[best.material])
    specified = factor * best.spin_inertia
    requirement = replace(alone.requirement, spin_inertia=specified)
    larger = select(replace(alone, requirement=requirement)).best
    assert larger.spin_inertia == pytest.approx(specified, rel=1e-9)
    assert larger.mass >= best.mass * (1.0 - EXACT)
