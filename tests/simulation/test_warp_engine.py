"""MuJoCo Warp against MuJoCo, on Warp's processor: the same kernels as on a GPU, without one."""

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
from ocs_design.simulation.warp_engine import SINGLE_GATE, WarpPhysics, room, warp_engine
from ocs_design.simulation.world import start_states
from ocs_design.simulation.world_builder import WorldBuilder

COUNT, STEPS = 6, 10
SPREAD = UncertaintySection(
    mass_error=Normal(0.0, 0.1), com_error=Normal(0.0, 0.01), inertia_error=Normal(0.0, 0.1)
)
"""So wide that a world with the parameters of another one is far off."""


@pytest.fixture(scope="module")
def engine():
    pytest.importorskip("mujoco_warp", reason="the gpu extra is not installed")
    return warp_engine("cpu")


@pytest.fixture(scope="module")
def campaign(solo12):
    return short_campaign(solo12, SPREAD)


@pytest.fixture(scope="module")
def flying(campaign):
    """Robots that are let fall, as they were built, and what is done to each in each step."""
    worlds = [campaign.built(campaign.sample(index), 1) for index in range(COUNT)]
    model, random = worlds[0].model, np.random.default_rng(3)
    commands = np.stack([world.ctrl for world in worlds])[:, None].repeat(STEPS, 1)
    commands += random.normal(0.0, 0.1, commands.shape)
    wrenches = np.zeros((COUNT, STEPS, model.nbody, 6))
    wrenches[:, :, 1:] = random.normal(0.0, 0.3, (COUNT, STEPS, model.nbody - 1, 6))
    control = np.concatenate([commands, wrenches.reshape(COUNT, STEPS, -1)], axis=2)
    return [world.model for world in worlds], start_states(worlds), control


def stepped(physics, models, start, control):
    """States after each step and sensors before, by some physics."""
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


def off(found, expected):
    """Largest difference, in units of the largest value of each column."""
    scale = np.maximum(np.abs(expected).max(axis=(0, 1)), 1e-3)
    return (np.abs(found - expected) / scale).max()


TOLERANCE = 1e-5
"""Forty stages round by 2^-24 each, 2.4e-6 together; the sums in each make it a few times that."""


@pytest.mark.slow
@pytest.mark.parametrize("pushed", [True, False])
def test_every_world_has_its_own_parameters_commands_and_pushes(engine, flying, pushed):
    models, start, control = flying
    control = control if pushed else np.ascontiguousarray(control[..., : models[0].nu])
    with Rollout(nthread=0) as pool, engine.physics() as physics:
        states, sensors = stepped(pool, models, start, control)
        found = stepped(physics, models, start, control)
        assert off(found[0], states) < TOLERANCE
        assert off(found[1], sensors) < TOLERANCE
        # Fewer worlds, later: those that are left go on from where they are put.
        some = stepped(physics, models[:2], states[:2, -1], control[:2])
        assert off(some[0], stepped(pool, models[:2], states[:2, -1], control[:2])[0]) < TOLERANCE
        # All of this shows: with what another world has, each is off by a hundred times as much.
        for other in (
            stepped(pool, models[:1] * COUNT, start, control),
            stepped(pool, models, start, np.roll(control, 1, axis=0)),
            stepped(pool, models, start, np.roll(control, 1, axis=1)),
        ):
            assert off(other[0], states) > 100 * TOLERANCE


@pytest.mark.slow
def test_a_sample_ends_as_with_mujoco(engine, campaign):
    """Cut off at different times, after the landing of those that fall."""
    jump, drop = campaign.flights
    drop = replace(drop, world=replace(drop.world, duration=0.7))
    campaign = replace(campaign, flights=(jump, drop))
    expected = fly_samples(campaign, range(3))
    single = replace(campaign, engine=engine)
    found = fly_samples(single, range(3))
    np.testing.assert_array_equal(found.codes, expected.codes)
    for name in ("touchdown_pitch", "touchdown_roll", "turned_angle"):
        np.testing.assert_allclose(found.metric(name), expected.metric(name), atol=1e-5)
    assert found.metric("momentum_error").max() < SINGLE_GATE
    # Nobody's numbers depend on who flies along.
    alone = fly_samples(single, [2])
    np.testing.assert_array_equal(alone.metrics[0], found.metrics[2])


@pytest.mark.slow
def test_what_it_cannot_have_for_each_world_is_refused(engine, flying):
    models, start, control = flying
    other = copy(models[1])
    other.actuator_ctrllimited[:] = 1 - other.actuator_ctrllimited
    with engine.physics() as physics, pytest.raises(OcsError, match="actuator_ctrllimited"):
        stepped(physics, [models[0], other, *models[2:]], start, control)


def test_a_pivot_which_weighs_ten_million_robots_is_refused():
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


def test_there_is_room_for_all_contacts_that_can_be(campaign):
    """Lying on the floor with everything at once: no robot touches more of it."""
    model = campaign.flights[0].world.model
    data = mujoco.MjData(model)
    model.geom_margin[:] = 10.0
    mujoco.mj_forward(model, data)
    contacts, rows = room(model)
    assert contacts / 4 <= data.ncon <= contacts
    assert data.nefc <= rows


def test_a_momentum_gate_of_its_own_judges_it(campaign):
    """That of double precision stays what it is for all others."""
    expected = fly_samples(campaign, [0], threads=1)
    metrics = replace(metrics_of(expected, 0, 1), momentum_error=0.5 * SINGLE_GATE)
    assert campaign.judged(metrics, 1).fault is Fault.UNSOUND
    single = replace(campaign, engine=SimpleNamespace(gate=SINGLE_GATE))
    assert single.judged(metrics, 1).fault is not Fault.UNSOUND
    worse = replace(metrics, momentum_error=2.0 * SINGLE_GATE)
    assert single.judged(worse, 1).fault is Fault.UNSOUND


def test_without_the_package_the_command_that_installs_it_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "warp", None)
    with pytest.raises(MissingToolError, match="not installed") as error:
        warp_engine()
    assert "ocs-design[gpu]" in error.value.hint


def test_without_a_gpu_it_says_so(monkeypatch):
    warp = SimpleNamespace(
        config=SimpleNamespace(), LOG_WARNING=30, is_cuda_available=lambda: False
    )
    monkeypatch.setitem(sys.modules, "warp", warp)
    monkeypatch.setitem(sys.modules, "mujoco_warp", SimpleNamespace())
    with pytest.raises(MissingToolError, match="needs a CUDA device; none was found") as error:
        warp_engine()
    assert error.value.hint == "leave --engine out"
