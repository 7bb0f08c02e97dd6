"""The selection: a device recomputed independently, rejections, and relaxations."""

import pickle
import re
from dataclasses import replace

import numpy as np
import pinocchio
import pytest
from carrier_parts import carrier_parts
from commands import SOLO12
from naive_wheel import wheel_body
from selections import has_device, lightest, random_problem

from ocs_design.actuation.drive import armature, drive_line, rotor_share
from ocs_design.actuation.motor import DIRECT
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia, wheel_slew_time
from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.device.layout import module_axes
from ocs_design.parts.joints import SERVICE
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.turns import Flip
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.advice import ADVICE_PRECISION, advice_on
from ocs_design.sizing.limits import BUS_VOLTAGE, TIME
from ocs_design.sizing.selection.problem import Reason, with_limit
from ocs_design.sizing.selection.select import select
from ocs_design.sizing.specified import selection_problem

MASS_TOLERANCE = 2e-5
"""Relative tolerance of the mass of the lightest device."""

FEASIBLE_SEEDS = (
    *(0, 21),
    *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (3, 9, 12, 20, 22)),
)
"""Seeds of feasible problems, some of them barely: direct and geared drives."""


@pytest.fixture(scope="module", params=FEASIBLE_SEEDS)
def solved(request):
    problem = random_problem(request.param)
    return problem, lightest(problem)


def by_pinocchio(problem, device, incidence):
    """Total of robot, wheels and all parts of the carriers by Pinocchio."""
    total = pinocchio.Inertia(problem.robot.mass, problem.robot.com, problem.robot.inertia)
    parts = list(pieces(device))
    for center, side in zip(device.centers, (1.0, -1.0), strict=True):
        # The right module is the left one turned about the vertical.
        turn = -incidence if side > 0.0 else np.pi + incidence
        seat = pinocchio.SE3(pinocchio.utils.rotate("z", turn), center)
        mass, spin, across = wheel_body(device)
        total += seat.act(pinocchio.Inertia(mass, np.zeros(3), np.diag([across, spin, across])))
        for body in parts:
            total += seat.act(pinocchio.Inertia(body.mass, body.com, body.inertia))
    return total


def pieces(device):
    """All parts around its wheel."""
    return carrier_parts(device.motor, device.gear, device.outer_radius, device.height)


def test_the_lightest_device_recomputed_from_its_dimensions(solved):
    """Masses, total inertia and the demands of all maneuvers."""
    problem, device = solved
    motor, gear = device.motor, device.gear
    total = by_pinocchio(problem, device, device.incidence)
    assert device.total.mass == pytest.approx(total.mass, rel=1e-12)
    np.testing.assert_allclose(device.total.com, total.lever, rtol=0, atol=1e-12)
    np.testing.assert_allclose(device.total.inertia, total.inertia, rtol=1e-9, atol=1e-12)
    mass = sum(part.mass for part in pieces(device))
    assert device.carrier.mass == pytest.approx(mass, rel=1e-12)
    assert device.mass == pytest.approx(2.0 * (wheel_body(device)[0] + mass), rel=1e-12)

    share = rotor_share(motor.rotor_inertia, gear)
    assert device.spin_inertia == pytest.approx(wheel_body(device)[1] + share, rel=1e-9)
    line = drive_line(motor, gear, problem.supply.voltage)
    cap = problem.wheel_speed_max or np.inf
    line = replace(line, speed_max=min(line.speed_max, cap)).reserved()
    by_name = {demand.source: demand for demand in device.demands}
    for maneuver in problem.requirement.maneuvers:
        angle = device.incidence if maneuver.incidence is None else maneuver.incidence
        inertia = TiltInertia.of(by_pinocchio(problem, device, angle).inertia)
        slew = maneuver.slew(inertia)
        axes = module_axes(angle)[:2]
        task = WheelTask(slew.swept, slew.momentum, slew.duration, inertia, axes)
        drag = armature(motor.rotor_inertia, gear)
        time = wheel_slew_time(task, device.spin_inertia, line, drag)
        demand = by_name[maneuver.name]
        assert demand.time_given == pytest.approx(slew.duration)
        assert demand.time_needed == pytest.approx(float(time), rel=1e-9)
        assert time <= slew.duration * (1.0 + 1e-8)
        needed = float(smallest_spin_inertia(task, line, drag))
        assert demand.spin_inertia == pytest.approx(needed, rel=1e-8)
        assert 0.0 < demand.peak_speed <= float(line.speed_max) * (1.0 + 1e-12)
        assert 0.0 < demand.peak_torque <= float(line.torque_limit) * (1.0 + 1e-12)
    # As large as required within the residual of the fixed point, unless it is the smallest rim.
    assert device.residual < 1e-9
    if not {"h_min", "web"} & set(device.binding):
        required = max(demand.spin_inertia for demand in device.demands)
        assert device.spin_inertia == pytest.approx(required, rel=1e-8)
        assert device.binding_maneuver in by_name


