"""Which way a device is designed, and by which criterion its incidence goes."""

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
from ocs_design.device.solids import foot_of
from ocs_design.export.bill_of_materials import bill_rows
from ocs_design.parts.foot import foot_shock
from ocs_design.parts.printed import CLEARANCE, GUARD_GAP, SHOCK
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.phrases import Kick
from ocs_design.requirement.sections import RequirementSection, RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing import on_robot
from ocs_design.sizing.design import design_device, survivors
from ocs_design.sizing.footing.feet import Footing
from ocs_design.workflows.pareto import read_task


@pytest.mark.parametrize("motor", ["none", MOTOR])
def test_the_total_is_robot_and_device_braked(motor):
    task, found = design_with_motor(motor)
    expected = braked_inertia(task.robot, found.device)
    assert found.sized.total.mass == pytest.approx(expected.mass, rel=1e-12)
    np.testing.assert_allclose(found.sized.total.com, expected.com, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found.sized.total.inertia, expected.inertia, rtol=1e-7, atol=1e-12)


@pytest.mark.slow
def test_the_incidence_of_the_robot_alone_does_not_count_the_plate():
    task = solo12_task(motor__name="Antigravity MN5006 KV450")
    found = design_device(task)
    assert found.device.plate is not None
    alone = found.sized.incidence_by_criterion_robot[Criterion.EQUAL_RATE]
    assert alone == pytest.approx(equal_rate(task.robot.inertia), rel=1e-12)


@pytest.mark.slow
def test_wheels_that_a_brake_stops_turn_no_faster_than_their_joint_takes():
    """J W / t of the rotor goes through it; the motor alone would turn faster than that."""
    task = solo12_task(
        motor__name="XING2 2207 KV1855",
        requirement__pivot="0,0,-0.272 along left",
        requirement__stand_up="pitch 20deg by brake",
    )
    (climb,) = task.resolved.requirement.maneuvers
    found = design_device(task).device
    joint = next(each for each in joints_of(found) if each.name == SHAFT_JOINT)
    drive = found.motor
    most = joint.capacity * climb.stop / (1.5 * drive.rotor_inertia)
    assert drive.speed_max <= most * (1.0 + 1e-9)
    assert most < min(drive.no_load_speed, speed_limit(motor(drive.name)))


def test_what_was_minimised_is_the_device_or_one_rim():
    _, bound = design_with_motor("none")
    assert bound.choice is None
    assert bound.sized.optimum.objective == bound.device.flywheel.mass
    _, chosen = design_with_motor()
    assert chosen.choice.chosen is chosen.choice.selection.best
    assert chosen.sized.optimum.objective == pytest.approx(chosen.device.mass, rel=1e-12)
    assert chosen.device.motor.name == MOTOR


@pytest.mark.parametrize("motor", ["none", pytest.param(MOTOR, marks=pytest.mark.slow)])
def test_an_incidence_by_hand_is_kept(motor):
    _, found = design_with_motor(motor, alpha=0.4)
    assert (found.criterion, found.device.incidence) == ("by hand", 0.4)


@pytest.mark.parametrize("motor", ["none", MOTOR])
def test_equal_rate_is_that_of_robot_and_device(motor):
    """tan(alpha) = I_roll / I_pitch; it is the default."""
    task, found = design_with_motor(motor)
    roll, pitch, _ = np.diag(braked_inertia(task.robot, found.device).inertia)
    assert found.criterion == "equal-rate"
    assert found.device.incidence == pytest.approx(np.arctan(roll / pitch), abs=1e-8)


@pytest.mark.slow
def test_a_motor_weighs_more_than_wheels_alone():
    """And what it weighs, the wheels have to turn too."""
    _, bound = design_with_motor("none", alpha=0.4)
    _, chosen = design_with_motor(alpha=0.4)
    assert chosen.device.mass > bound.device.mass + chosen.device.motor.mass
    assert chosen.sized.total.inertia[1, 1] > bound.sized.total.inertia[1, 1]


@pytest.mark.slow
def test_feet_of_a_heavy_device_are_as_thick_as_its_shock_asks_for():
    """To 0.1 mm, and 0.2 mm that are left as they are; all of it is weighed."""
    robot = RobotSection(mass=12.0, inertia=(0.1, 0.25, 0.3))
    task = read_task(Specification(robot=robot, motor=MotorSection(name="U8 Lite L KV110")))
    device = design_device(task).device
    thick = device.foot_plate
    assert thick > 0.006
    bears = foot_shock(foot_of(device), device.flywheel.mass + device.carrier.mass)
    assert SHOCK <= bears <= SHOCK * (thick / (thick - 3e-4)) ** 2
    whole = sum(row.quantity * row.mass for row in bill_rows(device))
    assert whole == pytest.approx(device.mass, rel=1e-9)


