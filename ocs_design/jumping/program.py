"""The push-off as a nonlinear program of equal nodes, and IPOPT's answer to it.

The derivatives of all nodes are those of one, which is differentiated once; left to itself, CasADi
would colour the whole program and evaluate every node for every colour.
"""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.jumping.mesh import NODES, STEPS, WEIGHTS
from ocs_design.jumping.node import Limit, Node
from ocs_design.sizing.optimal_control.nonlinear_program import IPOPT_OPTIONS

_TOLERANCE = 1e-6
_ITERATIONS_MAX = 120

_EXCESS = len(Limit)
_PENALTY = 1000.0
"""On overdrawing a limit: far above what any jump gains by it, so that none is unless it must."""


_WARM: dict[str, Any] = {
    "ipopt.warm_start_init_point": "yes",
    "ipopt.warm_start_bound_push": 1e-6,
    "ipopt.warm_start_mult_bound_push": 1e-6,
    "ipopt.warm_start_slack_bound_push": 1e-6,
    "ipopt.mu_strategy": "monotone",
    "ipopt.mu_init": 1e-4,
}
"""From the answer for a similar jump IPOPT needs a third of the steps."""


@dataclass(frozen=True, eq=False)
class Bounds:
    """What one jump may do.

    Attributes:
        start: where the search begins, shape (size, nodes), or the answer for a similar jump.
        lower, upper: of the nodes' unknowns, shape (size, nodes).
        end: what the last rows of the last node must be, shape (END_ROWS,).
        load: of the trunk, see `floating_base.Load.values`.
    """

    start: "FloatArray | Found"
    lower: FloatArray
    upper: FloatArray
    end: FloatArray
    load: FloatArray


@dataclass(frozen=True, eq=False)
class Found:
    """What IPOPT found.

    Attributes:
        nodes: unknowns, shape (size, nodes).
        rows: of every node, whether kept to or not, shape (m, nodes).
        torque: of the joints [N m or N], shape (n, nodes).
        excess: share by which each `Limit` had to be overdrawn, shape (3,).
        x, on_bounds, on_rows: the whole answer and its multipliers, to begin a similar search at.
        solved: whether it is a local optimum. iterations: taken. status: IPOPT's word.
    """

    nodes: FloatArray
    rows: FloatArray
    torque: FloatArray
    excess: FloatArray
    x: FloatArray
    on_bounds: FloatArray
    on_rows: FloatArray
    solved: bool
    iterations: int
    status: str


class Program:
    """Made once for a robot, solved for each of its jumps."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._kept = _kept(node)
        flat = ca.MX.sym("x", node.layout.size * NODES + _EXCESS)
        z = ca.reshape(flat[:-_EXCESS], node.layout.size, NODES)
        load = ca.MX.sym("load", node.load.numel())
        pieces = _Pieces.of(node, self._kept)
        self._evaluated = pieces.value.map(NODES)
        nlp, options = _posed(flat, z, load, pieces)
        self._cold = ca.nlpsol("push_off", "ipopt", nlp, options)
        self._warm = ca.nlpsol("similar_push_off", "ipopt", nlp, options | _WARM)
        self._defects = pieces.defects.size1()

    def solve(self, bounds: Bounds) -> Found:
        """Search from where the bounds say."""
        node, tight = self._node, np.zeros(self._defects)
        lower, upper = (
            np.repeat(each[:, None], NODES, axis=1) for each in (node.lower, node.upper)
        )
        lower[-len(bounds.end) :, -1] = upper[-len(bounds.end) :, -1] = bounds.end
        start = bounds.start
        solver = self._warm if isinstance(start, Found) else self._cold
        if isinstance(start, Found):
            begin = {"x0": start.x, "lam_x0": start.on_bounds, "lam_g0": start.on_rows}
        else:
            begin = {"x0": np.append(start.ravel("F"), np.full(_EXCESS, 0.5))}
        found = solver(
            **begin,
            lbx=np.append(bounds.lower.ravel("F"), np.zeros(_EXCESS)),
            ubx=np.append(bounds.upper.ravel("F"), np.full(_EXCESS, np.inf)),
            lbg=np.append(tight, lower.ravel("F")[self._kept]),
            ubg=np.append(tight, upper.ravel("F")[self._kept]),
            p=bounds.load,
        )
        stats, x = solver.stats(), np.asarray(found["x"]).ravel()
        nodes = x[:-_EXCESS].reshape(bounds.lower.shape, order="F")
        rows, _, torque = self._evaluated(nodes, np.tile(bounds.load[:, None], NODES))
        return Found(
            nodes=nodes,
            rows=np.asarray(rows),
            torque=np.asarray(torque),
            excess=x[-_EXCESS:],
            x=x,
            on_bounds=np.asarray(found["lam_x"]).ravel(),
            on_rows=np.asarray(found["lam_g"]).ravel(),
            solved=bool(stats["success"]),
            iterations=int(stats["iter_count"]),
            status=str(stats["return_status"]),
        )


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Functions of one node, and what joins the nodes.

    Attributes:
        value: rows, cost and torque of a node's unknowns and the load.
        cost_slope: cost and its gradient.
        slope: rows, cost and the Jacobian of both, one below the other.
        curvature: upper triangle of the Hessian, of rows and cost weighed by multipliers.
        selection: from the rows of all nodes, and their costs, to those that are kept to.
        overdrawn: what each `Limit`'s excess takes off these.
        defects: matrix of what the spline's nodes have to do with each other.
        weights: of the nodes' costs, shape (NODES,).
    """

    value: ca.Function
    cost_slope: ca.Function
    slope: ca.Function
    curvature: ca.Function
    selection: ca.DM
    overdrawn: ca.DM
    defects: ca.DM
    weights: ca.DM

    @classmethod
    def of(cls, node: Node, kept: NDArray[np.intp]) -> "_Pieces":
        """Differentiate one node; `kept` as `_kept` gives it."""
        z, load = node.unknowns, node.load
        both = ca.vertcat(node.rows, node.cost)
        count = both.numel()
        multipliers = ca.SX.sym("multipliers", count)
        hessian, _ = ca.hessian(ca.dot(multipliers, both), z)
        place, row = np.divmod(kept, count - 1)
        limit = node.limit[row]
        charged = np.flatnonzero(limit >= 0)
        return cls(
            value=ca.Function("value", [z, load], [node.rows, node.cost, node.torque]),
            cost_slope=ca.Function("cost", [z, load], [node.cost, ca.gradient(node.cost, z)]),
            slope=ca.Function("slope", [z, load], [both, ca.jacobian(both, z)]),
            curvature=ca.Function("curvature", [z, load, multipliers], [ca.triu(hessian)]),
            selection=_ones(np.arange(len(kept)), place * count + row, (len(kept), count * NODES)),
            overdrawn=-_ones(charged, limit[charged], (len(kept), _EXCESS)),
            defects=_defects(node),
            weights=ca.DM(np.array(WEIGHTS)),
        )


