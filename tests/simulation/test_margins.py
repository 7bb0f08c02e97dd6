"""Motions that set a margin: the plans, and all of the flights."""

from dataclasses import replace

import numpy as np
import pytest
from campaigns import zero_metrics
from designed_devices import MOTOR, design_with_motor

from ocs_design.catalogue.materials import material
from ocs_design.requirement.pivoted import StandUp
from ocs_design.simulation.margins import record_margins
from ocs_design.simulation.run import Run, Series
from ocs_design.sizing.buildable import buildable_of
from ocs_design.sizing.trajectory.motion import Trajectory
from ocs_design.sizing.trajectory.plans import Reference

TIME = np.linspace(0.0, 0.4, 41)
LANDED = 0.3
AFTER = TIME > LANDED


def run(scenario, *, speed=500.0, torque=0.2, ocs=True, impact=1.0):
    """A flight with constant wheel speeds and torques, multiplied by `impact` after touchdown."""
    factor = np.where(AFTER, impact, 1.0)[:, None]
    still, zeros = np.zeros((TIME.size, 3)), np.zeros(TIME.size)
    series = Series(
        time=TIME, com=still, roll=zeros, pitch=zeros, yaw=zeros, rate=still,
        wheel_speed=speed * factor * [1.0, -0.5], wheel_torque=torque * factor * [-1.0, 0.5],
        torque_lowest=None, torque_highest=None, contact=AFTER, wheels=("left", "right"),
    )  # fmt: skip
    metrics = zero_metrics(touchdown_time=LANDED, peak_wheel_speed=speed, peak_wheel_torque=torque)
    return Run(scenario, ocs, True, "", metrics, series, "", True)


def recorded(runs=(), plans=None, motor=MOTOR):
    task, sizing = design_with_motor(motor)
    margins = record_margins(task.resolved, sizing, runs, plans or {})
    return {margin.name: margin for margin in margins}


def planned(speed):
    wheel_speed = np.broadcast_to([speed, 0.0], (TIME.size, 2))
    zeros = np.zeros((TIME.size, 3))
    vertical = np.broadcast_to([0.0, 0.0, 1.0], (TIME.size, 3))
    plan = Trajectory(TIME, vertical, zeros, zeros, wheel_speed, 0.0 * wheel_speed, "")
    return Reference(plan, "")


def test_margins_include_the_landing():
    smooth, hard = recorded([run("drop")]), recorded([run("drop", impact=2.0)])
    for name in ("wheel speed", "motor speed", "motor torque"):
        friction = smooth["motor torque"].demand - 0.2 if name == "motor torque" else 0.0
        expected = 2.0 * (smooth[name].demand - friction) + friction
        assert hard[name].demand == pytest.approx(expected)
    # The wheels of these runs are braked.
    assert hard["bus power, fed back"].demand > smooth["bus power, fed back"].demand > 0.0
    assert hard["winding heat"].demand > smooth["winding heat"].demand


def test_a_mean_excludes_the_time_at_rest():
    at_rest, in_motion = recorded([run("drop", impact=0.0)]), recorded([run("drop")])
    assert at_rest["rms current"].demand == pytest.approx(in_motion["rms current"].demand)


def test_the_worst_maneuver_sets_a_margin():
    margins = recorded([run("drop", speed=900.0), run("disturbance", speed=400.0, torque=0.3)])
    speed, torque = margins["wheel speed"], margins["motor torque"]
    assert (speed.scenario, speed.demand) == ("drop", 900.0)
    assert torque.scenario == "disturbance"


def test_the_bare_robot_has_no_wheels():
    flown = run("drop")
    assert recorded([flown, run("disturbance", speed=5000.0, ocs=False)]) == recorded([flown])


def test_the_worst_of_plan_and_flight_sets_a_margin():
    plans = {"drop": planned(1234.0), "disturbance": Reference(None, "unforeseen")}
    assert recorded(plans=plans)["wheel speed"].demand == 1234.0
    assert recorded([run("drop")], plans)["wheel speed"].demand == 1234.0
    assert recorded([run("drop", speed=1300.0)], plans)["wheel speed"].demand == 1300.0


