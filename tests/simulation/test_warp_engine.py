"""MuJoCo Warp against MuJoCo, on Warp's CPU device, which runs the kernels of a GPU."""

import sys
from contextlib import nullcontext
from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from campaigns import short_campaign
from mujoco.rollout import Rollout
from wheels import driven_device

from ocs_design.common.errors import MissingToolError, OcsError
from ocs_design.monte_carlo.campaign import fly_samples, metrics_of
from ocs_design.requirement.pivoted import Balance
from ocs_design.requirement.uncertainty import Normal, UncertaintySection
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.verdict import Fault
from ocs_design.simulation.warp_engine import SINGLE_GATE, WarpPhysics, buffer_sizes, warp_engine
from ocs_design.simulation.world import start_states
from ocs_design.simulation.world_builder import WorldBuilder

COUNT, STEPS = 6, 10
SPREAD = UncertaintySection(
    mass_error=Normal(0.0, 0.1), com_error=Normal(0.0, 0.01), inertia_error=Normal(0.0, 0.1)
)
"""So wide that worlds with the parameters of other ones differ clearly."""


@pytest.fixture(scope="module")
def engine():
    pytest.importorskip("mujoco_warp", reason="the gpu extra is not installed")
    return warp_engine("cpu")


@pytest.fixture(scope="module")
def campaign(solo12):
    return short_campaign(solo12, SPREAD)


@pytest.fixture(scope="module")
def flying(campaign):
    """Models of falling robots, their start states, and controls and wrenches of each step."""
    worlds = [campaign.sampled_world(campaign.sample(index), 1) for index in range(COUNT)]
    model, random = worlds[0].model, np.random.default_rng(3)
    commands = np.stack([world.ctrl for world in worlds])[:, None].repeat(STEPS, 1)
    commands += random.normal(0.0, 0.1, commands.shape)
    wrenches = np.zeros((COUNT, STEPS, model.nbody, 6))
    wrenches[:, :, 1:] = random.normal(0.0, 0.3, (COUNT, STEPS, model.nbody - 1, 6))
    control = np.concatenate([commands, wrenches.reshape(COUNT, STEPS, -1)], axis=2)
    return [world.model for world in worlds], start_states(worlds), control


def stepped(physics, models, start, control):
    """States after each step and sensors before it, by some physics engine."""
    kind, pushed = mujoco.mjtState, control.shape[2] > models[0].nu
    bits = kind.mjSTATE_CTRL.value | (kind.mjSTATE_XFRC_APPLIED.value if pushed else 0)
    states = np.empty((len(models), STEPS, start.shape[1]))
    sensors = np.empty((len(models), STEPS, models[0].nsensordata))
    physics.rollout(
        models,
        [mujoco.MjData(models[0])],
        start,
        control,
        control_spec=bits,
        skip_checks=True,
        nstep=STEPS,
        state=states,
        sensordata=sensors,
    )
    return states, sensors


def difference(actual, expected):
    """Largest difference, relative to the largest value of each column."""
    scale = np.maximum(np.abs(expected).max(axis=(0, 1)), 1e-3)
    return (np.abs(actual - expected) / scale).max()


TOLERANCE = 1e-5
"""Forty stages with rounding errors of 2^-24 give 2.4e-6, and sums within them a few times that."""


@pytest.mark.slow
@pytest.mark.parametrize("pushed", [True, False])
def test_every_world_has_its_own_parameters_commands_and_pushes(engine, flying, pushed):
    models, start, control = flying
    control = control if pushed else np.ascontiguousarray(control[..., : models[0].nu])
    with Rollout(nthread=0) as pool, engine.physics() as physics:
        states, sensors = stepped(pool, models, start, control)
        single = stepped(physics, models, start, control)
        assert difference(single[0], states) < TOLERANCE
        assert difference(single[1], sensors) < TOLERANCE
        # Fewer worlds, later: the remaining ones continue from the given states.
        fewer = stepped(physics, models[:2], states[:2, -1], control[:2])
        expected = stepped(pool, models[:2], states[:2, -1], control[:2])
        assert difference(fewer[0], expected[0]) < TOLERANCE
        # With parameters or controls of another world the difference is a hundred times as large.
        for other in (
            stepped(pool, models[:1] * COUNT, start, control),
            stepped(pool, models, start, np.roll(control, 1, axis=0)),
            stepped(pool, models, start, np.roll(control, 1, axis=1)),
        ):
            assert difference(other[0], states) > 100 * TOLERANCE


