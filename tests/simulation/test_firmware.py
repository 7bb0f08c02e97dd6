"""The controller in C against the control law of the simulation."""

import re
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from firmware import bound, compiled
from trajectories import from_rest
from wheels import EC45, driven_device, layout_device, paper_device

from ocs_design.actuation.supply import Supply
from ocs_design.common import quaternions
from ocs_design.device.bodies import joint_names
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.turns import Flip
from ocs_design.simulation.desaturation import WheelBrake
from ocs_design.simulation.firmware import targets_of, write_controller
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world_builder import Options, WorldBuilder
from ocs_design.sizing.trajectory.plans import drive_line_of
from ocs_design.sizing.trajectory.tracking import tracking_gains

PERIOD, STATES = 0.005, 400
WITH_WINDING = replace(EC45, resistance=0.6, torque_constant=0.037)


def worlds_of(solo12, device, *, desaturate):
    """Worlds of the paper's three maneuvers, with a plan where the maneuver turns the trunk."""
    builder = WorldBuilder(solo12, device, Options(desaturate=desaturate))
    worlds = {}
    for maneuver in default_maneuvers(solo12):
        world = builder.flight(maneuver, Wheels.ACTIVE)
        if world.turn.span:
            turn = replace(world.turn, at_once=False)
            plan = from_rest(world.body, turn, samples=401)
            if isinstance(maneuver, Flip):
                # Feedback of the heading too, with gains that vary along the plan.
                attitude = quaternions.from_axis_angle(turn.axis, turn.angle(plan.time))
                gains = tracking_gains(world.body, drive_line_of(device), plan)
                plan = replace(plan, attitude=attitude, gains=gains)
            world = builder.flight(maneuver, Wheels.ACTIVE, plan)
        worlds[maneuver.name] = world
    return worlds


SLOW = "one wheel", "ideal wheels", "wheels on all axes"
CASES = {
    "one wheel": (layout_device(Layout(LayoutName.SINGLE)), False),
    "wheels on all axes": (layout_device(Layout(LayoutName.ORTHOGONAL)), False),
    "ideal wheels": (paper_device(), False),
    "motors on a weak supply, braked in stance": (
        replace(driven_device(drive=WITH_WINDING), supply=Supply(24.0, 2.0)),
        True,
    ),
}


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=[pytest.mark.slow] * (name in SLOW)) for name in CASES],
)
def written(request, solo12, tmp_path_factory):
    """Worlds by name, and the folder with their controller in C."""
    device, desaturate = CASES[request.param]
    worlds = worlds_of(solo12, device, desaturate=desaturate)
    folder = tmp_path_factory.mktemp("controller")
    write_controller("solo12", worlds, folder, joints=joint_names(device), period=PERIOD)
    return worlds, folder


@pytest.fixture(scope="module")
def controller_and_module(written):
    """The compiled controller, and the module of its Python binding."""
    return bound(written[1])


def random_states(wheels, n=STATES):
    """Attitudes, rates, wheel speeds far above those of motors, and times on the ground."""
    rng = np.random.default_rng(7)
    attitude = rng.normal(size=(n, 4))
    attitude[: n // 10, 1:3] = 0.0
    attitude /= np.linalg.norm(attitude, axis=1, keepdims=True)
    rate = rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-3.0, 1.0, (n, 1))
    speed = rng.normal(size=(n, wheels)) * 10.0 ** rng.uniform(0.0, 3.3, (n, 1))
    ground = np.where(rng.random(n) < 1.0 / 3.0, rng.uniform(0.005, 1.0, n), 0.0)
    return attitude, rate, speed, ground


def by_numpy(world, target, attitude, rate, speed, ground):
    """Torques of the simulation's control law and brake."""
    target = target.repeat(len(rate)).landed(ground > 0.0)
    if world.desaturation is not None:
        brake = WheelBrake([world.desaturation] * len(rate), PERIOD)
        brake._stood[:] = ground - PERIOD  # it counts the step that has just passed
        target = brake.with_braking(target, speed, ground > 0.0)
    return world.law.repeat(len(rate)).torque(
        quaternions.vertical(attitude), rate, speed, target, PERIOD, attitude=attitude
    )


