"""Fastest slews: special cases of the theory, round trips, optimality, limits, speed profiles.

Profiles, also with weak supplies, are compared with the motor's equation and with bounds.
"""

from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import pairwise, product

import numpy as np
import pytest
from driven_wheels import EC45_LINE
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import linprog
from scipy.sparse import coo_array, vstack
from subsets import fast_subset

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import in_units, slew_profile, slew_time
from ocs_design.actuation.unit_drive import (
    UnitDrive,
    brake_sweep,
    exp_remainder,
    farthest_slew,
    log_remainder,
    rise_sweep,
    rise_to,
)

INF = np.inf


def random_slews(rng, count):
    """Drives of every kind, with a wide range of inertias, final speeds and angles."""
    stall, no_load = 10 ** rng.uniform(-2, 2, count), 10 ** rng.uniform(1, 4, count)
    limit = stall * 10 ** rng.uniform(-3, 2, count)
    speed_max = np.where(rng.random(count) < 0.5, INF, no_load * rng.uniform(0.05, 1.3, count))
    kind = rng.integers(0, 6, count)
    limit = np.where(kind == 0, INF, limit)
    stall = np.where(kind == 1, INF, stall)
    line = DriveLine(stall, no_load, limit, speed_max)
    inertia = 10 ** rng.uniform(-6, -2, count)
    final = np.minimum(no_load, speed_max) * rng.uniform(0.0, 0.95, count)
    final = np.where(rng.random(count) < 0.5, 0.0, final)
    phi = 10 ** rng.uniform(-5, 5, count) * no_load**2 * inertia / np.minimum(stall, limit)
    return phi, inertia, line, final


def slew_angle(time, inertia, line, final_speed=0.0):
    """Largest phi within `time` [rad], the inverse of `slew_time`.

    Negative where the wheel reaches its final speed late, NaN where it does not reach it.
    """
    drive, unit = in_units(line, inertia)
    final = np.asarray(final_speed) / drive.no_load_speed
    units, final = np.broadcast_arrays(np.asarray(time) / unit, final)
    attainable = final < drive.highest
    final = np.where(attainable, final, 0.0)
    attainable = attainable & (units >= rise_sweep(drive, rise_to(drive, final)).time)
    final = np.where(attainable, final, 0.0)
    angle = farthest_slew(drive, units, final).angle - final * units
    return np.where(attainable, angle * drive.no_load_speed * unit, np.nan)


def test_limited_by_torque_only():
    """t = 2 sqrt(I_b theta / tau), peak 2 theta / (xi t), with theta = xi phi, I_red = xi I_b."""
    inertia, torque, phi = 9e-5, 0.3, np.array([1e-6, 0.1, 30.0, 200.0])
    expected = 2.0 * np.sqrt(inertia * phi / torque)
    line = DriveLine(INF, 1e4, torque, INF)
    np.testing.assert_allclose(slew_time(phi, inertia, line), expected, rtol=1e-14)
    profile = slew_profile(phi, inertia, line)
    np.testing.assert_allclose(profile.peak_speed, 2.0 * phi / expected, rtol=1e-14)


def test_limited_by_voltage_only():
    """t = 2 T arccosh(exp(phi / (2 w_0 T))), switch at t/2 + T ln cosh(t / 2T)."""
    inertia, stall, no_load = 9e-5, 1.4566, 650.4
    constant = inertia * no_load / stall
    phi = np.array([0.5, 5.0, 50.0, 500.0])
    expected = 2.0 * constant * np.arccosh(np.exp(phi / (2.0 * no_load * constant)))
    profile = slew_profile(phi, inertia, DriveLine(stall, no_load, INF, INF))
    np.testing.assert_allclose(profile.end, expected, rtol=1e-13)
    switch = expected / 2 + constant * np.log(np.cosh(expected / (2 * constant)))
    np.testing.assert_allclose(profile.brake_from, switch, rtol=1e-13)
    peak = no_load * np.tanh(expected / (2 * constant))
    np.testing.assert_allclose(profile.peak_speed, peak, rtol=1e-13)


def test_time_and_angle_are_inverse_to_each_other():
    phi, inertia, line, final = random_slews(np.random.default_rng(1), 50_000)
    time = slew_time(phi, inertia, line, final)
    assert np.isfinite(time).all()
    # With a final speed phi is a difference, with errors relative to the whole angle.
    error = np.abs(slew_angle(time, inertia, line, final) - phi) / (phi + final * time)
    assert error.max() < 1e-12
    rest = final == 0.0
    assert np.abs(slew_angle(time, inertia, line, final) / phi - 1.0)[rest].max() < 1e-12
    difference = np.abs(
        slew_time(slew_angle(time, inertia, line, final), inertia, line, final) - time
    )
    assert (difference[rest] / time[rest]).max() < 1e-12


