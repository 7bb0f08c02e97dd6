"""One node of a push-off: its instant, its unknowns, its cost and its constraints.

The nodes are closer together towards the end, where the legs are fastest. Between them the second
derivatives are linear in time: the coordinates are cubic splines (de Boor, A Practical Guide to
Splines, chapter IV).

The unknowns of a node are the coordinates y, their first two derivatives with respect to the share
of time passed, the forces on the feet in units of the weight, and the duration. Every node has its
own copy of the duration, so that the program stays banded. All rows are dimensionless.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import casadi as ca
import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.jumping.floating_base import POSE, FloatingBase
from ocs_design.jumping.legged_body import LeggedBody

NODES = 17

_LAST = 0.25
"""Length of the last interval over that of the first."""

STEPS = frozen(np.linspace(1.0, _LAST, NODES - 1) / np.linspace(1.0, _LAST, NODES - 1).sum())
"""Lengths of the intervals, as shares of the duration, shape (NODES - 1,)."""

SHARES = frozen(np.append(0.0, np.cumsum(STEPS)))
"""Share of the duration that has passed at each node, shape (NODES,)."""

WEIGHTS = frozen((np.append(0.0, STEPS) + np.append(STEPS, 0.0)) / 2.0)
"""Trapezoidal weights of the nodes in an integral over the shares, shape (NODES,)."""

FRICTION = 0.6
"""Coefficient of friction that a plan relies on: rubber on most dry floors has more."""

REACH = (0.40, 0.95)
"""Smallest and largest leg length over the stretched length: the knee always stays bent."""


class SoftLimit(IntEnum):
    """Limits that a plan may exceed, at a price."""

    TORQUE = 0
    SPEED = 1
    FRICTION = 2


class NodeLayout(NamedTuple):
    """Indices of the unknowns in a node's column.

    Attributes:
        joints, legs: their numbers.
        y, v, a: coordinates of trunk and joints [m, rad], their first and second derivatives.
        f: forces on the feet over the weight.
        duration: of the push-off [s].
        size: number of unknowns per node.
    """

    joints: int
    legs: int
    y: slice
    v: slice
    a: slice
    f: slice
    duration: int
    size: int

    @classmethod
    def of(cls, body: LeggedBody) -> "NodeLayout":
        """Layout for a robot's nodes."""
        joints, legs = len(body.joints), len(body.legs)
        count = POSE + joints
        y, v, a = (slice(k * count, (k + 1) * count) for k in range(3))
        last = a.stop + 3 * legs
        return cls(joints, legs, y, v, a, slice(a.stop, last), last, last + 1)


@dataclass(frozen=True, eq=False)
class Constraints:
    """Constraints of one kind: lower <= fold @ values <= upper.

    Attributes:
        values: dimensionless quantities, shape (k, 1).
        fold: matrix of coefficients from values to rows, shape (m, k).
        lower, upper: bounds of every row.
        limit: the `SoftLimit` whose excess relaxes the rows; -1: none.
        first, stop: the rows hold at nodes from `first` on, before `stop`.
    """

    values: ca.SX
    fold: ca.DM
    lower: float
    upper: float
    limit: int = -1
    first: int = 0
    stop: int = NODES


