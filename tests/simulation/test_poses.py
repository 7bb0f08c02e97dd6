import mujoco
import numpy as np
import pytest
from wheels import paper_device, paper_maneuvers

from ocs_design.simulation.batch import pose_stride
from ocs_design.simulation.engine import poses_of, simulate
from ocs_design.simulation.scenario import Options, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world import WorldBuilder


@pytest.fixture(scope="module")
def worlds(solo12):
    builder = WorldBuilder(solo12, paper_device())
    _, drop, flip = paper_maneuvers(solo12)
    return [builder.flight(flip, Wheels.ABSENT), builder.flight(drop, Wheels.ACTIVE)]


@pytest.fixture(scope="module")
def recording(worlds):
    return simulate(worlds, pose_rate=60.0)


def test_mujoco_finds_the_recorded_centre_of_mass_in_each_pose(worlds, recording):
    for index, world in enumerate(worlds):
        poses, data = poses_of(recording, index, world), mujoco.MjData(world.model)
        found = []
        for qpos in poses.qpos:
            data.qpos[:] = qpos
            mujoco.mj_kinematics(world.model, data)
            mujoco.mj_comPos(world.model, data)
            found.append(data.subtree_com[1].copy())
        recorded = recording.com[: recording.lengths[index] : recording.pose_stride, index]
        np.testing.assert_allclose(found, recorded, atol=1e-9)


def test_poses_last_as_long_as_their_world(worlds, recording):
    for index, world in enumerate(worlds):
        time = poses_of(recording, index, world).time
        assert time[0] == 0.0
        assert 0.0 < world.duration - time[-1] <= 0.02
        np.testing.assert_allclose(np.diff(time), 0.015)


def test_the_recorded_attitude_is_that_of_the_trunks_body(worlds, recording):
    for index, world in enumerate(worlds):
        poses = poses_of(recording, index, world)
        kept = recording.attitude[: recording.lengths[index] : recording.pose_stride, index]
        trunk = poses.attitude[:, world.addresses.trunk - 1]
        np.testing.assert_allclose(np.abs(np.sum(trunk * kept, axis=1)), 1.0, atol=1e-9)


def test_wheels_turn_as_fast_as_recorded(worlds, recording):
    poses = poses_of(recording, 1, worlds[1])
    mean = np.diff(poses.wheel_angle, axis=0) / np.diff(poses.time)[:, None]
    speed = recording.wheel_speed[: recording.lengths[1] : recording.pose_stride, 1]
    between = (speed[:-1] + speed[1:]) / 2.0
    np.testing.assert_allclose(mean, between, atol=0.05 * np.abs(speed).max())


def test_nothing_is_recorded_unless_asked_for(worlds):
    recording = simulate(worlds[1:])
    assert recording.qpos.size == 0
    assert poses_of(recording, 0, worlds[1]) is None


def test_a_pose_is_never_wanted_between_two_control_steps():
    assert pose_stride(60.0, 0.005) == 3
    assert pose_stride(1e6, 0.005) == 1


def test_runs_carry_their_poses(solo12):
    maneuver = paper_maneuvers(solo12)[1]
    runs = run_scenarios(solo12, paper_device(), [maneuver], options=Options(pose_rate=30.0))
    assert [len(run.poses.qpos) for run in runs] == [len(run.poses.time) for run in runs]