SCALE = st.floats(-3.0, 3.0).map(lambda exponent: 10.0**exponent)
LIMITS = st.one_of(st.just(INF), SCALE)


@given(
    phi=st.one_of(st.just(0.0), SCALE),
    stall=LIMITS,
    limit=LIMITS,
    speed_max=LIMITS,
    final=st.floats(0.0, 0.99),
    inertia=SCALE,
)
def test_time_and_angle_are_inverse_at_extreme_limits(phi, stall, limit, speed_max, final, inertia):
    line = DriveLine(stall, 1.0, limit, speed_max)
    end = final * min(1.0, speed_max)
    time = float(slew_time(phi, inertia, line, end))
    assert 0.0 <= time < INF
    if time > 1e-90:
        back = slew_angle(time, inertia, line, end)
        assert abs(back - phi) <= 1e-10 * (phi + end * time)


@given(
    phi=SCALE, stall=LIMITS, limit=LIMITS, speed_max=LIMITS, final=st.floats(0.0, 0.9), scale=SCALE
)
def test_times_scale_with_the_inertia(phi, stall, limit, speed_max, final, scale):
    line = DriveLine(stall, 1.0, limit, speed_max)
    end = final * min(1.0, speed_max)
    time = slew_time(phi, 1.0, line, end)
    assert slew_time(scale * phi, scale, line, end) == pytest.approx(scale * time, rel=1e-11)


def test_stronger_faster_or_lighter_drives_need_no_more_time():
    rng = np.random.default_rng(2)
    phi, inertia, line, final = random_slews(rng, 20_000)
    time = slew_time(phi, inertia, line, final)
    slack = time * (1.0 + 1e-11)
    stronger = DriveLine(
        line.stall_torque * 1.1, line.no_load_speed, line.torque_limit * 1.1, line.speed_max
    )
    faster = DriveLine(
        line.stall_torque, line.no_load_speed, line.torque_limit, line.speed_max * 1.1
    )
    assert (slew_time(phi, inertia, stronger, final) <= slack).all()
    assert (slew_time(phi, inertia, faster, final) <= slack).all()
    assert (slew_time(phi, inertia * 0.9, line, final) <= slack).all()
    assert (slew_time(phi * 0.9, inertia, line, final) <= slack).all()


def farthest_by_linear_program(time, inertia, line, final, steps):
    """Largest integral of W - W_f over all feasible speed profiles, on a grid.

    The limits on dW/dt are linear in W: a linear program without assumptions on switching.
    """
    dt = time / steps
    index = np.arange(steps)

    def rows(left, right):
        values = np.concatenate([np.full(steps, left), np.full(steps, right)])
        places = (np.tile(index, 2), np.concatenate([index, index + 1]))
        return coo_array((values, places), shape=(steps, steps + 1))

    slope = line.stall_torque / line.no_load_speed * dt / 2.0
    limits = [
        (rows(-inertia, inertia), line.torque_limit * dt),
        (rows(inertia, -inertia), line.torque_limit * dt),
        (rows(slope - inertia, slope + inertia), line.stall_torque * dt),
        (rows(inertia - slope, -inertia - slope), line.stall_torque * dt),
    ]
    weights = np.full(steps + 1, dt)
    weights[[0, -1]] /= 2.0
    top = min(line.no_load_speed, line.speed_max)
    bounds = [(0.0, 0.0)] + [(0.0, top)] * (steps - 1) + [(final, final)]
    solution = linprog(
        -weights,
        A_ub=vstack([matrix for matrix, _ in limits]),
        b_ub=np.repeat([bound for _, bound in limits], steps),
        bounds=bounds,
        method="highs",
    )
    assert solution.status == 0
    return -solution.fun - final * time


@pytest.mark.parametrize("lam", [0.4, 0.9, 1.5, 5.0])
@pytest.mark.parametrize("final", [0.0, 250.0])
@pytest.mark.parametrize("speed_max", [INF, 400.0])
def test_no_speed_profile_is_faster(lam, final, speed_max):
    line = DriveLine(1.4566, 650.4, 1.4566 * lam, speed_max)
    inertia, time = 9e-5, 0.2
    by_program = farthest_by_linear_program(time, inertia, line, final, 400)
    phi = slew_angle(time, inertia, line, final)
    # The grid rounds the corners of the profile, each by up to about dW dt / 8.
    assert phi == pytest.approx(by_program, rel=1e-4)


