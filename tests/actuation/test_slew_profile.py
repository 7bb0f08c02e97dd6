"""The course of a slew, on weak supplies too, against the motor's equation and against bounds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_profile, slew_time

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


@pytest.mark.parametrize(("phi", "lam", "speed_max", "final"), CASES[2::5])
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


STRONG, FAST = 8.0, 1100.0
WHOLE = STRONG * FAST
"""V^2 / R, the power at stall [W]."""


def power(line, speed, torque):
    """R i^2 and what the wheel takes [W], by V = R i + k_t w."""
    return torque * (torque * line.no_load_speed / line.stall_torque + speed)


def strongest(line, speed, sense):
    """Torque up (1) or down (-1) that line, current and power leave, on a fine grid."""
    torque = sense * np.linspace(0.0, line.torque_limit, 4001)
    volts = speed / line.no_load_speed + torque / line.stall_torque
    fits = (np.abs(volts) <= 1.0 + 1e-9) & (np.abs(power(line, speed, torque)) <= line.power_max)
    return torque[np.argmin(fits) - 1] if not fits.all() else torque[-1]


@pytest.mark.parametrize("share", [0.02, 0.1, 0.24])
@pytest.mark.parametrize("lam", [0.07, 0.2, 0.9])
@pytest.mark.parametrize("final", [0.0, 150.0])
@pytest.mark.parametrize("speed_max", [INF, 700.0])
def test_the_wheel_takes_all_that_the_supply_leaves(share, lam, final, speed_max):
    line = DriveLine(STRONG, FAST, lam * STRONG, speed_max, share * WHOLE)
    phi = np.array([2.0, 20.0, 80.0, 400.0])
    profile = slew_profile(phi, INERTIA, line, final)
    for row in range(phi.size):
        end, brake = float(profile.end[row]), float(profile.brake_from[row])
        one = [0.02 * end, 0.3 * brake, 0.7 * brake, 0.97 * brake]
        down = [brake + part * (end - brake) for part in (0.02, 0.4, 0.8)]
        for time in one + down:
            sense = -1.0 if time in down else 1.0
            speed = profile.speed(time)[row]
            if sense > 0.0 and time >= profile.coast_from[row]:
                continue
            # Currents above that whose heat alone takes all the power are left out.
            most = min(line.torque_limit, np.sqrt(share) * STRONG)
            found = strongest(replace(line, torque_limit=most), speed, sense)
            assert profile.torque(time)[row] == pytest.approx(found, rel=2e-3, abs=6e-4 * most)


@pytest.mark.parametrize("share", [0.02, 0.1])
@pytest.mark.parametrize("lam", [0.07, 0.3])
@pytest.mark.parametrize(("phi", "final"), [(30.0, 0.0), (150.0, 100.0), (400.0, 0.0)])
def test_the_motor_equation_gives_the_same_course_on_a_weak_supply(share, lam, phi, final):
    line = DriveLine(STRONG, FAST, lam * STRONG, INF, share * WHOLE)
    profile = slew_profile(phi, INERTIA, line, final)
    switches = [0.0, float(profile.coast_from), float(profile.brake_from), float(profile.end)]
    speed, angle = 0.0, 0.0
    for begin, end in pairwise(switches):
        # The torque jumps at the end of a phase.
        times = np.linspace(begin, max(begin, end - 1e-12), 8001)
        risen = speed + cumulative_trapezoid(profile.torque(times) / INERTIA, times, initial=0.0)
        np.testing.assert_allclose(profile.speed(times), risen, rtol=1e-4, atol=0.01)
        speed, angle = risen[-1], angle + np.trapezoid(risen, times)
    assert angle - final * float(profile.end) == pytest.approx(phi, rel=1e-4)


def drives(count):
    rng = np.random.default_rng(5)
    stall, no_load = 10 ** rng.uniform(-2, 2, count), 10 ** rng.uniform(1, 4, count)
    limit = stall * 10 ** rng.uniform(-2, 1, count)
    top = np.where(rng.random(count) < 0.5, INF, no_load * rng.uniform(0.1, 1.3, count))
    line = DriveLine(
        stall, no_load, limit, top, stall * no_load * 10 ** rng.uniform(-3, 0.5, count)
    )
    final = np.minimum(no_load, top) * rng.uniform(0.0, 0.9, count) * (rng.random(count) < 0.5)
    inertia = 10 ** rng.uniform(-6, -2, count)
    phi = 10 ** rng.uniform(-4, 4, count) * no_load**2 * inertia / np.minimum(stall, limit)
    return line, inertia, final, phi


def test_no_slew_takes_or_feeds_back_more():
    line, inertia, final, phi = drives(1500)
    profile = slew_profile(phi, inertia, line, final)
    ends = profile.end
    for part in np.linspace(0.0, 1.0, 41):
        time = part * ends
        used = power(line, profile.speed(time), profile.torque(time)) / line.power_max
        assert np.nanmax(np.abs(used)) <= 1.0 + 1e-6


def test_it_lies_between_no_limit_and_a_current_that_never_passes_it():
    line, inertia, final, phi = drives(1500)
    limited = slew_time(phi, inertia, line, final)
    free = slew_time(phi, inertia, replace(line, power_max=INF), final)
    assert np.all(limited >= free * (1.0 - 1e-9))
    # At full voltage V i <= P: a torque of P / w_0 is never too much.
    # At rest the power is all heat, and plain currents above its root are left out.
    heat = np.sqrt(line.power_max * line.stall_torque / line.no_load_speed)
    least = np.min([line.torque_limit, heat, line.power_max / line.no_load_speed], axis=0)
    capped = replace(line, power_max=INF, torque_limit=least)
    assert np.all(limited <= slew_time(phi, inertia, capped, final) * (1.0 + 1e-9))


def test_more_power_is_never_slower_and_a_lot_is_no_limit():
    line, inertia, final, phi = drives(2000)
    times = [
        slew_time(phi, inertia, replace(line, power_max=line.power_max * factor), final)
        for factor in (1.0, 1.1, 2.0, 1e6)
    ]
    for less, more in pairwise(times):
        assert np.all(more <= less * (1.0 + 1e-9))
    free = slew_time(phi, inertia, replace(line, power_max=INF), final)
    np.testing.assert_allclose(times[-1], free, rtol=1e-9)