def _posed(
    flat: ca.MX, z: ca.MX, load: ca.MX, pieces: _Pieces
) -> tuple[dict[str, ca.MX], dict[str, Any]]:
    """The program, and IPOPT's options with the derivatives among them."""
    loads = ca.repmat(load, 1, NODES)
    excess = flat[-_EXCESS:]
    count = pieces.slope.size1_out(0)
    values, slopes = pieces.slope.map(NODES)(z, loads)
    joined = ca.diagcat(*ca.horzsplit(slopes, z.size1()))
    costs, of_costs = pieces.cost_slope.map(NODES)(z, loads)
    goal = ca.dot(pieces.weights.T, costs) + _PENALTY * ca.sum1(excess)
    kept = pieces.selection @ ca.vec(values) + pieces.overdrawn @ excess
    constraints = ca.vertcat(pieces.defects @ flat, kept)
    jacobian = ca.vertcat(pieces.defects, ca.horzcat(pieces.selection @ joined, pieces.overdrawn))
    weighed = of_costs * ca.repmat(pieces.weights.T, z.size1(), 1)
    # IPOPT takes the gradient as dense, whatever its sparsity.
    gradient = ca.densify(ca.vertcat(ca.vec(weighed), _PENALTY * ca.DM.ones(_EXCESS)))
    on_goal, on_rows = ca.MX.sym("on_goal"), ca.MX.sym("on_rows", constraints.numel())
    multipliers = ca.reshape(
        pieces.selection.T @ on_rows[pieces.defects.size1() :], count, NODES
    ) + ca.vertcat(ca.MX(count - 1, NODES), on_goal * pieces.weights.T)
    blocks = pieces.curvature.map(NODES)(z, loads, multipliers)
    hessian = ca.diagcat(*ca.horzsplit(blocks, z.size1()), ca.MX(_EXCESS, _EXCESS))
    options: dict[str, Any] = {
        **IPOPT_OPTIONS,
        "ipopt.tol": _TOLERANCE,
        "ipopt.max_iter": _ITERATIONS_MAX,
        "grad_f": ca.Function("grad_f", [flat, load], [goal, gradient]),
        "jac_g": ca.Function("jac_g", [flat, load], [constraints, jacobian]),
        "hess_lag": ca.Function("hess_lag", [flat, load, on_goal, on_rows], [hessian]),
    }
    return {"x": flat, "p": load, "f": goal, "g": constraints}, options


def _defects(node: Node) -> ca.DM:
    """Cubic splines: y'' is linear on each interval, y' and y its integrals."""
    layout = node.layout
    step = ca.repmat(ca.DM(np.array(STEPS)).T, layout.coordinates, 1)
    flat = ca.MX.sym("x", layout.size * NODES + _EXCESS)
    z = ca.reshape(flat[:-_EXCESS], layout.size, NODES)
    y, v, a, duration = (z[part, :] for part in (layout.y, layout.v, layout.a, layout.duration))
    ahead, here = slice(1, None), slice(None, -1)
    joined = ca.veccat(
        v[:, ahead] - v[:, here] - step / 2.0 * (a[:, here] + a[:, ahead]),
        y[:, ahead]
        - y[:, here]
        - step * v[:, here]
        - step**2 / 6.0 * (2.0 * a[:, here] + a[:, ahead]),
        duration[:, ahead] - duration[:, here],
    )
    return ca.evalf(ca.jacobian(joined, flat))


def _kept(node: Node) -> NDArray[np.intp]:
    """Which rows hold, of all nodes' rows one node after the other.

    At the start all coordinates are given; at the end the feet let go. The last rows are the end's.
    """
    holds = np.ones((NODES, node.rows.numel()), dtype=bool)
    holds[0, node.feet] = False
    holds[-1, node.ground] = False
    holds[:-1, -6:] = False
    return np.flatnonzero(holds)


def _ones(rows: NDArray[Any], columns: NDArray[Any], shape: tuple[int, int]) -> ca.DM:
    return ca.DM.triplet(
        list(map(int, rows)), list(map(int, columns)), ca.DM.ones(len(rows)), *shape
    )