def test_impossible_slews():
    line = DriveLine(1.0, 100.0, 0.5, 80.0)
    assert np.isinf(slew_time(1.0, 1e-4, line, [80.0, 90.0, 200.0])).all()
    assert np.isinf(slew_time(INF, 1e-4, line))
    assert np.isnan(slew_angle(1.0, 1e-4, line, 80.0))
    # 0.5 N m on 1e-4 kg m^2 need 10 ms to reach 50 rad/s.
    angle = slew_angle([0.0099, 0.0101], 1e-4, line, 50.0)
    assert np.isnan(angle[0])
    assert angle[1] == pytest.approx(-50.0 * 0.01 / 2.0, rel=0.05)


def test_no_angle_takes_no_time_but_a_final_speed_does():
    assert slew_time(0.0, 9e-5, EC45_LINE) == 0.0
    # Beyond 100 rad/s and back, so that the mean is 100: the peak is W_f (1 + 1 / sqrt 2).
    expected = 9e-5 / 1.0 * (2.0 * (1.0 + np.sqrt(0.5)) - 1.0) * 100.0
    assert slew_time(0.0, 9e-5, EC45_LINE, 100.0) == pytest.approx(expected, rel=1e-13)


def test_without_power_no_slew_is_possible():
    line = replace(EC45_LINE, power_max=0.0)
    assert np.isinf(slew_time([1.0, 0.0], 9e-5, line, [0.0, 100.0])).all()
    assert slew_time(0.0, 9e-5, line) == 0.0
    assert np.isnan(slew_profile(1.0, 9e-5, line).end)


POINTS = np.concatenate([np.geomspace(1e-12, 0.999, 200), [0.3, np.nextafter(0.3, 0.0)]])


def exact_exp(z: float) -> float:
    term, total, z = Fraction(1), Fraction(0), Fraction(z)
    for n in range(1, 40):
        term *= -z / n
        total += term if n > 1 else 0
    return float(total)


def exact_log(y: float) -> float:
    """y - log(1 + y), log by the series of 2 artanh(y / (2 + y)), rounded to 2^-200 each step."""
    ratio = Fraction(y) / (2 + Fraction(y))
    square, power, total = ratio**2, ratio, Fraction(0)
    for n in range(1, 120, 2):
        total += 2 * power / n
        power = Fraction(round(power * square * 2**400), 2**400)
    return float(Fraction(y) - total)


@pytest.mark.parametrize(
    ("function", "exact"), [(exp_remainder, exact_exp), (log_remainder, exact_log)]
)
def test_remainders_are_exact_at_every_size(function, exact):
    expected = np.array([exact(float(point)) for point in POINTS])
    np.testing.assert_allclose(function(POINTS), expected, rtol=3e-15)


def test_remainders_at_zero_and_infinity():
    assert exp_remainder(np.array(0.0)) == log_remainder(np.array(0.0)) == 0.0
    assert exp_remainder(np.array(1e4)) == 9999.0
    assert exp_remainder(np.array(np.inf)) == np.inf


STALL, NO_LOAD, INERTIA = 1.4566, 650.4, 9e-5

CASES = [
    (phi, lam, speed_max, final)
    for phi in (3.0, 60.0, 500.0)
    for lam in (0.2, 0.7, 1.0, 1.3, 1.7, 3.0, INF)
    for speed_max in (INF, 500.0, 150.0)
    for final in (0.0, 100.0)
]


def integrated(line, profile, motor, initial_speed=0.0):
    """Speed at the peak and at the end, and angle, of a drive that brakes at the profile's time.

    `I dW/dt = tau` with a motor's torque at a speed, driving (1) or braking (-1); zero at the
    highest speed. Intervals end at kinks of the equation.
    """
    speed_max = min(line.speed_max, line.no_load_speed)

    def slope(time, state, sense):
        return [motor(state[0], sense) / INERTIA, state[0]]

    def reached(time, state, sense):
        return state[0] - speed_max

    reached.terminal = True
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}
    brake, end = float(profile.brake_from), float(profile.end)
    up = solve_ivp(
        slope, (0.0, brake), [initial_speed, 0.0], args=(1.0,), events=reached, **options
    )
    peak, angle = up.y[:, -1]
    at_brake = [peak, angle + (brake - up.t[-1]) * peak]
    down = solve_ivp(slope, (brake, end), at_brake, args=(-1.0,), **options)
    return peak, *down.y[:, -1]


