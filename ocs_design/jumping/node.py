"""One instant of a push-off: its unknowns, what it costs, and what it must keep to.

The unknowns of a node are the coordinates y, their first two derivatives by the share of the time
that has passed, the forces on the feet in units of the weight, and the duration. Every node has
its own copy of the duration, so that the program stays banded. All rows are free of units.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.jumping.floating_base import POSE, FloatingBase
from ocs_design.jumping.legged_body import LeggedBody

FRICTION = 0.6
"""Coefficient that a plan relies on: rubber on most dry floors has more."""

REACH = (0.40, 0.95)
"""Length of a leg over that of the stretched one: it folds no further, and keeps its knee bent."""

_Indices = NDArray[np.int64]


class Limit(IntEnum):
    """What a jump may ask too much of."""

    TORQUE = 0
    SPEED = 1
    FRICTION = 2


@dataclass(frozen=True)
class Layout:
    """Places of the unknowns in a node's column.

    Attributes:
        joints, legs: how many there are.
    """

    joints: int
    legs: int

    @property
    def coordinates(self) -> int:
        """Of trunk and joints."""
        return POSE + self.joints

    @property
    def y(self) -> slice:
        """Coordinates [m, rad]."""
        return slice(0, self.coordinates)

    @property
    def v(self) -> slice:
        """Their first derivatives."""
        return slice(self.coordinates, 2 * self.coordinates)

    @property
    def a(self) -> slice:
        """Their second derivatives."""
        return slice(2 * self.coordinates, 3 * self.coordinates)

    @property
    def f(self) -> slice:
        """Forces on the feet over the weight."""
        return slice(3 * self.coordinates, 3 * self.coordinates + 3 * self.legs)

    @property
    def duration(self) -> int:
        """Of the push-off [s]."""
        return 3 * self.coordinates + 3 * self.legs

    @property
    def size(self) -> int:
        """Of the column."""
        return self.duration + 1


@dataclass(frozen=True, eq=False)
class Node:
    """Rows of one node in symbols.

    Attributes:
        unknowns: one column, see `Layout`. load: parameters, see `floating_base.Load`.
        cost: per share of the time.
        rows: of all constraints, shape (m, 1), those of `END_ROWS` last.
        lower, upper: of the rows; those of the end are set by the jump, shape (m,).
        limit: which `Limit` may be overdrawn to keep each row; -1: none, shape (m,).
        feet, ground: of the rows that keep feet in place, and forces inside the cone.
        torque: of the joints [N m or N], shape (n, 1).
        layout: of the unknowns.
    """

    unknowns: ca.SX
    load: ca.SX
    cost: ca.SX
    rows: ca.SX
    lower: FloatArray
    upper: FloatArray
    limit: _Indices
    feet: _Indices
    ground: _Indices
    torque: ca.SX
    layout: Layout


END_ROWS = 6
"""Velocity of the centre of mass and angular momentum, both as numbers without unit."""


def node(body: LeggedBody) -> Node:
    """The rows of a robot; what differs between its jumps stays a symbol."""
    base = FloatingBase.of(body)
    layout = Layout(len(body.joints), len(body.legs))
    z = ca.SX.sym("z", layout.size)
    units = _Units.of(body, base)
    blocks = [
        _Block(_balance(base, units), 0.0, 0.0),
        _Block(_feet(body, base) / body.length, 0.0, 0.0),
        *_joint_limits(body, base),
        _Block(_friction(base, units), -np.inf, 0.0, Limit.FRICTION),
        _reach(body, base),
        _Block(_end(base, units), 0.0, 0.0),
    ]
    rows, cost, torque = _in_unknowns(
        base, units, layout, z, [_stacked(blocks), _cost(body, base, units), base.torque]
    )
    firsts = np.cumsum([0, *(block.rows.numel() for block in blocks)])
    return Node(
        unknowns=z,
        load=base.load.packed(),
        cost=cost,
        rows=rows,
        lower=np.concatenate([block.bound(block.lower) for block in blocks]),
        upper=np.concatenate([block.bound(block.upper) for block in blocks]),
        limit=np.concatenate([np.full(block.rows.numel(), int(block.limit)) for block in blocks]),
        feet=np.arange(firsts[1], firsts[2]),
        ground=np.arange(firsts[-4], firsts[-3]),
        torque=torque,
        layout=layout,
    )


@dataclass(frozen=True, eq=False)
class _Block:
    """Rows of one kind."""

    rows: ca.SX
    lower: FloatArray | float
    upper: FloatArray | float
    limit: Limit | int = -1

    def bound(self, value: FloatArray | float) -> FloatArray:
        """One value for each row, shape (m,)."""
        return np.array(np.broadcast_to(value, self.rows.numel()), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class _Units:
    """Of force [N], moment [N m], one leg's joint torque [N m], speed [m/s] and time [s]."""

    force: ca.SX
    moment: ca.SX
    torque: ca.SX
    speed: ca.SX
    time: ca.SX

    @classmethod
    def of(cls, body: LeggedBody, base: FloatingBase) -> "_Units":
        """Weight and leg length of the robot make all of them."""
        mass, gravity = base.load.trunk.mass + body.leg_mass, base.load.gravity
        force, length = mass * gravity, body.length
        return cls(
            force,
            force * length,
            force * length / len(body.legs),
            ca.sqrt(gravity * length),
            ca.sqrt(length / gravity),
        )