def test_a_shaft_too_short_for_its_joint_is_not_chosen():
    """Solo12's motor with 3.5 mm of shaft: 2.0 mm in a hub of 0.5 mm chamfers bear 0.63 N m."""
    task = Task.of(Specification(), read_robot(SOLO12))
    (motor,) = (
        each for each in task.resolved.choice.motors if each.name == "Antigravity MN5006 KV450"
    )
    short = replace(motor, name="short", mounting=replace(motor.mounting, shaft_length=0.0035))
    assert 0.63 < SERVICE * motor.peak_torque < 1.10
    choice = replace(task.resolved.choice, motors=(short, motor))
    task = replace(task, resolved=replace(task.resolved, choice=choice))
    assert selection_problem(task).motors == (motor,)


@pytest.mark.slow
def test_a_specified_incidence_is_kept_and_no_lighter_than_the_best():
    problem = random_problem(9)
    best = select(problem).best
    for angle in (best.incidence, best.incidence + 0.1):
        specified = select(replace(problem, incidence=angle)).best
        assert specified.incidence == angle
        assert specified.mass >= best.mass * (1.0 - MASS_TOLERANCE)
    same = select(replace(problem, incidence=best.incidence)).best
    assert same.mass == pytest.approx(best.mass, rel=MASS_TOLERANCE)


@pytest.mark.slow
def test_a_rate_change_alone():
    """Momentum over twice the share of the reserved speed, L / (2 share W)."""
    problem = random_problem(9)
    requirement = replace(problem.requirement, maneuvers=(), rate_change=1.0)
    device = lightest(replace(problem, requirement=requirement))
    roll, pitch = device.demands
    assert (roll.source, pitch.source) == ("rate change, roll", "rate change, pitch")
    inertia = np.diag(device.total.inertia)[:2]
    speed = 0.95 * min(device.line.no_load_speed, device.line.speed_max)
    shares = np.array([np.sin(device.incidence), np.cos(device.incidence)])
    expected = inertia / (2.0 * shares * speed)
    np.testing.assert_allclose([roll.spin_inertia, pitch.spin_inertia], expected, rtol=1e-9)
    if not {"h_min", "web"} & set(device.binding):
        assert roll.spin_inertia == pytest.approx(pitch.spin_inertia, rel=1e-3)


def direct_only(problem, **changes):
    return replace(problem, gears=(DIRECT,), **changes)


def refusal(problem):
    """The error of an infeasible problem, as from another process."""
    with pytest.raises(Infeasible) as caught:
        select(problem)
    return pickle.loads(pickle.dumps(caught.value))


@pytest.mark.exhaustive
def test_rejections_give_their_reasons():
    problem = direct_only(random_problem(9), incidence=None)
    best = select(problem).best
    strong = best.motor
    weak = replace(strong, name="weak", peak_torque=0.2 * strong.peak_torque)
    slow = replace(strong, name="slow", speed_max=0.002 * strong.speed_max)
    heavy = replace(strong, name="heavy", mass=5.0 * strong.mass)
    unknown = replace(strong, name="unknown", resistance=None, mass=None)
    fleet = (strong, weak, slow, heavy, unknown)
    # The five best motors and those of the ten lightest devices are not rejected.
    steels = tuple(replace(problem.materials[0], name=f"steel {index}") for index in range(10))
    twins = tuple(replace(strong, name=f"twin {index}") for index in range(4))
    selection = select(replace(problem, motors=(*fleet, *twins), materials=steels))
    rejected = {rejection.motor: rejection for rejection in selection.rejections}
    assert rejected["weak"].reason is Reason.TORQUE
    assert " s at best, " in rejected["weak"].detail
    assert rejected["slow"].reason in {Reason.ENVELOPE, Reason.MASS, Reason.SPEED}
    assert rejected["heavy"].reason is Reason.HEAVIER
    assert " g at least" in rejected["heavy"].detail
    assert rejected["unknown"].reason is Reason.FIGURES
    assert "mass" in rejected["unknown"].detail
    assert "resistance" in rejected["unknown"].detail
    assert strong.name not in rejected


