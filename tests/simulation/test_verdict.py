from dataclasses import replace

import numpy as np
import pytest
from campaigns import zero_metrics

from ocs_design.requirement.pushes import Shove
from ocs_design.requirement.turns import Drop, Flip, TurnTo
from ocs_design.simulation.verdict import judge, landing_attitude, lands_well, stands

GOOD = zero_metrics(
    touchdown_time=0.39,
    touchdown_pitch=np.radians(1.0),
    touchdown_rate=0.05,
    turned_angle=np.radians(-29.0),
    pitch_swing=np.radians(3.0),
)
DROP = Drop(name="drop", height=1.0, pitch=0.5)
SHOVE = Shove(name="shove", torque=(0.0, 1.0, 0.0), duration=0.05, settling=0.5)
FLIP = Flip(name="flip", jump_height=1.0, angle=-2.0 * np.pi, duration=2.0)
FALLEN = replace(GOOD, upright_at_end=False, final_pitch=np.pi)
ASIDE = replace(GOOD, touchdown_roll=np.radians(89.0), touchdown_pitch=np.radians(-90.0))
IN_ORBIT = TurnTo(name="turn", gravity=0.0, roll=np.pi / 2.0, duration=60.0)
TILTED = replace(GOOD, touchdown_roll=np.radians(-5.1))


@pytest.mark.parametrize(
    ("metrics", "maneuver", "can_stand", "passed", "reason"),
    [
        (GOOD, DROP, True, True, "pitch 1.0, roll 0.0 deg and stands, ending at pitch 0.0"),
        (GOOD, DROP, None, True, "no legs"),
        (replace(GOOD, lift_off_time=None), DROP, True, None, "cannot lift the robot off"),
        (TILTED, DROP, True, False, "roll -5.1 deg, more than 5 deg"),
        (TILTED, DROP, None, False, "roll -5.1 deg"),
        (FALLEN, DROP, True, False, "does not stay up: ends at pitch 180.0"),
        (FALLEN, DROP, False, True, "even if level; ends at pitch 180.0"),
        (GOOD, FLIP, True, False, "turns -29.0 of -360 deg"),
        (replace(GOOD, turned_angle=np.radians(-356.0)), FLIP, True, True, "stands"),
        (replace(GOOD, turned_angle=np.radians(360.0)), FLIP, True, False, "turns 360.0 of -360"),
        (
            replace(GOOD, turned_angle=2.0, touchdown_pitch=2.0),
            replace(FLIP, angle=2.0),
            True,
            False,
            "a turn of 114.6 deg does not end level, one of 360 deg does",
        ),
        (
            replace(FALLEN, touchdown_pitch=np.pi / 2.0),
            TurnTo(name="turn", jump_height=1.0, pitch=np.pi / 2.0, duration=0.8),
            None,
            True,
            "legs cannot stand in this attitude; ends at pitch 180.0",
        ),
        (replace(GOOD, momentum_error=2e-6), DROP, True, None, "off by 2.0e-06"),
        (replace(GOOD, touchdown_time=None), DROP, True, None, "no part of the robot touched"),
        (None, DROP, True, None, "became unstable"),
        (replace(ASIDE, touchdown_time=None), IN_ORBIT, None, True, "ends at pitch -90.0, roll"),
        (ASIDE, replace(IN_ORBIT, roll=1.4), None, False, "roll 89.0 deg, not at"),
    ],
)
def test_pass_rule(metrics, maneuver, can_stand, passed, reason):
    verdict = judge(metrics, maneuver, can_stand=can_stand)
    assert verdict.passed is passed
    assert reason in verdict.reason
    without_legs = judge(metrics, maneuver, can_stand=None)
    assert lands_well(metrics, maneuver) is (without_legs.passed is True)


def test_a_turn_to_an_attitude_reports_the_error_of_the_vertical():
    """Roll and pitch of the vertical differ from the angles of the maneuver."""
    maneuver = TurnTo(name="turn", gravity=0.0, roll=0.7, pitch=-0.5, duration=2.0)
    roll, pitch, heading = landing_attitude(maneuver)
    assert (roll, pitch) != (0.7, -0.5)
    flown = replace(GOOD, touchdown_roll=roll, touchdown_pitch=pitch, heading_drift=heading)
    assert "its vertical 0.0 deg off what is asked" in judge(flown, maneuver, can_stand=None).reason
    missed = replace(flown, touchdown_pitch=pitch + 0.05)
    assert "deg off what is asked" in judge(missed, maneuver, can_stand=None).reason


def test_a_biped_has_a_reason_why_it_does_not_stand():
    reason = judge(FALLEN, DROP, can_stand=False, legs=2).reason
    assert "even if level, since a robot on fewer than three feet must step" in reason


def test_a_robot_that_topples_slowly_does_not_stand():
    assert stands(GOOD)
    assert not stands(replace(GOOD, final_pitch=np.radians(30.0)))
    assert not stands(FALLEN)
    assert not stands(None)


@pytest.mark.parametrize(
    ("metrics", "can_stand", "passed", "reason"),
    [
        (GOOD, True, True, "swings by pitch 3.0, roll 0.0 deg"),
        (FALLEN, True, False, "does not stay up: ends at pitch 180.0"),
        (FALLEN, False, None, "even without the shove"),
        (TILTED, True, None, "does not stand level by itself: it leans by pitch 1.0, roll -5.1"),
        (replace(GOOD, touchdown_rate=0.2), True, None, "does not stand still by itself: it turns"),
        (GOOD, None, None, "no legs"),
    ],
)
def test_a_shoved_robot_has_to_stay_up(metrics, can_stand, passed, reason):
    verdict = judge(metrics, SHOVE, can_stand=can_stand)
    assert verdict.passed is passed
    assert reason in verdict.reason
