"""Maneuvers that track a trajectory with its feed-forward torque, within the motor's limits."""

from dataclasses import replace

import numpy as np
import pytest
from trajectories import from_rest
from wheels import EC45, driven_device, geared, paper_maneuvers

from ocs_design.requirement.maneuver import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation import quaternions
from ocs_design.simulation.engine import simulate
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import Quintic, track
from ocs_design.simulation.scenario import run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.target import Target
from ocs_design.simulation.wheel_law import Allocation, Gains, WheelLaw, tilt_error
from ocs_design.simulation.world import WorldBuilder

BODY = robot_by_hand(2.5, (0.030, 0.0535, 0.068, 0.001, 0.003, -0.002))
DROP = Drop(name="drop", height=3.5, pitch=np.radians(20.0), roll=np.radians(5.0))
DRIVES = {"direct": EC45, "reducing": geared(1.2), "speeding up": geared(0.5, inertia=0.0)}


def planned(builder, maneuver):
    """The quintic turn of a maneuver with its exact feed-forward torque."""
    world = builder.flight(maneuver, Wheels.ACTIVE)
    return from_rest(world.body, replace(world.turn, profile=Quintic()))


def in_flight(builder, maneuver, trajectory):
    world = builder.flight(maneuver, Wheels.ACTIVE, trajectory)
    return replace(world, duration=world.flight_time)


def tracking_error(world):
    """Largest tilt off the trajectory [rad]."""
    recording, trajectory = simulate([world]), world.trajectory
    vertical = quaternions.vertical(recording.attitude[:, 0])
    wanted = [np.interp(recording.time, trajectory.time, c) for c in trajectory.vertical.T]
    return np.abs(tilt_error(vertical, np.column_stack(wanted))).max()


@pytest.mark.parametrize("name", DRIVES)
def test_feed_forward_follows_where_feedback_alone_lags_behind(name):
    builder = WorldBuilder(BODY, driven_device(drive=DRIVES[name]))
    trajectory = planned(builder, DROP)
    without = replace(trajectory, wheel_torque=np.zeros_like(trajectory.wheel_torque))
    error = tracking_error(in_flight(builder, DROP, trajectory))
    assert error < np.radians(0.1)
    assert tracking_error(in_flight(builder, DROP, without)) > 30.0 * error


def test_on_the_trajectory_the_law_adds_nothing():
    """Feedback is what is added: in the planned state the motors give the planned torque."""
    builder = WorldBuilder(BODY, driven_device())
    trajectory = planned(builder, DROP)
    law = WheelLaw.of(
        builder.flight(DROP, Wheels.ACTIVE).body,
        Gains(60.0, 12.0),
        MotorLimits(np.inf, 0.0, np.inf),
        Allocation.PSEUDO_INVERSE,
    )
    # Momentum that it did not start with makes the gyroscopic torque worth looking at.
    trajectory = replace(trajectory, wheel_speed=trajectory.wheel_speed + np.array([80.0, -50.0]))
    times, period = trajectory.time[:-1], trajectory.time[1]
    found = track(trajectory, law, times, period)
    flies = np.zeros(len(times), dtype=bool)
    target = Target(
        found.vertical, found.rate, np.zeros_like(found.rate), found.torque, stands=flies
    )
    state = trajectory.vertical[:-1], trajectory.rate[:-1], trajectory.wheel_speed[:-1]
    given = WheelLaw.joined([law] * len(times)).torque(*state, target, period)
    between = 0.5 * (trajectory.wheel_torque[1:] + trajectory.wheel_torque[:-1])
    np.testing.assert_allclose(given, between, rtol=0, atol=1e-12)


@pytest.mark.parametrize("period", [1e-3, 5e-3, 0.0371])
def test_held_torques_have_the_planned_impulse(period):
    """Whatever the control step, also where samples and steps do not meet; to the last of them."""
    builder = WorldBuilder(BODY, driven_device())
    trajectory = planned(builder, DROP)
    coarse = slice(None, None, 13)
    thin = {
        name: getattr(trajectory, name)[coarse]
        for name in ("time", "vertical", "rate", "acceleration", "wheel_speed", "wheel_torque")
    }
    few = replace(trajectory, **thin)
    law = builder.flight(DROP, Wheels.ACTIVE).law
    times = np.arange(0.0, 1.2, period)
    still = replace(few, rate=np.zeros_like(few.rate))
    held = track(still, law, times, period).torque
    until = np.cumsum(held, axis=0) * period
    ends = times + period
    exact = [
        [np.trapezoid(*_until(few.time, column, end)) for column in few.wheel_torque.T]
        for end in ends
    ]
    np.testing.assert_allclose(until, exact, rtol=0, atol=1e-12)


