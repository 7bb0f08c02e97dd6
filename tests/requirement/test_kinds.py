"""Laws for maneuvers of every kind."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from specifications import MANEUVERS

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.requirement.boundary import End
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.maneuver import Built
from ocs_design.requirement.pivoted import StandUp
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Catch
from ocs_design.robot.mass import MassProperties

BODY = MassProperties(2.5, np.array([0.01, 0.0, 0.02]), np.diag([0.03, 0.05, 0.07]))
CATCH = Catch(name="catch", jump_height=0.5, rate=(0.4, -0.8, 0.0), duration=0.6)
ALL_MANEUVERS = tuple(replace(each, standing_height=0.25).on(BODY) for each in (*MANEUVERS, CATCH))


for_every_kind = pytest.mark.parametrize("maneuver", ALL_MANEUVERS, ids=lambda each: each.name)


def test_every_kind_is_tested():
    kinds = {kind.maneuver for kind in MANEUVER_KINDS.values()}
    assert {type(each) for each in ALL_MANEUVERS} == kinds
    # A field without a default would take a property of the same name in a base class.
    assert not [
        (kind, each.name)
        for kind in kinds
        for each in fields(kind)
        if isinstance(each.default, property)
    ]


@for_every_kind
def test_the_turn_leads_from_the_start_to_the_end(maneuver):
    boundary = maneuver.boundary()
    attitudes = [boundary.attitude, boundary.final_attitude]
    start, final = Rotation.from_quat(attitudes, scalar_first=True)
    turn = Rotation.from_rotvec(boundary.angle * boundary.axis)
    # About a pivot the axis is given in the world.
    turned = turn * start if maneuver.on_pivot else start * turn
    if boundary.end != End.ATTITUDE:
        # The heading is free.
        turned, final = (each.inv().apply([0.0, 0.0, 1.0]) for each in (turned, final))
        np.testing.assert_allclose(turned, final, rtol=0, atol=1e-12)
    else:
        assert (turned.inv() * final).magnitude() < 1e-12


@for_every_kind
@pytest.mark.parametrize("factor", [0.9, 1.0, 1.4])
def test_a_slower_maneuver_has_more_time_by_the_factor(maneuver, factor):
    before, after = (each.boundary() for each in (maneuver, maneuver.slower(factor)))
    assert after.duration == pytest.approx(factor * before.duration, rel=1e-12)
    np.testing.assert_array_equal(after.attitude, before.attitude)


@for_every_kind
def test_a_maneuver_reduced_to_zero_requires_nothing(maneuver):
    assert not maneuver.zero_demand
    assert bool(maneuver.milder(0.0).zero_demand) == bool(maneuver.milder_by)
    assert not maneuver.reducible or maneuver.milder_by


@for_every_kind
def test_only_turns_are_possible_without_gravity(maneuver):
    assert not list(maneuver.contradictions())
    (fault,) = replace(maneuver, gravity=0.0).contradictions()
    assert "orbit" in fault
    if maneuver.heading_matters:
        assert not list(replace(maneuver, gravity=0.0, jump_height=0.0).contradictions())


@for_every_kind
def test_a_flight_lands_at_its_take_off_height(maneuver):
    """A parabola, except for a push during the flight."""
    if maneuver.rise:
        height = maneuver.rise - maneuver.gravity * (maneuver.flight_time / 2.0) ** 2 / 2.0
        assert height == pytest.approx(0.0, abs=1e-12)


def slews(maneuver, **errors):
    """Slew of a design and of one robot built with these errors."""
    inertia = TiltInertia.uncoupled([[0.03, 0.05]])
    exact = {"offset": np.zeros((1, 3)), "weight": np.ones(1), "bias": np.zeros((1, 2))}
    designed = maneuver.slew(inertia)
    return designed, maneuver.as_built(designed, Built(**exact | errors))


@for_every_kind
def test_a_robot_without_errors_has_the_slew_of_the_design(maneuver):
    designed, built = slews(maneuver)
    np.testing.assert_array_equal(built.swept, designed.swept)
    np.testing.assert_array_equal(built.momentum, designed.momentum)


def test_a_kick_turns_a_robot_about_its_true_centre_of_mass():
    times = {"takeoff_velocity": (0.0, 2.5), "torque": (0.0,) * 3, "onset": 0.1, "duration": 0.05}
    kick = Disturbance(name="kick", **times, impulse=(0.2, -0.5, 0.1), point=(0.1, 0.05, 0.1))
    offset = np.array([0.004, -0.003, 0.002])
    moved = replace(BODY, com=BODY.com + offset)
    _, built = slews(kick.on(BODY), offset=offset[None])
    expected, _ = slews(kick.on(moved))
    np.testing.assert_allclose(built.momentum, expected.momentum, rtol=1e-9)
    np.testing.assert_allclose(built.swept, expected.swept, rtol=1e-9)


@pytest.mark.parametrize("actuation", ["motor", "brake"])
def test_on_a_pivot_errors_of_balance_and_level_are_a_larger_tilt(actuation):
    stand = {"name": "up", "pivot": (0.01, 0.0, -0.28), "duration": 0.4, "actuation": actuation}
    edge = {"edge": (0.0, 1.0, 0.0)}
    up = StandUp(**stand, **edge, pitch=0.2).on(BODY)
    assert np.linalg.norm(up.lever) == pytest.approx(0.3)
    # 3 mm forward over a lever of 300 mm are 0.01 rad nose down, as is a level measured too low.
    _, forward = slews(up, offset=np.array([[0.003, 0.0, 0.0]]))
    _, lowered = slews(up, bias=np.array([[0.0, -0.01]]))
    designed, tilted = slews(replace(up, pitch=0.21), weight=np.full(1, 1.02))
    expected = designed if actuation == "motor" else slews(up)[0]
    for built in (forward, lowered):
        np.testing.assert_allclose(built.swept, expected.swept, rtol=1e-3)
        np.testing.assert_allclose(built.momentum, expected.momentum, rtol=1e-3)
    if actuation == "motor":
        np.testing.assert_allclose(tilted.swept, 1.02 * designed.swept, rtol=1e-12)
        # About roll the edge holds the robot.
        aside = slews(up, offset=np.array([[0.0, 0.003, 0.0]]), bias=np.array([[0.1, 0.0]]))
        np.testing.assert_allclose(aside[1].swept, aside[0].swept, rtol=1e-12)
    assert up.growth == pytest.approx(np.exp(min(up.growth_rate * 0.4, 3.0)), rel=0.01)
