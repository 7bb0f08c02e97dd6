"""A nonlinear program put together from parts, and IPOPT's answer to it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray

TOLERANCE = 1e-8
"""Of IPOPT, scaled."""

ITERATIONS_MAX = 200
"""A program that is solved takes 5 to 100."""

IPOPT_OPTIONS: dict[str, Any] = {
    "ipopt.tol": TOLERANCE,
    "ipopt.acceptable_iter": 0,
    # Bounds are bounds: a rim is not to stick out of its envelope by 1e-8 of it.
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.linear_solver": "mumps",
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
}


@dataclass(frozen=True, eq=False)
class Unknown:
    """Variables of the program, any shape; start and bounds broadcast to it.

    Attributes:
        symbol: of CasADi. start: where the search begins. lower, upper: bounds.
    """

    symbol: ca.MX
    start: FloatArray | float
    lower: FloatArray | float = -np.inf
    upper: FloatArray | float = np.inf


@dataclass(frozen=True, eq=False)
class Constraint:
    """lower <= expression <= upper, any shape; the bounds broadcast to it."""

    expression: ca.MX
    lower: FloatArray | float
    upper: FloatArray | float


@dataclass(frozen=True, eq=False)
class Program:
    """Minimise the objective over the unknowns under the constraints."""

    unknowns: Sequence[Unknown]
    constraints: Sequence[Constraint]
    objective: ca.MX


@dataclass(frozen=True, eq=False)
class Answer:
    """What IPOPT found.

    Attributes:
        values: of the unknowns, each in its shape.
        objective: there. status: IPOPT's own word. solved: whether it is a local optimum.
        iterations: taken. violation: largest, of the constraints, scaled as they are written.
    """

    values: tuple[FloatArray, ...]
    objective: float
    status: str
    solved: bool
    iterations: int
    violation: float


def solve_program(program: Program, iterations_max: int = ITERATIONS_MAX) -> Answer:
    """Search from where the unknowns start."""
    symbols = [unknown.symbol for unknown in program.unknowns]
    nlp: dict[str, Any] = {
        "x": ca.veccat(*symbols),
        "f": program.objective,
        "g": ca.veccat(*(constraint.expression for constraint in program.constraints)),
    }
    solver = ca.nlpsol("ocp", "ipopt", nlp, IPOPT_OPTIONS | {"ipopt.max_iter": iterations_max})
    lower = _flat([(c.expression, c.lower) for c in program.constraints])
    upper = _flat([(c.expression, c.upper) for c in program.constraints])
    found = solver(
        x0=_flat([(u.symbol, u.start) for u in program.unknowns]),
        lbx=_flat([(u.symbol, u.lower) for u in program.unknowns]),
        ubx=_flat([(u.symbol, u.upper) for u in program.unknowns]),
        lbg=lower,
        ubg=upper,
    )
    stats = solver.stats()
    reached = np.asarray(found["g"]).ravel()
    return Answer(
        values=_split(np.asarray(found["x"]).ravel(), symbols),
        objective=float(found["f"]),
        status=str(stats["return_status"]),
        solved=bool(stats["success"]),
        iterations=int(stats["iter_count"]),
        violation=float(np.max([lower - reached, reached - upper], initial=0.0)),
    )


def _flat(parts: Sequence[tuple[ca.MX, FloatArray | float]]) -> FloatArray:
    """Values in the shape of their expressions, column by column, one after the other."""
    return np.concatenate([np.broadcast_to(value, part.shape).ravel("F") for part, value in parts])


def _split(flat: FloatArray, symbols: Sequence[ca.MX]) -> tuple[FloatArray, ...]:
    """The reverse of `_flat`."""
    ends = np.cumsum([symbol.numel() for symbol in symbols])[:-1]
    parts = zip(np.split(flat, ends), symbols, strict=True)
    return tuple(part.reshape(symbol.shape, order="F") for part, symbol in parts)
