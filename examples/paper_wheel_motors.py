"""The wheel of the paper on each motor of the catalogue: which of its three experiments it can do.

    python examples/paper_wheel_motors.py [VOLTAGE]

Solo12 with two rims of R 30 mm, r 22 mm and h 10 mm at 40 deg (0 deg for the back-flip), each on
the shaft of its motor: the rotor adds to the rim's spin inertia, the motor's mass to the trunk. The
paper flies the same wheels without motors. Takes about a minute.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ocs_design.actuation.drive import drive_line, missing_figures
from ocs_design.actuation.motor import DIRECT, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import material
from ocs_design.catalogue.motors import motors
from ocs_design.device.device import Device, modules_at
from ocs_design.parts.module import drive_moments
from ocs_design.parts.solids import Carrier
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.reading import read_specification
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot
from ocs_design.simulation.metrics import measure
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.verdict import Verdict, judge
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.driven_wheel import DrivenWheel
from ocs_design.sizing.free_place import place_on_top

ROBOT = Path(__file__).with_name("solo12.urdf")
MANEUVERS = read_specification(ROBOT.with_suffix(".toml")).maneuvers  # the paper's
INNER_RADIUS, OUTER_RADIUS, HEIGHT = 0.022, 0.03, 0.01  # m
INCIDENCE = np.radians(40.0)
BATCH = 50  # devices that fly at once


def main() -> None:
    """Fly every motor and print what it did."""
    voltage = float(sys.argv[1]) if len(sys.argv) > 1 else 24.0
    robot, maneuvers = read_robot(ROBOT), MANEUVERS
    known = [motor for motor in motors().values() if not missing_figures(motor, DIRECT)]
    devices = [on_paper_wheel(robot, motor, voltage) for motor in known]
    rows = sorted(
        zip(devices, fly(robot, devices, maneuvers), strict=True), key=lambda row: row[0].mass
    )
    print(f"{len(rows)} motors at {voltage:g} V, {len(motors()) - len(rows)} lack a figure")
    names = "  ".join(maneuver.name for maneuver in maneuvers)
    print(f"{'motor':28s}{'[g]':>6}{'[rpm]':>8}{'[N m]':>7}  {names}")
    for device, verdicts in rows:
        print(line(device, maneuvers, verdicts))
    best = [device for device, verdicts in rows if all(verdict.passed for verdict in verdicts)]
    print(f"{len(best)} do all three; the lightest: {best[0].motor.name}, {best[0].mass:.3f} kg")


def on_paper_wheel(robot: Robot, motor: Motor, voltage: float) -> Device:
    """Two wheels of the paper's table 2 with that motor."""
    wheel = DrivenWheel(
        inner_radius=INNER_RADIUS,
        outer_radius=OUTER_RADIUS,
        height=HEIGHT,
        material=material("steel-4140-qt"),
        motor=motor,
        gear=DIRECT,
        line=drive_line(motor, DIRECT, voltage),
        supply=Supply(voltage),
    )
    modules = modules_at(place_on_top(robot)(OUTER_RADIUS, HEIGHT), INCIDENCE)
    carrier = Carrier.of(drive_moments(motor))
    return Device(INCIDENCE, modules, wheel.flywheel, wheel.drive, carrier)


def fly(
    robot: Robot, devices: Sequence[Device], maneuvers: Sequence[Maneuver]
) -> list[list[Verdict]]:
    """The verdict on each maneuver, device by device."""
    verdicts = []
    for first in range(0, len(devices), BATCH):
        builders = [WorldBuilder(robot, device) for device in devices[first : first + BATCH]]
        worlds = [
            builder.flight(maneuver, Wheels.ACTIVE)
            for builder in builders
            for maneuver in maneuvers
        ]
        recording = simulate(worlds)
        metrics = [measure(recording, i, world) for i, world in enumerate(worlds)]
        flown = [metrics[i : i + len(maneuvers)] for i in range(0, len(metrics), len(maneuvers))]
        verdicts += [
            [
                judge(measured, maneuver, can_stand=True)
                for measured, maneuver in zip(of_device, maneuvers, strict=True)
            ]
            for of_device in flown
        ]
    return verdicts


def line(device: Device, maneuvers: Sequence[Maneuver], verdicts: Sequence[Verdict]) -> str:
    """One row of the table."""
    motor = device.motor
    speed = min(motor.no_load_speed, motor.speed_max or np.inf) * 30.0 / np.pi
    marks = {True: "yes", False: "no", None: "?"}
    done = "  ".join(
        f"{marks[verdict.passed]:{len(maneuver.name)}}"
        for maneuver, verdict in zip(maneuvers, verdicts, strict=True)
    )
    return f"{motor.name:28s}{motor.mass * 1e3:6.0f}{speed:8.0f}{motor.torque_limit:7.2f}  {done}"


if __name__ == "__main__":
    main()
