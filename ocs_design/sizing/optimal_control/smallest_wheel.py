"""The smallest spin inertia with which a drive can do a maneuver in 3-D, in the time it has."""

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from ocs_design.drive.line import DriveLine
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.incidence import module_axes
from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.flight import fly
from ocs_design.sizing.optimal_control.joint_program import (
    Figures,
    FreeTask,
    JointSolution,
    solve_jointly,
)
from ocs_design.sizing.optimal_control.plant import Plant
from ocs_design.sizing.optimal_control.solution import FineGrid, fine_grid
from ocs_design.sizing.optimal_control.task import Task, maneuver_task

_LEAST, _MOST = 1e-2, 1e2
"""Of the spin inertia, over the first guess."""

_NEAREST = 1e-3
"""Of a free incidence to 0 and to a right angle, where an axis gets out of reach [rad]."""


@dataclass(frozen=True, eq=False)
class SmallestWheel:
    """What the optimal control problem came to.

    Attributes:
        spin_inertia: h [kg m^2]. incidence: [rad].
        solved: whether IPOPT found a local optimum. status: IPOPT's own word.
        iterations: taken.
        fine: see `FineGrid`.
    """

    spin_inertia: float
    incidence: float
    solved: bool
    status: str
    iterations: int
    fine: FineGrid


def smallest_wheel(
    guess: Gyrostat, line: DriveLine, asked: Boundary, *, free_incidence: bool = False
) -> SmallestWheel:
    """The smallest spin inertia, and the incidence that goes with it if that is free.

    The inertia of the whole with its wheels braked stays as it is.

    Args:
        guess: robot and device where the search begins; its armature is kept.
        line: what of the drives may be used.
        asked: see `Boundary`.
        free_incidence: whether to look for the best one too.
    """
    task = maneuver_task(guess, line, asked)
    symbols = ca.SX.sym("figures", 2)
    plant = _plant(guess, symbols)
    incidence = float(np.arctan2(guess.axes[0, 0], guess.axes[1, 0]))
    low, high = (_NEAREST, np.pi / 2.0 - _NEAREST) if free_incidence else (incidence, incidence)
    figures = Figures(
        symbols=symbols,
        start=np.array([1.0, incidence]),
        lower=np.array([_LEAST, low]),
        upper=np.array([_MOST, high]),
        objective=symbols[0],
        excess=ca.SX(0, 1),
    )
    solution = solve_jointly(figures, [FreeTask(task, plant)])
    return _smallest(guess, line, task, solution)


def _plant(guess: Gyrostat, symbols: ca.SX) -> Plant:
    """The guess with its spin inertia scaled and its wheels turned."""
    factor, incidence = ca.vertsplit(symbols)
    fixed = Plant.of(guess)
    return replace(
        fixed,
        spin_inertia=fixed.spin_inertia * factor,
        sine=ca.sin(incidence),
        cosine=ca.cos(incidence),
    )


def _smallest(
    guess: Gyrostat, line: DriveLine, task: Task, solution: JointSolution
) -> SmallestWheel:
    factor, incidence = (float(figure) for figure in solution.figures)
    found = replace(guess, spin_inertia=guess.spin_inertia * factor, axes=module_axes(incidence))
    motion = solution.motions[0]
    return SmallestWheel(
        spin_inertia=found.spin_inertia,
        incidence=incidence,
        solved=solution.answer.solved,
        status=solution.answer.status,
        iterations=solution.iterations,
        fine=fine_grid(fly(found, task.asked, motion), motion, line, task.asked),
    )