@pytest.mark.slow
def test_a_sample_ends_as_with_mujoco(engine, campaign):
    """The worlds end at different times, each after its landing."""
    jump, drop = campaign.flights
    drop = replace(drop, world=replace(drop.world, duration=0.7))
    campaign = replace(campaign, flights=(jump, drop))
    expected = fly_samples(campaign, range(3))
    single = replace(campaign, engine=engine)
    actual = fly_samples(single, range(3))
    np.testing.assert_array_equal(actual.codes, expected.codes)
    for name in ("touchdown_pitch", "touchdown_roll", "turned_angle"):
        np.testing.assert_allclose(actual.metric(name), expected.metric(name), atol=1e-5)
    assert actual.metric("momentum_error").max() < SINGLE_GATE
    # The results do not depend on the other worlds.
    alone = fly_samples(single, [2])
    np.testing.assert_array_equal(alone.metrics[0], actual.metrics[2])


@pytest.mark.slow
def test_fields_that_cannot_differ_between_worlds_are_refused(engine, flying):
    models, start, control = flying
    other = copy(models[1])
    other.actuator_ctrllimited[:] = 1 - other.actuator_ctrllimited
    with engine.physics() as physics, pytest.raises(OcsError, match="actuator_ctrllimited"):
        stepped(physics, [models[0], other, *models[2:]], start, control)


def test_maneuvers_about_a_pivot_are_refused():
    builder = WorldBuilder(robot_by_hand(2.5, (0.02, 0.025, 0.02)), driven_device())
    tilted = Balance(name="tilted", pivot=(0.0, 0.0, -0.2), roll=0.03, duration=1.0)
    world = builder.flight(tilted, Wheels.ACTIVE)
    warp = SimpleNamespace(ScopedDevice=nullcontext)
    start, control = start_states([world]), np.zeros((1, STEPS, world.model.nu))
    with (
        WarpPhysics(warp, SimpleNamespace(), "cpu") as physics,
        pytest.raises(OcsError, match="about a pivot need double precision"),
    ):
        stepped(physics, [world.model], start, control)


def test_there_is_room_for_all_possible_contacts(campaign):
    """With a margin of 10 m every geom is in contact with the floor at once."""
    model = campaign.flights[0].world.model
    data = mujoco.MjData(model)
    model.geom_margin[:] = 10.0
    mujoco.mj_forward(model, data)
    contacts, rows = buffer_sizes(model)
    assert contacts / 4 <= data.ncon <= contacts
    assert data.nefc <= rows


def test_the_engine_has_its_own_momentum_tolerance(campaign):
    """The tolerance of double precision still applies to other engines."""
    expected = fly_samples(campaign, [0], threads=1)
    metrics = replace(metrics_of(expected, 0, 1), momentum_error=0.5 * SINGLE_GATE)
    assert campaign.judged(metrics, 1).fault is Fault.UNSOUND
    single = replace(campaign, engine=SimpleNamespace(gate=SINGLE_GATE))
    assert single.judged(metrics, 1).fault is not Fault.UNSOUND
    worse = replace(metrics, momentum_error=2.0 * SINGLE_GATE)
    assert single.judged(worse, 1).fault is Fault.UNSOUND


def test_without_the_package_the_hint_is_the_command_that_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "warp", None)
    with pytest.raises(MissingToolError, match="not installed") as error:
        warp_engine()
    assert "ocs-design[gpu]" in error.value.hint


def test_without_a_gpu_the_error_says_so(monkeypatch):
    warp = SimpleNamespace(
        config=SimpleNamespace(), LOG_WARNING=30, is_cuda_available=lambda: False
    )
    monkeypatch.setitem(sys.modules, "warp", warp)
    monkeypatch.setitem(sys.modules, "mujoco_warp", SimpleNamespace())
    with pytest.raises(MissingToolError, match="needs a CUDA device; none was found") as error:
        warp_engine()
    assert error.value.hint == "leave --engine out"