def _until(time, values, end):
    """Samples up to `end` and the value there."""
    before = time < end
    last = min(end, time[-1])
    return (
        np.append(values[before], np.interp(last, time, values)),
        np.append(time[before], last),
    )


def test_after_its_end_the_trunk_is_held_level():
    builder = WorldBuilder(BODY, driven_device())
    trajectory = planned(builder, DROP)
    law = builder.flight(DROP, Wheels.ACTIVE).law
    late = track(trajectory, law, trajectory.time[-1] + np.array([0.0, 0.3]), 5e-3)
    np.testing.assert_array_equal(late.vertical, [[0.0, 0.0, 1.0]] * 2)
    np.testing.assert_array_equal(late.rate, 0.0)
    np.testing.assert_array_equal(late.torque, 0.0)


def test_each_maneuver_tracks_its_own_reference_and_a_push_none(solo12):
    device = driven_device(carrier=replace(driven_device().carrier, mass=0.05))
    jump, drop, flip = paper_maneuvers(solo12)
    drop = replace(drop, pitch=np.radians(15.0))
    builder = WorldBuilder(solo12, device)
    references = {maneuver.name: planned(builder, maneuver) for maneuver in (jump, drop)}
    runs = run_scenarios(solo12, device, [jump, drop, flip], references=references)
    notes = {run.scenario: run.note for run in runs if run.ocs}
    assert notes["drop"] == "by hand"
    assert "by hand" not in (notes["disturbance"], notes["back-flip"])
    assert {run.note for run in runs if not run.ocs} == {""}
    alone = run_scenarios(solo12, device, [jump])[0]
    np.testing.assert_array_equal(alone.series.wheel_torque, runs[0].series.wheel_torque)


def test_worlds_with_and_without_trajectory_do_not_feel_each_other():
    builder = WorldBuilder(BODY, driven_device())
    tracked = in_flight(builder, DROP, planned(builder, DROP))
    free = replace(tracked, trajectory=None)
    together = simulate([free, tracked, free])
    for index, world in enumerate([free, tracked, free]):
        alone = simulate([world])
        np.testing.assert_array_equal(together.rate[:, index], alone.rate[:, 0])


@pytest.mark.parametrize("speed_max", [1047.2, 300.0])
@pytest.mark.parametrize("tracked", [True, False])
def test_a_real_motor_never_does_what_it_cannot(solo12, speed_max, tracked):
    """The paper's drop, which takes all that the EC 45 has, and more with a slower wheel."""
    drive = replace(EC45, speed_max=speed_max)
    device = driven_device(drive=drive)
    drop = paper_maneuvers(solo12)[1]
    builder = WorldBuilder(solo12, device)
    references = {drop.name: planned(builder, drop)} if tracked else {}
    run, _ = run_scenarios(solo12, device, [drop], references=references)
    flight = run.series.contact == 0
    speed, torque = run.series.wheel_speed[flight], run.series.wheel_torque[flight]
    slope = 650.4 / 1.4566
    assert np.abs(torque).max() <= 1.0
    assert np.abs(speed + slope * torque).max() <= 650.4 * (1.0 + 1e-12)
    assert np.abs(speed[torque * speed > 0.0]).max() <= speed_max
    # With the motor off, the trunk's own motion still changes what is measured against it: a little
    # up to touchdown, and in a bounce by a hundredth of what the floor turns the trunk by.
    before = int(np.argmax(run.series.contact != 0))
    assert np.abs(run.series.wheel_speed[:before]).max() <= speed_max * (1.0 + 2e-6)
    struck = np.abs(np.diff(run.series.rate[before - 1 :] @ device.axes, axis=0)).max()
    assert np.abs(speed).max() <= speed_max + 0.01 * struck
    lowest, highest = run.series.torque_lowest[flight], run.series.torque_highest[flight]
    assert np.all((lowest <= torque + 1e-12) & (torque <= highest + 1e-12))
    assert np.abs(torque).max() > 0.5, "it was not asked for much"