@dataclass(frozen=True, eq=False)
class Node:
    """Symbolic node.

    Attributes:
        unknowns: one column, see `NodeLayout`. load: parameters, see `floating_base.Load`.
        residuals: two columns; the sum of their squares is the cost per share of the time.
        blocks: all constraints except that of `end`.
        end: dimensionless velocity of the centre of mass and angular momentum, which the last node
            has to reach, shape (6, 1).
        torque: of the joints [N m or N], shape (n, 1).
        layout: of the unknowns.
    """

    unknowns: ca.SX
    load: ca.SX
    residuals: tuple[ca.SX, ca.SX]
    blocks: tuple[Constraints, ...]
    end: ca.SX
    torque: ca.SX
    layout: NodeLayout

    @classmethod
    def of(cls, body: LeggedBody, base: FloatingBase) -> "Node":
        """Node of a robot; everything that differs between its jumps stays symbolic."""
        layout = NodeLayout.of(body)
        z, units = ca.SX.sym("z", layout.size), _Units.of(body, base)
        duration = z[layout.duration]
        # A node's unknowns in place of coordinates, rates and forces.
        symbols = ca.vertcat(base.y, base.v, base.a, base.f)
        unknown = ca.vertcat(
            z[layout.y],
            z[layout.v] / duration,
            z[layout.a] / duration**2,
            z[layout.f] * units.force,
        )
        shared = base.f / units.force * len(body.legs)
        swing = base.a * units.time**2
        # Small terms of the cost that settle what the torques leave undetermined.
        minor = ca.vertcat(
            np.sqrt(0.01) * shared,
            np.sqrt(0.3) * ca.vertcat(shared[0::3], shared[1::3]),
            np.sqrt(0.001) * swing[POSE:],
            np.sqrt(0.01) * swing[3:POSE],
            np.sqrt(0.1) * base.y[:2] / body.length,
            base.y[3:POSE],
        )
        balance, slips, torque, speed, force, reach, minor, end = ca.substitute(
            [
                # Only the ground pushes the robot.
                ca.vertcat(base.imbalance[:3] / units.force, base.imbalance[3:] / units.moment),
                _slips(body, base) / body.length,
                base.torque,
                base.v[POSE:],
                base.f / units.force,
                base.reach / ca.DM([leg.length for leg in body.legs]) ** 2,
                minor,
                ca.vertcat(
                    base.momentum / (units.force / base.load.gravity * units.speed),
                    base.spin / (units.moment * units.time),
                ),
            ],
            [symbols],
            [unknown],
        )
        limits = (
            np.array([limit_or_inf(getattr(joint, name)) for joint in body.joints])
            for name in ("effort", "velocity")
        )
        # Joint values over their limits, in both directions, for joints with limits, shape (m, n).
        efforts, velocities = (
            _sparse(np.kron(np.diag(1.0 / limit)[np.isfinite(limit)], [[1.0], [-1.0]]))
            for limit in limits
        )
        # Forces outside the pyramid inscribed in the friction cone, shape (4 legs, 3 legs).
        side = FRICTION / np.sqrt(2.0)
        sides = [[1.0, 0.0, -side], [-1.0, 0.0, -side], [0.0, 1.0, -side], [0.0, -1.0, -side]]
        pyramids = _sparse(np.kron(np.eye(layout.legs), sides))
        root = ca.sqrt(duration / units.time)
        return cls(
            unknowns=z,
            load=base.load.packed(),
            residuals=(root * torque / units.torque, root * minor),
            blocks=(
                Constraints(balance, ca.DM.eye(POSE), 0.0, 0.0),
                # At the start all coordinates are given.
                Constraints(slips, ca.DM.eye(slips.numel()), 0.0, 0.0, first=1),
                Constraints(torque, efforts, -np.inf, 1.0, SoftLimit.TORQUE),
                Constraints(speed, velocities, -np.inf, 1.0, SoftLimit.SPEED),
                # At the end the feet lift off.
                Constraints(force, pyramids, -np.inf, 0.0, SoftLimit.FRICTION, stop=NODES - 1),
                Constraints(reach, ca.DM.eye(layout.legs), REACH[0] ** 2, REACH[1] ** 2),
            ),
            end=end,
            torque=torque,
            layout=layout,
        )


@dataclass(frozen=True, eq=False)
class _Units:
    """Units of force [N], moment [N m], one leg's joint torque [N m], speed [m/s] and time [s]."""

    force: ca.SX
    moment: ca.SX
    torque: ca.SX
    speed: ca.SX
    time: ca.SX

    @classmethod
    def of(cls, body: LeggedBody, base: FloatingBase) -> "_Units":
        """Units made of the robot's weight and the length of its legs."""
        mass, gravity = base.load.trunk.mass + body.leg_mass, base.load.gravity
        force, length = mass * gravity, body.length
        return cls(
            force,
            force * length,
            force * length / len(body.legs),
            ca.sqrt(gravity * length),
            ca.sqrt(length / gravity),
        )


def _slips(body: LeggedBody, base: FloatingBase) -> ca.SX:
    """Slip of each foot from its stance position [m]; a foot's ball rolls as its shank turns.

    A ball of radius r that turns by phi about y and chi about x rolls to (r phi, -r chi): exact for
    a turn about one axis, which is nearly true of these balls.
    """
    rows: list[ca.SX] = []
    standing = np.concatenate([[0.0, 0.0, body.height, 0.0, 0.0, 0.0], body.posture])
    stance = ca.Function("stance", [base.y], [*base.feet, *base.shanks])(standing)
    count = len(body.legs)
    for i, leg in enumerate(body.legs):
        turn = base.shanks[i] @ stance[count + i].T
        about_y = ca.atan2(turn[0, 2] - turn[2, 0], turn[0, 0] + turn[2, 2])
        about_x = ca.atan2(turn[2, 1] - turn[1, 2], turn[1, 1] + turn[2, 2])
        rolled = leg.foot_radius * ca.vertcat(about_y, -about_x, 0.0)
        rows.append(base.feet[i] - stance[i] - rolled)
    return ca.vertcat(*rows)


def limit_or_inf(value: float) -> float:
    """Limit of a joint; 0 in a file means that the author left it open."""
    return value if value > 0.0 else np.inf


def _sparse(matrix: FloatArray) -> ca.DM:
    return ca.sparsify(ca.DM(matrix))