def power(line, speed, torque):
    """R i^2 plus mechanical power [W], by V = R i + k_t w."""
    return torque * (torque * line.no_load_speed / line.stall_torque + speed)


def by_the_motor_equation(line, speed, sense):
    """Torque by V = R i + k_t w within current and power [N m], driving or braking.

    Currents are limited to that whose heat alone needs all the power.
    """
    along, heat = sense * speed, line.no_load_speed / line.stall_torque
    heat_limit = np.sqrt(line.power_max / heat)
    torque = min(line.torque_limit, heat_limit, line.stall_torque - along / heat)
    if power(line, along, torque) > line.power_max:
        torque = (np.sqrt(along**2 + 4.0 * heat * line.power_max) - along) / (2.0 * heat)
    elif along < -2.0 * np.sqrt(heat * line.power_max):
        feedback_limit = (-along - np.sqrt(along**2 - 4.0 * heat * line.power_max)) / (2.0 * heat)
        torque = min(torque, feedback_limit)
    return sense * torque


@pytest.mark.parametrize(("phi", "lam", "speed_max", "final"), CASES[2::5])
def test_the_motor_equation_gives_the_same_profile(phi, lam, speed_max, final):
    line = DriveLine(STALL, NO_LOAD, lam * STALL, speed_max)
    profile, motor = slew_profile(phi, INERTIA, line, final), partial(by_the_motor_equation, line)
    peak, last, angle = integrated(line, profile, motor)
    assert profile.peak_speed == pytest.approx(peak, rel=1e-8)
    assert last == pytest.approx(final, abs=1e-8 * NO_LOAD)
    assert angle - final * profile.end == pytest.approx(phi, rel=1e-8)
    ends = [motor(0.0, 1.0), motor(peak, -1.0) if profile.end > profile.brake_from else 0.0]
    assert profile.peak_torque == pytest.approx(max(map(abs, ends)), rel=1e-9)


def test_the_phases_add_up_to_the_time():
    """To rounding, each by its own formula."""
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


def test_arrays_with_impossible_slews():
    line = DriveLine(STALL, NO_LOAD, np.array([0.3, 1.0, 3.0]), 500.0)
    profile = slew_profile([20.0, 60.0, 60.0], INERTIA, line, [0.0, 0.0, 600.0])
    for figure in (profile.end, profile.brake_from, profile.peak_speed):
        assert np.isnan(figure).tolist() == [False, False, True]
    assert profile.peak_torque[2] == 0.0
    alone = slew_profile(60.0, INERTIA, DriveLine(STALL, NO_LOAD, 1.0, 500.0))
    for name, figure in vars(alone).items():
        assert getattr(profile, name)[1] == pytest.approx(figure, rel=1e-13)


STRONG, FAST = 8.0, 1100.0
STALL_POWER = STRONG * FAST
"""V^2 / R [W]."""


def strongest(line, speed, sense):
    """Largest torque, driving (1) or braking (-1), within all limits, on a fine grid."""
    torque = sense * np.linspace(0.0, line.torque_limit, 4001)
    volts = speed / line.no_load_speed + torque / line.stall_torque
    feasible = (np.abs(volts) <= 1.0 + 1e-9) & (
        np.abs(power(line, speed, torque)) <= line.power_max
    )
    return torque[np.argmin(feasible) - 1] if not feasible.all() else torque[-1]


def torque_at(line, speed, sense):
    """Torque of the drive [N m], driving (1) or braking (-1)."""
    drive = UnitDrive.of(line)
    x = np.asarray(speed) / drive.no_load_speed
    return drive.torque * (drive.accelerating(x) if sense > 0.0 else -drive.braking(x))


@pytest.mark.parametrize("share", [0.02, 0.1, 0.24])
@pytest.mark.parametrize("lam", [0.07, 0.2, 0.9])
def test_the_torque_is_the_largest_that_the_supply_permits(share, lam):
    line = DriveLine(STRONG, FAST, lam * STRONG, INF, share * STALL_POWER)
    # Currents are limited to that whose heat alone needs all the power.
    torque_max = min(line.torque_limit, np.sqrt(share) * STRONG)
    for speed in FAST * np.linspace(0.01, 0.97, 25):
        for sense in (1.0, -1.0):
            expected = strongest(replace(line, torque_limit=torque_max), speed, sense)
            torque = torque_at(line, speed, sense)
            assert torque == pytest.approx(expected, rel=2e-3, abs=6e-4 * torque_max)


