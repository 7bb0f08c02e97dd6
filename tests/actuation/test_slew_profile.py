"""The course of a slew, on weak supplies too, against the motor's equation and against bounds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import in_units, slew_profile, slew_time
from ocs_design.actuation.unit_drive import UnitDrive, brake_sweep

INF = np.inf
STALL, NO_LOAD, INERTIA = 1.4566, 650.4, 9e-5

CASES = [
    (phi, lam, speed_max, final)
    for phi in (3.0, 60.0, 500.0)
    for lam in (0.2, 0.7, 1.0, 1.3, 1.7, 3.0, INF)
    for speed_max in (INF, 500.0, 150.0)
    for final in (0.0, 100.0)
]


def integrated(line, profile, motor):
    """Speed at the peak and at the end, and the angle, of a drive that only knows when to brake.

    `I dW/dt = tau`, of a motor's torque at a speed, pushing (1) or braking (-1); nothing at the
    highest speed. The intervals end where the equation has a kink.
    """
    speed_max = min(line.speed_max, line.no_load_speed)

    def slope(time, state, sense):
        return [motor(state[0], sense) / INERTIA, state[0]]

    def reached(time, state, sense):
        return state[0] - speed_max

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}
    brake, end = float(profile.brake_from), float(profile.end)
    up = solve_ivp(slope, (0.0, brake), [0.0, 0.0], args=(1.0,), events=reached, **options)
    peak, angle = up.y[:, -1]
    held = [peak, angle + (brake - up.t[-1]) * peak]
    down = solve_ivp(slope, (brake, end), held, args=(-1.0,), **options)
    return peak, *down.y[:, -1]


@pytest.mark.parametrize(("phi", "lam", "speed_max", "final"), CASES[2::5])
def test_the_motor_equation_gives_the_same_course(phi, lam, speed_max, final):
    """The torque is from `V = R i + k_t W` with the current clipped."""
    line = DriveLine(STALL, NO_LOAD, lam * STALL, speed_max)
    profile = slew_profile(phi, INERTIA, line, final)

    def motor(speed, sense):
        torque = sense * line.stall_torque * (1.0 - sense * speed / line.no_load_speed)
        return np.clip(torque, -line.torque_limit, line.torque_limit)

    peak, last, angle = integrated(line, profile, motor)
    assert profile.peak_speed == pytest.approx(peak, rel=1e-8)
    assert last == pytest.approx(final, abs=1e-8 * NO_LOAD)
    assert angle - final * profile.end == pytest.approx(phi, rel=1e-8)
    ends = [motor(0.0, 1.0), motor(peak, -1.0) if profile.end > profile.brake_from else 0.0]
    assert profile.peak_torque == pytest.approx(max(map(abs, ends)), rel=1e-9)


def test_the_phases_add_up_to_the_time_to_the_last_digits():
    """Each by its own formula."""
    rng = np.random.default_rng(12)
    count = 20_000
    lam = np.where(rng.random(count) < 0.5, 1.0, 10 ** rng.uniform(-1, 0.5, count))
    line = DriveLine(1.0, 1.0, lam, np.where(rng.random(count) < 0.2, 0.6, INF))
    final = np.where(rng.random(count) < 0.5, 0.0, rng.uniform(0.0, 0.5, count))
    profile = slew_profile(10 ** rng.uniform(-2, 1, count), 1.0, line, final)
    drive, unit = in_units(line, 1.0)
    braked = unit * brake_sweep(drive, profile.peak_speed, final).time
    error = np.abs(profile.brake_from + braked - profile.end)
    assert (error / np.maximum(profile.end, 1.0)).max() < 1e-14


def test_many_at_once_and_what_cannot_be_done():
    line = DriveLine(STALL, NO_LOAD, np.array([0.3, 1.0, 3.0]), 500.0)
    profile = slew_profile([20.0, 60.0, 60.0], INERTIA, line, [0.0, 0.0, 600.0])
    for figure in (profile.end, profile.brake_from, profile.peak_speed):
        assert np.isnan(figure).tolist() == [False, False, True]
    assert profile.peak_torque[2] == 0.0
    alone = slew_profile(60.0, INERTIA, DriveLine(STALL, NO_LOAD, 1.0, 500.0))
    for name, figure in vars(alone).items():
        assert getattr(profile, name)[1] == pytest.approx(figure, rel=1e-13)


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


def torque_at(line, speed, sense):
    """Torque of the drive [N m], pushing (1) or braking (-1)."""
    drive = UnitDrive.of(line)
    x = np.asarray(speed) / drive.no_load_speed
    return drive.torque * (drive.accelerating(x) if sense > 0.0 else -drive.braking(x))


@pytest.mark.parametrize("share", [0.02, 0.1, 0.24])
@pytest.mark.parametrize("lam", [0.07, 0.2, 0.9])
def test_the_wheel_takes_all_that_the_supply_leaves(share, lam):
    line = DriveLine(STRONG, FAST, lam * STRONG, INF, share * WHOLE)
    # Currents above that whose heat alone takes all the power are left out.
    most = min(line.torque_limit, np.sqrt(share) * STRONG)
    for speed in FAST * np.linspace(0.01, 0.97, 25):
        for sense in (1.0, -1.0):
            found = strongest(replace(line, torque_limit=most), speed, sense)
            own = torque_at(line, speed, sense)
            assert own == pytest.approx(found, rel=2e-3, abs=6e-4 * most)


@pytest.mark.parametrize("share", [0.02, 0.1])
@pytest.mark.parametrize("lam", [0.07, 0.3])
@pytest.mark.parametrize("speed_max", [INF, 700.0])
@pytest.mark.parametrize(("phi", "final"), [(30.0, 0.0), (150.0, 100.0), (400.0, 0.0)])
def test_the_motor_equation_gives_the_same_course_on_a_weak_supply(
    share, lam, speed_max, phi, final
):
    line = DriveLine(STRONG, FAST, lam * STRONG, speed_max, share * WHOLE)
    profile = slew_profile(phi, INERTIA, line, final)
    peak, last, angle = integrated(line, profile, lambda *state: torque_at(line, *state).item())
    assert profile.peak_speed == pytest.approx(peak, rel=1e-6)
    assert last == pytest.approx(final, abs=1e-6 * FAST)
    assert angle - final * float(profile.end) == pytest.approx(phi, rel=1e-6)


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
    for part in np.linspace(0.0, 1.0, 41):
        for sense, begin in ((1.0, 0.0), (-1.0, final)):
            speed = begin + part * (profile.peak_speed - begin)
            used = power(line, speed, torque_at(line, speed, sense)) / line.power_max
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
