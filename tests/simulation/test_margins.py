"""Which motions a margin is about: what was planned, and all of what was flown."""

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


def run(scenario, *, speed=500.0, torque=0.2, ocs=True, knock=1.0):
    """A flight with steady wheels; whatever comes after touchdown is `knock` times that."""
    wild = np.where(AFTER, knock, 1.0)[:, None]
    still, zeros = np.zeros((TIME.size, 3)), np.zeros(TIME.size)
    series = Series(
        time=TIME, com=still, roll=zeros, pitch=zeros, yaw=zeros, rate=still,
        wheel_speed=speed * wild * [1.0, -0.5], wheel_torque=torque * wild * [-1.0, 0.5],
        torque_lowest=None, torque_highest=None, contact=AFTER, wheels=("left", "right"),
    )  # fmt: skip
    metrics = zero_metrics(touchdown_time=LANDED, peak_wheel_speed=speed, peak_wheel_torque=torque)
    return Run(scenario, ocs, True, "", metrics, series, "", True)


def recorded(runs=(), plans=None, motor=MOTOR):
    task, found = design_with_motor(motor)
    margins = record_margins(task.resolved, found, runs, plans or {})
    return {margin.name: margin for margin in margins}


def planned(speed):
    turning = np.broadcast_to([speed, 0.0], (TIME.size, 2))
    still = np.zeros((TIME.size, 3))
    upright = np.broadcast_to([0.0, 0.0, 1.0], (TIME.size, 3))
    return Reference(Trajectory(TIME, upright, still, still, turning, 0.0 * turning, ""), "")


def test_a_landing_is_asked_of_the_drive_too():
    calm, knocked = recorded([run("drop")]), recorded([run("drop", knock=2.0)])
    for name in ("wheel speed", "motor speed", "motor torque"):
        rubbed = calm["motor torque"].demand - 0.2 if name == "motor torque" else 0.0
        twice = 2.0 * (calm[name].demand - rubbed) + rubbed
        assert knocked[name].demand == pytest.approx(twice)
    # The wheels of these runs are braked.
    assert knocked["bus power, fed back"].demand > calm["bus power, fed back"].demand > 0.0
    assert knocked["winding heat"].demand > calm["winding heat"].demand


def test_a_mean_over_time_is_not_thinned_by_standing_still():
    resting, working = recorded([run("drop", knock=0.0)]), recorded([run("drop")])
    assert resting["rms current"].demand == pytest.approx(working["rms current"].demand)


def test_the_worst_maneuver_sets_a_margin():
    found = recorded([run("drop", speed=900.0), run("disturbance", speed=400.0, torque=0.3)])
    speed, torque = found["wheel speed"], found["motor torque"]
    assert (speed.scenario, speed.demand) == ("drop", 900.0)
    assert torque.scenario == "disturbance"


def test_the_bare_robot_has_no_wheels():
    flown = run("drop")
    assert recorded([flown, run("disturbance", speed=5000.0, ocs=False)]) == recorded([flown])


def test_the_worst_is_over_plan_and_flight():
    plans = {"drop": planned(1234.0), "disturbance": Reference(None, "unforeseen")}
    assert recorded(plans=plans)["wheel speed"].demand == 1234.0
    assert recorded([run("drop")], plans)["wheel speed"].demand == 1234.0
    assert recorded([run("drop", speed=1300.0)], plans)["wheel speed"].demand == 1300.0


def test_wheels_before_a_brake_are_asked_of_the_drive_too():
    found = recorded(plans={"drop": replace(planned(10.0), spun=1234.0)})
    assert found["wheel speed"].demand == 1234.0
    assert (
        found["stored energy"].demand
        > recorded(plans={"drop": planned(1233.0)})["stored energy"].demand
    )


def test_without_flight_or_plan_there_is_still_the_room():
    assert list(recorded())[-3:] == ["outer radius", "height", "rim mass"]


def test_wheels_without_a_motor_say_what_they_can():
    found = recorded([run("drop", speed=900.0), run("disturbance", torque=0.3)], motor="none")
    speed, torque = found["wheel speed"], found["motor torque"]
    task, device = design_with_motor("none")
    assert (speed.demand, torque.demand, torque.capacity) == (900.0, 0.3, None)
    assert speed.capacity == task.resolved.requirement.wheel_speed_max
    assert speed.margin == pytest.approx(speed.capacity / 900.0)
    stress = found["hoop stress"]
    assert stress.demand == device.device.flywheel.hoop_stress
    assert stress.margin == pytest.approx(device.device.flywheel.stress_margin)


def braked(found):
    """A stand-up by a brake from 400 rad/s, and margins of a design of Solo12's that makes it."""
    task, _ = design_with_motor()
    edge = {"pivot": (0.0, 0.0, -0.24), "edge": (0.0, 1.0, 0.0)}
    up = StandUp(name="up", **edge, pitch=0.5, duration=1.0, actuation="brake")
    up = up.on(found.sized.total)
    asked = replace(task.resolved.requirement, maneuvers=(up,))
    plans = {"up": replace(planned(100.0), spun=400.0)}
    margins = record_margins(replace(task.resolved, requirement=asked), found, (), plans)
    return up, {margin.name: margin for margin in margins}


def test_a_brake_is_asked_of_the_wheel_and_of_what_holds_its_rotor():
    """J W / t of the wheel, 1.5 J_r W / t of the rotor; the wheel turns fastest before it."""
    _, found = design_with_motor()
    up, rows = braked(found)
    wheel, drive = found.device.flywheel, found.device.motor
    assert rows["wheel speed"].demand == 400.0
    assert rows["brake torque"].demand == pytest.approx(wheel.spin_inertia * 400.0 / up.stop)
    held = rows["shaft joint, braked"]
    assert held.demand == pytest.approx(1.5 * drive.rotor_inertia * 400.0 / up.stop)
    assert held.capacity == rows["shaft joint"].capacity
    assert "from 3,820 rpm in 3.8 ms" in held.note
    assert held.scenario == "up"
    assert "rim joint, braked" not in rows


def test_a_brake_is_asked_of_a_shrink_fit_too():
    """1.5 J W / t of the wheel, should the brake grip the web: more than its fit is made for."""
    task, found = design_with_motor()
    wheel, aluminium = found.device.flywheel, material("aluminium-6061-t6")
    web = replace(wheel.web, material=aluminium.name, density=aluminium.density)
    shrunk = replace(found.device, flywheel=replace(wheel, web=web))
    found = replace(found, device=shrunk)
    _, rows = braked(found)
    held = rows["rim joint, braked"]
    assert held.demand == pytest.approx(1.5 * rows["brake torque"].demand)
    assert held.capacity == rows["rim joint"].capacity
    assert held.margin < 1.0
    opened = buildable_of(task.robot, found, tuple(rows.values()), None).open
    (point,) = [point for point in opened if point.what.startswith("rim joint, braked")]
    assert "--web disc" in point.cure
