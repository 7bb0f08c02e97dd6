"""Smallest spin inertia: worked examples, monotonic times, brute force, reasons of failure."""

from dataclasses import replace

import numpy as np
import pytest
from driven_wheels import EC45_LINE
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, linprog

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_profile
from ocs_design.actuation.spin_root import smallest_root
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import (
    SlewReason,
    WheelTask,
    gauge,
    momentum_of_each,
    slew_reason,
    smallest_spin_inertia,
    spin_demand,
    wheel_slew_time,
    without_each,
)
from ocs_design.device.layout import PAIR, Layout, LayoutName

INF = np.inf
ANTIGRAVITY = DriveLine(24.0 * 0.025 / 0.4651, 960.0, 0.30, INF)
ROLL, BODY = 0.030, 0.0535
"""Inertia of the trunk with the wheels' mass, without their spin inertia [kg m^2]."""


def axes(roll, pitch):
    """Tilt inertia along principal axes."""
    return TiltInertia.uncoupled([roll, pitch])


def pair(incidence):
    """Axes of two wheels about roll and pitch."""
    return PAIR.axes(incidence)[..., :2, :]


def pitch_turn(degrees, duration, incidence, spin_inertia):
    """Task of a turn about pitch of the body with two wheels of this spin inertia."""
    total = BODY + 2.0 * np.cos(incidence) ** 2 * spin_inertia
    return WheelTask(
        [0.0, total * np.radians(degrees)], [0.0, 0.0], duration, axes(ROLL, total), pair(incidence)
    )


def own_fixed_point(degrees, duration, incidence):
    """Spin inertia sufficient for the turn of the body including these wheels."""
    h = 0.0
    for _ in range(30):
        h = float(smallest_spin_inertia(pitch_turn(degrees, duration, incidence, h), EC45_LINE))
    return h


def lumped(degrees, incidence, spin_inertia):
    """Slew of one wheel with 2 cos(a) I_w and 2 cos(a) tau on a body I_b (docs/theory.md).

    At an incidence, I_red / (2 cos a) of the lumped wheel replaces that of each wheel.
    """
    share = 2.0 * np.cos(incidence)
    wheel = share * spin_inertia
    xi, reduced = wheel / (wheel + BODY), wheel * BODY / (wheel + BODY)
    return slew_profile(np.radians(degrees) / xi, reduced / share, EC45_LINE)


@pytest.mark.parametrize(
    ("degrees", "duration", "incidence", "published", "exact"),
    [(30.0, 0.385, 40.0, 9.01e-5, 9.0054e-5), (360.0, 2.0, 0.0, 1.374e-4, 1.37423e-4)],
)
def test_worked_examples(degrees, duration, incidence, published, exact):
    """30 deg in 0.385 s at 40 deg, 360 deg in 2.0 s at 0 (docs/theory.md).

    The published figures lump both wheels into one on the body's axis, which is exact for wheels on
    the axis. At an incidence only cos(a) of the trunk's rate acts on a wheel, and the exact figure
    is smaller in the third digit.
    """
    angle = np.radians(incidence)
    assert float(lumped(degrees, angle, published).end) == pytest.approx(duration, rel=3e-4)
    h = own_fixed_point(degrees, duration, angle)
    assert h == pytest.approx(exact, rel=1e-5)
    assert h <= published * (1.0 + 5e-4)
    at_own = wheel_slew_time(pitch_turn(degrees, duration, angle, h), h, EC45_LINE)
    assert at_own == pytest.approx(duration, rel=1e-12)
    if incidence == 0.0:
        assert float(lumped(degrees, angle, h).end) == pytest.approx(duration, rel=1e-12)
    else:
        assert float(lumped(degrees, angle, h).end) > duration * (1.0 + 1e-5)


def test_the_wheel_of_the_example_peaks_where_published():
    """At 6209 rpm."""
    peak = lumped(30.0, np.radians(40.0), 9.01e-5).peak_speed * 30.0 / np.pi
    assert peak == pytest.approx(6209.0, rel=1e-3)


