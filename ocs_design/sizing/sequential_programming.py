"""The smallest value of a smooth function of a few variables under smooth limits.

Sequential linear programming in a trust region with an exact penalty (Fletcher and Sainz de la
Maza, Nonlinear programming and nonsmooth optimization by successive linear programming, Math.
Program. 43, 1989). Where as many limits hold as there are variables, which is what sizes a device
as a rule, it converges as Newton's method does; elsewhere the region shrinks around the flat
bottom. Gradients are central differences, all points of one iteration in one call.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray

Evaluate = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Points, shape (k, n), to the function, shape (k,), and to what must not be negative, (k, m)."""

_DIFFERENCE = 1e-6
_PENALTY = 1e3
_ROUNDS = 80
_SMALLEST = 1e-9
_GROW, _SHRINK = 2.0, 0.35
# Of what the linear programme promised.
_POOR, _GOOD = 0.1, 0.7
# Keeps the linear programme strictly convex; far below any slope that matters.
_CURVATURE = 1e-9


class Optimum(NamedTuple):
    """Where the search ended.

    Attributes:
        point: shape (n,). value: of the function there.
        violation: how far below zero the worst limit is; 0: all hold.
    """

    point: FloatArray
    value: float
    violation: float


@dataclass(frozen=True, eq=False)
class _Model:
    """Function and limits at a point, and how they move around it."""

    value: float
    limits: FloatArray
    slope: FloatArray
    slopes: FloatArray

    @property
    def merit(self) -> float:
        """Value and penalty."""
        return _merit(self.value, self.limits)

    def promised(self, step: FloatArray) -> float:
        """By how much a step lowers the merit, if nothing bends."""
        limits = self.limits + self.slopes @ step
        return self.merit - _merit(self.value + float(self.slope @ step), limits)


class _Room(NamedTuple):
    """How far a step may lead either way, shape (n,) each."""

    low: FloatArray
    high: FloatArray

    @classmethod
    def around(
        cls, point: FloatArray, low: FloatArray, high: FloatArray, trust: FloatArray
    ) -> "_Room":
        """What bounds and trust region leave around a point."""
        return cls(np.maximum(low - point, -trust), np.minimum(high - point, trust))


def minimise(
    evaluate: Evaluate,
    start: FloatArray,
    low: FloatArray,
    high: FloatArray,
    trust: FloatArray,
    *,
    smallest: float = _SMALLEST,
) -> Optimum:
    """The best point near the start.

    Args:
        evaluate: function and limits, all of about the order of one; see `Evaluate`.
        start: shape (n,).
        low, high: of the variables, shape (n,).
        trust: how far a first step may lead, shape (n,); 0 where a variable is held.
        smallest: part of that at which the search ends.
    """
    point = np.clip(start, low, high)
    model, reach = _model(evaluate, point, low, high), 1.0
    for _ in range(_ROUNDS):
        if reach < smallest:
            break
        room = _Room.around(point, low, high, reach * trust)
        step, promised = _step(evaluate, point, model, room, reach)
        if step is None:
            reach *= _SHRINK
            continue
        point = point + step
        before, model = model.merit, _model(evaluate, point, low, high)
        reach *= _GROW if before - model.merit > _GOOD * promised else 1.0
    return Optimum(point, model.value, float(np.maximum(-model.limits, 0.0).max(initial=0.0)))


def _step(
    evaluate: Evaluate, point: FloatArray, model: _Model, room: _Room, reach: float
) -> tuple[FloatArray | None, float]:
    """The better of the linear programme's step and a corrected one, and what was promised.

    Limits that bend are missed by the square of a step. With what they are behind it, a second
    programme meets them again; ever smaller steps would have to be taken otherwise. None: neither
    gains as much as it should.
    """
    straight = _linear_step(model, model.limits, room, reach)
    promised = model.promised(straight)
    value, behind = evaluate((point + straight)[None])
    least = _merit(float(value[0]), behind[0])
    if model.merit - least > max(_GOOD * promised, 0.0):
        return straight, promised
    bent = _linear_step(model, behind[0] - model.slopes @ straight, room, reach)
    value, limits = evaluate((point + bent)[None])
    corrected = _merit(float(value[0]), limits[0])
    if model.merit - min(least, corrected) <= max(_POOR * promised, 0.0):
        return None, promised
    return (bent if corrected < least else straight), promised


def _merit(value: float, limits: FloatArray) -> float:
    return value + _PENALTY * float(np.maximum(-limits, 0.0).max(initial=0.0))


def _model(evaluate: Evaluate, point: FloatArray, low: FloatArray, high: FloatArray) -> _Model:
    """By differences that stay within the bounds: beyond, there may be nothing to evaluate."""
    n, width = point.size, _DIFFERENCE * np.eye(point.size)
    ahead, behind = np.minimum(point + width, high), np.maximum(point - width, low)
    values, limits = evaluate(np.concatenate([point[None], ahead, behind]))
    apart = np.diag(ahead - behind)
    # A held variable has no slope.
    over = np.where(apart > 0.0, apart, np.inf)
    return _Model(
        value=float(values[0]),
        limits=limits[0],
        slope=(values[1 : n + 1] - values[n + 1 :]) / over,
        slopes=((limits[1 : n + 1] - limits[n + 1 :]) / over[:, None]).T,
    )


def _linear_step(model: _Model, limits: FloatArray, room: _Room, reach: float) -> FloatArray:
    """To where the linear programme of the model with these limits has its optimum, shape (n,).

    The worst violation is its last variable. All lengths are over `reach`: so the tolerances of the
    solver shrink with the region.
    """
    count, size = model.slopes.shape
    found = _programme(size + 1, count)(
        h=np.full(size + 1, _CURVATURE),
        g=np.append(model.slope, _PENALTY),
        a=np.column_stack([model.slopes, np.ones(count)]),
        lba=-limits / reach,
        uba=np.inf,
        lbx=np.append(room.low / reach, 0.0),
        ubx=np.append(room.high / reach, np.inf),
    )
    step: FloatArray = np.asarray(found["x"]).ravel()[:size]
    if not np.isfinite(step).all():
        return np.zeros(size)
    return np.clip(reach * step, room.low, room.high)


@cache
def _programme(variables: int, rows: int) -> ca.Function:
    sparsity = {"h": ca.Sparsity.diag(variables), "a": ca.Sparsity.dense(rows, variables)}
    silent = {"print_iter": False, "print_header": False, "print_info": False}
    return ca.conic("step", "qrqp", sparsity, {"error_on_fail": False, **silent})