def _stacked(blocks: Sequence[_Block]) -> ca.SX:
    return ca.vertcat(*(block.rows for block in blocks))


def _balance(base: FloatingBase, units: _Units) -> ca.SX:
    """Nothing but the ground pushes the trunk."""
    return ca.vertcat(base.imbalance[:3] / units.force, base.imbalance[3:] / units.moment)


def _feet(body: LeggedBody, base: FloatingBase) -> ca.SX:
    """How far each foot has slid from where it stood; a ball rolls as its shank turns [m].

    A ball of radius r that turns by phi about y and chi about x rolls to (r phi, -r chi): exact as
    long as it turns about one axis, and these balls nearly do.
    """
    rows: list[ca.SX] = []
    standing = np.concatenate([[0.0, 0.0, body.height, 0.0, 0.0, 0.0], body.posture])
    found = ca.Function("stance", [base.y], [*base.feet, *base.shanks])(standing)
    count = len(body.legs)
    for i, leg in enumerate(body.legs):
        turn = base.shanks[i] @ found[count + i].T
        about_y = ca.atan2(turn[0, 2] - turn[2, 0], turn[0, 0] + turn[2, 2])
        about_x = ca.atan2(turn[2, 1] - turn[1, 2], turn[1, 1] + turn[2, 2])
        rolled = leg.foot_radius * ca.vertcat(about_y, -about_x, 0.0)
        rows.append(base.feet[i] - found[i] - rolled)
    return ca.vertcat(*rows)


def _joint_limits(body: LeggedBody, base: FloatingBase) -> Sequence[_Block]:
    """Torque and speed of each joint over its limit, both ways, where it has one."""
    torques, speeds = [], []
    for i, joint in enumerate(body.joints):
        if np.isfinite(effort := limit_or_inf(joint.effort)):
            torques += [base.torque[i] / effort, -base.torque[i] / effort]
        if np.isfinite(speed := limit_or_inf(joint.velocity)):
            speeds += [base.v[POSE + i] / speed, -base.v[POSE + i] / speed]
    return (
        _Block(ca.vertcat(ca.SX(0, 1), *torques), -np.inf, 1.0, Limit.TORQUE),
        _Block(ca.vertcat(ca.SX(0, 1), *speeds), -np.inf, 1.0, Limit.SPEED),
    )


def limit_or_inf(stated: float) -> float:
    """Of a joint; files write 0 where the author left it open."""
    return stated if stated > 0.0 else np.inf


def _friction(base: FloatingBase, units: _Units) -> ca.SX:
    """Forces outside the pyramid that is inscribed into the friction cone, in units of weight."""
    side = FRICTION / np.sqrt(2.0)
    rows: list[ca.SX] = []
    for i in range(base.f.numel() // 3):
        x, y, z = (base.f[3 * i + k] / units.force for k in range(3))
        rows += [x - side * z, -x - side * z, y - side * z, -y - side * z]
    return ca.vertcat(*rows)


def _reach(body: LeggedBody, base: FloatingBase) -> _Block:
    lengths = ca.DM([leg.length for leg in body.legs])
    shortest, longest = REACH
    return _Block(base.reach / lengths**2, shortest**2, longest**2)


def _end(base: FloatingBase, units: _Units) -> ca.SX:
    """See `END_ROWS`."""
    return ca.vertcat(
        base.momentum / (units.force / base.load.gravity * units.speed),
        base.spin / (units.moment * units.time),
    )


def _cost(body: LeggedBody, base: FloatingBase, units: _Units) -> ca.SX:
    """Joint torques above all; the rest is small and settles what they leave open."""
    shared = base.f / units.force * len(body.legs)
    sideways = ca.vertcat(shared[0::3], shared[1::3])
    swing = base.a[POSE:] * units.time**2
    sway = base.y[:2] / body.length
    cost: ca.SX = (
        ca.sumsqr(base.torque / units.torque)
        + 0.01 * ca.sumsqr(shared)
        + 0.3 * ca.sumsqr(sideways)
        + 0.001 * ca.sumsqr(swing)
        + 0.01 * ca.sumsqr(base.a[3:POSE] * units.time**2)
        + 0.1 * ca.sumsqr(sway)
        + 1.0 * ca.sumsqr(base.y[3:POSE])
    )
    return cost


def _in_unknowns(
    base: FloatingBase, units: _Units, layout: Layout, z: ca.SX, found: Sequence[ca.SX]
) -> Sequence[ca.SX]:
    """The same, with a node's unknowns in place of coordinates, rates and forces."""
    duration = z[layout.duration]
    stated = ca.vertcat(base.y, base.v, base.a, base.f)
    meant = ca.vertcat(
        z[layout.y], z[layout.v] / duration, z[layout.a] / duration**2, z[layout.f] * units.force
    )
    rows, cost, torque = ca.substitute(list(found), [stated], [meant])
    return rows, cost * duration / units.time, torque
