"""Designs with a motor or by the bound, and the criterion of their incidence."""

import re
from dataclasses import replace
from itertools import cycle
from types import SimpleNamespace

import numpy as np
import pytest
from designed_devices import MOTOR, design_with_motor, solo12, solo12_task
from fronts import infeasible
from products import equal_rate
from wheels import braked_inertia

from ocs_design.actuation.drive import speed_limit
from ocs_design.catalogue.motors import motor
from ocs_design.common.errors import Infeasible
from ocs_design.device.joints import SHAFT_JOINT, burst_of, joints_of
from ocs_design.device.layout import Criterion
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.parts.foot import foot_shock
from ocs_design.parts.printed import CLEARANCE, GUARD_GAP, SHOCK
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.phrases import Kick
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing import on_robot
from ocs_design.sizing.design import design_device, layouts_that_survive
from ocs_design.sizing.footing.feet import Footing
from ocs_design.workflows.pareto import read_task


@pytest.mark.parametrize("motor", ["none", MOTOR])
def test_the_total_is_the_robot_with_its_braked_device(motor):
    task, design = design_with_motor(motor)
    total, expected = design.sized.total, braked_inertia(task.robot, design.device)
    assert total.mass == pytest.approx(expected.mass, rel=1e-12)
    np.testing.assert_allclose(total.com, expected.com, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(total.inertia, expected.inertia, rtol=1e-7, atol=1e-12)


@pytest.mark.slow
def test_the_incidence_of_the_robot_alone_excludes_the_plate():
    task = solo12_task(motor__name="Antigravity MN5006 KV450")
    design = design_device(task)
    assert design.device.plate is not None
    alone = design.sized.incidence_by_criterion_robot[Criterion.EQUAL_RATE]
    assert alone == pytest.approx(equal_rate(task.robot.inertia), rel=1e-12)


@pytest.mark.slow
def test_the_shaft_joint_limits_the_speed_of_braked_wheels():
    """It carries J W / t of the rotor; the motor could turn faster."""
    task = solo12_task(
        motor__name="XING2 2207 KV1855",
        requirement__pivot="0,0,-0.272 along left",
        requirement__stand_up="pitch 20deg by brake",
    )
    (climb,) = task.resolved.requirement.maneuvers
    device = design_device(task).device
    joint = next(each for each in joints_of(device) if each.name == SHAFT_JOINT)
    drive = device.motor
    speed_max = joint.capacity * climb.braking_time / (1.5 * drive.rotor_inertia)
    assert drive.speed_max <= speed_max * (1.0 + 1e-9)
    assert speed_max < min(drive.no_load_speed, speed_limit(motor(drive.name)))


def test_the_objective_is_the_mass_of_the_device_or_of_one_rim():
    _, bound = design_with_motor("none")
    assert bound.choice is None
    assert bound.sized.optimum.objective == bound.device.flywheel.mass
    _, chosen = design_with_motor()
    assert chosen.choice.chosen is chosen.choice.selection.best
    assert chosen.sized.optimum.objective == pytest.approx(chosen.device.mass, rel=1e-12)
    assert chosen.device.motor.name == MOTOR


@pytest.mark.parametrize("motor", ["none", pytest.param(MOTOR, marks=pytest.mark.slow)])
def test_a_specified_incidence_is_kept(motor):
    _, design = design_with_motor(motor, alpha=0.4)
    assert (design.criterion, design.device.incidence) == ("by hand", 0.4)


@pytest.mark.parametrize("motor", ["none", MOTOR])
def test_default_incidence_gives_equal_rates_of_robot_and_device(motor):
    """tan(alpha) = I_roll / I_pitch."""
    task, design = design_with_motor(motor)
    roll, pitch, _ = np.diag(braked_inertia(task.robot, design.device).inertia)
    assert design.criterion == "equal-rate"
    assert design.device.incidence == pytest.approx(np.arctan(roll / pitch), abs=1e-8)


@pytest.mark.slow
def test_a_motor_adds_its_mass_and_inertia():
    _, bound = design_with_motor("none", alpha=0.4)
    _, chosen = design_with_motor(alpha=0.4)
    assert chosen.device.mass > bound.device.mass + chosen.device.motor.mass
    assert chosen.sized.total.inertia[1, 1] > bound.sized.total.inertia[1, 1]


@pytest.mark.slow
def test_feet_of_a_heavy_device_are_as_thick_as_the_landing_shock_requires():
    """To 0.1 mm, plus 0.2 mm within which the thickness is not changed; the mass counts it."""
    robot = RobotSection(mass=12.0, inertia=(0.1, 0.25, 0.3))
    task = read_task(Specification(robot=robot, motor=MotorSection(name="U8 Lite L KV110")))
    device = design_device(task).device
    thickness = device.foot_plate
    assert thickness > 0.006
    capacity = foot_shock(device.foot, device.flywheel.mass + device.carrier.mass)
    assert SHOCK <= capacity <= SHOCK * (thickness / (thickness - 3e-4)) ** 2
    bill_mass = sum(row.quantity * row.mass for row in bill_rows(device))
    assert bill_mass == pytest.approx(device.mass, rel=1e-9)


@pytest.mark.parametrize("motor", ["none", MOTOR])
@pytest.mark.exhaustive
def test_a_mass_limit_below_the_lightest_device_is_infeasible(motor):
    mass = design_with_motor(motor)[1].device.mass
    assert design_with_motor(motor, mass_max=mass * 1.001)[1].device.mass == pytest.approx(
        mass, rel=1e-12
    )
    with pytest.raises(Infeasible, match="mass_max allows") as caught:
        design_with_motor(motor, mass_max=0.99 * mass)
    assert caught.value.binding == ("mass_max",)
    assert caught.value.relaxations == {"mass_max": pytest.approx(mass, rel=1e-12)}
    assert "would do" in caught.value.hint


@pytest.mark.slow
def test_guard_rings_contain_the_wheel_that_they_were_sized_with():
    """Device, bill and burst agree: the mass counts the ring, which is thick enough."""
    _, unguarded = design_with_motor()
    task, design = design_with_motor(guard="containing")
    device, wall = design.device, burst_of(design.device).steel
    assert wall <= device.guard_wall <= wall + 2e-4
    rows = {row.part: row for row in bill_rows(device)}
    inside = device.flywheel.outer_radius + CLEARANCE - GUARD_GAP
    height = device.flywheel.height + 2.0 * CLEARANCE
    area = np.pi * ((inside + device.guard_wall) ** 2 - inside**2)
    assert rows["guard ring"].mass == pytest.approx(7850.0 * area * height, rel=1e-9)
    bill_mass = sum(row.quantity * row.mass for row in bill_rows(device))
    assert bill_mass == pytest.approx(device.mass, rel=1e-9)
    assert device.mass > unguarded.device.mass + 2.0 * rows["guard ring"].mass
    total = braked_inertia(task.robot, device)
    np.testing.assert_allclose(design.sized.total.inertia, total.inertia, rtol=1e-7, atol=1e-12)


@pytest.mark.slow
def test_kicks_act_about_the_centre_of_mass_of_robot_and_device():
    """It is higher than the robot's own, so that kicks from above have a smaller lever."""
    requirement = RequirementSection(jump_height=(0.3,), kick=(Kick(1.0, (0.1, 0.1, 0.03)),))
    task = solo12().with_specification(
        Specification(requirement=requirement, motor=MotorSection(name=MOTOR))
    )
    design = design_device(task)
    kicks, robot_kicks = design.requirement.kicks, task.resolved.requirement.kicks
    assert kicks == pytest.approx(task.resolved.requirement.on(design.sized.total).kicks)
    assert design.choice.problem.requirement.kicks == pytest.approx(kicks, rel=0.01, abs=1e-9)
    assert abs(kicks[0, 0]) < 0.9 * abs(robot_kicks[0, 0])


@pytest.mark.slow
def test_a_kick_too_large_for_the_robot_alone_is_sized_about_its_centre_of_mass_with_a_device():
    """Parts and incidence that the lightest device has were refused."""

    def task(kick):
        return solo12_task(
            motor__name="Antigravity MN5006 KV450",
            ocs__alpha="30deg",
            requirement__jump_height="0.3m",
            requirement__kick=f"{kick} N s at 0,0,0.05",
        )

    design = design_device(task(1.0), ranked=False)
    assert design.choice.problem.requirement.kicks == pytest.approx(
        design.requirement.kicks, rel=0.011, abs=1e-9
    )
    # The kick on the robot alone is one too large, and of the next one the message says so.
    alone = np.abs(task(1.0).resolved.requirement.kicks).max()
    assert np.abs(design.requirement.kicks).max() < 0.87 * alone
    with pytest.raises(Infeasible, match=r"kick takes 0\.456 s at best, 0\.343 s given"):
        design_device(task(1.15), ranked=False)


@pytest.mark.slow
@pytest.mark.parametrize(("change", "accepted"), [(0.05, False), (0.01, True)])
def test_a_mount_that_alternates_between_iterations_is_refused(monkeypatch, change, accepted):
    """Unless its mass changes by at most 5 % of the device's, which is 0.49 kg here.

    The error names the mass of the heavier mount, 20 g more than the change.
    """
    task, design = design_with_motor(alpha=0.4)
    place, device_mass = design.choice.problem.place, design.device.mass
    assert (change > 0.05 * device_mass) is not accepted
    masses = [
        MassProperties(mass, task.robot.com, np.zeros((3, 3))) for mass in (0.02 + change, 0.02)
    ]
    masts = [SimpleNamespace(mass_properties=lambda each=each: each) for each in masses]
    footings = cycle([Footing(place, mast) for mast in masts])

    def alternating_footing(search, problem, _device):
        return replace(problem, robot=next(footings).added_to(search.robot.mass_properties))

    monkeypatch.setattr(on_robot.OnRobot, "_own_footing", alternating_footing)
    refused = None
    try:
        design_device(task)
    except on_robot.NoMountHolds as error:
        refused = error
    assert (refused is None) is accepted
    if refused is not None:
        mass = re.search(
            r"A device of ([\d.]+) kg needs a mount of 0.07 kg on the trunk,", refused.message
        )
        assert float(mass[1]) == pytest.approx(device_mass, rel=0.2)
        assert refused.binding == ("mount",)


def test_infeasible_layouts_that_would_survive_a_failure_give_their_reasons(monkeypatch):
    """The message once named the layouts without the shortfall of each."""

    def infeasible_device(task, **_):
        raise infeasible(f"{task.specification.ocs.layout} lacks 20 %.")

    monkeypatch.setattr("ocs_design.sizing.design.design_device", infeasible_device)
    task = solo12()
    text = layouts_that_survive(task.specification, task.robot, lambda _: None)
    assert "triad: triad lacks 20 %; double-pair: double-pair lacks 20 %; pyramid: " in text
