"""Demands of each maneuver, against figures worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from specifications import MANEUVERS

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Catch, Drop, Flip, TurnTo, loop_length

INERTIA = TiltInertia.uncoupled([0.03, 0.0515])
PUSH = Disturbance(
    name="push", takeoff_velocity=(0.5, 2.4), torque=(-0.2, 0.8, 9.0), onset=0.1, duration=0.05
)
DROP = Drop(
    name="drop", standing_height=0.25, height=1.0, roll=np.radians(-10.0), pitch=np.radians(30.0)
)
FLIP = Flip(name="flip", gravity=1.62, jump_height=1.0, angle=-2 * np.pi, duration=2.0)


def test_the_momentum_of_a_disturbance_is_its_impulse():
    np.testing.assert_allclose(PUSH.momentum(INERTIA), [0.01, 0.04], rtol=1e-15)


def test_a_drop_takes_the_time_of_its_fall():
    fall = DROP.time()
    assert 0.25 + 9.81 * fall**2 / 2 == pytest.approx(1.0, rel=1e-15)
    expected = [0.03, 0.0515] * np.abs(DROP.turn) * 2.0 / fall
    np.testing.assert_allclose(DROP.momentum(INERTIA), expected, rtol=1e-14)


@pytest.mark.parametrize("roll", np.radians([-10.0, 0.0, 40.0, 100.0]))
@pytest.mark.parametrize("pitch", np.radians([-60.0, 0.0, 30.0]))
def test_a_tilt_is_the_smallest_turn_to_level(roll, pitch):
    """By SciPy: the vertical, rotated by the tilt about a horizontal axis, is level."""
    trunk = Rotation.from_euler("YX", [pitch, roll])
    vertical = trunk.inv().apply([0.0, 0.0, 1.0])
    tilt = replace(DROP, roll=roll, pitch=pitch).turn
    assert np.linalg.norm(tilt) == pytest.approx(np.arccos(vertical[2]), abs=1e-12)
    np.testing.assert_allclose(
        Rotation.from_rotvec([*tilt, 0.0]).apply(vertical), [0.0, 0.0, 1.0], atol=1e-12
    )


@pytest.mark.parametrize("height", [0.1, 0.25])
def test_a_drop_from_below_the_standing_height_is_refused(height):
    with pytest.raises(SpecificationError, match=r"'low'.*stands at 0.25 m"):
        replace(DROP, name="low", height=height).momentum(INERTIA)


def test_a_flip_peaks_at_twice_its_mean_rate():
    """A triangular profile of rates over 2 s covers the full turn."""
    roll, pitch = FLIP.momentum(INERTIA)
    assert roll == 0.0
    rate = pitch / INERTIA.diagonal[1]
    times = np.linspace(0.0, 2.0, 2001)
    rates = rate * (1.0 - np.abs(times - 1.0))
    assert np.trapezoid(rates, times) == pytest.approx(2 * np.pi, rel=1e-6)


@pytest.mark.parametrize("angle", np.radians([-360.0, -180.0, -20.0, 90.0, 270.0, 720.0]))
def test_stray_of_a_flip_is_the_chord_of_its_angle(angle):
    """Distance of a unit vector along the trunk from its start; zero after a full turn."""
    moved = Rotation.from_rotvec([0.0, angle, 0.0]).apply([1.0, 0.0, 0.0]) - [1.0, 0.0, 0.0]
    assert replace(FLIP, angle=angle).tilt_per_drift == pytest.approx(
        np.linalg.norm(moved), abs=1e-14
    )


def test_least_torque_gives_the_momentum_in_half_the_time():
    momentum = FLIP.least_torque(INERTIA) * FLIP.duration / 2.0
    np.testing.assert_allclose(momentum, FLIP.momentum(INERTIA))


def test_a_disturbance_needs_no_torque():
    np.testing.assert_array_equal(PUSH.least_torque(INERTIA), [0.0, 0.0])


def test_the_shortest_loop_around_a_solid_angle():
    """Cap of radius b: area 2 pi (1 - cos b), edge 2 pi sin b; for 90 degrees cos b is 0.75."""
    assert loop_length(np.pi / 2.0) == pytest.approx(2.0 * np.pi * np.sqrt(1.0 - 0.75**2))
    assert loop_length(2.0 * np.pi) == pytest.approx(2.0 * np.pi)
    assert loop_length(-0.3) == loop_length(0.3)


def test_a_turn_requires_its_tilt_and_the_loop_of_its_heading():
    tilted = TurnTo(name="t", jump_height=1.0, pitch=-0.5, duration=0.8)
    half = replace(FLIP, angle=-0.5, duration=0.8, gravity=9.81)
    np.testing.assert_allclose(tilted.momentum(INERTIA), half.momentum(INERTIA))
    np.testing.assert_allclose(tilted.slew(INERTIA).swept, half.slew(INERTIA).swept)
    yawed = TurnTo(name="h", jump_height=1.0, yaw=-1.5 * np.pi, duration=2.0)
    steady = 2.0 / np.pi * loop_length(np.pi / 2.0)
    expected = [0.03 * steady, 0.0515 * steady]
    slew = yawed.slew(INERTIA)
    np.testing.assert_allclose(slew.swept / slew.duration, np.array(expected) / 2.0)
    assert slew.duration == 0.75 * 2.0
    np.testing.assert_allclose(yawed.momentum(INERTIA), np.array(expected) / 2.0)


def test_a_catch_leaves_its_momentum_in_the_wheels():
    catch = Catch(name="c", jump_height=0.5, rate=(0.4, -0.8, 0.1), duration=0.6)
    slew = catch.slew(INERTIA)
    np.testing.assert_allclose(slew.momentum, [0.012, -0.0412])
    np.testing.assert_array_equal(slew.swept, 0.0)
    assert catch.end == "level"


COUPLED = TiltInertia(np.array([0.03, 0.05]), np.array(0.004))

IN_THE_AIR = [
    replace(each, standing_height=0.25) for each in MANEUVERS if not isinstance(each, Pivoted)
]


@pytest.mark.parametrize("maneuver", IN_THE_AIR, ids=lambda maneuver: maneuver.name)
@pytest.mark.parametrize("factor", [1.01, 1.3, 4.0])
def test_a_slower_maneuver_differs_in_time_only(maneuver, factor):
    before = maneuver.slew(COUPLED)
    after = maneuver.slower(factor).slew(COUPLED)
    assert after.duration == pytest.approx(factor * before.duration, rel=1e-12)
    np.testing.assert_allclose(after.swept, before.swept, rtol=1e-15)
    np.testing.assert_allclose(after.momentum, before.momentum, rtol=1e-15)


@pytest.mark.parametrize("factor", [1.01, 1.3, 4.0])
def test_a_turn_ends_before_its_flight(factor):
    flip = next(maneuver for maneuver in MANEUVERS if isinstance(maneuver, Flip))
    longer = flip.slower(factor)
    assert longer.duration < longer.flight_time
    assert (longer.jump_height == flip.jump_height) == (factor * flip.duration < flip.flight_time)


def test_changed_keys_are_rounded_to_the_safe_side():
    push, nudge, drop, flip, *_ = IN_THE_AIR
    for maneuver, factor, text in (
        (push, 1.1, "push takeoff_velocity [0.5, 2.57] m/s"),
        (nudge, 1.1, "nudge settling 0.44 s"),
        (drop, 1.1, "drop height 1.16 m"),
        (flip, 1.05, "back-flip duration 2.1 s"),
        (flip, 1.5, "back-flip jump_height 1.9 m and duration 3 s"),
    ):
        assert change_text(maneuver, maneuver.slower(factor)) == text