def test_a_motor_too_weak_for_any_wheel():
    """Antigravity 4004 at 0.30 N m: 0.494 s at best for 30 deg of pitch at 40 deg."""
    angle = np.radians(40.0)
    best = np.sqrt(4.0 * BODY * np.radians(30.0) / (2.0 * np.cos(angle) * 0.30))
    assert best == pytest.approx(0.494, abs=5e-4)
    task = pitch_turn(30.0, 0.385, angle, 0.0)
    assert slew_reason(task, ANTIGRAVITY) == SlewReason.TORQUE
    reasons = [
        slew_reason(pitch_turn(30.0, best * f, angle, 0.0), ANTIGRAVITY) for f in (0.999, 1.001)
    ]
    assert reasons == [SlewReason.TORQUE, SlewReason.SPEED]


def test_a_drive_without_power_is_infeasible():
    """Friction may need all the power of a small supply."""
    line, task = replace(ANTIGRAVITY, power_max=0.0), pitch_turn(30.0, 0.385, np.radians(40.0), 0.0)
    assert np.isinf(smallest_spin_inertia(task, line))
    assert np.isinf(wheel_slew_time(task, 9e-5, line))
    assert slew_reason(task, line) == SlewReason.TORQUE
    empty = pitch_turn(0.0, 0.385, np.radians(40.0), 0.0)
    assert smallest_spin_inertia(empty, line) == 0.0


@pytest.mark.parametrize("turning", [False, True])
def test_insufficient_torque_is_the_reason_with_momentum_too(turning):
    """A trunk much heavier than any wheel, and a wheel of nearly constant speed."""
    rng = np.random.default_rng(11)
    count = 5_000
    momentum = rng.uniform(0.0, 0.3, (count, 2)) * (rng.random(count) < 0.7)[:, None]
    swept, incidence = rng.uniform(0.0, 0.1, (count, 2)), rng.uniform(0.3, 1.2, count)
    task = WheelTask(swept, momentum, 1.0, axes(1e9, 1e9), pair(incidence))
    line = DriveLine(INF, 1e3, rng.uniform(0.05, 2.0, count), INF)
    if turning:
        line = replace(line, stall_torque=rng.uniform(0.5, 2.0, count))
        task = replace(task, initial_speed=rng.uniform(-0.9, 0.9, count) * line.no_load_speed)
    weak = slew_reason(task, line) == SlewReason.TORQUE
    time = wheel_slew_time(task, 10.0, line)
    assert (np.isinf(time) <= weak).all()
    assert ((time > 1.0) == weak)[abs(time - 1.0) > 1e-3].all()
    assert 1_000 < weak.sum() < 4_000


def random_tasks(rng, count):
    """Turns of small to large robots about both axes, half of them with final momentum."""
    inertia = 10 ** rng.uniform(-2.0, 0.0, (count, 2))
    turned = rng.random((count, 2)) < 0.7
    turned[~turned.any(axis=1)] = True
    incidence = rng.uniform(0.05, 1.5, count)
    angle = np.where(turned, rng.uniform(0.05, 6.3, (count, 2)), 0.0)
    moving = turned & (rng.random(count) < 0.5)[:, None]
    rate = np.where(moving, rng.uniform(0, 4, (count, 2)), 0.0)
    duration = 10 ** rng.uniform(-0.7, 0.5, count)
    return WheelTask(
        inertia * angle, inertia * rate, duration, TiltInertia.uncoupled(inertia), pair(incidence)
    )


def random_lines(rng, count):
    stall, no_load = 10 ** rng.uniform(-0.5, 1.5, count), 10 ** rng.uniform(1.8, 3.3, count)
    limit = stall * 10 ** rng.uniform(-1.5, 1.0, count)
    speed_max = np.where(rng.random(count) < 0.5, INF, no_load * rng.uniform(0.3, 1.2, count))
    return DriveLine(stall, no_load, limit, speed_max)


