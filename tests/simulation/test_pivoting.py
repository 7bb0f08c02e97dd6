"""Robots on a pivot in MuJoCo: balance, stand-up, and the momentum that gravity gives."""

import re
from dataclasses import replace

import numpy as np
import pytest
from wheels import driven_device, layout_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.pivoted import Balance, StandUp
from ocs_design.robot.manual import robot_by_hand
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.trajectory.plans import gyrostat_of, plan

ROBOT = robot_by_hand(2.5, (0.02, 0.025, 0.02))
ROLL_EDGE, PITCH_EDGE = {"edge": (1.0, 0.0, 0.0)}, {"edge": (0.0, 1.0, 0.0)}
PIVOT = {"pivot": (0.0, 0.005, -0.2)}
HEAVY = replace(driven_device().flywheel, spin_inertia=3e-3, transverse_inertia=1.6e-3)
TILTED = Balance(name="tilted", **PIVOT, **ROLL_EDGE, roll=np.radians(2.0), duration=1.2)
ON_POINT = Balance(
    name="point", **PIVOT, roll=np.radians(1.0), pitch=np.radians(-2.0), duration=1.2
)
KICKED = Balance(
    name="hit", **PIVOT, **PITCH_EDGE, impulse=(0.1, 0.0, 0.0), point=(0.0, 0.0, 0.05), duration=1.2
)
STAND_UP = StandUp(name="up", **PIVOT, **ROLL_EDGE, roll=np.radians(3.0), duration=0.6)
BRAKED = StandUp(
    name="braked", **PIVOT, **ROLL_EDGE, roll=np.radians(-45.0), duration=0.7, actuation="brake"
)


def _flown(device, *maneuvers):
    plans = plan(ROBOT.mass_properties, device, maneuvers)
    references = {
        name: reference.trajectory for name, reference in plans.items() if reference.trajectory
    }
    runs = run_scenarios(Flights(ROBOT, device, maneuvers, references=references))
    return plans, runs


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["pair", "triad", "pyramid"])
def test_wheels_balance_a_robot_on_a_pivot_which_falls_without_them(layout):
    device = driven_device() if layout == "pair" else layout_device(Layout(LayoutName(layout)))
    _, runs = _flown(device, TILTED, ON_POINT, KICKED, STAND_UP)
    for run in runs:
        assert run.passed is run.ocs, run.reason
        # There is no touchdown: the robot stands or falls.
        assert (run.level, run.stands) == (None, run.ocs)
        # The momentum about the pivot is that given by gravity.
        assert run.metrics.momentum_error < 3e-7
        # The balanced robot leans a little, which brings the wheels to rest too.
        if run.ocs:
            limit = run.metrics.peak_wheel_speed
            assert run.metrics.final_wheel_speed < 0.2 * limit


@pytest.mark.slow
def test_a_brake_stands_a_robot_up_whose_motors_cannot():
    """At 45 deg the torque of gravity is 3.5 N m; both motors give 1.3 N m about roll."""
    heavy = replace(driven_device(), flywheel=HEAVY)
    plans, (run, without) = _flown(heavy, BRAKED)
    assert "the wheels are stopped from" in plans["braked"].note
    assert plans["braked"].braked_speed > run.metrics.peak_wheel_speed
    assert run.passed, run.reason
    assert not without.passed
    by_motor = replace(BRAKED, name="motor", actuation="motor")
    assert plans["braked"].trajectory.rate[0, 0] > 0.0
    refused = plan(ROBOT.mass_properties, heavy, [by_motor])["motor"]
    assert refused.trajectory is None
    assert "cannot stand it up from 45 deg in 0.7 s: from" in refused.note


def test_a_brake_cannot_stop_wheels_faster_than_the_motors_spin_them():
    refused = plan(ROBOT.mass_properties, driven_device(), [BRAKED])["braked"]
    assert refused.trajectory is None
    match = re.fullmatch(
        r"the brake would have to stop the wheels from ([\d,]+) rpm, but the motors reach only "
        r"([\d,]+) rpm",
        refused.note,
    )
    needed, reached = (float(speed.replace(",", "")) for speed in match.groups())
    assert needed == pytest.approx(refused.braked_speed * 30.0 / np.pi, rel=0.01)
    assert reached / needed == pytest.approx(refused.tilt_fraction, rel=0.01)
    assert reached == 6211.0


@pytest.mark.parametrize("maneuver", [TILTED, ON_POINT])
def test_energy_about_the_pivot_is_conserved_without_drives(maneuver):
    """A heavy pendulum with its wheels held, from the start over the lowest point."""
    device = driven_device()
    world = WorldBuilder(ROBOT, device).flight(maneuver, Wheels.BRAKED)
    recording = simulate([replace(world, duration=2.0)])
    on_device = maneuver.on(device.on(ROBOT.mass_properties))
    rate = recording.rate[:, 0]
    kinetic = 0.5 * np.einsum("ki,ij,kj->k", rate, on_device.inertia, rate)
    w, x, y, z = recording.attitude[:, 0].T
    up = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z])
    energy = kinetic + on_device.gravity_moment @ up
    scale = np.linalg.norm(on_device.gravity_moment)
    assert np.ptp(on_device.gravity_moment @ up) > 1.5 * scale
    np.testing.assert_allclose(energy, energy[0], rtol=0, atol=1e-5 * scale)
    # The recorded centre of mass is that of robot and device, without the heavy anchor.
    com, mass = recording.com[:, 0], device.mass + ROBOT.mass
    height = on_device.gravity_moment @ up / (mass * maneuver.gravity)
    assert np.ptp(height) > 0.4
    # In 2 s robot and anchor fall by a ten millionth of a free fall, 2e-6 m.
    np.testing.assert_allclose(com[:, 2] - com[0, 2], height - height[0], rtol=0, atol=3e-6)


def test_the_model_has_the_inertia_of_the_plan():
    device = driven_device()
    world = WorldBuilder(ROBOT, device).flight(ON_POINT, Wheels.ACTIVE)
    planned = gyrostat_of(ROBOT.mass_properties, device, ON_POINT)
    np.testing.assert_allclose(world.body.inertia, planned.inertia, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(
        world.body.gravity_moment, planned.gravity_moment, rtol=1e-9, atol=1e-12
    )
