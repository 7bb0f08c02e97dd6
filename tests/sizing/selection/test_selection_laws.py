"""What must hold of a selection whatever its robot: laws on problems drawn at random."""

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

POSSIBLE = (2, 6)
"""Of the drawn problems, two with a device and all kinds of maneuvers between them."""
ON_THE_EDGE = 15
"""One whose lightest drive can carry few wheels, and those at few incidences."""
EXACT = 1e-9
"""To which a mass is settled, relative."""


@pytest.fixture(
    scope="module", params=[POSSIBLE[0], pytest.param(POSSIBLE[1], marks=pytest.mark.exhaustive)]
)
def problem(request):
    return random_case(request.param).problem


chosen = cache(select)
"""The selection of a problem, made once."""


def mass(problem):
    """Of the lightest device [kg]; inf where there is none."""
    try:
        return chosen(problem).best.mass
    except Infeasible:
        return inf


def no_heavier(problem, *others):
    """Each of these is no heavier than the one before."""
    masses = [mass(each) for each in (problem, *others)]
    assert np.isfinite(masses[-1])
    pairs = zip(masses[1:], masses[:-1], strict=True)
    return all(after <= before * (1.0 + EXACT) for after, before in pairs)


def in_more_time(maneuver, standing, times):
    """The same turn, or the same push, with so many times as long for it."""
    match maneuver:
        case Drop():
            return replace(maneuver, height=standing + (maneuver.height - standing) * times**2)
        case Flip():
            return replace(maneuver, duration=maneuver.duration * times)
        case Disturbance():
            forward, up = maneuver.takeoff_velocity
            return replace(maneuver, takeoff_velocity=(forward, up * times))


def with_maneuvers(problem, maneuvers):
    return replace(problem, requirement=replace(problem.requirement, maneuvers=tuple(maneuvers)))


def test_more_time_is_no_heavier(problem):
    standing = problem.requirement.standing_height
    slower = [
        with_maneuvers(
            problem,
            [in_more_time(each, standing, times) for each in problem.requirement.maneuvers],
        )
        for times in (1.05, 1.3)
    ]
    assert no_heavier(problem, *slower)


def test_less_to_do_is_no_heavier(problem):
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
    room = problem.envelope
    rooms = [replace(room, **{name: getattr(room, name) * times}) for times in factors]
    assert no_heavier(problem, *(replace(problem, envelope=each) for each in rooms))


@pytest.mark.parametrize("name", fast_subset(3, ["motors", "gears", "materials"]))
def test_more_to_choose_from_is_no_heavier(problem, name):
    choices = getattr(problem, name)
    fewer = [replace(problem, **{name: choices[:count]}) for count in range(1, len(choices) + 1)]
    assert no_heavier(*fewer)


@pytest.mark.slow
def test_the_lightest_is_that_of_each_combination_by_itself(problem):
    check_each_by_itself(problem)


@pytest.mark.exhaustive
def test_so_it_is_on_the_edge_of_the_possible():
    check_each_by_itself(random_case(ON_THE_EDGE).problem)


def check_each_by_itself(problem):
    """Whatever was left out, no motor, gear and material by themselves are lighter."""
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
    possible = sorted([*ten, *(each for each in leaders if each not in ten)])
    assert len(ranked) == len(possible)
    assert ranked[0] == pytest.approx(possible[0], rel=EXACT)
    # Behind the first, up to some percent more than would have to be.
    assert np.all(np.array(ranked) >= np.array(possible) * (1.0 - EXACT))


def test_more_voltage_is_no_heavier_where_no_speed_is_limited(problem):
    """No limit of speed binds at 60 V more, and no stress: rims may then turn ever faster."""
    motors = [replace(motor, speed_max=1e6) for motor in problem.motors]
    gears = [replace(gear, motor_speed_max=inf, wheel_speed_max=inf) for gear in problem.gears]
    free = replace(
        problem,
        motors=motors,
        gears=gears,
        wheel_speed_max=None,
        materials=[replace(kind, yield_strength=None) for kind in problem.materials],
    )
    volts = free.supply.voltage
    higher = [replace(free, supply=Supply(volts * times)) for times in (1.2, 2.0)]
    assert no_heavier(free, *higher)


@pytest.mark.exhaustive
def test_a_free_incidence_is_no_heavier_than_any(problem):
    free = mass(replace(problem, incidence=None))
    fixed = [
        mass(replace(problem, incidence=float(angle))) for angle in np.linspace(0.0, pi / 2.0, 10)
    ]
    assert free <= min(fixed) * (1.0 + EXACT)


def test_the_ranking_is_sorted_settled_and_adds_up(problem):
    ranking = chosen(problem).ranking
    masses = [device.mass for device in ranking]
    assert masses == sorted(masses)
    names = {(d.motor.name, d.gear.name, d.material.name) for d in ranking}
    assert len(names) == len(ranking) <= 14
    for device in ranking:
        assert device.residual < 1e-9
        assert device.total.mass == pytest.approx(problem.robot.mass + device.mass, rel=1e-12)


@pytest.mark.parametrize("times", [1.01, 1.05])
def test_a_stated_spin_inertia_is_kept(problem, times):
    best = chosen(problem).best
    # Of the same drive: another one may have less momentum in the same wheel.
    alone = replace(problem, motors=[best.motor], gears=[best.gear], materials=[best.material])
    specified = times * best.spin_inertia
    asking = replace(alone, requirement=replace(alone.requirement, spin_inertia=specified))
    kept = select(asking).best
    assert kept.spin_inertia == pytest.approx(specified, rel=1e-9)
    assert kept.mass >= best.mass * (1.0 - EXACT)