def row(values, k):
    """Some of many tasks or lines."""
    return type(values)(*(_one(getattr(values, name), k) for name in values.__dataclass_fields__))


def _one(value, k):
    if isinstance(value, tuple):
        return TiltInertia(*(part[k] for part in value))
    return value if np.ndim(value) == 0 else value[k]


@pytest.mark.parametrize("turning", [False, True])
def test_the_smallest_wheel_is_exactly_in_time(turning):
    rng = np.random.default_rng(3)
    task, line = random_tasks(rng, 20_000), random_lines(rng, 20_000)
    if turning:
        initial_speed = rng.uniform(-1.0, 1.0, 20_000) * line.top_speed
        power = line.stall_torque * line.no_load_speed * 10 ** rng.uniform(-2.0, 1.0, 20_000)
        task, line = replace(task, initial_speed=initial_speed), replace(line, power_max=power)
    armature = np.where(rng.random(20_000) < 0.5, 0.0, 10 ** rng.uniform(-7, -4, 20_000))
    h = smallest_spin_inertia(task, line, armature)
    feasible = np.flatnonzero(np.isfinite(h))
    assert 5_000 < feasible.size < 18_000
    task, line, h, armature = (
        row(task, feasible),
        row(line, feasible),
        h[feasible],
        armature[feasible],
    )
    time = wheel_slew_time(task, h, line, armature)
    np.testing.assert_allclose(time, task.duration, rtol=1e-8 if turning else 1e-11)
    assert (wheel_slew_time(task, h * (1.0 - 1e-3), line, armature) > task.duration).all()


def test_where_no_wheel_is_feasible_the_largest_is_too_slow():
    rng = np.random.default_rng(4)
    task, line = random_tasks(rng, 20_000), random_lines(rng, 20_000)
    infeasible = np.flatnonzero(np.isinf(smallest_spin_inertia(task, line)))
    assert infeasible.size > 2_000
    task, line = row(task, infeasible), row(line, infeasible)
    largest = 1.0 / (2.0 * task.load().coupling)
    assert (wheel_slew_time(task, largest, line) > task.duration).all()
    assert set(slew_reason(task, line)) <= {SlewReason.TORQUE, SlewReason.SPEED}


def test_time_falls_as_the_wheel_grows():
    """The law that makes the smallest wheel a root, up to half of 1 / kappa."""
    rng = np.random.default_rng(5)
    task, line = random_tasks(rng, 2_000), random_lines(rng, 2_000)
    armature = np.where(rng.random(2_000) < 0.5, 0.0, 10 ** rng.uniform(-7, -3, 2_000))
    largest = 1.0 / (2.0 * task.load().coupling)
    shares = np.geomspace(1e-5, 1.0, 60)[:, np.newaxis]
    time = wheel_slew_time(task, shares * largest, line, armature)
    with np.errstate(invalid="ignore"):
        rise = time[1:] / time[:-1]
    assert np.nanmax(rise) <= 1.0 + 1e-12
    assert np.isfinite(time).mean() > 0.5


def test_wheels_above_half_of_the_inertia_they_turn_count_as_half():
    rng = np.random.default_rng(12)
    task, line = random_tasks(rng, 2_000), random_lines(rng, 2_000)
    largest = 1.0 / (2.0 * task.load().coupling)
    time = wheel_slew_time(task, largest, line)
    np.testing.assert_array_equal(wheel_slew_time(task, 1.5 * largest, line), time)
    assert (wheel_slew_time(task, 0.99 * largest, line) > time)[np.isfinite(time)].mean() > 0.9


