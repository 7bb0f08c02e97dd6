"""Plans: robot and device as one gyrostat, and the limits of the drives."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from gyrostats import BACK_FLIP, PUSH
from wheels import EC45, PAPER_WHEEL, braked_inertia, driven_device, geared

from ocs_design.actuation.drive import RESERVE
from ocs_design.requirement.turns import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.sizing.trajectory.plans import drive_line_of, gyrostat_of, plan

ROBOT = robot_by_hand(2.5, (0.032, 0.055, 0.0696, 0.001, -0.002, 0.0005), (0.001, 0.002, -0.0276))
STANDING = 0.272
DRIVES = {"direct": EC45, "reducing": geared(3.0), "reversing": geared(0.5, reverses=True)}


@pytest.fixture(params=DRIVES)
def device(request):
    return driven_device(drive=DRIVES[request.param])


def test_the_gyrostat_is_robot_and_device_braked(device):
    """As measured by a pendulum: the carriers' inertia includes the rotors, counted once."""
    gyrostat = gyrostat_of(ROBOT.mass_properties, device)
    expected = braked_inertia(ROBOT, device).inertia
    np.testing.assert_allclose(gyrostat.inertia, expected, rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(gyrostat.axes, device.axes)
    assert gyrostat.spin_inertia == PAPER_WHEEL.spin_inertia + device.motor.rotor_inertia
    assert gyrostat.armature == device.motor.armature


def test_momentum_is_the_sum_over_all_bodies(device):
    """I w + A h W for trunk rate w and wheel speeds W, with the rotors' sense of rotation."""
    rate, speed = np.array([0.3, -0.7, 0.2]), np.array([400.0, -250.0])
    by_bodies = braked_inertia(ROBOT, device).inertia @ rate
    for module, wheel_speed in zip(device.modules, speed, strict=True):
        rim = np.pi * 7860.0 * 0.01 * (0.03**4 - 0.022**4) / 2.0
        by_bodies = by_bodies + module.axis * (rim + device.motor.rotor_inertia) * wheel_speed
    momentum = gyrostat_of(ROBOT.mass_properties, device).mass_matrix[:3] @ [*rate, *speed]
    np.testing.assert_allclose(momentum, by_bodies, rtol=1e-10)


def test_the_line_is_that_of_the_motor():
    line = drive_line_of(driven_device())
    assert (line.stall_torque, line.no_load_speed) == (EC45.stall_torque, EC45.no_load_speed)
    assert (line.torque_limit, line.speed_max) == (EC45.torque_limit, EC45.speed_max)


def test_unknown_figures_do_not_limit():
    unlimited = replace(EC45, stall_torque=None, torque_limit=None, speed_max=None)
    line = drive_line_of(driven_device(drive=unlimited))
    assert (line.stall_torque, line.torque_limit, line.speed_max) == (inf, inf, inf)


@pytest.fixture(scope="module")
def plans():
    height = STANDING + 9.81 * 0.385**2 / 2.0
    drop = Drop(name="drop", standing_height=STANDING, height=height, pitch=np.radians(20.0))
    turned = replace(BACK_FLIP, angle=-1.5, incidence=0.0)
    device = driven_device(np.radians(40.0))
    return plan(ROBOT.mass_properties, device, (drop, PUSH, turned))


def test_each_turn_has_a_plan_and_a_push_has_none(plans):
    assert list(plans) == ["drop", "push", "back-flip"]
    assert plans["push"].trajectory is None
    assert "not known beforehand" in plans["push"].note
    assert plans["drop"].trajectory.time[-1] == pytest.approx(0.385, rel=1e-9)


@pytest.mark.parametrize(("name", "incidence"), [("drop", 40.0), ("back-flip", 0.0)])
def test_a_plan_is_for_its_maneuvers_incidence(plans, name, incidence):
    """From rest to rest the momentum of trunk and wheels is zero at any time: I w + h A W = 0."""
    device, trajectory = driven_device(np.radians(incidence)), plans[name].trajectory
    trunk = trajectory.rate @ braked_inertia(ROBOT, device).inertia
    wheels = trajectory.wheel_speed @ (device.flywheel.spin_inertia * device.axes.T)
    assert np.abs(trunk + wheels).max() < 1e-6 * np.abs(wheels).max()


def test_a_plan_leaves_a_margin_for_the_feedback(plans):
    for name in ("drop", "back-flip"):
        trajectory = plans[name].trajectory
        assert plans[name].note == ""
        share = trajectory.wheel_speed / EC45.no_load_speed
        share = share + trajectory.wheel_torque / EC45.stall_torque
        assert np.abs(share).max() <= (1.0 + RESERVE) / 2.0 + 1e-6
        torque_max = EC45.torque_limit * (1.0 + RESERVE) / 2.0
        assert np.abs(trajectory.wheel_torque).max() <= torque_max + 1e-6
