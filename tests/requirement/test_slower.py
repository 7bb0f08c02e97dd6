"""More time by keys that a user can set: the same turn, in so much more time."""

import numpy as np
import pytest
from specifications import MANEUVERS

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.requirement.kinds import change_text, slower
from ocs_design.requirement.maneuver import Flip
from ocs_design.requirement.pivoted import Pivoted

HEIGHT = 0.25
INERTIA = TiltInertia(np.array([0.03, 0.05]), np.array(0.004))


IN_THE_AIR = [each for each in MANEUVERS if not isinstance(each, Pivoted)]


@pytest.mark.parametrize("maneuver", IN_THE_AIR, ids=lambda maneuver: maneuver.name)
@pytest.mark.parametrize("factor", [1.01, 1.3, 4.0])
def test_only_the_time_is_other(maneuver, factor):
    before = maneuver.slew(INERTIA, HEIGHT)
    after = slower(maneuver, factor, HEIGHT).slew(INERTIA, HEIGHT)
    assert after.duration == pytest.approx(factor * before.duration, rel=1e-12)
    np.testing.assert_allclose(after.swept, before.swept, rtol=1e-15)
    np.testing.assert_allclose(after.momentum, before.momentum, rtol=1e-15)


@pytest.mark.parametrize("factor", [1.01, 1.3, 4.0])
def test_a_turn_ends_before_its_flight(factor):
    flip = next(maneuver for maneuver in MANEUVERS if isinstance(maneuver, Flip))
    longer = slower(flip, factor, HEIGHT)
    assert longer.duration < longer.flight_time
    assert (longer.jump_height == flip.jump_height) == (factor * flip.duration < flip.flight_time)


def test_keys_are_told_rounded_to_the_safe_side():
    push, nudge, drop, flip, *_ = MANEUVERS
    for maneuver, factor, told in (
        (push, 1.1, "push takeoff_velocity [0.5, 2.57] m/s"),
        (nudge, 1.1, "nudge settling 0.44 s"),
        (drop, 1.1, "drop height 1.16 m"),
        (flip, 1.05, "back-flip duration 2.1 s"),
        (flip, 1.5, "back-flip jump_height 1.9 m and duration 3 s"),
    ):
        assert change_text(maneuver, slower(maneuver, factor, HEIGHT)) == told