@pytest.mark.slow
def test_the_smallest_wheel_is_found_where_time_is_not_monotonic():
    """With a negative armature time may fall, rise and fall again; brute force finds the first."""
    rng = np.random.default_rng(6)
    count, points = 400, 1000
    task, line = random_tasks(rng, count), random_lines(rng, count)
    load = task.load()
    largest = 1.0 / (2.0 * load.coupling)
    usual = np.minimum(smallest_spin_inertia(task, line), largest / 4.0)
    armature = -usual * rng.uniform(0.05, 0.5, count)
    least = -armature * rng.uniform(1.4, 3.0, count)
    h = smallest_root(spin_demand(task, line, armature, least))
    step = (largest / least) ** (1.0 / (points - 1))
    grid = least * step ** np.arange(points)[:, np.newaxis]
    time = wheel_slew_time(task, grid, line, armature)
    in_time = time <= task.duration
    first = np.where(in_time.any(axis=0), grid[in_time.argmax(axis=0), np.arange(count)], INF)
    feasible = np.isfinite(first)
    assert (h[feasible] <= first[feasible] * (1.0 + 1e-12)).all()
    assert (h[feasible] >= first[feasible] / step[feasible] * (1.0 - 1e-12)).all()
    assert np.isinf(h[~feasible]).all()
    assert 100 < feasible.sum() < count
    rises = (time[1:] > time[:-1] * (1.0 + 1e-12)).any(axis=0)
    assert (rises & feasible).sum() > 20


def test_a_wheel_is_larger_than_its_negative_armature():
    """Without `least`, the search starts where the driven inertia is positive."""
    rng = np.random.default_rng(9)
    task, line = random_tasks(rng, 2_000), random_lines(rng, 2_000)
    relief = 0.1 / task.load().coupling
    h = smallest_spin_inertia(task, line, -relief)
    feasible = np.isfinite(h)
    assert (h > relief).all()
    time = wheel_slew_time(task, np.where(feasible, h, INF), line, -relief)
    assert (time[feasible] <= task.duration[feasible] * (1.0 + 1e-11)).all()


def test_bisection_finds_the_root_where_newton_fails(monkeypatch):
    rng = np.random.default_rng(10)
    task, line = random_tasks(rng, 500), random_lines(rng, 500)
    h = smallest_spin_inertia(task, line)
    monkeypatch.setattr(
        "ocs_design.actuation.spin_root.newton_step", lambda demand, h, can: np.full_like(h, INF)
    )
    by_bisection = smallest_spin_inertia(task, line)
    time = wheel_slew_time(task, by_bisection, line)
    feasible = np.isfinite(h)
    assert (np.isfinite(by_bisection) == feasible).all()
    np.testing.assert_allclose(time[feasible], task.duration[feasible], rtol=1e-11)


def test_an_uncontrolled_axis():
    turn = [0.01, 0.02]
    for incidence, swept, reachable in [
        (0.0, turn, False),
        (np.pi / 2.0, turn, False),
        (0.0, [0.0, 0.02], True),
        (np.pi / 2.0, [0.02, 0.0], True),
        (0.7, turn, True),
    ]:
        task = WheelTask(swept, [0.0, 0.0], 1.0, axes(ROLL, BODY), pair(incidence))
        assert np.isfinite(smallest_spin_inertia(task, EC45_LINE)) == reachable
        assert (slew_reason(task, EC45_LINE) == SlewReason.AXIS) != reachable


def test_empty_and_impossible_tasks():
    empty = WheelTask([0.0, 0.0], [0.0, 0.0], 0.5, axes(ROLL, BODY), pair(0.6))
    assert smallest_spin_inertia(empty, EC45_LINE) == 0.0
    assert smallest_root(spin_demand(empty, EC45_LINE, least=3e-5)) == 3e-5
    assert wheel_slew_time(empty, [0.0, 1e-4, INF], EC45_LINE).tolist() == [0.0, 0.0, 0.0]
    turn = WheelTask([0.0, 0.01], [0.0, 0.0], 0.5, axes(ROLL, BODY), pair([0.6, 0.6, np.pi / 2]))
    assert np.isinf(wheel_slew_time(turn, [0.0, INF, 1e-4], EC45_LINE)).all()
    late = WheelTask([0.0, 0.01], [0.0, 0.01], [0.0, -0.1], axes(ROLL, BODY), pair(0.6))
    assert np.isinf(smallest_spin_inertia(late, EC45_LINE)).all()
    assert (slew_reason(late, EC45_LINE) == SlewReason.TORQUE).all()