@pytest.mark.parametrize(
    ("share", "lam", "speed_max", "slew"),
    fast_subset(
        5,
        product(
            (0.02, 0.1), (0.07, 0.3), (INF, 700.0), ((30.0, 0.0), (150.0, 100.0), (400.0, 0.0))
        ),
        pytest.mark.exhaustive,
    ),
)
def test_the_motor_equation_gives_the_same_profile_on_a_weak_supply(share, lam, speed_max, slew):
    phi, final = slew
    line = DriveLine(STRONG, FAST, lam * STRONG, speed_max, share * STALL_POWER)
    profile = slew_profile(phi, INERTIA, line, final)
    peak, last, angle = integrated(line, profile, partial(by_the_motor_equation, line))
    assert profile.peak_speed == pytest.approx(peak, rel=1e-6)
    assert last == pytest.approx(final, abs=1e-6 * FAST)
    assert angle - final * float(profile.end) == pytest.approx(phi, rel=1e-6)


@pytest.mark.parametrize("slew", [(0.5, 0.0), (150.0, 0.0), (20.0, 100.0)])
@pytest.mark.parametrize(("share", "lam"), [(INF, 0.3), (INF, 1.5), (0.1, 0.3), (0.02, 0.2)])
@pytest.mark.parametrize("initial_speed", [-600.0, -200.0, 300.0])
def test_a_wheel_with_an_initial_speed_obeys_the_motor_equation(initial_speed, share, lam, slew):
    """Backwards, back EMF helps to stop it, and leaves less voltage to return to its speed."""
    phi, gain = slew
    line = DriveLine(STRONG, FAST, lam * STRONG, 900.0, share * STALL_POWER)
    profile = slew_profile(phi, INERTIA, line, gain, initial_speed)
    motor = partial(by_the_motor_equation, line)
    peak, last, angle = integrated(line, profile, motor, initial_speed)
    assert profile.peak_speed == pytest.approx(peak, abs=1e-6 * FAST)
    assert last == pytest.approx(initial_speed + gain, abs=1e-6 * FAST)
    assert angle - (initial_speed + gain) * float(profile.end) == pytest.approx(
        phi, rel=1e-6, abs=1e-5
    )
    phases = (initial_speed, peak, 1.0), (peak, last, -1.0)
    largest = max(
        abs(motor(speed, sense)) for a, b, sense in phases for speed in np.linspace(a, b, 2_000)
    )
    assert profile.peak_torque == pytest.approx(largest, rel=2e-3)


def on_weak_supplies(count):
    """Slews of drives of every kind, some with much less power than they could use."""
    rng = np.random.default_rng(5)
    phi, inertia, line, final = random_slews(rng, count)
    power_max = line.stall_torque * line.no_load_speed * 10 ** rng.uniform(-3, 0.5, count)
    return phi, inertia, replace(line, power_max=power_max), final


def test_no_slew_exceeds_the_power_of_the_supply():
    phi, inertia, line, final = on_weak_supplies(1500)
    profile = slew_profile(phi, inertia, line, final)
    for part in np.linspace(0.0, 1.0, 41):
        for sense, begin in ((1.0, 0.0), (-1.0, final)):
            speed = begin + part * (profile.peak_speed - begin)
            used = power(line, speed, torque_at(line, speed, sense)) / line.power_max
            assert np.nanmax(np.abs(used)) <= 1.0 + 1e-6


def test_times_with_limited_power_are_between_bounds():
    phi, inertia, line, final = on_weak_supplies(1500)
    limited = slew_time(phi, inertia, line, final)
    free = slew_time(phi, inertia, replace(line, power_max=INF), final)
    assert np.all(limited >= free * (1.0 - 1e-9))
    # A torque of P / w_0 never exceeds the power, as V i <= P at full voltage. At rest all power is
    # heat, which limits the current.
    heat = np.sqrt(line.power_max * line.stall_torque / line.no_load_speed)
    torque_limit = np.min([line.torque_limit, heat, line.power_max / line.no_load_speed], axis=0)
    capped = replace(line, power_max=INF, torque_limit=torque_limit)
    assert np.all(limited <= slew_time(phi, inertia, capped, final) * (1.0 + 1e-9))


def test_more_power_is_never_slower_and_ample_power_is_no_limit():
    phi, inertia, line, final = on_weak_supplies(2000)
    times = [
        slew_time(phi, inertia, replace(line, power_max=line.power_max * factor), final)
        for factor in (1.0, 1.1, 2.0, 1e6)
    ]
    for less, more in pairwise(times):
        assert np.all(more <= less * (1.0 + 1e-9))
    free = slew_time(phi, inertia, replace(line, power_max=INF), final)
    np.testing.assert_allclose(times[-1], free, rtol=1e-9)
