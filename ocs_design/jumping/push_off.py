"""The push-off of least effort for a jump, or the limits that forbid one."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.floating_base import POSE, FloatingBase, Load
from ocs_design.jumping.jump import Jump
from ocs_design.jumping.legged_body import LeggedBody
from ocs_design.jumping.node import (
    FRICTION,
    NODES,
    REACH,
    SHARES,
    Node,
    NodeLayout,
    SoftLimit,
    limit_or_inf,
)
from ocs_design.jumping.program import Program, PushOffSolution
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.stance import lifted
from ocs_design.robot.tree import JointKind

_CROUCH = 0.25
"""Depth of the crouch at the start of the search, over the leg's length."""

_LEAST_LOAD = 0.2
"""Least load of a foot until lift-off, over its share of the weight: with less it might slip."""

_TILT = 0.3
"""Largest roll, pitch and yaw of the trunk while it pushes [rad]."""

_WINDING = 6.0
"""Largest angle of joints without limits [rad]."""

_LIMIT_TOLERANCE = 1e-3
"""Share by which a limit may be exceeded and still counts as kept."""


@dataclass(frozen=True, eq=False)
class PushOff:
    """A push-off.

    Attributes:
        time: of the nodes [s], shape (k,).
        y: trunk and joints [m, rad], shape (k, 6 + n); v and a: their derivatives.
        torque: of the joints [N m or N], shape (k, n).
        force: of the ground on each foot, in the world [N], shape (k, legs, 3).
        forbidden: limits that forbid it, as a sentence; empty if none does.
        answer: solution of the program, from which to start the search for a similar push-off.
    """

    time: FloatArray
    y: FloatArray
    v: FloatArray
    a: FloatArray
    torque: FloatArray
    force: FloatArray
    forbidden: str
    answer: PushOffSolution

    def joints_at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions and velocities of the joints on the cubic splines, shape (len(times), n)."""
        y, v, a = (values[:, POSE:] for values in (self.y, self.v, self.a))
        jerk = np.diff(a, axis=0) / np.diff(self.time)[:, None]
        spline = PPoly(np.array([jerk / 6.0, a[:-1] / 2.0, v[:-1], y[:-1]]), self.time)
        return np.asarray(spline(times)), np.asarray(spline(times, 1))


class PushOffs:
    """Finds the push-offs of one robot; its program is built once.

    Attributes:
        body: the robot.
    """

    def __init__(self, body: LeggedBody, base: FloatingBase) -> None:
        self.body = body
        self._node = Node.of(body, base)
        self._program = Program(self._node)

    def find(
        self,
        jump: Jump,
        trunk: MassProperties,
        *,
        spin: FloatArray | None = None,
        similar: "PushOff | None" = None,
    ) -> PushOff:
        """The push-off of least effort.

        Args:
            trunk: with everything that it carries, in B.
            spin: angular momentum about the centre of mass at lift-off, in B [kg m^2/s], shape
                (3,); None: none.
            similar: another push-off of this jump, from which to start the search.
        """
        body, layout = self.body, self._node.layout
        duration, height = _crouch(body, jump)
        lower, upper = _bounds_of_unknowns(body, layout, duration)
        mass = trunk.mass + body.leg_mass
        unit = np.sqrt(jump.gravity * body.length)
        velocity = np.array([jump.forward, 0.0, jump.upward]) / unit
        turning = np.zeros(3) if spin is None else spin / (mass * unit * body.length)
        end = np.concatenate([velocity, turning])
        bounds = lower, upper, end, Load.values(jump.gravity, trunk)
        solution = None if similar is None else self._program.solve(similar.answer, *bounds)
        if solution is None or not solution.solved:
            guess = _initial_guess(body, layout, jump.gravity, duration, height)
            start = np.clip(guess, lower, upper)
            solution = self._program.solve(start, *bounds)
        z = solution.nodes
        duration = z[layout.duration, -1]
        return PushOff(
            time=SHARES * duration,
            y=z[layout.y].T,
            v=z[layout.v].T / duration,
            a=z[layout.a].T / duration**2,
            torque=solution.torque.T,
            force=z[layout.f].T.reshape(NODES, -1, 3) * (mass * jump.gravity),
            forbidden=_exceeded_limits(body, layout, solution),
            answer=solution,
        )


def _crouch(body: LeggedBody, jump: Jump) -> tuple[float, FloatArray]:
    """Initial guess of the trunk's motion, down and up again.

    It falls at 0.6 g, and rises at constant acceleration to the specified speed.

    Returns:
        Duration [s]; height of the trunk above its stance at the nodes [m].
    """
    depth, stretched = _CROUCH * body.length, 0.0
    for leg, where in body.joint_slices:
        pose = leg.chain.pose(body.posture[where])
        span, axis = pose.point(leg.foot) - pose.origins[leg.hip], pose.axes[leg.hip]
        standing = float(np.linalg.norm(span - axis * (axis @ span)))
        stretched = max(stretched, REACH[1] * leg.length - standing)
    rise = max(0.9 * stretched, 0.02 * body.length)
    down = 2.0 * float(np.sqrt(2.0 * depth / (0.6 * jump.gravity)))
    duration = down + 2.0 * (depth + rise) / jump.upward
    bottom = down / duration
    first = np.clip(SHARES / bottom, 0.0, 1.0)
    second = np.clip((SHARES - bottom) / (1.0 - bottom), 0.0, 1.0)
    falling = -0.5 * depth * (1.0 - np.cos(np.pi * first))
    rising = -depth + (depth + rise) * second**2
    return duration, np.where(bottom > SHARES, falling, rising)


def _initial_guess(
    body: LeggedBody, layout: NodeLayout, gravity: float, duration: float, height: FloatArray
) -> FloatArray:
    """Initial guess of the unknowns: level trunk over fixed feet, shape (size, nodes)."""
    guess = np.zeros((layout.size, NODES))
    guess[2] = body.height + height
    for leg, where in body.joint_slices:
        rows = slice(POSE + where.start, POSE + where.stop)
        lifts = body.height - guess[2]
        guess[rows] = lifted(leg.chain, leg.foot, leg.length, body.posture[where], lifts).T
    # From rest, with a natural end.
    spline = CubicSpline(SHARES, guess[layout.y], axis=1, bc_type=("clamped", "natural"))
    guess[layout.v], guess[layout.a] = spline(SHARES, 1), spline(SHARES, 2)
    rising = guess[layout.a][2] / duration**2 / gravity
    guess[layout.f][2::3] = np.maximum(1.0 + rising, 0.2) / len(body.legs)
    guess[layout.duration] = duration
    return guess


def _bounds_of_unknowns(
    body: LeggedBody, layout: NodeLayout, duration: float
) -> tuple[FloatArray, FloatArray]:
    """Bounds of all nodes' unknowns, shape (size, nodes) each."""
    lower = np.full((layout.size, NODES), -np.inf)
    upper = np.full((layout.size, NODES), np.inf)
    length, legs = body.length, len(body.legs)
    box = np.array([0.5 * length, 0.2 * length, 2.0 * body.height, _TILT, _TILT, _TILT])
    lower[: len(box)], upper[: len(box)] = -box[:, None], box[:, None]
    joints = slice(len(box), layout.y.stop)
    lower[joints] = np.array([max(j.lower, -_WINDING) for j in body.joints])[:, None]
    upper[joints] = np.array([min(j.upper, _WINDING) for j in body.joints])[:, None]
    lower[layout.f][2::3] = _LEAST_LOAD / legs
    lower[layout.duration], upper[layout.duration] = 0.3 * duration, 2.0 * duration
    stance = np.concatenate([[0.0, 0.0, body.height, 0.0, 0.0, 0.0], body.posture])
    lower[layout.y, 0] = upper[layout.y, 0] = stance
    lower[layout.v, 0] = upper[layout.v, 0] = 0.0
    # Level at lift-off, when the feet carry nothing.
    lower[3:6, -1] = upper[3:6, -1] = 0.0
    lower[layout.f, -1] = upper[layout.f, -1] = 0.0
    return lower, upper