def test_drives_incidences_and_turns_broadcast():
    line = DriveLine(np.array([1.0, 2.0, 3.0])[:, None, None], 650.0, 1.0, INF)
    incidence = np.radians([20.0, 40.0])[:, None]
    swept = np.array([[0.0, 0.01], [0.01, 0.0], [0.01, 0.01], [0.0, 0.02]])
    task = WheelTask(swept, np.zeros(2), 0.8, axes(ROLL, BODY), pair(incidence))
    h = smallest_spin_inertia(task, line)
    assert h.shape == (3, 2, 4)
    single = WheelTask(swept[2], np.zeros(2), 0.8, axes(ROLL, BODY), pair(np.radians(40.0)))
    one = smallest_spin_inertia(single, DriveLine(3.0, 650.0, 1.0, INF))
    assert h[2, 1, 2] == pytest.approx(float(one), rel=1e-13)


def by_linear_program(axes, momentum):
    """Least load of the wheel with most load; inf where the axes do not span the momentum."""
    dimensions, wheels = axes.shape
    upper = np.hstack([np.eye(wheels), -np.ones((wheels, 1))])
    solution = linprog(
        np.append(np.zeros(wheels), 1.0),
        A_eq=np.hstack([axes, np.zeros((dimensions, 1))]),
        b_eq=momentum,
        A_ub=np.vstack([upper, upper * np.append(-np.ones(wheels), 1.0)]),
        b_ub=np.zeros(2 * wheels),
        bounds=[(None, None)] * wheels + [(0.0, None)],
    )
    return solution.fun if solution.success else INF


@settings(deadline=None)
@given(st.integers(2, 3), st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_the_gauge_agrees_with_a_linear_program(dimensions, wheels, seed):
    """Also of axes along a line or in a plane, and of momenta that they do not span."""
    rng = np.random.default_rng(seed)
    rank = rng.integers(1, dimensions + 1)
    axes = rng.normal(size=(dimensions, rank)) @ rng.normal(size=(rank, wheels))
    axes /= np.linalg.norm(axes, axis=0)
    if np.linalg.matrix_rank(axes, 1e-6) != np.linalg.matrix_rank(axes, 1e-12):
        return
    momentum = axes @ rng.normal(size=wheels)
    assert gauge(axes, momentum).busiest == pytest.approx(
        by_linear_program(axes, momentum), rel=1e-12
    )
    beyond = np.linalg.svd(axes)[0][:, -1]
    assert np.isinf(gauge(axes, beyond).busiest) == (np.linalg.matrix_rank(axes) < dimensions)


@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_the_wheels_hold_the_momentum_and_none_exceeds_the_gauge(wheels, seed):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(7, 2, wheels))
    momentum = (axes @ rng.normal(size=(7, wheels, 1)))[..., 0]
    each, most = momentum_of_each(axes, momentum), gauge(axes, momentum).busiest
    np.testing.assert_allclose((axes * each[:, None]).sum(axis=2), momentum, rtol=0, atol=1e-9)
    assert (np.abs(each).max(axis=1) <= most * (1.0 + 1e-9)).all()


