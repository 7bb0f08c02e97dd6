"""Where the modules go on every legged robot of example-robot-data, and what that takes.

    python benchmarks/placement.py [PART_OF_A_NAME ...]

Prints a Markdown table for devices without motors: where the left module of the largest size goes,
and how far the designed device is from the nearest link in the nominal posture and while the legs
give way.
"""

import sys
import time

import numpy as np
from legged_robots import LEGGED
from paired import ROBOTS

from ocs_design.common.errors import OcsError
from ocs_design.device.records.device import Clearance
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import NO_MOTOR
from ocs_design.robot.collision import collision_model
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.design import design_device
from ocs_design.sizing.free_place import Sizes, place_free
from ocs_design.sizing.mounting import mounting_of


def main() -> None:
    print("| robot | where | left at [mm] | nearest [mm] | legs give way [mm] | s |")
    print("|---|---|---|---|---|---|")
    for name in LEGGED:
        if not sys.argv[1:] or any(word in name for word in sys.argv[1:]):
            print(f"| {name.rpartition('/')[2]} | {row(name)} |", flush=True)


def row(name: str) -> str:
    path = ROBOTS / f"{name}.urdf"
    specification = Specification(
        robot=RobotSection(file=str(path)), motor=MotorSection(name=NO_MOTOR)
    )
    robot = read_robot(path)
    task = Task.of(specification, robot)
    resolved = task.resolved
    start = time.perf_counter()
    collision_model(robot)
    placing = place_free(robot, resolved.envelope)
    seconds = time.perf_counter() - start
    center = placing.place.centers(Sizes.of(resolved.envelope).largest)[0]
    at = ", ".join(f"{1e3 * float(value):.0f}" for value in np.array(center))
    where = f"{placing.face} the trunk" if placing.free else "none is free"
    try:
        designed = design_device(task)
    except OcsError as error:
        return f"{where} | {at} | {error.kind} | | {seconds:.2f}"
    start = time.perf_counter()
    mounting = mounting_of(
        robot, designed.device, resolved.requirement.maneuvers, designed.sized.total
    )
    seconds += time.perf_counter() - start
    clearances = f"{clearance_text(mounting.nearest)} | {clearance_text(mounting.landing)}"
    return f"{where} | {at} | {clearances} | {seconds:.2f}"


def clearance_text(clearance: Clearance | None) -> str:
    return "-" if clearance is None else f"{clearance.part} {1e3 * clearance.distance:.1f}"


if __name__ == "__main__":
    main()