def _exceeded_limits(body: LeggedBody, layout: NodeLayout, solution: PushOffSolution) -> str:
    """Limits that the push-off exceeds, and by how much, as text; empty if none."""
    duration, sentences = solution.nodes[layout.duration, -1], []
    speed = solution.nodes[layout.v][-layout.joints :] / duration
    # Units for hinges and for slides.
    for limit, quantity, name, units, values in (
        (SoftLimit.TORQUE, "torque", "effort", ("N m", "N"), solution.torque),
        (SoftLimit.SPEED, "speed", "velocity", ("rad/s", "m/s"), speed),
    ):
        if solution.excess[limit] <= _LIMIT_TOLERANCE:
            continue
        limits = np.array([limit_or_inf(getattr(joint, name)) for joint in body.joints])
        # The joint that needs the largest share of its limit, and when; the last of equal ones.
        share = np.abs(values) / limits[:, None]
        row, instant = np.argwhere(share >= (1.0 - _LIMIT_TOLERANCE) * share.max())[-1]
        joint, time = body.joints[row], duration * float(SHARES[instant])
        unit = units[joint.kind is JointKind.PRISMATIC]
        sentences.append(
            f"the {quantity} of joint '{joint.name}' would be {abs(values[row, instant]):.3g} "
            f"{unit} at {time:.3g} s, more than its {limits[row]:.3g} {unit}"
        )
    if solution.excess[SoftLimit.FRICTION] > _LIMIT_TOLERANCE:
        sentences.append(f"the feet would need a coefficient of friction above {FRICTION}")
    if not sentences and not solution.solved:
        return "no push-off was found within the legs' reach"
    return "; ".join(sentences)
