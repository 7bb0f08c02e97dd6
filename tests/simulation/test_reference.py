"""Turns within the motor's limits, and tracking of trajectories with their torque."""

from dataclasses import replace

import numpy as np
import pytest
from subsets import fast_subset
from trajectories import from_rest
from wheels import EC45, driven_device, geared, paper_maneuvers

from ocs_design.actuation.drive import RESERVE
from ocs_design.common import quaternions
from ocs_design.device.layout import module_axes
from ocs_design.requirement.froude import Gains
from ocs_design.requirement.turns import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import Turn, fit_turn, utilisation
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.schedule import track
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.wheel_law import Allocation, WheelLaw, tilt_error
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

PITCH = np.array([0.0, 1.0, 0.0])
BODY = Gyrostat(np.diag([0.03, 0.0535, 0.068]), module_axes(np.radians(40.0)), 1e-4)
FLIP = Turn(PITCH, 0.0, -2.0 * np.pi, 2.0)


@pytest.mark.parametrize("ramp", [0.0, 0.1, 0.3, 0.5])
def test_a_turn_runs_from_rest_to_rest_with_its_derivatives(ramp):
    flip = replace(FLIP, ramp=ramp)
    ends = np.array([0.0, 2.0])
    np.testing.assert_allclose(flip.angle(ends), [0.0, -2.0 * np.pi], atol=1e-12)
    np.testing.assert_allclose(flip.rate(ends), 0.0, atol=1e-12)
    np.testing.assert_allclose(flip.acceleration(ends), 0.0, atol=1e-12)
    t, h = np.linspace(0.02, 1.98, 97), 1e-6
    slope = (flip.angle(t + h) - flip.angle(t - h)) / (2 * h)
    np.testing.assert_allclose(flip.rate(t), slope, atol=1e-7)
    slope = (flip.rate(t + h) - flip.rate(t - h)) / (2 * h)
    np.testing.assert_allclose(flip.acceleration(t), slope, atol=1e-3)


def test_peaks_are_as_documented():
    turn, time = Turn(PITCH, 0.0, 1.0, 1.0), np.linspace(0.0, 1.0, 100_001)
    assert turn.rate(time).max() == pytest.approx(1.875)
    assert turn.acceleration(time).max() == pytest.approx(10.0 / np.sqrt(3.0))
    trapezoid = replace(turn, ramp=0.2)
    assert trapezoid.rate(time).max() == pytest.approx(1.0 / 0.8)
    assert trapezoid.acceleration(time).max() == pytest.approx(1.5 / (0.2 * 0.8))


def test_a_turn_holds_its_ends_before_and_after():
    turn = Turn(PITCH, 0.5, 0.0, 0.4)
    np.testing.assert_allclose(turn.angle(np.array([0.0, 0.2, 0.4, 9.0])), [0.5, 0.25, 0.0, 0.0])
    np.testing.assert_allclose(turn.rate(np.array([0.0, 9.0])), 0.0)
    at_once = replace(turn, at_once=True)
    np.testing.assert_allclose(at_once.angle(np.array([0.0])), 0.0)
    np.testing.assert_allclose(at_once.rate(np.array([0.1])), 0.0)


LOPSIDED = np.array([[0.03, 0.004, 0.003], [0.004, 0.0535, -0.006], [0.003, -0.006, 0.068]])


@pytest.mark.parametrize("inertia", [BODY.inertia, LOPSIDED], ids=["even", "lopsided"])
def test_utilisation_is_peak_speed_of_the_busier_wheel_over_no_load_speed(inertia):
    """Both wheels' speeds and the yaw rate of a pure pitch, from three equations of momentum."""
    body = replace(BODY, inertia=inertia)
    rate = 1.875 * 2.0 * np.pi / 2.0
    unknown = np.column_stack([inertia[:, 2], 1e-4 * body.axes])
    _, *speeds = np.linalg.solve(unknown, -inertia[:, 1] * rate)
    busier = float(np.abs(speeds).max())
    assert utilisation(FLIP, body, MotorLimits(busier, 0.0, np.inf)) == pytest.approx(1.0, rel=1e-4)


def test_a_feasible_turn_stays_as_it_is():
    fitted = fit_turn(FLIP, BODY, MotorLimits(np.inf, 0.0, np.inf))
    assert fitted is FLIP
    assert fitted.note == ""


