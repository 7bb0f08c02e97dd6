"""The push-off as a nonlinear program of identical nodes, and its solution by IPOPT.

One node is differentiated once, and its derivatives serve all nodes; left to itself, CasADi would
colour the whole program and evaluate every node for every colour.
"""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.node import NODES, STEPS, WEIGHTS, Node, SoftLimit
from ocs_design.sizing.trajectory.program import IPOPT_OPTIONS

_TOLERANCE = 1e-6
_ITERATIONS_MAX = 120

_EXCESS = len(SoftLimit)
_PENALTY = 1000.0
"""Penalty for exceeding a limit, far above any gain from it: limits are exceeded only if the jump
is otherwise impossible."""


_MUMPS_OPTIONS: dict[str, Any] = {"ipopt.mumps_pivot_order": 5, "ipopt.mumps_permuting_scaling": 0}
"""METIS elimination order, no permutation for scaling, since everything is of order one. Fewer
matrices appear singular, which halves the time and saves a third of the iterations."""

_WARM_START_OPTIONS: dict[str, Any] = {
    "ipopt.warm_start_init_point": "yes",
    "ipopt.warm_start_bound_push": 1e-6,
    "ipopt.warm_start_mult_bound_push": 1e-6,
    "ipopt.warm_start_slack_bound_push": 1e-6,
    "ipopt.mu_strategy": "monotone",
    "ipopt.mu_init": 1e-6,
}
"""Options of a search that starts from a similar jump: it takes a quarter of the steps."""


@dataclass(frozen=True, eq=False)
class PushOffSolution:
    """Solution found by IPOPT.

    Attributes:
        nodes: unknowns, shape (size, nodes).
        torque: of the joints [N m or N], shape (n, nodes).
        excess: share by which each `SoftLimit` had to be exceeded, shape (3,).
        x, on_bounds, on_rows: the whole solution and its multipliers, to start a similar search.
        solved: whether it is a local optimum.
    """

    nodes: FloatArray
    torque: FloatArray
    excess: FloatArray
    x: FloatArray
    bound_multipliers: FloatArray
    row_multipliers: FloatArray
    solved: bool


