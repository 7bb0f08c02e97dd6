"""Co-design against selection: mass of the device, what IPOPT made of it, and how long it took.

    python benchmarks/co_design.py [ROBOT ...]

Prints a Markdown table for five robots and three sets of maneuvers: the defaults, in which the
back-flip about one axis often decides; without it, the drop rolled by 10 deg as well; the same
drop at half the angles. Goals: never heavier, and below 10 s for Solo12.
"""

import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from math import degrees, radians

from paired import ROBOTS

from ocs_design.common.errors import Infeasible
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.select import select, with_demands
from ocs_design.sizing.specified import selection_problem
from ocs_design.sizing.trajectory.co_design import co_design

FILES = {
    "Solo12": "solo_description/robots/solo12.urdf",
    "A1": "a1_description/urdf/a1.urdf",
    "ANYmal C": "anymal_c_simple_description/urdf/anymal.urdf",
    "Go2": "go2_description/urdf/go2.urdf",
    "Bolt": "bolt_description/robots/bolt.urdf",
}
HEADER = (
    "| robot | maneuvers | motor | selection | co-design | gain | incidence | status | iterations "
    "| violation | time |\n|---|---|---|---|---|---|---|---|---|---|---|"
)


def main() -> None:
    print(f"imports, in a cold process: {import_time():.2f} s\n\n{HEADER}")
    for name in sys.argv[1:] or FILES:
        for label, problem in variants(robot_problem(name)):
            print(f"| {name} | {label} | {row(problem)} |", flush=True)


def import_time() -> float:
    """Of all that the co-design needs, CasADi among it [s]."""
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", f"import {co_design.__module__}"], check=True)
    return time.perf_counter() - began


def robot_problem(name: str) -> SelectionProblem:
    """With the default maneuvers and all of the catalogue."""
    path = ROBOTS / FILES[name]
    robot = read_robot(path)
    specification = Specification(robot=RobotSection(file=str(path)))
    problem = selection_problem(Task.of(specification, robot))
    if problem is None:
        raise TypeError("the default specification wants a motor")
    return problem


def variants(problem: SelectionProblem) -> Iterator[tuple[str, SelectionProblem]]:
    yield "default", problem
    for label, share in (("rolled drop", 1.0), ("gentle drop", 0.5)):
        kept = (m for m in problem.requirement.maneuvers if not isinstance(m, Flip))
        maneuvers = tuple(
            replace(m, pitch=share * m.pitch, roll=share * radians(10.0))
            if isinstance(m, Drop)
            else m
            for m in kept
        )
        yield label, replace(problem, requirement=replace(problem.requirement, maneuvers=maneuvers))


def row(problem: SelectionProblem) -> str:
    try:
        chosen = with_demands(problem, select(problem).best)
    except Infeasible:
        return " | ".join(["none", *["–"] * 8])
    start = time.perf_counter()
    result = co_design(problem, chosen)
    seconds = time.perf_counter() - start
    return (
        f"{chosen.motor.name}, {chosen.gear.name} | {1e3 * result.selected_mass:.1f} g "
        f"| {1e3 * result.device.mass:.1f} g | {result.gain:+.2%} "
        f"| {degrees(chosen.incidence):.1f}° to {degrees(result.device.incidence):.1f}° "
        f"| {result.status} | {result.iterations} | {result.fine_violation:.0e} "
        f"| {seconds:.1f} s"
    )


if __name__ == "__main__":
    main()
