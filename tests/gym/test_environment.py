"""The environment gives the flights of the campaign and conforms to Gymnasium."""

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


def episode(env, policy, **options):
    """Rewards, observations and final information of an episode."""
    readings, info = env.reset(seed=1, options=options)
    rewards, observations, terminated = [], [readings], False
    while not terminated:
        readings, reward, terminated, truncated, info = env.step(policy(readings, info))
        rewards.append(reward)
        observations.append(readings)
        assert not truncated
    return np.array(rewards), np.array(observations), info


def by_law(_observation, info):
    return info["law"]


def test_it_conforms_to_gymnasium(folder):
    env = gymnasium.make(f"ocs_design.gym:{ENVIRONMENT}", design=str(folder), maneuver="drop")
    check_env(env.unwrapped, skip_render_check=True)


@pytest.fixture(scope="module")
def outcomes(flight):
    """One sample in every maneuver."""
    return fly_samples(flight._campaign, [5])


@pytest.mark.parametrize("maneuver", ["drop", "disturbance", "back-flip"])
def test_with_the_control_law_an_episode_is_the_flight_of_its_sample(flight, outcomes, maneuver):
    number = [other.maneuver.name for other in flight._campaign.flights].index(maneuver)
    _, _, info = episode(flight, by_law, maneuver=maneuver, sample=5)
    assert info["passed"] is bool(outcomes.passed[0, number])
    expected = metrics_of(outcomes, 0, number)
    metrics = flight.metrics
    for name in ("touchdown_roll", "touchdown_pitch", "turned_angle", "peak_wheel_speed"):
        assert getattr(metrics, name) == pytest.approx(getattr(expected, name), abs=1e-6)
    assert metrics.touchdown_time == expected.touchdown_time


@pytest.mark.exhaustive
def test_three_wheels_fly_as_in_the_campaign(tmp_path):
    (tmp_path / "design.json").write_bytes(to_json(design(layout="triad")))
    env = OcsFlight(tmp_path, maneuver="drop")
    assert env.action_space.shape == (3,)
    assert env.observation_space.shape == (14,)
    _, _, info = episode(env, by_law, sample=5)
    number = [flight.maneuver.name for flight in env._campaign.flights].index("drop")
    expected = fly_samples(env._campaign, [5])
    assert info["passed"] is bool(expected.passed[0, number])
    for name in ("touchdown_roll", "touchdown_pitch"):
        value = getattr(env.metrics, name)
        assert value == pytest.approx(expected.metric(name)[0, number], abs=1e-6)


def test_the_seed_determines_the_sampled_robot(flight):
    def first(seed):
        return flight.reset(seed=seed)[1]["sample"]

    assert first(1) == first(1) != first(2)
    one, other = (episode(flight, by_law, maneuver="drop", sample=k)[1] for k in (1, 2))
    np.testing.assert_array_equal(one, episode(flight, by_law, maneuver="drop", sample=1)[1])
    assert np.abs(one[-1] - other[-1]).max() > 1e-3


def test_idle_wheels_do_not_level_a_tilted_fall_and_the_law_does(flight):
    levelled, _, law_info = episode(flight, by_law, maneuver="drop", sample=0)
    idle, readings, idle_info = episode(flight, lambda *_: np.zeros(2), maneuver="drop", sample=0)
    assert (law_info["passed"], idle_info["passed"]) == (True, False)
    # 30 of 180 deg, 1 for passing and 1 for landing level.
    assert levelled.sum() == pytest.approx(2.0 + 30.0 / 180.0, abs=0.02)
    assert abs(idle.sum()) < 0.02
    assert readings[0, -2] == 1.0
    assert list(np.unique(readings[:, -1])) == [0.0, 1.0]


def test_full_action_is_the_available_torque(flight):
    flight.reset(options={"maneuver": "drop", "sample": 0})
    motor = flight._flights.device.motor.without_friction
    for _ in range(40):
        readings = flight._pilot.readings
        limit = readings.highest
        assert (limit <= motor.torque_limit * (1.0 + 1e-12)).all()
        flight.step(np.ones(2))
    speeds = flight._pilot.readings.wheel_speed
    assert (speeds > 0.0).all()
    assert (speeds <= flight._top_speed).all()


def test_unknown_maneuvers_and_missing_motors_are_errors(flight, folder, tmp_path):
    with pytest.raises(UsageError, match="somersault"):
        OcsFlight(folder, maneuver="somersault")
    with pytest.raises(UsageError, match="somersault"):
        flight.reset(options={"maneuver": "somersault"})
    (tmp_path / "design.json").write_bytes(to_json(design("none")))
    assert design("none").ocs.motor.name != MOTOR
    with pytest.raises(OcsError, match="no motor"):
        OcsFlight(tmp_path)


def test_an_unknown_option_is_an_error(flight):
    """It was ignored, and any maneuver flown in place of the one that was meant."""
    with pytest.raises(UsageError, match="no option 'manuever'"):
        flight.reset(options={"manuever": "drop"})


@pytest.mark.parametrize("action", [[0.0], [0.0, np.nan]])
def test_invalid_actions_are_errors(flight, action):
    flight.reset(seed=0)
    with pytest.raises(UsageError, match="an action must fit"):
        flight.step(action)


def test_a_sample_may_be_a_numpy_integer(flight):
    assert flight.reset(options={"sample": np.int64(3)})[1]["sample"] == 3


@pytest.mark.parametrize("sample", [-1, 0.5, "1"])
def test_invalid_samples_are_errors(flight, sample):
    with pytest.raises(UsageError, match="whole number"):
        flight.reset(options={"sample": sample})


def test_without_gymnasium_the_hint_is_the_command_that_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "gymnasium.envs.registration", None)
    with pytest.raises(MissingToolError, match="needs gymnasium, which is not installed") as caught:
        importlib.reload(ocs_design.gym)
    assert "[gym]" in caught.value.hint


def test_rendered_pictures_show_the_robot(folder):
    env = OcsFlight(folder, maneuver="drop", render_mode="rgb_array_list")
    env.reset(seed=0)
    env.step(np.zeros(2))
    try:
        pictures = env.render()
    except MissingToolError as error:
        pytest.skip(str(error))
    assert [picture.shape for picture in pictures] == [(440, 480, 3)] * 2
    assert pictures[0].std() > 5.0