class Program:
    """The push-off program of a robot: built once, solved for each of its jumps."""

    def __init__(self, node: Node) -> None:
        self._rows = _Rows.of(node)
        self._torque = ca.Function("torque", [node.unknowns, node.load], [node.torque]).map(NODES)
        pieces, size, rows = _pieces(node), node.layout.size, self._rows
        weights = ca.DM(np.array(WEIGHTS)).T
        flat, load = ca.MX.sym("x", size * NODES + _EXCESS), ca.MX.sym("load", node.load.numel())
        z, excess = ca.reshape(flat[:-_EXCESS], size, NODES), flat[-_EXCESS:]
        last = z[:, -1]

        objective = ca.dot(weights, pieces["cost"].map(NODES)(z, load)) + _PENALTY * ca.sum1(excess)
        weighted_slopes = pieces["cost_slope"].map(NODES)(z, load) * ca.repmat(weights, size, 1)
        # IPOPT needs a dense gradient, whatever its sparsity.
        gradient = ca.densify(ca.vertcat(ca.vec(weighted_slopes), _PENALTY * ca.DM.ones(_EXCESS)))

        node_rows = (
            rows.selection @ ca.vec(pieces["rows"].map(NODES)(z, load)) + rows.relaxation @ excess
        )
        constraints = ca.vertcat(rows.defects @ flat, node_rows, pieces["end"](last, load))
        slopes = ca.diagcat(*ca.horzsplit(pieces["slope"].map(NODES)(z, load), size))
        end_slope = pieces["end_slope"](last, load)
        before, after = (ca.MX(end_slope.size1(), count) for count in (size * (NODES - 1), _EXCESS))
        jacobian = ca.vertcat(
            rows.defects,
            ca.horzcat(rows.selection @ slopes, rows.relaxation),
            ca.horzcat(before, end_slope, after),
        )

        objective_multiplier = ca.MX.sym("on_goal")
        row_multipliers = ca.MX.sym("on_rows", constraints.numel())
        _, node_row_multipliers, end_multipliers = ca.vertsplit(
            row_multipliers, [0, rows.defects.size1(), len(rows.lower), constraints.numel()]
        )
        node_multipliers = ca.reshape(rows.selection.T @ node_row_multipliers, -1, NODES)
        curvature = pieces["curvature"].map(NODES)(
            z, load, node_multipliers, objective_multiplier * weights
        )
        blocks = ca.horzsplit(curvature, size)
        blocks[-1] += pieces["end_curvature"](last, load, end_multipliers)
        hessian = ca.diagcat(*blocks, ca.MX(_EXCESS, _EXCESS))
        self._options: dict[str, Any] = {
            **IPOPT_OPTIONS,
            **_MUMPS_OPTIONS,
            "ipopt.tol": _TOLERANCE,
            "ipopt.max_iter": _ITERATIONS_MAX,
            "grad_f": ca.Function("grad_f", [flat, load], [objective, gradient]),
            "jac_g": ca.Function("jac_g", [flat, load], [constraints, jacobian]),
            "hess_lag": ca.Function(
                "hess_lag", [flat, load, objective_multiplier, row_multipliers], [hessian]
            ),
        }
        self._nlp = {"x": flat, "p": load, "f": objective, "g": constraints}

    def solve(
        self,
        start: FloatArray | PushOffSolution,
        lower: FloatArray,
        upper: FloatArray,
        end: FloatArray,
        load: FloatArray,
    ) -> PushOffSolution:
        """The push-off of least cost; several threads may solve at once.

        Args:
            start: initial unknowns, shape (size, nodes), or the solution for a similar jump.
            lower, upper: bounds of the nodes' unknowns, shape (size, nodes).
            end: required value of `Node.end`, shape (6,).
            load: gravity and trunk, see `floating_base.Load.values`.
        """
        rows, options = self._rows, self._options
        if isinstance(start, PushOffSolution):
            options = options | _WARM_START_OPTIONS
            start_values = {
                "x0": start.x,
                "lam_x0": start.bound_multipliers,
                "lam_g0": start.row_multipliers,
            }
        else:
            start_values = {"x0": np.append(start.ravel("F"), np.full(_EXCESS, 0.5))}
        # A solver keeps the statistics of one call, so each call has its own solver.
        solver = ca.nlpsol("push_off", "ipopt", self._nlp, options)
        result = solver(
            **start_values,
            lbx=np.append(lower.ravel("F"), np.zeros(_EXCESS)),
            ubx=np.append(upper.ravel("F"), np.full(_EXCESS, np.inf)),
            lbg=np.concatenate([rows.lower, end]),
            ubg=np.concatenate([rows.upper, end]),
            p=load,
        )
        x = np.asarray(result["x"]).ravel()
        nodes = x[:-_EXCESS].reshape(lower.shape, order="F")
        return PushOffSolution(
            nodes=nodes,
            torque=np.asarray(self._torque(nodes, load)),
            excess=x[-_EXCESS:],
            x=x,
            bound_multipliers=np.asarray(result["lam_x"]).ravel(),
            row_multipliers=np.asarray(result["lam_g"]).ravel(),
            solved=bool(solver.stats()["success"]),
        )


