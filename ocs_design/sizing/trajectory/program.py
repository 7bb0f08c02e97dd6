"""The trajectory program: maneuvers of one robot, and the device's dimensions if they are free."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import isfinite
from threading import Lock
from typing import Any

import casadi as ca
import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.sizing.trajectory.motion import Motion
from ocs_design.sizing.trajectory.transcription import (
    Phase,
    Plant,
    ProgramStructure,
    Variables,
    numbers_of,
    transcribe,
)

IPOPT_OPTIONS: dict[str, Any] = {
    "ipopt.tol": 1e-8,
    "ipopt.acceptable_iter": 0,
    # Bounds are strict: a rim must not exceed its envelope even by 1e-8 of it.
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.linear_solver": "mumps",
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
}

PLAN_OPTIONS: dict[str, Any] = {
    # A plan need not be optimal to eight digits, but must satisfy its equations: peaks are flat,
    # and some feasible plans were given up for the last two digits of their power.
    "ipopt.tol": 1e-5,
    "ipopt.constr_viol_tol": 1e-8,
    # Infeasibility is detected sooner.
    "ipopt.expect_infeasible_problem": "yes",
    "ipopt.max_resto_iter": 25,
}
"""Options in addition to `IPOPT_OPTIONS`, where no dimension is free."""

ITERATIONS_MAX = 200
"""Largest number of iterations; a program that is solved takes 5 to 150."""

GUESSED_MAX = 60
"""Largest number of iterations for a turn with its own guess, which takes 8 to 35, or all of them
if there is no solution."""

EFFORT_WEIGHT = 1e-4
"""Weight of each maneuver's mean squared torque beside another objective, both around one.

It selects the gentlest motion for a maneuver that does not determine the objective; without it
IPOPT wanders among many. It costs less of the objective than the collocation's own error.
"""

POWER_EFFORT = 0.2
"""Weight of the mean squared torque beside the peak power, each relative to its limit.

