"""Which flights are simulated, and how standing is judged."""

from dataclasses import replace

import numpy as np
import pytest
from robots import ROBOTS
from wheels import layout_device, paper_device, scaled_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.boundary import End
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.turns import Drop, TurnTo
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.simulation import scenario
from ocs_design.simulation.metrics import measure
from ocs_design.simulation.scenario import Flights, refusal, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.verdict import judge
from ocs_design.simulation.world_builder import WorldBuilder

GENTLE = Drop(name="gentle", height=0.4, pitch=np.radians(10.0))


@pytest.fixture
def batches(monkeypatch):
    """Number of worlds in each call of the engine."""
    sizes: list[int] = []
    simulate = scenario.simulate

    def counted(worlds, **options):
        sizes.append(len(worlds))
        return simulate(worlds, **options)

    monkeypatch.setattr(scenario, "simulate", counted)
    return sizes


def test_a_robot_that_stands_is_flown_twice(solo12, batches):
    runs = run_scenarios(Flights(solo12, paper_device(), [GENTLE]))
    assert "and stands" in runs[0].reason
    assert batches == [2]


@pytest.mark.slow
def test_a_robot_that_falls_is_flown_level_too(solo12, batches, monkeypatch):
    """Here the drives of the joints are off."""
    flight = WorldBuilder.flight

    def limp(self, *arguments, **options):
        world = flight(self, *arguments, **options)
        world.model.actuator_gainprm[:-2] = world.model.actuator_biasprm[:-2] = 0.0
        return world

    monkeypatch.setattr(WorldBuilder, "flight", limp)
    runs = run_scenarios(Flights(solo12, paper_device(), [GENTLE]))
    assert batches == [2, 1]
    assert "standing is not judged" in runs[0].reason


def test_a_robot_without_legs_is_not_flown_level(batches):
    body = robot_by_hand(2.5, (0.030, 0.0535, 0.068))
    drop = replace(GENTLE, height=1.0)
    runs = run_scenarios(Flights(body, paper_device(), [drop]))
    assert batches == [2]
    assert "no legs to stand on" in runs[0].reason


@pytest.mark.slow
def test_a_trunk_frame_whose_z_axis_is_not_up_is_not_judged():
    """Human's frames have y up; without `trunk` the reader adds a frame with z up."""
    path = ROBOTS / "human_description" / "robots" / "human.urdf"
    assert refusal(read_robot(path)) == ""
    human = read_robot(path, trunk="middle_pelvis")
    run, _ = run_scenarios(
        Flights(human, scaled_device(human), [Drop(name="low", height=1.3, pitch=0.1)])
    )
    assert run.passed is None
    assert "z axis of the trunk frame 'middle_pelvis'" in run.reason


def test_no_maneuvers_no_runs(solo12, batches):
    assert run_scenarios(Flights(solo12, paper_device(), [])) == ()
    assert batches == []


@pytest.mark.slow
def test_runs_come_in_the_order_of_the_maneuvers(solo12):
    jump, drop, _ = default_maneuvers(solo12)
    runs = run_scenarios(Flights(solo12, paper_device(), [drop, jump]))
    assert [(run.scenario, run.ocs) for run in runs] == [
        ("drop", True),
        ("drop", False),
        ("disturbance", True),
        ("disturbance", False),
    ]


@pytest.mark.parametrize(
    ("layout", "stops"), [(LayoutName.ORTHOGONAL, False), (LayoutName.PAIR, True)]
)
def test_stopping_includes_yaw_if_the_wheels_can_act_about_it(solo12, layout, stops):
    """With braked wheels a robot in orbit keeps its yaw rate."""
    stop = TurnTo(name="stop", rate=(0.0, 0.0, 0.5), duration=0.2, gravity=0.0, end=End.AT_REST)
    builder = WorldBuilder(solo12, layout_device(Layout(layout)))
    world = builder.flight(stop, Wheels.BRAKED)
    metrics = measure(simulate([replace(world, duration=0.3)]), 0, world)
    verdict = judge(metrics, stop, can_stand=None)
    assert verdict.passed is stops, verdict.reason
    assert metrics.touchdown_rate == pytest.approx(0.0 if stops else 0.5, abs=0.01)
