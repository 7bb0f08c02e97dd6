"""The course of a slew against the motor's equation, integrated numerically."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_profile

INF = np.inf
STALL, NO_LOAD, INERTIA = 1.4566, 650.4, 9e-5

CASES = [
    (phi, lam, speed_max, final)
    for phi in (3.0, 60.0, 500.0)
    for lam in (0.2, 0.7, 1.0, 1.3, 1.7, 3.0, INF)
    for speed_max in (INF, 500.0, 150.0)
    for final in (0.0, 100.0)
]


def integrated(line, profile, times):
    """Speed and angle at `times` by a drive that only knows when to brake.

    `I dW/dt = tau`, tau from `V = R i + k_t W` with the current clipped, nothing at the highest
    speed; the intervals end where the equation has a kink.
    """
    speed_max = min(line.speed_max, line.no_load_speed)

    def slope(time, state, braking):
        sign = -1.0 if braking else 1.0
        torque = sign * line.stall_torque * (1.0 - sign * state[0] / line.no_load_speed)
        return [np.clip(torque, -line.torque_limit, line.torque_limit) / INERTIA, state[0]]

    def reached(time, state, braking):
        return state[0] - speed_max

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12, "dense_output": True}
    brake, end = float(profile.brake_from), float(profile.end)
    up = solve_ivp(slope, (0.0, brake), [0.0, 0.0], args=(False,), events=reached, **options)
    held = brake - up.t[-1]
    peak, angle = up.y[:, -1]
    down = solve_ivp(slope, (brake, end), [peak, angle + held * peak], args=(True,), **options)

    def at(time):
        if time > brake:
            return down.sol(time)
        state = up.sol(min(time, up.t[-1]))
        held = max(time - up.t[-1], 0.0)
        return [state[0], state[1] + held * peak]

    return np.array([at(time) for time in times]).T


@pytest.mark.parametrize(("phi", "lam", "speed_max", "final"), CASES)
def test_the_motor_equation_gives_the_same_course(phi, lam, speed_max, final):
    line = DriveLine(STALL, NO_LOAD, lam * STALL, speed_max)
    profile = slew_profile(phi, INERTIA, line, final)
    times = np.sort(np.append(np.linspace(0.0, profile.end, 41), profile.brake_from))
    speed, angle = integrated(line, profile, times)
    np.testing.assert_allclose(profile.speed(times[:-1]), speed[:-1], rtol=1e-8, atol=1e-8)
    assert speed[-1] == pytest.approx(final, abs=1e-8 * NO_LOAD)
    assert angle[-1] - final * profile.end == pytest.approx(phi, rel=1e-8)
    assert profile.peak_speed == pytest.approx(speed.max(), rel=1e-8)


@pytest.mark.parametrize(("phi", "lam", "speed_max", "final"), CASES[::5])
def test_torque_is_the_limit_of_each_phase(phi, lam, speed_max, final):
    line = DriveLine(STALL, NO_LOAD, lam * STALL, speed_max)
    profile = slew_profile(phi, INERTIA, line, final)
    switches = np.array([0.0, profile.coast_from, profile.brake_from, profile.end])
    lengths = np.diff(switches)
    assert (lengths >= -1e-15).all()
    limit = line.torque_limit
    for k in np.flatnonzero(lengths > 1e-9):
        inside = switches[k] + lengths[k] * np.linspace(0.01, 0.99, 15)
        speed, torque = profile.speed(inside), profile.torque(inside)
        ahead, back = STALL * (1 - speed / NO_LOAD), -STALL * (1 + speed / NO_LOAD)
        expected = [np.minimum(limit, ahead), 0.0 * ahead, np.maximum(-limit, back)][k]
        np.testing.assert_allclose(torque, expected, rtol=1e-9, atol=1e-12)
    if lengths[1] > 0.0:
        assert profile.peak_speed == pytest.approx(speed_max, rel=1e-14)


def test_every_course_ends_at_the_final_speed_to_the_last_digits():
    """The phases, each by its own formula, add up to the time that was solved for."""
    rng = np.random.default_rng(12)
    count = 20_000
    lam = np.where(rng.random(count) < 0.5, 1.0, 10 ** rng.uniform(-1, 0.5, count))
    line = DriveLine(1.0, 1.0, lam, np.where(rng.random(count) < 0.2, 0.6, INF))
    final = np.where(rng.random(count) < 0.5, 0.0, rng.uniform(0.0, 0.5, count))
    profile = slew_profile(10 ** rng.uniform(-2, 1, count), 1.0, line, final)
    error = np.abs(profile.speed(profile.end * (1.0 - 1e-15)) - final)
    # The digits of the time, at a braking of at most 2.
    assert (error / np.maximum(profile.end, 1.0)).max() < 1e-14


def test_before_and_after():
    profile = slew_profile(60.0, INERTIA, DriveLine(STALL, NO_LOAD, 1.0, INF), 100.0)
    end = float(profile.end)
    assert profile.speed([-1.0, end, end + 1.0]).tolist() == [0.0, 100.0, 100.0]
    assert profile.torque([-1.0, end, end + 1.0]).tolist() == [0.0, 0.0, 0.0]


def test_many_at_once_and_what_cannot_be_done():
    line = DriveLine(STALL, NO_LOAD, np.array([0.3, 1.0, 3.0]), 500.0)
    profile = slew_profile([20.0, 60.0, 60.0], INERTIA, line, [0.0, 0.0, 600.0])
    assert np.isnan(profile.end).tolist() == [False, False, True]
    times = np.linspace(0.0, 0.3, 7)[:, np.newaxis]
    course = np.stack([profile.speed(times), profile.torque(times)])
    assert course.shape == (2, 7, 3)
    assert np.isnan(course[0, :, 2]).all()
    alone = slew_profile(60.0, INERTIA, DriveLine(STALL, NO_LOAD, 1.0, 500.0))
    np.testing.assert_allclose(profile.speed(times)[:, 1], alone.speed(times)[:, 0], rtol=1e-13)