def test_torques_are_those_of_the_control_law(written, controller_and_module):
    worlds, (controller, module) = written[0], controller_and_module
    states = [np.split(values, 50) for values in random_states(module.WHEELS)]
    targets = targets_of(list(worlds.values()), PERIOD)
    for index, (world, target) in enumerate(zip(worlds.values(), targets, strict=True)):
        instants = np.random.default_rng(8).integers(0, len(target) + 20, 50)
        for k, *state in zip(instants.tolist(), *states, strict=True):
            expected = by_numpy(world, target[min(k, len(target) - 1)], *state)
            actual = [
                controller.step(index, PERIOD * k, *single) for single in zip(*state, strict=True)
            ]
            np.testing.assert_allclose(actual, expected, rtol=1e-9, atol=1e-9)
            assert np.abs(expected).max() > 0.01


@pytest.mark.slow
def test_torques_are_those_of_the_flights(written, controller_and_module):
    worlds, controller = written[0], controller_and_module[0]
    recording = simulate(list(worlds.values()))
    for index in range(len(worlds)):
        in_flight = np.flatnonzero(np.cumsum(recording.contact[:, index]) == 0)
        states = (
            series[in_flight, index]
            for series in (recording.attitude, recording.rate, recording.wheel_speed)
        )
        actual = [
            controller.step(index, PERIOD * k, *state)
            for k, *state in zip(in_flight, *states, strict=True)
        ]
        np.testing.assert_allclose(actual, recording.wheel_torque[in_flight, index], atol=1e-9)
        assert len(in_flight) > 50


@pytest.mark.slow
def test_the_harness_prints_the_same_torques_also_in_single_precision(
    written, controller_and_module
):
    folder, (controller, module) = written[1], controller_and_module
    attitude, rate, speed, ground = random_states(module.WHEELS, 50)
    lines = np.column_stack([np.full(50, 0.1), ground, attitude, rate, speed])
    text = "".join(f"1 {' '.join(map(repr, line))}\n" for line in lines.tolist())
    states = zip(attitude, rate, speed, ground, strict=True)
    expected = np.array([controller.step(1, 0.1, *state) for state in states])
    for options, tolerance in (((), 0.0), (("-Docs_real=float",), 1e-4)):
        process = subprocess.run(
            [compiled(folder, *options)], input=text, capture_output=True, text=True, check=True
        )
        printed = np.array([list(map(float, line.split())) for line in process.stdout.splitlines()])
        assert np.abs(printed - expected).max() <= tolerance * np.abs(expected).max()


@pytest.mark.parametrize(
    "state",
    [
        {"maneuver": -1},
        {"maneuver": 3},
        {"time": -PERIOD},
        {"time": np.nan},
        {"attitude": (1.0, np.nan, 0.0, 0.0)},
        {"rate": (0.1, np.inf, 0.0)},
        {"wheel_speed": (np.nan,)},
    ],
)
def test_invalid_states_give_no_torque(controller_and_module, state):
    controller, module = controller_and_module
    valid = {
        "maneuver": 1,
        "time": 0.1,
        "attitude": (0.98, 0.1, 0.2, 0.0),
        "rate": (0.1, 0.2, 0.3),
        "wheel_speed": (10.0,) * module.WHEELS,
    }
    assert all(controller.step(**valid))
    assert controller.step(**{**valid, **state}) == [0.0] * module.WHEELS


@pytest.mark.slow
def test_it_allocates_nothing_and_takes_little_stack(written):
    _, folder = written
    library = compiled(folder, "-fPIC", "-shared", out="plain.so", sources=())
    symbols = subprocess.run(["nm", "-uD", library], capture_output=True, text=True, check=True)
    called = {
        line.split()[-1].partition("@")[0] for line in symbols.stdout.splitlines() if " U " in line
    }
    assert called <= {"atan2", "sqrt", "fmin", "fmax", "floor"}
    compiled(folder, "-fstack-usage", "-c", out="plain.o", sources=())
    (report,) = folder.glob("*.su")
    stack = [int(line.split("\t")[1]) for line in report.read_text().splitlines()]
    assert 0 < max(stack) <= 1024


@pytest.mark.parametrize(
    "names",
    [
        ["*/ übung", "Push 1", "push-1", "§"],
        ["wheels", "period", "maneuvers", "controller h"],
        ["push", "Push", "push 1", "push 0"],
    ],
)
def test_maneuver_names_become_distinct_identifiers(names, solo12, tmp_path):
    device = paper_device()
    world = WorldBuilder(solo12, device).flight(default_maneuvers(solo12)[0], Wheels.ACTIVE)
    worlds = dict.fromkeys(names, world)
    write_controller("solo12", worlds, tmp_path, joints=joint_names(device), period=PERIOD)
    header = (tmp_path / "solo12_ocs_controller.h").read_text()
    identifiers = re.findall(r"^    (OCS_\w+),$", header, re.MULTILINE)
    assert len(set(identifiers)) == len(names)
    compiled(tmp_path)
