from dataclasses import replace

import numpy as np
import pytest

from ocs_design.actuation.drive import RESERVE
from ocs_design.device.layout import module_axes
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import (
    Quintic,
    SmoothTrapezoid,
    Step,
    Turn,
    fit_turn,
    utilisation,
)
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

PITCH = np.array([0.0, 1.0, 0.0])
BODY = Gyrostat(np.diag([0.03, 0.0535, 0.068]), module_axes(np.radians(40.0)), 1e-4)
FLIP = Turn(PITCH, 0.0, -2.0 * np.pi, 2.0, Quintic())
SMOOTH = [Quintic(), SmoothTrapezoid(0.1), SmoothTrapezoid(0.3), SmoothTrapezoid(0.5)]


@pytest.mark.parametrize("profile", SMOOTH)
def test_profiles_run_from_rest_to_rest(profile):
    ends = np.array([0.0, 1.0])
    np.testing.assert_allclose(profile.position(ends), [0.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(profile.rate(ends), 0.0, atol=1e-12)
    np.testing.assert_allclose(profile.acceleration(ends), 0.0, atol=1e-12)


@pytest.mark.parametrize("profile", SMOOTH)
def test_rate_and_acceleration_are_the_derivatives(profile):
    s, h = np.linspace(0.01, 0.99, 97), 1e-6
    slope = (profile.position(s + h) - profile.position(s - h)) / (2 * h)
    np.testing.assert_allclose(profile.rate(s), slope, atol=1e-7)
    slope = (profile.rate(s + h) - profile.rate(s - h)) / (2 * h)
    np.testing.assert_allclose(profile.acceleration(s), slope, atol=1e-3)


def test_peaks_are_as_documented():
    s = np.linspace(0.0, 1.0, 100_001)
    assert Quintic().rate(s).max() == pytest.approx(1.875)
    assert Quintic().acceleration(s).max() == pytest.approx(10.0 / np.sqrt(3.0))
    trapezoid = SmoothTrapezoid(0.2)
    assert trapezoid.rate(s).max() == pytest.approx(1.0 / 0.8)
    assert trapezoid.acceleration(s).max() == pytest.approx(1.5 / (0.2 * 0.8))


def test_a_turn_holds_its_ends_before_and_after():
    turn = Turn(PITCH, 0.5, 0.0, 0.4, Quintic())
    np.testing.assert_allclose(turn.angle(np.array([0.0, 0.2, 0.4, 9.0])), [0.5, 0.25, 0.0, 0.0])
    np.testing.assert_allclose(turn.rate(np.array([0.0, 9.0])), 0.0)
    np.testing.assert_allclose(replace(turn, profile=Step()).angle(np.array([0.0])), 0.0)


def test_utilisation_is_peak_speed_over_no_load_speed():
    """I_tot rate = 2 cos(a) I_w W."""
    peak = 0.0535 * 1.875 * 2.0 * np.pi / 2.0 / (2.0 * np.cos(np.radians(40.0)) * 1e-4)
    assert utilisation(FLIP, BODY, MotorLimits(peak, 0.0, np.inf)) == pytest.approx(1.0, rel=1e-4)


def test_a_lopsided_trunk_asks_the_busier_wheel_and_drifts_in_heading():
    """Both wheels' speeds and the yaw rate of a pure pitch, from three equations of momentum."""
    inertia = np.array([[0.03, 0.004, 0.003], [0.004, 0.0535, -0.006], [0.003, -0.006, 0.068]])
    body = replace(BODY, inertia=inertia)
    rate = 1.875 * 2.0 * np.pi / 2.0
    unknown = np.column_stack([inertia[:, 2], 1e-4 * body.axes])
    _, *speeds = np.linalg.solve(unknown, -inertia[:, 1] * rate)
    busier = float(np.abs(speeds).max())
    assert utilisation(FLIP, body, MotorLimits(busier, 0.0, np.inf)) == pytest.approx(1.0, rel=1e-4)


def test_a_turn_that_fits_is_left_as_it_is():
    fitted = fit_turn(FLIP, BODY, MotorLimits(np.inf, 0.0, np.inf))
    assert fitted.turn is FLIP
    assert fitted.note == ""


def test_a_wheel_a_little_too_slow_gets_a_flatter_profile():
    limits = MotorLimits(2000.0, 0.0, np.inf)
    assert utilisation(FLIP, BODY, limits) > 1.0
    fitted = fit_turn(FLIP, BODY, limits)
    assert isinstance(fitted.turn.profile, SmoothTrapezoid)
    assert fitted.turn.duration == FLIP.duration
    assert utilisation(fitted.turn, BODY, limits) <= RESERVE
    assert "trapezoid" in fitted.note


def test_a_wheel_far_too_slow_gets_more_time_and_says_so():
    limits = MotorLimits(700.0, 350.0, 1.0)
    fitted = fit_turn(FLIP, BODY, limits)
    assert utilisation(fitted.turn, BODY, limits) == pytest.approx(RESERVE, rel=1e-6)
    assert "in place of the 2 s" in fitted.note
    faster = replace(fitted.turn, duration=0.999 * fitted.turn.duration)
    assert utilisation(faster, BODY, limits) > RESERVE


def test_a_fall_does_not_wait():
    drop = Turn(PITCH, 0.5, 0.0, 0.385, Quintic(), extendable=False)
    fitted = fit_turn(drop, BODY, MotorLimits(300.0, 0.0, np.inf))
    assert isinstance(fitted.turn.profile, Step)
    assert fitted.turn.duration == 0.385
    assert "step" in fitted.note