@pytest.mark.parametrize("motor", ["none", MOTOR])
@pytest.mark.exhaustive
def test_a_device_may_weigh_as_much_as_the_lightest_and_no_less(motor):
    _, free = design_with_motor(motor)
    mass = free.device.mass
    assert design_with_motor(motor, mass_max=mass * 1.001)[1].device.mass == pytest.approx(
        mass, rel=1e-12
    )
    with pytest.raises(Infeasible, match="mass_max allows") as caught:
        design_with_motor(motor, mass_max=0.99 * mass)
    assert caught.value.binding == ("mass_max",)
    assert caught.value.relaxations == {"mass_max": pytest.approx(mass, rel=1e-12)}
    assert "would do" in caught.value.hint


@pytest.mark.slow
def test_guard_rings_hold_the_wheel_that_they_were_sized_with():
    """Device, bill and burst go together: the ring is weighed, and thick enough for this wheel."""
    _, free = design_with_motor()
    task, found = design_with_motor(guard="containing")
    device, wall = found.device, burst_of(found.device).steel
    assert wall <= device.guard_wall <= wall + 2e-4
    rows = {row.part: row for row in bill_rows(device)}
    inside = device.flywheel.outer_radius + CLEARANCE - GUARD_GAP
    height = device.flywheel.height + 2.0 * CLEARANCE
    area = np.pi * ((inside + device.guard_wall) ** 2 - inside**2)
    assert rows["guard ring"].mass == pytest.approx(7850.0 * area * height, rel=1e-9)
    whole = sum(row.quantity * row.mass for row in bill_rows(device))
    assert whole == pytest.approx(device.mass, rel=1e-9)
    assert device.mass > free.device.mass + 2.0 * rows["guard ring"].mass
    total = braked_inertia(task.robot, device)
    np.testing.assert_allclose(found.sized.total.inertia, total.inertia, rtol=1e-7, atol=1e-12)


@pytest.mark.slow
def test_a_device_is_sized_for_kicks_about_the_centre_of_mass_of_all():
    """From above, for less than the robot alone would have to take up, and so it is lighter."""
    asked = RequirementSection(jump_height=(0.3,), kick=(Kick(1.0, (0.1, 0.1, 0.03)),))
    task = solo12().with_specification(
        Specification(requirement=asked, motor=MotorSection(name=MOTOR))
    )
    found = design_device(task)
    own, alone = found.requirement.kicks, task.resolved.requirement.kicks
    assert own == pytest.approx(task.resolved.requirement.on(found.sized.total).kicks)
    assert found.choice.problem.requirement.kicks == pytest.approx(own, rel=0.01, abs=1e-9)
    assert abs(own[0, 0]) < 0.9 * abs(alone[0, 0])


@pytest.mark.slow
@pytest.mark.parametrize(("kilograms", "stays"), [(0.05, False), (0.01, True)])
def test_a_device_that_is_held_another_way_each_time_is_refused(monkeypatch, kilograms, stays):
    """Unless what changes is a twentieth of it at the most; 0.49 kg weighs this one.

    The heavier footing is told, of 20 g more than what changes.
    """
    task, found = design_with_motor(alpha=0.4)
    place, device = found.choice.problem.place, found.device.mass
    assert (kilograms > 0.05 * device) is not stays
    masses = [
        MassProperties(each, task.robot.com, np.zeros((3, 3))) for each in (0.02 + kilograms, 0.02)
    ]
    masts = [SimpleNamespace(mass_properties=lambda each=each: each) for each in masses]
    held = cycle([Footing(place, mast) for mast in masts])

    def held_otherwise(search, problem, _device):
        return replace(problem, robot=next(held).carried(search.robot.mass_properties))

    monkeypatch.setattr(on_robot.OnRobot, "_own_footing", held_otherwise)
    refused = None
    try:
        design_device(task)
    except on_robot.NeverHeld as error:
        refused = error
    assert (refused is None) is stays
    if refused is not None:
        mass = re.search(
            r"A device of ([\d.]+) kg needs a mount of 0.07 kg on the trunk,", refused.message
        )
        assert float(mass[1]) == pytest.approx(device, rel=0.2)
        assert refused.binding == ("mount",)


def test_layouts_that_would_survive_and_have_no_device_say_why(monkeypatch):
    """It was told that there is none, and not by how much they miss it."""

    def none(task, **_):
        raise infeasible(f"{task.specification.ocs.layout} lacks 20 %.")

    monkeypatch.setattr("ocs_design.sizing.design.design_device", none)
    task = solo12()
    told = survivors(task.specification, task.robot, lambda _: None)
    assert "triad: triad lacks 20 %; double-pair: double-pair lacks 20 %; pyramid: " in told
