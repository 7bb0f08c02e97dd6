"""A batch of worlds, each simulated as if it were alone, and its recorded poses."""

import time
from dataclasses import fields, replace

import mujoco
import numpy as np
import pytest
from trajectories import from_rest
from wheels import paper_device, paper_maneuvers

from ocs_design.requirement.boundary import Push
from ocs_design.simulation.batch import Recording
from ocs_design.simulation.scenario import Flights, Options, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import poses_of, simulate


@pytest.fixture(scope="module")
def worlds(solo12, builder):
    jump, drop, flip = paper_maneuvers(solo12)
    flights = [
        builder.flight(drop, Wheels.ACTIVE),
        builder.flight(jump, Wheels.ABSENT),
        builder.flight(flip, Wheels.ACTIVE),
        builder.flight(drop, Wheels.BRAKED, level=True),
        builder.flight(jump, Wheels.ACTIVE),
    ]
    turn = replace(flights[0].turn, at_once=False)
    plan = from_rest(flights[0].body, turn, samples=401)
    flights.append(builder.flight(drop, Wheels.ACTIVE, plan))
    durations = (0.5, 0.62, 0.31, 0.45, 0.62, 0.48)
    return [replace(world, duration=t) for world, t in zip(flights, durations, strict=True)]


def assert_same(one: Recording, other: Recording):
    for field in fields(Recording):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))


@pytest.fixture(scope="module")
def together(worlds):
    return simulate(worlds)


@pytest.mark.parametrize("threads", [1, 4])
def test_results_do_not_depend_on_the_number_of_threads(worlds, together, threads):
    assert_same(together, simulate(worlds, threads=threads))


def test_a_world_does_not_depend_on_the_others(worlds, together):
    for index, world in enumerate(worlds):
        alone = simulate([world])
        steps = alone.lengths[0]
        assert together.lengths[index] == steps
        np.testing.assert_array_equal(together.com[:steps, index], alone.com[:, 0])
        np.testing.assert_array_equal(
            together.wheel_torque[:steps, index], alone.wheel_torque[:, 0]
        )
        assert np.isnan(together.com[steps:, index]).all()


def test_centre_of_mass_falls_freely(worlds, together):
    flying = together.time < 0.3
    t = together.time[flying]
    for index, world in enumerate(worlds[:2]):
        com = together.com[flying, index]
        expected = com[0] + np.outer(t, world.qvel[:3]) - np.outer(4.905 * t**2, [0.0, 0.0, 1.0])
        np.testing.assert_allclose(com, expected, atol=1e-9)


def test_the_control_period_changes_little(worlds):
    fine, coarse = simulate(worlds[:1], hold=1), simulate(worlds[:1], hold=5)
    np.testing.assert_allclose(coarse.time, fine.time[::5], atol=1e-12)
    before = coarse.time < 0.35
    tilt = [run.attitude[::step, 0, 2][: before.sum()] for run, step in ((fine, 5), (coarse, 1))]
    np.testing.assert_allclose(tilt[0], tilt[1], atol=np.radians(0.2))


def test_an_interrupt_stops_all_batches(worlds):
    """Ten minutes of flight would take much longer than the test allows."""

    def interrupt(_done: float) -> None:
        raise KeyboardInterrupt

    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        simulate([replace(world, duration=600.0) for world in worlds[:2]], progress=interrupt)
    assert time.perf_counter() - start < 10.0


@pytest.mark.parametrize("period", [1e-3, 5e-3, 7e-3])
def test_a_push_keeps_its_impulse_at_any_control_rate(period):
    push = Push(np.ones(3), onset=0.1003, duration=0.0504)
    starts = np.arange(0.0, 0.3, period)
    assert push.share(starts, period).sum() * period == pytest.approx(0.0504)


@pytest.fixture(scope="module")
def filmed(solo12, builder):
    _, drop, flip = paper_maneuvers(solo12)
    return [builder.flight(flip, Wheels.ABSENT), builder.flight(drop, Wheels.ACTIVE)]


@pytest.fixture(scope="module")
def recording(filmed):
    return simulate(filmed, pose_rate=60.0)


def test_poses_have_the_recorded_centre_of_mass_in_mujoco(filmed, recording):
    for index, world in enumerate(filmed):
        poses, data = poses_of(recording, index, world), mujoco.MjData(world.model)
        centres = []
        for qpos in poses.qpos:
            data.qpos[:] = qpos
            mujoco.mj_kinematics(world.model, data)
            mujoco.mj_comPos(world.model, data)
            centres.append(data.subtree_com[1].copy())
        recorded = recording.com[: recording.lengths[index] : recording.pose_stride, index]
        np.testing.assert_allclose(centres, recorded, atol=1e-9)


def test_poses_last_as_long_as_their_world(filmed, recording):
    for index, world in enumerate(filmed):
        time = poses_of(recording, index, world).time
        assert time[0] == 0.0
        assert 0.0 < world.duration - time[-1] <= 0.02
        np.testing.assert_allclose(np.diff(time), 0.015)


def test_the_recorded_attitude_is_that_of_the_trunks_body(filmed, recording):
    for index, world in enumerate(filmed):
        poses = poses_of(recording, index, world)
        kept = recording.attitude[: recording.lengths[index] : recording.pose_stride, index]
        trunk = poses.attitude[:, world.addresses.trunk - 1]
        np.testing.assert_allclose(np.abs(np.sum(trunk * kept, axis=1)), 1.0, atol=1e-9)


def test_wheel_angles_agree_with_the_recorded_speeds(filmed, recording):
    poses = poses_of(recording, 1, filmed[1])
    mean = np.diff(poses.wheel_angle, axis=0) / np.diff(poses.time)[:, None]
    speed = recording.wheel_speed[: recording.lengths[1] : recording.pose_stride, 1]
    expected = (speed[:-1] + speed[1:]) / 2.0
    np.testing.assert_allclose(mean, expected, atol=0.05 * np.abs(speed).max())


def test_no_poses_are_recorded_unless_asked_for(worlds, together):
    assert together.qpos.size == 0
    assert poses_of(together, 0, worlds[0]) is None


def test_poses_of_runs_are_at_control_steps(solo12):
    """Also where more poses per second are requested."""
    flights = Flights(
        solo12, paper_device(), paper_maneuvers(solo12)[1:2], options=Options(pose_rate=1e6)
    )
    for run in run_scenarios(flights):
        np.testing.assert_array_equal(run.poses.time, run.series.time)
        assert len(run.poses.qpos) == len(run.poses.time)