@given(st.floats(0.05, 1.5), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_gauge_of_a_pair_is_the_rhombus(incidence, roll, pitch):
    """(|L_x| / s + |L_y| / c) / 2 (docs/theory.md, What a maneuver asks for)."""
    rhombus = (abs(roll) / np.sin(incidence) + abs(pitch) / np.cos(incidence)) / 2.0
    busiest = gauge(pair(incidence), [roll, pitch]).busiest
    assert busiest == pytest.approx(rhombus, rel=1e-12, abs=1e-300)


LAYOUTS = {
    Layout(LayoutName.SINGLE): (1.773e-4, INF),
    PAIR: (6.55e-5, INF),
    Layout(LayoutName.TRIAD): (6.55e-5, 5.66e-5),
    Layout(LayoutName.ORTHOGONAL): (1.773e-4, 7.84e-5),
    Layout(LayoutName.PYRAMID): (5.52e-5, 5.58e-5),
}


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.name)
def test_layouts_against_optimal_control(layout):
    """Smallest h for 30 deg of pitch, and for 20 deg of pitch and of roll, in 0.385 s.

    The figures are for 40 constant torques, which need 1 to 3 % more (`test_smallest_wheels.py`).
    The closed form is optimal about one axis; about both, a plan with a free ratio of the wheels
    needs up to a third less.
    """
    elevation = np.radians(35.0) if layout.name == LayoutName.PYRAMID else 0.0
    smallest = []
    for turn in ([0.0, 30.0], [20.0, 20.0]):
        swept = np.array([ROLL, BODY]) * np.radians(turn)
        task = WheelTask(swept, np.zeros(2), 0.385, axes(ROLL, BODY), layout.axes(elevation)[:2])
        smallest.append(float(smallest_spin_inertia(task, EC45_LINE)))
    pitch, both = LAYOUTS[layout]
    assert 0.97 < smallest[0] / pitch < 0.995
    if np.isinf(both):
        assert smallest[1] == INF
    else:
        assert 0.97 < smallest[1] / both < 1.34


def largest_swept_angle(reduced):
    """Largest angle of a wheel with this reduced inertia in 2 s from rest to rest, integrated."""

    def accelerated(until):
        run = solve_ivp(
            lambda _, state: (min(1.0, 1.4566 * (1.0 - state[0] / 650.4)) / reduced, state[0]),
            (0.0, until),
            (0.0, 0.0),
            rtol=1e-10,
            atol=1e-10,
        )
        return run.y[:, -1]

    until = brentq(lambda until: until + accelerated(until)[0] * reduced - 2.0, 1e-3, 2.0 - 1e-3)
    speed, angle = accelerated(until)
    return angle + 0.5 * speed * (2.0 - until)


def largest_swept_angle_by_steps(reduced, count):
    """Largest angle with torques constant over each step, by a linear program."""
    step = 2.0 / count
    after = step / reduced * np.tril(np.ones((count, count)))
    before, slope = np.vstack([np.zeros(count), after[:-1]]), 650.4 / 1.4566 * np.eye(count)
    ends = np.vstack([before + slope, after + slope])
    solution = linprog(
        -0.5 * step * (before + after).sum(axis=0),
        A_ub=np.vstack([ends, -ends]),
        b_ub=np.full(4 * count, 650.4),
        A_eq=after[-1:],
        b_eq=[0.0],
        bounds=[(-1.0, 1.0)] * count,
    )
    return -solution.fun


