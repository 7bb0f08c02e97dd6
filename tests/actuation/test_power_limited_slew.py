"""Slews that the supply limits: against the motor's equation, and against bounds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_profile, slew_time

INF = np.inf
STALL, NO_LOAD, INERTIA = 8.0, 1100.0, 9e-5
WHOLE = STALL * NO_LOAD
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
    line = DriveLine(STALL, NO_LOAD, lam * STALL, speed_max, share * WHOLE)
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
            most = min(line.torque_limit, np.sqrt(share) * STALL)
            found = strongest(replace(line, torque_limit=most), speed, sense)
            assert profile.torque(time)[row] == pytest.approx(found, rel=2e-3, abs=6e-4 * most)


@pytest.mark.parametrize("share", [0.02, 0.1])
@pytest.mark.parametrize("lam", [0.07, 0.3])
@pytest.mark.parametrize(("phi", "final"), [(30.0, 0.0), (150.0, 100.0), (400.0, 0.0)])
def test_the_motor_equation_gives_the_same_course(share, lam, phi, final):
    line = DriveLine(STALL, NO_LOAD, lam * STALL, INF, share * WHOLE)
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