@dataclass(frozen=True, eq=False)
class _Rows:
    """Constraints of the program: the splines' first, then the nodes', without those of the end.

    Attributes:
        defects: matrix of the spline conditions between nodes.
        selection: matrix that selects, from the rows of all nodes, those that hold there.
        relaxation: matrix by which each `SoftLimit`'s excess relaxes the selected rows.
        lower, upper: of all rows.
    """

    defects: ca.DM
    selection: ca.DM
    relaxation: ca.DM
    lower: FloatArray
    upper: FloatArray

    @classmethod
    def of(cls, node: Node) -> "_Rows":
        """Rows of all nodes."""
        counts = [block.fold.size1() for block in node.blocks]
        active = np.zeros((NODES, sum(counts)), dtype=bool)
        for block, last in zip(node.blocks, np.cumsum(counts), strict=True):
            active[block.first : block.stop, last - block.fold.size1() : last] = True
        kept = np.flatnonzero(active)
        lower, upper, limit = (
            np.tile(np.repeat([getattr(b, name) for b in node.blocks], counts), NODES)[kept]
            for name in ("lower", "upper", "limit")
        )
        # Cubic splines: y'' is linear on each interval, y' and y its integrals.
        layout = node.layout
        step = ca.repmat(ca.DM(np.array(STEPS)).T, layout.y.stop, 1)
        flat = ca.MX.sym("x", layout.size * NODES + _EXCESS)
        z = ca.reshape(flat[:-_EXCESS], layout.size, NODES)
        y, v, a, duration = (z[part, :] for part in (layout.y, layout.v, layout.a, layout.duration))
        later, earlier = slice(1, None), slice(None, -1)
        continuity = ca.veccat(
            v[:, later] - v[:, earlier] - step / 2.0 * (a[:, earlier] + a[:, later]),
            y[:, later]
            - y[:, earlier]
            - step * v[:, earlier]
            - step**2 / 6.0 * (2.0 * a[:, earlier] + a[:, later]),
            duration[:, later] - duration[:, earlier],
        )
        defects, relaxed = ca.evalf(ca.jacobian(continuity, flat)), np.flatnonzero(limit >= 0)
        tight = np.zeros(defects.size1())
        return cls(
            defects,
            selection=_ones(np.arange(len(kept)), kept, (len(kept), active.size)),
            relaxation=-_ones(relaxed, limit[relaxed], (len(kept), _EXCESS)),
            lower=np.append(tight, lower),
            upper=np.append(tight, upper),
        )


def _pieces(node: Node) -> dict[str, ca.Function]:
    """Functions of one node's unknowns and the load.

    The Hessian of a sum of squares r^2 is 2 J^T J plus that of r with multipliers 2 r: a third of
    the operations of differentiating the sum twice. CasADi chooses between forward and reverse mode
    by the shape of a Jacobian, so each block has its own.

    Returns:
        `rows` and `slope`: constraints of any node, and their Jacobian. `cost` and `cost_slope`:
        cost per share of the time, and its gradient. `curvature`: upper triangle of the Hessian of
        rows and cost, weighted by multipliers. `end`, `end_slope` and `end_curvature`: the same for
        the rows that only the last node has.
    """
    z, inputs = node.unknowns, [node.unknowns, node.load]
    rows = [block.fold @ block.values for block in node.blocks]
    slopes = [block.fold @ ca.jacobian(block.values, z) for block in node.blocks]
    residuals = ca.vertcat(*node.residuals)
    residual_jacobian = ca.vertcat(*(ca.jacobian(residual, z) for residual in node.residuals))
    cost = ca.sumsqr(residuals)
    row_multipliers = [ca.SX.sym("on_rows", block.fold.size1()) for block in node.blocks]
    residual_multipliers = ca.SX.sym("on_residuals", residuals.numel())
    cost_multiplier = ca.SX.sym("on_cost")
    linear = ca.dot(residual_multipliers, residuals)
    for block, multipliers in zip(node.blocks, row_multipliers, strict=True):
        linear += ca.dot(block.fold.T @ multipliers, block.values)
    curvature = ca.substitute(
        ca.hessian(linear, z)[0], residual_multipliers, 2.0 * cost_multiplier * residuals
    )
    end_multipliers = ca.SX.sym("on_end", node.end.numel())
    end_curvature = ca.hessian(ca.dot(end_multipliers, node.end), z)[0]
    functions = {
        "rows": (inputs, ca.vertcat(*rows)),
        "slope": (inputs, ca.vertcat(*slopes)),
        "cost": (inputs, cost),
        "cost_slope": (inputs, ca.gradient(cost, z)),
        "curvature": (
            [*inputs, ca.vertcat(*row_multipliers), cost_multiplier],
            ca.triu(curvature + 2.0 * cost_multiplier * (residual_jacobian.T @ residual_jacobian)),
        ),
        "end": (inputs, node.end),
        "end_slope": (inputs, ca.jacobian(node.end, z)),
        "end_curvature": ([*inputs, end_multipliers], ca.triu(end_curvature)),
    }
    return {name: ca.Function(name, i, [o]) for name, (i, o) in functions.items()}


def _ones(rows: NDArray[Any], columns: NDArray[Any], shape: tuple[int, int]) -> ca.DM:
    return ca.DM.triplet(
        list(map(int, rows)), list(map(int, columns)), ca.DM.ones(len(rows)), *shape
    )