@pytest.mark.parametrize(
    ("name", "elevation", "published"),
    [(LayoutName.ORTHOGONAL, 0.0, 8.6e-5), (LayoutName.PYRAMID, 35.0, 3.7e-5)],
)
def test_wheels_that_control_yaw_turn_it_directly(name, elevation, published):
    """90 deg of yaw in 2 s of the same body, I_zz = 0.068 kg m^2, as published to two digits.

    The published wheels are for 40 constant torques, 1.3 and 1.9 % larger than with the full
    torque-speed line and the torque limit for braking.
    """
    wheels, yaw_inertia = Layout(name).axes(np.radians(elevation)), np.array(0.068)
    swept = np.array([0.0, 0.0, yaw_inertia * np.pi / 2.0])
    turn = WheelTask(swept, np.zeros(3), 2.0, axes(ROLL, BODY), wheels, yaw_inertia=yaw_inertia)
    smallest, gain = float(smallest_spin_inertia(turn, EC45_LINE)), np.abs(wheels[2]).sum()
    required = np.pi / 2.0 * 0.068 / gain
    reduced = smallest - smallest**2 * gain * np.abs(wheels[2]).max() / 0.068
    assert smallest * largest_swept_angle(reduced) == pytest.approx(required, rel=1e-6)

    def excess(h):
        reduced = h - h**2 * gain * np.abs(wheels[2]).max() / 0.068
        return h * largest_swept_angle_by_steps(reduced, 40) - required

    larger = brentq(excess, smallest, 1.1 * smallest, rtol=1e-5)
    assert larger == pytest.approx(published, abs=0.05e-5)
    assert 1.01 < larger / smallest < 1.02
    # A demand about roll and pitch is added to the wheel with most load.
    more = replace(turn, swept=swept + np.array([0.01, 0.0, 0.0]))
    assert more.load().excess > turn.load().excess * (1.0 - 1e-12)
    level = WheelTask([0.01, 0.0], np.zeros(2), 2.0, axes(ROLL, BODY), wheels[:2])
    assert more.load().excess >= level.load().excess


@pytest.mark.slow
@settings(deadline=None)
@given(st.integers(2, 6), st.integers(0, 2**32 - 1))
def test_the_gauge_without_a_wheel_agrees_with_a_linear_program(wheels, seed):
    """Without one wheel the largest load of the others is no less than with all."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(2, wheels)) * np.array([1.0, rng.choice([1.0, 0.0])])[:, None]
    momentum = axes[:, 0] + axes[:, 1]
    for lost, remaining in enumerate(without_each(axes)):
        others, busiest = np.delete(axes, lost, axis=1), gauge(remaining, momentum).busiest
        assert busiest == pytest.approx(by_linear_program(others, momentum), rel=1e-9)
        assert busiest >= gauge(axes, momentum).busiest * (1.0 - 1e-12)


@pytest.mark.parametrize("name", [LayoutName.TRIAD, LayoutName.DOUBLE_PAIR, LayoutName.PAIR])
def test_a_task_with_a_failed_drive_is_that_of_the_worst_failure(name):
    layout, momentum = Layout(name), np.zeros(2)
    all_axes = layout.axes(0.7)[:2]
    task = WheelTask([0.01, 0.02], momentum, 0.4, axes(ROLL, BODY), all_axes, one_stops=True)
    loads = [replace(task, axes=left, one_stops=False).load() for left in without_each(all_axes)]
    assert task.load().excess == max(load.excess for load in loads)
    assert task.load().excess >= replace(task, one_stops=False).load().excess
    assert np.isinf(task.load().excess) == (name is LayoutName.PAIR)


@pytest.mark.parametrize(("pitch", "sense"), [(1.0, 1.0), (-1.0, -1.0)])
def test_a_wheel_that_starts_backwards_can_change_its_speed_by_more(pitch, sense):
    """From -w it can change by w + w_max: h = L / (w + w_max), for both wheels of a pair."""
    top, w, duration = 200.0, 70.0, 1e6
    line = DriveLine(np.inf, top, 1e9, np.inf)
    momentum = np.array([0.0, pitch * 0.01])
    task = WheelTask(0.0 * momentum, momentum, duration, axes(ROLL, BODY), pair(0.6))
    per_wheel = 0.01 / (2.0 * np.cos(0.6))
    for initial_speed in (-sense * w, sense * w):
        spin_inertia = smallest_spin_inertia(replace(task, initial_speed=initial_speed), line)
        assert spin_inertia == pytest.approx(per_wheel / (top - sense * initial_speed), rel=1e-6)
    # A pair rolls the trunk by opposite wheels: one of them gains nothing.
    rolled = replace(task, momentum=momentum[::-1], initial_speed=-w)
    assert smallest_spin_inertia(rolled, line) == pytest.approx(
        0.01 / (2.0 * np.sin(0.6)) / (top - w), rel=1e-6
    )