Minimising power alone would put the torque at its limit wherever the wheels are slow."""

_PROGRAM_LOCK = Lock()
"""A cached program holds the numbers of the turn that it is solving."""


@dataclass(frozen=True, eq=False)
class Dimensions:
    """Free dimensions of the device.

    Attributes:
        start, lower, upper: scaled to be around one, shape (m,).
        objective: function of the dimensions to be minimised, around one.
        excess: scaled constraint function of the dimensions, which must be <= 0; None: no
            constraint.
    """

    start: FloatArray
    lower: FloatArray
    upper: FloatArray
    objective: Callable[[ca.MX], ca.MX]
    excess: Callable[[ca.MX], ca.MX] | None = None


@dataclass(frozen=True, eq=False)
class Solution:
    """The outcome of the program.

    Attributes:
        motions: of each turn.
        dimensions: optimal ones, shape (m,).
        solved: whether IPOPT found a local optimum; if not, the rest is meaningless.
        status: IPOPT's return status. iterations: of all passes.
        violation: largest violation of the program's scaled constraints.
        cost: value of the objective.
    """

    motions: tuple[Motion, ...]
    dimensions: FloatArray
    solved: bool
    status: str
    iterations: int
    violation: float
    cost: float


def solve(
    turns: Sequence[Phase],
    line: DriveLine,
    passes: Sequence[int],
    dimensions: Dimensions | None = None,
) -> Solution:
    """Least peak power, or the best dimensions with which every turn is feasible.

    Without a power limit, the effort is minimised. Where a finer pass fails, the previous one
    counts.

    Args:
        turns: of one robot and device.
        line: usable voltage line of the drives.
        passes: number of intervals of each pass: even in the first, then short where the torques
            change.
        dimensions: free dimensions; None: the gyrostats as they are.
    """
    guesses = [turn.guess or turn.outline.motion(turn.gyrostat, passes[0]) for turn in turns]
    if dimensions is None and isfinite(float(line.power_max)) and turns[0].guess is None:
        guesses = [guesses[0].uneven(turns[0].gyrostat)]
    solution = _solve(turns, guesses, line, dimensions)
    for intervals in passes[1:] if solution.solved else ():
        if dimensions is not None:
            dimensions = replace(dimensions, start=solution.dimensions)
        guesses = [motion.refined(intervals) for motion in solution.motions]
        finer = _solve(turns, guesses, line, dimensions)
        best = finer if finer.solved else solution
        solution = replace(best, iterations=solution.iterations + finer.iterations)
        if not finer.solved:
            break
    return solution


def _solve(
    turns: Sequence[Phase],
    guesses: Sequence[Motion],
    line: DriveLine,
    dimensions: Dimensions | None,
) -> Solution:
    """Solve on the intervals of the guesses."""
    if dimensions is None:
        # One turn of a fixed device, by the cached program of its structure.
        turn, guess = turns[0], guesses[0]
        with _PROGRAM_LOCK:
            numbers = numbers_of(turn, Plant.of(turn.gyrostat), line, guess)
            values = {name: ca.sparsify(ca.evalf(number)) for name, number in numbers.items()}
            patterns = (
                (name, tuple(value.sparsity().compress())) for name, value in values.items()
            )
            structure = ProgramStructure.of(turn, line, guess)
            program, parameters, variables = _plan_program(structure, tuple(patterns))
            for name, parameter in parameters.items():
                program.set_value(parameter, values[name].nonzeros())
            variables.set_initial_guess(program, turn, guess, values)
            return _solved(program, [variables], [guess], ca.MX(0, 1))
    program = ca.Opti()
    dimension = program.variable(len(dimensions.start))
    program.set_initial(dimension, dimensions.start)
    program.subject_to(program.bounded(dimensions.lower, dimension, dimensions.upper))
    if dimensions.excess is not None:
        program.subject_to(dimensions.excess(dimension) <= 0.0)
    objective, all_variables = dimensions.objective(dimension), []
    for turn, guess in zip(turns, guesses, strict=True):
        plant = Plant.of(turn.gyrostat) if turn.plant is None else turn.plant(dimension)
        structure = ProgramStructure.of(turn, line, guess)
        numbers = numbers_of(turn, plant, line, guess)
        variables = transcribe(program, structure, numbers)
        variables.set_initial_guess(program, turn, guess, numbers)
        objective += EFFORT_WEIGHT * variables.effort
        all_variables.append(variables)
    program.minimize(objective)
    # A flat graph would be quicker, but splines of the dimensions cannot be expanded.
    program.solver("ipopt", IPOPT_OPTIONS | _options(guessed=turns[0].guess is not None))
    return _solved(program, all_variables, guesses, dimension)


@lru_cache(maxsize=16)
def _plan_program(
    structure: ProgramStructure, patterns: tuple[tuple[str, tuple[int, ...]], ...]
) -> tuple[ca.Opti, dict[str, ca.MX], Variables]:
    """Program for all turns of one structure, with the nonzero numbers as its parameters.

    Deriving a program takes as long as 40 iterations. `patterns`: each number's name, and where it
    is not zero.
    """
    program, parameters, numbers = ca.Opti(), {}, {}
    for name, pattern in patterns:
        where = ca.Sparsity.compressed(pattern)
        numbers[name] = ca.MX(*where.shape)
        if where.nnz():
            parameters[name] = program.parameter(where.nnz())
            numbers[name] = ca.MX(where, parameters[name])
    variables = transcribe(program, structure, numbers)
    # Without a power limit, only the effort counts.
    peak = 0.0 if variables.peak is None else variables.peak / POWER_EFFORT
    program.minimize(variables.effort + peak)
    options = _options(guessed=structure.guessed) | {"expand": True} | PLAN_OPTIONS
    if structure.power_limited:
        # The peak is reached at many instants at once: a monotone barrier takes half the time.
        options["ipopt.mu_strategy"] = "monotone"
        options["ipopt.mu_linear_decrease_factor"] = 0.1
        options["ipopt.mu_superlinear_decrease_power"] = 1.6
    if structure.one_stops:
        # The many rows make an iteration three times as long, and feasible plans need no more
        # restoration steps.
        options["ipopt.max_resto_iter"] = 4
    program.solver("ipopt", IPOPT_OPTIONS | options)
    return program, parameters, variables


def _options(*, guessed: bool) -> dict[str, Any]:
    """Options of every program."""
    most = GUESSED_MAX if guessed else ITERATIONS_MAX
    return {"ipopt.max_iter": most, "detect_simple_bounds": True}


def _solved(
    program: ca.Opti,
    all_variables: Sequence[Variables],
    guesses: Sequence[Motion],
    dimension: ca.MX,
) -> Solution:
    """Solution of a program by IPOPT."""
    try:
        program.solve()
    except RuntimeError:
        # CasADi raises this where IPOPT finds no solution; the statistics give the details.
        if program.stats()["success"]:
            raise
    value, stats = program.debug.value, program.stats()
    excess = np.array([value(program.lbg) - value(program.g), value(program.g - program.ubg)])
    return Solution(
        motions=tuple(
            Motion(
                guess.lengths,
                np.array(value(variables.scaled_states), ndmin=2),
                np.array(value(variables.scaled_torques), ndmin=2),
            )
            for guess, variables in zip(guesses, all_variables, strict=True)
        ),
        dimensions=np.array(value(dimension), ndmin=1),
        solved=bool(stats["success"]),
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        violation=float(np.max(excess, initial=0.0)),
        cost=float(value(program.f)),
    )
