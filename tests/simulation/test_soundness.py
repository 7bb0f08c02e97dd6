"""Faults that make a simulation unreliable, planted one by one."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from wheels import paper_device

from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.turns import Drop
from ocs_design.simulation.metrics import breakdown, drive_growth, measure, objection
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.verdict import judge
from ocs_design.simulation.wheel_law import WheelLaw


@pytest.fixture(scope="module")
def drop(solo12):
    return default_maneuvers(solo12)[1]


@pytest.fixture
def world(builder, drop):
    """A new world for each test, because tests modify its model."""
    return builder.flight(drop, Wheels.ABSENT)


def with_stiff_drives(world, factor: float):
    world.model.actuator_gainprm[:, 0] *= factor
    world.model.actuator_biasprm[:, 1:3] *= factor
    return world


def test_an_unmodified_world_is_sound(world):
    assert objection(world) == ""
    assert breakdown(simulate([replace(world, duration=0.02)]), 0) == ""


def test_a_drop_from_inside_the_floor_is_not_judged(solo12):
    """Tilted by 60 degrees at 0.3 m, the hind feet are under the floor."""
    low = Drop(name="low", height=0.3, pitch=np.radians(60.0))
    runs = run_scenarios(Flights(solo12, paper_device(), [low]))
    assert [run.passed for run in runs] == [None, None]
    for run in runs:
        assert "mm into the floor; release it that much higher" in run.reason


def test_drives_too_stiff_for_the_step_are_found_before_the_simulation(world):
    assert "drives are unstable at a time step of 1 ms" in objection(with_stiff_drives(world, 5.0))


@pytest.mark.parametrize("factor", [4.0, 5.0, 6.0])
def test_growth_is_that_of_small_motions_in_mujoco(world, factor):
    """In free flight: power iteration by MuJoCo's steps, from small random rates."""
    model, data = with_stiff_drives(world, factor).model, mujoco.MjData(world.model)
    data.qpos[:], data.ctrl[:] = world.qpos, world.ctrl
    model.opt.gravity[:] = 0.0
    mujoco.mj_forward(model, data)
    predicted = 1.0 + max(drive_growth(model, data), 0.0)
    data.qvel[6:] = 1e-9 * np.random.default_rng(0).standard_normal(model.nv - 6)
    sizes = []
    for _ in range(12):
        mujoco.mj_step(model, data)
        sizes.append(np.linalg.norm(data.qvel))
    if predicted == 1.0:
        assert sizes[-1] < 3.0 * sizes[0]
        return
    assert sizes[-1] / sizes[-2] == pytest.approx(predicted, rel=0.15)


def test_wheels_too_fast_for_the_step_are_not_judged(builder, drop):
    """A hundred times as fast as designed, without control."""
    world = builder.flight(drop, Wheels.ACTIVE)
    world.qvel[list(world.addresses.wheels)] = 8e4
    world = replace(world, law=WheelLaw.off(2))
    metrics = measure(simulate([world]), 0, world)
    verdict = judge(metrics, drop, can_stand=True)
    assert verdict.passed is None
    assert "lower `wheel_speed_max` for heavier, slower wheels" in verdict.reason


def test_an_infinite_state_is_reported(world):
    world.qvel[0] = 1e12
    recording = simulate([replace(world, duration=0.02)])
    assert not recording.stable[0]
    assert "MuJoCo stopped at a speed that is huge or not a number" in breakdown(recording, 0)
    assert "run `ocs-design inspect` and look for links with next to" in breakdown(recording, 0)
    world.qvel[0] = np.nan
    assert "the start is not finite" in objection(world)


def test_an_infinite_state_is_found_at_every_control_rate(world):
    """With one step per control period MuJoCo resets the state each time and does not stop."""
    world.qvel[0] = np.inf
    assert not simulate([replace(world, duration=0.02)], hold=1).stable[0]