def test_a_wheel_a_little_too_slow_gets_a_flatter_rate():
    limits = MotorLimits(2000.0, 0.0, np.inf)
    assert utilisation(FLIP, BODY, limits) > 1.0
    fitted = fit_turn(FLIP, BODY, limits)
    assert fitted.ramp > 0.0
    assert fitted.duration == FLIP.duration
    assert utilisation(fitted, BODY, limits) <= RESERVE
    assert "trapezoid" in fitted.note


def test_a_wheel_far_too_slow_gets_more_time_with_a_note():
    limits = MotorLimits(700.0, 350.0, 1.0)
    fitted = fit_turn(FLIP, BODY, limits)
    assert utilisation(fitted, BODY, limits) == pytest.approx(RESERVE, rel=1e-6)
    assert "instead of the 2 s" in fitted.note
    faster = replace(fitted, duration=0.999 * fitted.duration)
    assert utilisation(faster, BODY, limits) > RESERVE


def test_a_fall_is_not_extended():
    drop = Turn(PITCH, 0.5, 0.0, 0.385, extendable=False)
    fitted = fit_turn(drop, BODY, MotorLimits(300.0, 0.0, np.inf))
    assert fitted.at_once
    assert fitted.duration == 0.385
    assert "step" in fitted.note


ROBOT = robot_by_hand(2.5, (0.030, 0.0535, 0.068, 0.001, 0.003, -0.002))
DROP = Drop(name="drop", height=3.5, pitch=np.radians(20.0), roll=np.radians(5.0))
DRIVES = {"direct": EC45, "reducing": geared(1.2), "speeding up": geared(0.5, inertia=0.0)}


@pytest.fixture(scope="module")
def builder():
    return WorldBuilder(ROBOT, driven_device())


@pytest.fixture(scope="module")
def trajectory(builder):
    return planned(builder, DROP)


@pytest.fixture(scope="module")
def law(builder):
    return builder.flight(DROP, Wheels.ACTIVE).law


def planned(builder, maneuver):
    """The quintic turn of a maneuver with its exact feed-forward torque."""
    world = builder.flight(maneuver, Wheels.ACTIVE)
    return from_rest(world.body, replace(world.turn, ramp=0.0, at_once=False))


def until_landing(builder, maneuver, trajectory):
    world = builder.flight(maneuver, Wheels.ACTIVE, trajectory)
    return replace(world, duration=world.flight_time)


def tracking_error(world):
    """Largest angle between the actual and the planned vertical [rad]."""
    recording, trajectory = simulate([world]), world.trajectory
    vertical = quaternions.vertical(recording.attitude[:, 0])
    planned_vertical = [
        np.interp(recording.time, trajectory.time, c) for c in trajectory.vertical.T
    ]
    return np.abs(tilt_error(vertical, np.column_stack(planned_vertical))).max()


@pytest.mark.parametrize("name", DRIVES)
def test_feed_forward_follows_where_feedback_alone_lags_behind(name):
    builder = WorldBuilder(ROBOT, driven_device(drive=DRIVES[name]))
    trajectory = planned(builder, DROP)
    no_feedforward = replace(trajectory, wheel_torque=np.zeros_like(trajectory.wheel_torque))
    error = tracking_error(until_landing(builder, DROP, trajectory))
    assert error < np.radians(0.1)
    assert tracking_error(until_landing(builder, DROP, no_feedforward)) > 30.0 * error


def test_on_the_trajectory_there_is_no_feedback(builder, trajectory):
    """In the planned state the motors give the planned torque."""
    law = WheelLaw.of(
        builder.flight(DROP, Wheels.ACTIVE).body,
        Gains(60.0, 12.0),
        MotorLimits(np.inf, 0.0, np.inf),
        Allocation.PSEUDO_INVERSE,
    )
    # Additional momentum makes the gyroscopic torque count.
    trajectory = replace(trajectory, wheel_speed=trajectory.wheel_speed + np.array([80.0, -50.0]))
    times, period = trajectory.time[:-1], trajectory.time[1]
    target = track(trajectory, law, times, period)
    state = trajectory.vertical[:-1], trajectory.rate[:-1], trajectory.wheel_speed[:-1]
    actual = law.repeat(len(times)).torque(*state, target, period)
    expected = 0.5 * (trajectory.wheel_torque[1:] + trajectory.wheel_torque[:-1])
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("period", [1e-3, 5e-3, 0.0371])
def test_held_torques_have_the_planned_impulse(trajectory, law, period):
    """For any control step, also where samples and steps do not coincide, up to the end."""
    samples = {name: x for name, x in vars(trajectory).items() if isinstance(x, np.ndarray)}
    coarse = replace(trajectory, **{name: x[::13] for name, x in samples.items()})
    times = np.arange(0.0, 1.2, period)
    without_rates = replace(coarse, rate=np.zeros_like(coarse.rate))
    impulse = np.cumsum(track(without_rates, law, times, period).torque, axis=0) * period
    exact = [
        [np.trapezoid(*_until(coarse.time, column, end)) for column in coarse.wheel_torque.T]
        for end in times + period
    ]
    np.testing.assert_allclose(impulse, exact, rtol=0, atol=1e-12)


