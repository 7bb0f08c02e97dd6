"""The paper's maneuvers on Solo12, and Froude scaling to other robots."""

from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.requirement.froude import (
    SOLO12_GYRATION_RADIUS,
    SOLO12_HEIGHT,
    SOLO12_PITCH_INERTIA,
    SOLO12_ROLL_INERTIA,
    FroudeScale,
    default_envelope,
    default_maneuvers,
    example_maneuvers,
    standing_height,
)
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot

EXAMPLE = Path(__file__).parents[2] / "examples" / "solo12.urdf"
RATIOS = st.floats(0.2, 20.0)
ANY = robot_by_hand(2.5, (0.03, 0.05, 0.07))


def test_solo12_has_the_maneuvers_of_the_paper(solo12):
    push, drop, flip = default_maneuvers(solo12)
    assert push.torque == (0.2, 0.8, 0.0)
    assert (push.onset, push.duration) == (0.1, 0.05)
    assert push.takeoff_velocity == (0.5, 2.4)
    assert (drop.height, drop.roll, drop.pitch) == (1.0, 0.0, np.radians(30.0))
    assert (push.gravity, drop.gravity, flip.gravity) == (9.81, 9.81, 1.62)
    assert (flip.jump_height, flip.angle, flip.duration) == (1.0, -2 * np.pi, 2.0)
    assert (push.incidence, drop.incidence, flip.incidence) == (None, None, None)


def test_the_envelope_of_a_larger_robot_has_the_same_proportions(make_robot, solo12):
    larger = make_robot(30.0, (1.0, 2.0, 2.4), 0.6)
    small, large = default_envelope(solo12), default_envelope(larger)
    lengths = ("inner_radius_min", "height_max", "height_min", "wall_min")
    ratio = large.outer_radius_max / small.outer_radius_max
    assert ratio > 1.5
    for name in lengths:
        assert getattr(large, name) == pytest.approx(ratio * getattr(small, name), rel=1e-12), name


@given(length=RATIOS, mass=RATIOS)
def test_maneuvers_scale_with_size_and_mass(length, mass):
    """Equal Froude numbers and angles per robot's time scale."""
    inertia = length**2 * mass
    small, large = FroudeScale(1.0, 1.0, 1.0), FroudeScale(length, inertia, inertia)
    moments = np.array([0.03, 0.05])
    for one, other in zip(maneuvers_of(small), maneuvers_of(large), strict=True):
        rates = one.momentum(TiltInertia.uncoupled(moments)) / moments
        scaled = other.momentum(TiltInertia.uncoupled(moments * inertia))
        scaled /= moments * inertia
        np.testing.assert_allclose(scaled * np.sqrt(length), rates, rtol=1e-9)


@given(length=RATIOS, gravity=st.floats(1.0, 25.0))
def test_the_jump_keeps_its_froude_number(length, gravity):
    scale = FroudeScale(length, 1.0, 1.0)
    push = maneuvers_of(scale, gravity)[0]
    forward, upward = push.takeoff_velocity
    height = SOLO12_HEIGHT
    assert upward**2 / (gravity * length * height) == pytest.approx(2.4**2 / (9.81 * height))
    assert forward / upward == pytest.approx(0.5 / 2.4)
    assert push.onset * upward / length == pytest.approx(0.24)


@given(length=RATIOS, gravity=st.floats(1.0, 25.0))
def test_durations_of_examples_scale_with_the_robots_time_scale(length, gravity):
    """sqrt(L / g): a shove of 0.1 s and 0.5 s to come to rest, a turn on the Moon, a stop."""
    time, on_earth = np.sqrt(length * np.array([9.81 / gravity, 1.0]))
    with patch.object(FroudeScale, "of", return_value=FroudeScale(length, 1.0, 1.0)):
        shove, turn, stop, *on_pivot = example_maneuvers(ANY, gravity)
    assert (shove.duration, shove.settling) == pytest.approx((0.1 * time, 0.5 * time))
    assert (turn.duration, stop.duration) == pytest.approx((3.0 * on_earth, 0.5 * time))
    assert [each.duration for each in on_pivot] == pytest.approx([1.5 * time, time])
    assert stop.rate == pytest.approx((0.2 / time, 0.5 / time, 0.0))
    for each in (turn, stop):
        flight_time = np.sqrt(8.0 * each.jump_height / each.gravity)
        assert each.duration == pytest.approx(0.9 * flight_time)


def test_without_legs_lengths_scale_with_the_radius_of_gyration(make_robot):
    robot = make_robot(2.5, (0.03, 0.05, 0.064), None)
    ratio = np.sqrt(0.144 / 7.5) / SOLO12_GYRATION_RADIUS
    assert FroudeScale.of(robot).length == pytest.approx(ratio)
    assert standing_height(robot) == pytest.approx(ratio * SOLO12_HEIGHT)


def maneuvers_of(scale: FroudeScale, gravity: float = 9.81):
    """The default maneuvers of a robot of this scale."""
    with patch.object(FroudeScale, "of", return_value=scale):
        maneuvers = default_maneuvers(None, gravity)
    height = SOLO12_HEIGHT * scale.length
    return [replace(each, standing_height=height) for each in maneuvers]


def test_the_reference_values_are_those_of_solo12s_file():
    robot = read_robot(EXAMPLE)
    assert robot.posture_name == "stand"
    assert robot.standing_height == pytest.approx(SOLO12_HEIGHT, rel=1e-8)
    assert robot.inertia[0, 0] == pytest.approx(SOLO12_ROLL_INERTIA, rel=1e-8)
    assert robot.inertia[1, 1] == pytest.approx(SOLO12_PITCH_INERTIA, rel=1e-8)
    assert robot.mass_properties.gyration_radius == pytest.approx(SOLO12_GYRATION_RADIUS, rel=1e-8)
    assert FroudeScale.of(robot) == FroudeScale(1.0, 1.0, 1.0)
