"""A device's figures and all of its maneuvers as one nonlinear program."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.optimal_control.mesh import refined
from ocs_design.sizing.optimal_control.motion import Motion
from ocs_design.sizing.optimal_control.nonlinear_program import (
    Answer,
    Constraint,
    Program,
    Unknown,
    solve_program,
)
from ocs_design.sizing.optimal_control.plant import Plant
from ocs_design.sizing.optimal_control.task import Task
from ocs_design.sizing.optimal_control.transcription import transcribe

PASSES = (48,)
"""Intervals of the passes after the first one."""

EFFORT_WEIGHT = 1e-4
"""Of each maneuver's mean square of the torques beside the objective, both around one.

Of all ways through a maneuver that does not decide it makes the gentlest the only one; without it
IPOPT wanders among them. It costs less of the objective than the collocation's own error.
"""


@dataclass(frozen=True, eq=False)
class Figures:
    """The device's figures that are free.

    Attributes:
        symbols: (n, 1), scaled to be around one.
        start, lower, upper: shape (n,).
        objective: to be minimised, a function of the symbols.
        excess: functions of the symbols that must not be positive, scaled, (m, 1).
    """

    symbols: ca.SX
    start: FloatArray
    lower: FloatArray
    upper: FloatArray
    objective: ca.SX
    excess: ca.SX


@dataclass(frozen=True, eq=False)
class FreeTask:
    """A maneuver of a robot whose plant depends on the figures."""

    task: Task
    plant: Plant


@dataclass(frozen=True, eq=False)
class JointSolution:
    """What the program came to.

    Attributes:
        figures: found, scaled as `Figures.symbols`, shape (n,).
        motions: of each maneuver.
        answer: of the last pass that was solved; of the first if none was.
        iterations: of all passes.
    """

    figures: FloatArray
    motions: tuple[Motion, ...]
    answer: Answer
    iterations: int


def solve_jointly(
    figures: Figures, tasks: Sequence[FreeTask], passes: Sequence[int] = PASSES
) -> JointSolution:
    """Solve on even intervals, then again on more that follow the torques.

    Args:
        figures: see `Figures`.
        tasks: of all maneuvers, with guesses on even intervals.
        passes: number of intervals of each pass after the first.
    """
    solution = _solve(figures, tasks)
    iterations = solution.answer.iterations
    for intervals in passes if solution.answer.solved else ():
        figures = replace(figures, start=solution.figures)
        tasks = [
            replace(each, task=replace(each.task, guess=motion.onto(refined(motion, intervals))))
            for each, motion in zip(tasks, solution.motions, strict=True)
        ]
        finer = _solve(figures, tasks)
        iterations += finer.answer.iterations
        if not finer.answer.solved:
            break
        solution = finer
    return replace(solution, iterations=iterations)


def _solve(figures: Figures, tasks: Sequence[FreeTask]) -> JointSolution:
    """On the intervals of the guesses."""
    free = Unknown(
        ca.MX.sym("figures", figures.symbols.numel()),
        figures.start[:, None],
        figures.lower[:, None],
        figures.upper[:, None],
    )
    parts = [
        transcribe(each.task, _on(figures, each.plant.packed(), free.symbol), ca.MX(1.0))
        for each in tasks
    ]
    answer = solve_program(
        Program(
            unknowns=[free, *(unknown for part in parts for unknown in part.unknowns)],
            constraints=[
                Constraint(_on(figures, figures.excess, free.symbol), -np.inf, 0.0),
                *(constraint for part in parts for constraint in part.constraints),
            ],
            objective=_on(figures, figures.objective, free.symbol)
            + EFFORT_WEIGHT * sum((part.effort for part in parts), ca.MX(0.0)),
        )
    )
    found, values = answer.values[0].ravel(), iter(answer.values[1:])
    motions = tuple(
        part.motion(*(next(values) for _ in part.unknowns), duration=each.task.units.time)
        for part, each in zip(parts, tasks, strict=True)
    )
    return JointSolution(found, motions, answer, answer.iterations)


def _on(figures: Figures, expression: ca.SX, symbol: ca.MX) -> ca.MX:
    """A function of the figures, of the program's own variable."""
    return ca.Function("of_figures", [figures.symbols], [expression])(symbol)