def _until(time, values, end):
    """Samples up to `end` and the value there."""
    before = time < end
    last = min(end, time[-1])
    return (np.append(values[before], np.interp(last, time, values)), np.append(time[before], last))


def test_after_its_end_the_trunk_is_held_level(trajectory, law):
    target = track(trajectory, law, trajectory.time[-1] + np.array([0.0, 0.3]), 5e-3)
    np.testing.assert_array_equal(target.vertical, [[0.0, 0.0, 1.0]] * 2)
    np.testing.assert_array_equal(target.rate, 0.0)
    np.testing.assert_array_equal(target.torque, 0.0)


def test_after_a_quarter_turn_the_trunk_is_held_there(trajectory, law):
    """Once the target returned to level, in flights and in the exported C alike."""
    backwards = replace(trajectory, vertical=trajectory.vertical[::-1])
    target = track(backwards, law, trajectory.time[-1] + np.array([0.0, 0.3]), 5e-3)
    np.testing.assert_array_equal(target.vertical, [trajectory.vertical[0]] * 2)


@pytest.mark.slow
def test_each_maneuver_tracks_its_own_reference_but_not_a_push(solo12):
    device = driven_device(carrier=replace(driven_device().carrier, mass=0.05))
    jump, drop, flip = paper_maneuvers(solo12)
    drop = replace(drop, pitch=np.radians(15.0))
    builder = WorldBuilder(solo12, device)
    references = {maneuver.name: planned(builder, maneuver) for maneuver in (jump, drop)}
    runs = run_scenarios(Flights(solo12, device, [jump, drop, flip], references=references))
    notes = {run.scenario: run.note for run in runs if run.ocs}
    assert notes["drop"] == "by hand"
    assert "by hand" not in (notes["disturbance"], notes["back-flip"])
    assert {run.note for run in runs if not run.ocs} == {""}
    alone = run_scenarios(Flights(solo12, device, [jump]))[0]
    np.testing.assert_array_equal(alone.series.wheel_torque, runs[0].series.wheel_torque)


@pytest.mark.parametrize(
    ("speed_max", "tracked"),
    fast_subset(2, [(1047.2, True), (1047.2, False), (300.0, False), (300.0, True)]),
)
def test_flights_stay_within_the_limits_of_the_motor(solo12, speed_max, tracked):
    """The paper's drop needs the full power of the EC 45, and more where its speed is limited."""
    drive = replace(EC45, speed_max=speed_max)
    device = driven_device(drive=drive)
    drop = paper_maneuvers(solo12)[1]
    builder = WorldBuilder(solo12, device)
    references = {drop.name: planned(builder, drop)} if tracked else {}
    run, _ = run_scenarios(Flights(solo12, device, [drop], references=references))
    flight = run.series.contact == 0
    speed, torque = run.series.wheel_speed[flight], run.series.wheel_torque[flight]
    slope = 650.4 / 1.4566
    assert np.abs(torque).max() <= 1.0
    assert np.abs(speed + slope * torque).max() <= 650.4 * (1.0 + 1e-12)
    assert np.abs(speed[torque * speed > 0.0]).max() <= speed_max
    # With the motor off, the trunk's own motion still changes the relative speed: slightly up to
    # touchdown, and in a bounce by a hundredth of the change of the trunk's rate.
    before = int(np.argmax(run.series.contact != 0))
    assert np.abs(run.series.wheel_speed[:before]).max() <= speed_max * (1.0 + 2e-6)
    impact = np.abs(np.diff(run.series.rate[before - 1 :] @ device.axes, axis=0)).max()
    assert np.abs(speed).max() <= speed_max + 0.01 * impact
    lowest, highest = run.series.torque_lowest[flight], run.series.torque_highest[flight]
    assert np.all((lowest <= torque + 1e-12) & (torque <= highest + 1e-12))
    assert np.abs(torque).max() > 0.5, "the motor is hardly used"