def test_a_rim_that_would_burst():
    problem = direct_only(random_problem(9), incidence=None)
    weak_materials = tuple(
        replace(material, yield_strength=1e2, ultimate_strength=None)
        for material in problem.materials
    )
    error = refusal(replace(problem, materials=weak_materials))
    assert "stands" in error.message
    assert error.binding == ("hoop_stress",)


def test_the_closest_motor_is_not_one_without_any_rim():
    """A U15's rotor alone could turn Solo12, but r_max is a seventh of its hub."""
    robot = read_robot(SOLO12)
    specified = Specification(
        flywheel=FlywheelSection(r_max=0.012),
        motor=MotorSection(name="U15 II KV100, AT2820 KV1050"),
    )
    problem = selection_problem(Task.of(specified, robot))
    error = refusal(problem)
    assert "AT2820 KV1050 comes closest" in error.message
    wide = refusal(replace(problem, motors=problem.motors[:1]))
    assert (
        "around its hub or the smallest bore allowed its radius is at least 83.45 mm, and "
        "r_max allows 12 mm"
    ) in wide.message
    assert wide.nearest.shortfall == pytest.approx((83.45 / 12.0) ** 4 - 1.0, rel=1e-3)
    assert 0.0 < error.nearest.shortfall < wide.nearest.shortfall


@pytest.mark.slow
def test_a_refusal_names_sufficient_changes():
    """Each change is confirmed by a new search, and a slightly smaller one is not enough."""
    problem = direct_only(random_problem(9), incidence=None)
    best = select(problem).best
    motor = replace(best.motor, peak_torque=0.4 * best.motor.peak_torque)
    narrow = replace(problem, motors=(motor,))
    with pytest.raises(Infeasible) as caught:
        select(narrow)
    error = advice_on(caught.value)
    assert error.message.startswith(
        f"Motor {motor.name} cannot do it at {problem.supply.voltage:g} V"
    )
    assert "alone would do: " in error.hint
    assert "time" in error.relaxations
    match = re.search(r"([\w-]+) (height|duration|takeoff_velocity|settling) ", error.hint)
    assert match is not None
    assert match[1] in {maneuver.name for maneuver in narrow.requirement.maneuvers}
    limits = {limit.name: limit for limit in (BUS_VOLTAGE, TIME)}
    value = error.relaxations["time"]
    assert has_device(with_limit(narrow, limits["time"], value))
    assert not has_device(with_limit(narrow, limits["time"], value * (1.0 - ADVICE_PRECISION)))


def test_incomplete_problems_are_refused():
    problem = random_problem(9)
    empty = Requirement((), None, 1.0, None)
    with pytest.raises(UsageError, match="nothing is required"):
        select(replace(problem, requirement=empty))
    with pytest.raises(UsageError, match="no motors"):
        select(replace(problem, motors=()))
    with pytest.raises(UsageError, match="wheel_speed_max"):
        select(replace(problem, wheel_speed_max=-1.0))


@pytest.mark.slow
def test_a_specified_wheel_speed_is_a_limit():
    problem = random_problem(9)
    best = lightest(problem)
    fastest = max(demand.peak_speed for demand in best.demands)
    slower = lightest(replace(problem, wheel_speed_max=0.7 * fastest))
    assert max(demand.peak_speed for demand in slower.demands) <= 0.7 * fastest * (1.0 + 1e-12)
    assert slower.mass >= best.mass


def test_maneuvers_with_modules_turned_by_hand_do_not_affect_the_incidence():
    problem = direct_only(random_problem(9), incidence=None)
    roll = Disturbance(
        name="push", takeoff_velocity=(0.5, 2.0), torque=(0.2, 0.0, 0.0), onset=0.1, duration=0.05
    )
    flip = Flip(name="flip", gravity=1.62, incidence=0.0, jump_height=1.0, angle=-3.0, duration=2.0)
    motors = tuple(replace(motor, peak_torque=50.0) for motor in problem.motors)
    requirement = Requirement((roll, flip), None, 1.0, None)
    device = lightest(replace(problem, requirement=requirement, motors=motors))
    assert {demand.source: demand.incidence for demand in device.demands}["flip"] == 0.0
    assert device.incidence > 0.5  # Only roll is required at the design's own incidence.


def test_a_refusal_says_where_no_rim_fits():
    """Even if the rotor's inertia alone would be enough."""
    problem = random_problem(0)
    envelope = replace(problem.envelope, wall_min=2.0 * problem.envelope.outer_radius_max)
    with pytest.raises(Infeasible) as caught:
        select(replace(problem, envelope=envelope))
    assert "no rim fits at all" in str(caught.value)
    assert caught.value.largest_spin_inertia == 0.0
