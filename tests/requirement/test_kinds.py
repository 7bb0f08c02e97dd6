"""Laws that hold for maneuvers of every kind."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from specifications import MANEUVERS

from ocs_design.requirement.boundary import End
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.turns import Catch
from ocs_design.robot.mass import MassProperties

HEIGHT = 0.25
BODY = MassProperties(2.5, np.array([0.01, 0.0, 0.02]), np.diag([0.03, 0.05, 0.07]))
CATCH = Catch(name="catch", jump_height=0.5, rate=(0.4, -0.8, 0.0), duration=0.6)
EVERY = tuple(each.on(BODY) for each in (*MANEUVERS, CATCH))


def of_every_kind(test):
    return pytest.mark.parametrize("maneuver", EVERY, ids=lambda each: each.name)(test)


def test_every_kind_is_here():
    kinds = {kind.maneuver for kind in MANEUVER_KINDS.values()}
    assert {type(each) for each in EVERY} == kinds
    # A field without a default takes that of a property of its name further up.
    assert not [
        (kind, each.name)
        for kind in kinds
        for each in fields(kind)
        if isinstance(each.default, property)
    ]


@of_every_kind
def test_its_turn_leads_from_its_start_to_its_end(maneuver):
    asked = maneuver.boundary(HEIGHT)
    start, final = Rotation.from_quat([asked.attitude, asked.final_attitude], scalar_first=True)
    turn = Rotation.from_rotvec(asked.angle * asked.axis)
    # About a pivot it is tilted about axes of the world.
    turned = turn * start if maneuver.on_pivot else start * turn
    if asked.end != End.ATTITUDE:
        # Its heading is free.
        turned, final = (each.inv().apply([0.0, 0.0, 1.0]) for each in (turned, final))
        np.testing.assert_allclose(turned, final, rtol=0, atol=1e-12)
    else:
        assert (turned.inv() * final).magnitude() < 1e-12


@of_every_kind
@pytest.mark.parametrize("factor", [0.9, 1.0, 1.4])
def test_a_slower_one_has_so_much_more_time(maneuver, factor):
    before, after = (each.boundary(HEIGHT) for each in (maneuver, maneuver.slower(factor, HEIGHT)))
    assert after.duration == pytest.approx(factor * before.duration, rel=1e-12)
    np.testing.assert_array_equal(after.attitude, before.attitude)


@of_every_kind
def test_one_of_which_nothing_is_left_requires_nothing(maneuver):
    assert not maneuver.idle
    assert bool(maneuver.milder(0.0).idle) == bool(maneuver.milder_by)
    assert not maneuver.reducible or maneuver.milder_by


@of_every_kind
def test_only_turns_need_no_gravity(maneuver):
    assert not list(maneuver.contradictions())
    (fault,) = replace(maneuver, gravity=0.0).contradictions()
    assert "orbit" in fault
    if maneuver.heading_matters:
        assert not list(replace(maneuver, gravity=0.0, jump_height=0.0).contradictions())


@of_every_kind
def test_what_takes_off_lands_where_it_took_off(maneuver):
    """A parabola, but for a push on the way."""
    if maneuver.rise:
        fallen = maneuver.rise - maneuver.gravity * (maneuver.flight_time / 2.0) ** 2 / 2.0
        assert fallen == pytest.approx(0.0, abs=1e-12)
