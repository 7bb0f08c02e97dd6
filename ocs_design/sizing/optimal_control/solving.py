"""Maneuvers of a given robot and drive as optimal control problems in 3-D."""

import casadi as ca

from ocs_design.drive.line import DriveLine
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.flight import fly
from ocs_design.sizing.optimal_control.nonlinear_program import (
    Program,
    Unknown,
    solve_program,
)
from ocs_design.sizing.optimal_control.plant import Plant
from ocs_design.sizing.optimal_control.solution import (
    ManeuverSolution,
    Objective,
    fine_grid,
    trajectory_of,
)
from ocs_design.sizing.optimal_control.task import maneuver_task
from ocs_design.sizing.optimal_control.transcription import transcribe

INTERVALS = 24

_QUICKEST = 0.02
"""Shortest time that is looked for, over the time that the maneuver has."""


def solve_maneuver(
    gyrostat: Gyrostat,
    line: DriveLine,
    asked: Boundary,
    objective: Objective = Objective.EFFORT,
    intervals: int = INTERVALS,
) -> ManeuverSolution:
    """The best way through a maneuver, from the start of its turn to rest.

    On an axis that the wheels do not reach nothing is asked of the end.

    Args:
        gyrostat: robot and device, at the incidence of the maneuver.
        line: what of the drives may be used.
        asked: see `Boundary`.
        objective: what to minimise.
        intervals: of the collocation.
    """
    task = maneuver_task(gyrostat, line, asked, intervals)
    quickest = _QUICKEST if objective is Objective.TIME else 1.0
    share = Unknown(ca.MX.sym("share"), 1.0, quickest, 1.0)
    part = transcribe(task, ca.MX(ca.evalf(Plant.of(gyrostat).packed())), share.symbol)
    goal = share.symbol if objective is Objective.TIME else part.effort
    answer = solve_program(Program([*part.unknowns, share], part.constraints, goal))
    *values, share_found = answer.values
    duration = share_found.item() * task.units.time
    motion = part.motion(*values, duration=duration)
    flight = fly(gyrostat, asked, motion)
    effort = answer.objective * task.units.torque**2 * duration
    return ManeuverSolution(
        name=asked.name,
        objective=objective,
        solved=answer.solved,
        status=answer.status,
        iterations=answer.iterations,
        value=duration if objective is Objective.TIME else effort,
        duration=duration,
        violation=answer.violation,
        fine=fine_grid(flight, motion, line, asked),
        trajectory=trajectory_of(flight, task.axis),
    )
