"""The lightest device of a selected motor, gear and material that does its maneuvers in 3-D."""

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from ocs_design.requirement.maneuver import Maneuver
from ocs_design.sizing.co_design.device import device_mass, gyrostat
from ocs_design.sizing.co_design.problem import (
    CoDesign,
    CoDesignProblem,
    DeviceShape,
    ManeuverCheck,
)
from ocs_design.sizing.co_design.program import build_program, shape_of
from ocs_design.sizing.optimal_control.boundary import boundary
from ocs_design.sizing.optimal_control.flight import fly
from ocs_design.sizing.optimal_control.joint_program import (
    JointSolution,
    solve_jointly,
)
from ocs_design.sizing.optimal_control.solution import failure, fine_grid
from ocs_design.sizing.optimal_control.task import Task, maneuver_task

LEAST_GAIN = 1e-4
"""Of the mass: less is the program's own error, and the selection stands."""


def co_design(problem: CoDesignProblem) -> CoDesign:
    """All continuous figures of the device together with all maneuvers, least mass.

    Never heavier than the selection: where IPOPT fails, finds nothing lighter, or the fine grid
    does not bear its answer out, the selection stands and the note says why.
    """
    if problem.selection.requirement.spin_inertia is not None:
        return _untouched(problem, "the spin inertia is stated")
    began = perf_counter()
    tasks = [_task(problem, maneuver) for maneuver in problem.selection.requirement.maneuvers]
    solution = solve_jointly(*build_program(problem, tasks))
    shape = shape_of(problem, solution.figures)
    checks = _checks(problem, shape, tasks, solution)
    selected, found = float(problem.selected.mass), device_mass(problem, shape)
    wrong = _objection(solution, checks, found / selected)
    return CoDesign(
        adopted=not wrong,
        note=_standing(wrong) if wrong else _praise(found / selected),
        shape=problem.shape if wrong else shape,
        mass=selected if wrong else found,
        found_mass=found,
        selected_mass=selected,
        status=solution.answer.status,
        iterations=solution.iterations,
        seconds=perf_counter() - began,
        violation=solution.answer.violation,
        checks=checks,
    )


def _untouched(problem: CoDesignProblem, reason: str) -> CoDesign:
    mass = float(problem.selected.mass)
    return CoDesign(
        adopted=False,
        note=_standing(reason),
        shape=problem.shape,
        mass=mass,
        found_mass=mass,
        selected_mass=mass,
        status="not tried",
        iterations=0,
        seconds=0.0,
        violation=0.0,
        checks=(),
    )


def _task(problem: CoDesignProblem, maneuver: Maneuver) -> Task:
    asked = boundary(maneuver, problem.selection.requirement.standing_height)
    start = gyrostat(problem, _at_own_incidence(problem.shape, maneuver))
    return maneuver_task(start, problem.line, asked)


def _at_own_incidence(shape: DeviceShape, maneuver: Maneuver) -> DeviceShape:
    """The device with its modules turned by hand where the maneuver wants that."""
    own = maneuver.incidence
    return shape if own is None else replace(shape, incidence=own)


def _checks(
    problem: CoDesignProblem, shape: DeviceShape, tasks: Sequence[Task], solution: JointSolution
) -> tuple[ManeuverCheck, ...]:
    """Each maneuver's torques on the device as numbers give it."""
    line, maneuvers = problem.line, problem.selection.requirement.maneuvers
    found = []
    for maneuver, task, motion in zip(maneuvers, tasks, solution.motions, strict=True):
        device = gyrostat(problem, _at_own_incidence(shape, maneuver))
        flight = fly(device, task.asked, motion)
        found.append(
            ManeuverCheck(
                name=maneuver.name,
                fine=fine_grid(flight, motion, line, task.asked),
                peak_speed=float(np.abs(flight.wheel_speed).max()),
                peak_torque=float(np.abs(flight.wheel_torque).max()),
            )
        )
    return tuple(found)


def _objection(solution: JointSolution, checks: Sequence[ManeuverCheck], ratio: float) -> str:
    """Why the outcome is not taken, in a few words; empty if it is."""
    answer = solution.answer
    if not answer.solved:
        return f"IPOPT ended with {answer.status}"
    for check in checks:
        wrong = failure(answer.status, check.fine, solved=True)
        if wrong:
            return f"in {check.name!r}, {wrong}"
    if ratio > 1.0 - LEAST_GAIN:
        return (
            f"the co-design in 3-D found nothing lighter ({100.0 * (ratio - 1.0):+.2f} % of mass)"
        )
    return ""


def _standing(reason: str) -> str:
    return f"the selection stands: {reason}"


def _praise(ratio: float) -> str:
    return f"co-design in 3-D saves {1.0 - ratio:.2%} of the selection's mass"
