"""Laws for maneuvers of every kind."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from specifications import MANEUVERS

from ocs_design.requirement.boundary import End
from ocs_design.requirement.kinds import MANEUVER_KINDS
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
