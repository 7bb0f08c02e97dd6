"""Quickest slews: the special cases of the theory, round trips, optimality, limits."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.sparse import coo_array, vstack

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import in_units, slew_profile, slew_time
from ocs_design.actuation.unit_drive import (
    exp_remainder,
    farthest_slew,
    log_remainder,
    rise_sweep,
    rise_to,
)

INF = np.inf
EC45 = DriveLine(1.4566, 650.4, 1.0, INF)


def random_slews(rng, count):
    """Drives of every kind, with inertias, final speeds and angles from far below to far above."""
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

    Negative where the wheel gets to its final speed, but late; NaN where it does not get there.
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


def test_torque_alone():
    """t = 2 sqrt(I_b theta / tau), peak 2 theta / (xi t), with theta = xi phi, I_red = xi I_b."""
    inertia, torque, phi = 9e-5, 0.3, np.array([1e-6, 0.1, 30.0, 200.0])
    expected = 2.0 * np.sqrt(inertia * phi / torque)
    line = DriveLine(INF, 1e4, torque, INF)
    np.testing.assert_allclose(slew_time(phi, inertia, line), expected, rtol=1e-14)
    profile = slew_profile(phi, inertia, line)
    np.testing.assert_allclose(profile.peak_speed, 2.0 * phi / expected, rtol=1e-14)


def test_voltage_line_alone():
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


def test_there_and_back_to_ten_digits():
    phi, inertia, line, final = random_slews(np.random.default_rng(1), 50_000)
    time = slew_time(phi, inertia, line, final)
    assert np.isfinite(time).all()
    # With a final speed, phi is a difference: it has the digits of the whole angle.
    error = np.abs(slew_angle(time, inertia, line, final) - phi) / (phi + final * time)
    assert error.max() < 1e-12
    rest = final == 0.0
    assert np.abs(slew_angle(time, inertia, line, final) / phi - 1.0)[rest].max() < 1e-12
    settled = np.abs(slew_time(slew_angle(time, inertia, line, final), inertia, line, final) - time)
    assert (settled[rest] / time[rest]).max() < 1e-12


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
def test_there_and_back_at_the_corners(phi, stall, limit, speed_max, final, inertia):
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


def test_more_of_anything_is_quicker():
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
    """Largest integral of W - W_f over all speed curves that the drive allows, on a grid.

    The limits on dW/dt are linear in W: a linear program that knows nothing of switching.
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
    answer = linprog(
        -weights,
        A_ub=vstack([matrix for matrix, _ in limits]),
        b_ub=np.repeat([bound for _, bound in limits], steps),
        bounds=bounds,
        method="highs",
    )
    assert answer.status == 0
    return -answer.fun - final * time


@pytest.mark.parametrize("lam", [0.4, 0.9, 1.5, 5.0])
@pytest.mark.parametrize("final", [0.0, 250.0])
@pytest.mark.parametrize("speed_max", [INF, 400.0])
def test_nothing_is_quicker(lam, final, speed_max):
    line = DriveLine(1.4566, 650.4, 1.4566 * lam, speed_max)
    inertia, time = 9e-5, 0.2
    by_program = farthest_by_linear_program(time, inertia, line, final, 400)
    phi = slew_angle(time, inertia, line, final)
    # The grid rounds the corners of the speed curve, each by up to dW dt / 8 or so.
    assert phi == pytest.approx(by_program, rel=1e-4)


def test_impossible_slews():
    line = DriveLine(1.0, 100.0, 0.5, 80.0)
    assert np.isinf(slew_time(1.0, 1e-4, line, [80.0, 90.0, 200.0])).all()
    assert np.isinf(slew_time(INF, 1e-4, line))
    assert np.isnan(slew_angle(1.0, 1e-4, line, 80.0))
    # 0.5 N m on 1e-4 kg m2 need 10 ms to 50 rad/s.
    angle = slew_angle([0.0099, 0.0101], 1e-4, line, 50.0)
    assert np.isnan(angle[0])
    assert angle[1] == pytest.approx(-50.0 * 0.01 / 2.0, rel=0.05)


def test_no_angle_takes_no_time_but_a_final_speed_does():
    assert slew_time(0.0, 9e-5, EC45) == 0.0
    # Up beyond 100 rad/s and back, so that the mean is 100: the torque-limited peak is
    # W_f (1 + 1 / sqrt 2).
    expected = 9e-5 / 1.0 * (2.0 * (1.0 + np.sqrt(0.5)) - 1.0) * 100.0
    assert slew_time(0.0, 9e-5, EC45, 100.0) == pytest.approx(expected, rel=1e-13)


def test_a_supply_whose_power_friction_takes_whole_moves_nothing():
    line = DriveLine(1.4566, 650.4, 1.0, INF, power_max=0.0)
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
def test_full_precision_at_every_size(function, exact):
    expected = np.array([exact(float(point)) for point in POINTS])
    np.testing.assert_allclose(function(POINTS), expected, rtol=3e-15)


def test_ends():
    assert exp_remainder(np.array(0.0)) == log_remainder(np.array(0.0)) == 0.0
    assert exp_remainder(np.array(1e4)) == 9999.0
    assert exp_remainder(np.array(np.inf)) == np.inf
