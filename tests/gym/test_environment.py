"""The environment flies what the campaign flies, and keeps Gymnasium's promises."""

import importlib
import sys

import gymnasium
import numpy as np
import pytest
from designed_devices import MOTOR
from gymnasium.utils.env_checker import check_env
from stories import design

import ocs_design.gym
from ocs_design import OcsError
from ocs_design.common.errors import MissingToolError, UsageError
from ocs_design.common.files import to_json
from ocs_design.gym import ENVIRONMENT
from ocs_design.gym.environment import OcsFlight
from ocs_design.monte_carlo.campaign import fly_samples, metrics_of

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("designed")
    (folder / "design.json").write_bytes(to_json(design()))
    return folder


@pytest.fixture(scope="module")
def flight(folder):
    return OcsFlight(folder)


def flown(env, choose, **options):
    """Rewards of an episode, what was seen, and the verdict."""
    readings, told = env.reset(seed=1, options=options)
    rewards, observed, ended = [], [readings], False
    while not ended:
        readings, reward, ended, truncated, told = env.step(choose(readings, told))
        rewards.append(reward)
        observed.append(readings)
        assert not truncated
    return np.array(rewards), np.array(observed), told


def by_law(_seen, told):
    return told["law"]


def test_it_keeps_the_promises_of_gymnasium(folder):
    env = gymnasium.make(f"ocs_design.gym:{ENVIRONMENT}", design=str(folder), maneuver="drop")
    check_env(env.unwrapped, skip_render_check=True)


@pytest.fixture(scope="module")
def outcomes(flight):
    """One sample, flown in every maneuver."""
    return fly_samples(flight._campaign, [5])


@pytest.mark.parametrize("maneuver", ["drop", "disturbance", "back-flip"])
def test_under_the_law_an_episode_is_the_flight_of_that_sample(flight, outcomes, maneuver):
    number = [each.maneuver.name for each in flight._campaign.flights].index(maneuver)
    _, _, told = flown(flight, by_law, maneuver=maneuver, sample=5)
    assert told["passed"] is bool(outcomes.passed[0, number])
    expected = metrics_of(outcomes, 0, number)
    found = flight.metrics
    for name in ("touchdown_roll", "touchdown_pitch", "turned_angle", "peak_wheel_speed"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), abs=1e-6)
    assert found.touchdown_time == expected.touchdown_time


def test_three_wheels_fly_as_in_the_campaign(tmp_path):
    (tmp_path / "design.json").write_bytes(to_json(design(layout="triad")))
    env = OcsFlight(tmp_path, maneuver="drop")
    assert env.action_space.shape == (3,)
    assert env.observation_space.shape == (14,)
    _, _, told = flown(env, by_law, sample=5)
    number = [each.maneuver.name for each in env._campaign.flights].index("drop")
    expected = fly_samples(env._campaign, [5])
    assert told["passed"] is bool(expected.passed[0, number])
    for name in ("touchdown_roll", "touchdown_pitch"):
        found = getattr(env.metrics, name)
        assert found == pytest.approx(expected.metric(name)[0, number], abs=1e-6)


def test_a_seed_draws_the_same_robot_and_another_one_another(flight):
    def first(seed):
        return flight.reset(seed=seed)[1]["sample"]

    assert first(1) == first(1) != first(2)
    one, other = (flown(flight, by_law, maneuver="drop", sample=k)[1] for k in (1, 2))
    np.testing.assert_array_equal(one, flown(flight, by_law, maneuver="drop", sample=1)[1])
    assert np.abs(one[-1] - other[-1]).max() > 1e-3


def test_idle_wheels_do_not_level_a_tilted_fall_and_the_law_does(flight):
    levelled, _, good = flown(flight, by_law, maneuver="drop", sample=0)
    idle, readings, bad = flown(flight, lambda *_: np.zeros(2), maneuver="drop", sample=0)
    assert (good["passed"], bad["passed"]) == (True, False)
    # 30 deg is a sixth of half a turn, and one for passing and one for coming down level.
    assert levelled.sum() == pytest.approx(2.0 + 30.0 / 180.0, abs=0.02)
    assert abs(idle.sum()) < 0.02
    assert readings[0, -2] == 1.0
    assert list(np.unique(readings[:, -1])) == [0.0, 1.0]


def test_full_action_is_what_the_motor_can_give(flight):
    flight.reset(options={"maneuver": "drop", "sample": 0})
    motor = flight._flights.device.motor.at_the_air_gap
    for _ in range(40):
        readings = flight._pilot.readings
        limit = readings.highest
        assert (limit <= motor.torque_limit * (1.0 + 1e-12)).all()
        flight.step(np.ones(2))
    speeds = flight._pilot.readings.wheel_speed
    assert (speeds > 0.0).all()
    assert (speeds <= flight._top_speed).all()


def test_what_cannot_be_flown_is_told(flight, folder, tmp_path):
    with pytest.raises(UsageError, match="somersault"):
        OcsFlight(folder, maneuver="somersault")
    with pytest.raises(UsageError, match="somersault"):
        flight.reset(options={"maneuver": "somersault"})
    (tmp_path / "design.json").write_bytes(to_json(design("none")))
    assert design("none").ocs.motor.name != MOTOR
    with pytest.raises(OcsError, match="no motor"):
        OcsFlight(tmp_path)


@pytest.mark.parametrize("action", [[0.0], [0.0, np.nan]])
def test_an_action_that_is_none_is_told(flight, action):
    flight.reset(seed=0)
    with pytest.raises(UsageError, match="an action must fit"):
        flight.step(action)


def test_a_sample_may_be_a_number_of_numpy(flight):
    assert flight.reset(options={"sample": np.int64(3)})[1]["sample"] == 3


@pytest.mark.parametrize("sample", [-1, 0.5, "1"])
def test_a_sample_that_is_none_is_told(flight, sample):
    with pytest.raises(UsageError, match="whole number"):
        flight.reset(options={"sample": sample})


def test_without_gymnasium_the_cure_is_told(monkeypatch):
    monkeypatch.setitem(sys.modules, "gymnasium.envs.registration", None)
    with pytest.raises(MissingToolError, match="needs gymnasium, which is not installed") as caught:
        importlib.reload(ocs_design.gym)
    assert "[gym]" in caught.value.hint


def test_its_pictures_show_the_robot(folder):
    env = OcsFlight(folder, maneuver="drop", render_mode="rgb_array_list")
    env.reset(seed=0)
    env.step(np.zeros(2))
    try:
        pictures = env.render()
    except MissingToolError as error:
        pytest.skip(str(error))
    assert [picture.shape for picture in pictures] == [(440, 480, 3)] * 2
    assert pictures[0].std() > 5.0
