"""Which motion a margin is about: flown up to touchdown, else planned."""

import numpy as np
import pytest
from designed import designed

from ocs_design.simulation.metrics import Metrics, Series
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.trajectory.flight import Trajectory
from ocs_design.sizing.trajectory.plans import Reference
from ocs_design.workflows.recording import record_margins

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
        torque_lowest=None, torque_highest=None, contact=AFTER,
    )  # fmt: skip
    metrics = Metrics(
        LANDED, 0.0, 0.0, 0.0, 0.0, 0.0, speed, torque, 0.0, True, 0.0, 0.0,
        roll_swing=0.0, pitch_swing=0.0, settling_time=0.0, lift_off_time=0.0, rise=0.0,
        nutation=0.0, final_wheel_speed=0.0,
    )  # fmt: skip
    return Run(scenario, ocs, True, "", metrics, series, "", True)


def recorded(runs=(), plans=None, motor=None):
    task, found = designed() if motor is None else designed(motor)
    margins = record_margins(task.resolved, found, runs, plans or {})
    return {margin.name: margin for margin in margins}


def planned(speed):
    turning = np.broadcast_to([speed, 0.0], (TIME.size, 2))
    still = np.zeros((TIME.size, 3))
    upright = np.broadcast_to([0.0, 0.0, 1.0], (TIME.size, 3))
    return Reference(
        Trajectory(
            time=TIME, vertical=upright, rate=still, acceleration=still, wheel_speed=turning,
            wheel_torque=0.0 * turning, turned=0.0 * TIME, note="",
        ),
        "",
        None,
    )  # fmt: skip


def test_a_landing_is_no_part_of_a_maneuver():
    assert recorded([run("drop", knock=9.0)]) == recorded([run("drop")])


def test_the_worst_maneuver_sets_a_margin():
    found = recorded([run("drop", speed=900.0), run("disturbance", speed=400.0, torque=0.3)])
    speed, torque = found["wheel speed, to no load"], found["torque, to the current limit"]
    assert (speed.maneuver, speed.demand) == ("drop", 900.0)
    assert (torque.maneuver, torque.demand) == ("disturbance", pytest.approx(0.3))


def test_the_bare_robot_has_no_wheels():
    flown = run("drop")
    assert recorded([flown, run("disturbance", speed=5000.0, ocs=False)]) == recorded([flown])


def test_what_was_flown_goes_before_what_was_planned():
    plans = {"drop": planned(1234.0), "disturbance": Reference(None, "unforeseen", None)}
    assert recorded(plans=plans)["wheel speed, to no load"].demand == 1234.0
    assert recorded([run("drop")], plans)["wheel speed, to no load"].demand == 500.0


def test_without_flight_or_plan_there_is_still_the_room():
    assert list(recorded()) == ["outer radius", "height", "rim mass"]


def test_wheels_without_a_motor_say_what_they_can():
    found = recorded([run("drop", speed=900.0), run("disturbance", torque=0.3)], motor="none")
    speed, torque = found["wheel speed in flight"], found["wheel torque in flight"]
    task, device = designed("none")
    assert (speed.demand, torque.demand, torque.capacity) == (900.0, 0.3, None)
    assert speed.capacity == task.resolved.requirement.wheel_speed_max
    assert speed.margin == pytest.approx(speed.capacity / 900.0)
    stress = found["hoop stress, to yield"]
    assert stress.demand == device.device.flywheel.hoop_stress
    assert stress.margin == pytest.approx(device.device.flywheel.stress_margin)