def test_margins_include_the_wheel_speed_before_braking():
    margins = recorded(plans={"drop": replace(planned(10.0), braked_speed=1234.0)})
    assert margins["wheel speed"].demand == 1234.0
    assert (
        margins["stored energy"].demand
        > recorded(plans={"drop": planned(1233.0)})["stored energy"].demand
    )


def test_without_flight_or_plan_there_are_margins_of_dimensions():
    assert list(recorded())[-3:] == ["outer radius", "height", "rim mass"]


def test_wheels_without_a_motor_have_margins_of_speed_and_stress():
    margins = recorded([run("drop", speed=900.0), run("disturbance", torque=0.3)], motor="none")
    speed, torque = margins["wheel speed"], margins["motor torque"]
    task, device = design_with_motor("none")
    assert (speed.demand, torque.demand, torque.capacity) == (900.0, 0.3, None)
    assert speed.capacity == task.resolved.requirement.wheel_speed_max
    assert speed.margin == pytest.approx(speed.capacity / 900.0)
    stress = margins["hoop stress"]
    assert stress.demand == device.device.flywheel.hoop_stress
    assert stress.margin == pytest.approx(device.device.flywheel.stress_margin)


def braked_margins(sizing):
    """A stand-up by a brake from 400 rad/s, and the margins of a design for Solo12."""
    task, _ = design_with_motor()
    edge = {"pivot": (0.0, 0.0, -0.24), "edge": (0.0, 1.0, 0.0)}
    up = StandUp(name="up", **edge, pitch=0.5, duration=1.0, actuation="brake")
    up = up.on(sizing.sized.total)
    requirement = replace(task.resolved.requirement, maneuvers=(up,))
    plans = {"up": replace(planned(100.0), braked_speed=400.0)}
    margins = record_margins(replace(task.resolved, requirement=requirement), sizing, (), plans)
    return up, {margin.name: margin for margin in margins}


def test_braking_loads_the_wheel_and_the_shaft_joint():
    """J W / t of the wheel, 1.5 J_r W / t of the rotor; the wheel is fastest before braking."""
    _, sizing = design_with_motor()
    up, margins = braked_margins(sizing)
    wheel, drive = sizing.device.flywheel, sizing.device.motor
    assert margins["wheel speed"].demand == 400.0
    assert margins["brake torque"].demand == pytest.approx(
        wheel.spin_inertia * 400.0 / up.braking_time
    )
    shaft = margins["shaft joint, braked"]
    assert shaft.demand == pytest.approx(1.5 * drive.rotor_inertia * 400.0 / up.braking_time)
    assert shaft.capacity == margins["shaft joint"].capacity
    assert "from 3,820 rpm in 3.8 ms" in shaft.note
    assert shaft.scenario == "up"
    assert "rim joint, braked" not in margins


def test_braking_loads_a_shrink_fit_too():
    """1.5 J W / t of the wheel, if the brake acts on the web, is more than the fit holds."""
    task, sizing = design_with_motor()
    wheel, aluminium = sizing.device.flywheel, material("aluminium-6061-t6")
    web = replace(wheel.web, material=aluminium.name, density=aluminium.density)
    shrunk = replace(sizing.device, flywheel=replace(wheel, web=web))
    sizing = replace(sizing, device=shrunk)
    _, margins = braked_margins(sizing)
    rim_joint = margins["rim joint, braked"]
    assert rim_joint.demand == pytest.approx(1.5 * margins["brake torque"].demand)
    assert rim_joint.capacity == margins["rim joint"].capacity
    assert rim_joint.margin < 1.0
    open_points = buildable_of(task.robot, sizing, tuple(margins.values()), None).open
    (point,) = [point for point in open_points if point.what.startswith("rim joint, braked")]
    assert "--web disc" in point.cure
