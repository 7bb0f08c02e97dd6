"""A limb as an open kinematic chain: forward kinematics, Jacobian and reach.

`Tree.placements` moves every body; the inverse kinematics of a limb needs only its own bodies.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement, cross, rotation_about
from ocs_design.robot.tree import Body, Joint, JointKind, Tree

_SWEEPS = 40

_STRETCHED_SHARE = 0.5
"""Share of a limb's length below which the ascent may not have stretched it fully."""

_RESTART_OFFSETS = (0.5, -0.5)
"""Offsets from zero at which the ascent restarts [rad]."""

_RESTART_GAIN = 0.01
"""Share of a limb's length by which a restart must be better, so that rounding does not decide."""


@dataclass(frozen=True, eq=False)
class ChainPose:
    """Pose of a chain at some joint values, in the chain's reference frame.

    Attributes:
        axes: of every joint, shape (n, 3).
        origins: of every joint [m], shape (n, 3).
        end: placement of the last body.
    """

    axes: FloatArray
    origins: FloatArray
    end: Placement

    def point(self, local: FloatArray) -> FloatArray:
        """A point of the last body, in the reference frame [m], shape (3,)."""
        return self.end.point(local)


@dataclass(frozen=True, eq=False)
class Chain:
    """Bodies in series.

    Attributes:
        start: placement of the first body's parent in the reference frame.
        bodies: from the first that moves relative to the start to the last.
    """

    start: Placement
    bodies: tuple[Body, ...]

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Joint of each body, mimics included."""
        return tuple(body.joint for body in self.bodies if body.joint is not None)

    @cached_property
    def driven(self) -> tuple[int, ...]:
        """Indices of the joints that move independently, as opposed to mimics."""
        return tuple(i for i, joint in enumerate(self.joints) if joint.mimic is None)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the driven joints."""
        return tuple(self.joints[i].name for i in self.driven)

    @cached_property
    def lower(self) -> FloatArray:
        """Lower limits of the driven joints [rad or m]."""
        return np.array([self.joints[i].lower for i in self.driven])

    @cached_property
    def upper(self) -> FloatArray:
        """Upper limits of the driven joints [rad or m]."""
        return np.array([self.joints[i].upper for i in self.driven])

    @cached_property
    def _coupling(self) -> tuple[FloatArray, FloatArray]:
        """All joints as `matrix @ driven + offset`; mimics of joints elsewhere are at rest."""
        columns = {name: column for column, name in enumerate(self.names)}
        matrix, offset = np.zeros((len(self.joints), len(columns))), np.zeros(len(self.joints))
        for row, joint in enumerate(self.joints):
            leader, factor, shift = joint.mimic or (joint.name, 1.0, 0.0)
            offset[row] = shift
            if leader in columns:
                matrix[row, columns[leader]] = factor
        return matrix, offset

    def neutral(self) -> FloatArray:
        """Each driven joint at zero, or at the limit nearest to it [rad or m]."""
        return np.clip(np.zeros(len(self.driven)), self.lower, self.upper)

    @cached_property
    def _slides(self) -> NDArray[np.bool_]:
        """Mask of the prismatic joints, shape (n,)."""
        return np.array([joint.kind is JointKind.PRISMATIC for joint in self.joints])

    @cached_property
    def _crosses(self) -> FloatArray:
        """Cross-product matrix of each joint's axis, in its body's frame, shape (n, 3, 3)."""
        axes = np.array([joint.axis for joint in self.joints])
        return np.cross(axes[:, None, :], np.eye(3)).transpose(0, 2, 1)

    def pose(self, values: FloatArray) -> ChainPose:
        """Forward kinematics at the driven joints' `values` [rad or m]."""
        matrix, offset = self._coupling
        travels = matrix @ values + offset
        # Rodrigues' formula for all joints at once: the solver spends most of its time here.
        angles = np.where(self._slides, 0.0, travels)[:, None, None]
        crosses = self._crosses
        turns = np.eye(3) + np.sin(angles) * crosses + (1 - np.cos(angles)) * (crosses @ crosses)
        rotation, position = self.start.rotation, self.start.position
        axes, origins = np.empty((len(self.joints), 3)), np.empty((len(self.joints), 3))
        for i, body in enumerate(self.bodies):
            position = rotation @ body.placement.position + position
            rotation = rotation @ body.placement.rotation
            axes[i] = rotation @ self.joints[i].axis
            if self._slides[i]:
                position = position + travels[i] * axes[i]
            rotation = rotation @ turns[i]
            origins[i] = position
        return ChainPose(axes, origins, Placement(rotation, position))

    def point_jacobian(self, pose: ChainPose, point: FloatArray) -> FloatArray:
        """Jacobian of a point of the last body w.r.t. the driven joints, shape (3, driven)."""
        columns = np.cross(pose.axes, point - pose.origins)
        columns[self._slides] = pose.axes[self._slides]
        return columns.T @ self._coupling[0]

    def direction_jacobian(self, pose: ChainPose, direction: FloatArray) -> FloatArray:
        """Jacobian of a direction of the last body w.r.t. the driven joints, shape (3, driven)."""
        columns = np.cross(pose.axes, direction)
        columns[self._slides] = 0.0
        return columns.T @ self._coupling[0]

    def stretched(
        self,
        local: FloatArray,
        direction: FloatArray,
        movable: Sequence[int] | None = None,
        *,
        start: FloatArray | None = None,
    ) -> FloatArray:
        """Driven joints' values that bring a point of the last body farthest along `direction`.

        Cyclic coordinate ascent within the limits: along a single hinge the objective is a
        sinusoid, whose maximum is known in closed form (Wang and Chen, IEEE T-RA 7(4), 1991).
        Prismatic joints are not moved. A limb folded onto itself at zero is at a saddle point; if
        the first ascent leaves it short, it restarts with every joint turned. Joints that are not
        `movable` stay as in `start`, by default at zero or at the limit nearest to it.
        """
        columns = range(len(self.driven)) if movable is None else movable
        start = self.neutral() if start is None else np.clip(start, self.lower, self.upper)
        best, extension = self._coordinate_ascent(local, direction, columns, start)
        span = self.span(local)
        for turn in _RESTART_OFFSETS if extension < _STRETCHED_SHARE * span else ():
            turned = start.copy()
            turned[list(columns)] += turn
            turned = np.clip(turned, self.lower, self.upper)
            values, restarted = self._coordinate_ascent(local, direction, columns, turned)
            if restarted > extension + _RESTART_GAIN * span:
                best, extension = values, restarted
        return best

    def span(self, local: FloatArray) -> float:
        """Length of the path from the first joint via all others to a point of the last [m]."""
        lengths = [np.linalg.norm(body.placement.position) for body in self.bodies[1:]]
        return float(sum(lengths) + np.linalg.norm(local))

    def _coordinate_ascent(
        self, local: FloatArray, direction: FloatArray, columns: Sequence[int], start: FloatArray
    ) -> tuple[FloatArray, float]:
        """Values at which the ascent ends, and how far the point is from the first joint [m]."""
        values = start.copy()
        for _ in range(_SWEEPS):
            before = values.copy()
            pose = self.pose(values)
            tip = pose.point(local)
            # From the tip inwards, so that turning a joint does not move those still to be turned.
            for column in reversed(columns):
                row = self.driven[column]
                if self.joints[row].kind is JointKind.PRISMATIC:
                    continue
                lever, axis = tip - pose.origins[row], pose.axes[row]
                cosine = direction @ (lever - axis * (axis @ lever))
                sine = direction @ cross(axis, lever)
                if np.hypot(cosine, sine) < 1e-9 * max(1e-9, float(np.linalg.norm(lever))):
                    continue
                value = nearest_turn(
                    float(values[column] + np.arctan2(sine, cosine)),
                    float(self.lower[column]),
                    float(self.upper[column]),
                )
                tip = pose.origins[row] + rotation_about(axis, value - values[column]) @ lever
                values[column] = value
            if np.abs(values - before).max(initial=0.0) < 1e-6:
                break
        pose = self.pose(values)
        return values, float(direction @ (pose.point(local) - pose.origins[0]))


def nearest_turn(angle: float, lower: float, upper: float) -> float:
    """The angle within the limits nearest to `angle`, modulo whole turns [rad].

    Of equivalent angles within the limits, the one nearest to zero.
    """
    wrapped = (angle + np.pi) % (2.0 * np.pi) - np.pi
    turns = wrapped + 2.0 * np.pi * np.array([0.0, 1.0, -1.0])
    clipped = np.clip(turns, lower, upper)
    return float(clipped[np.argmin(np.abs(clipped - turns))])


def chain_of(tree: Tree, base: int, last: int, placements: Sequence[Placement]) -> Chain:
    """The chain that hangs on body `base` and ends with body `last`, its descendant.

    Args:
        tree: of the robot.
        base, last: indices of the two bodies.
        placements: of all bodies in the reference frame.
    """
    return Chain(placements[base], tuple(tree.bodies[i] for i in tree.path(base, last)))


def neutral_posture(tree: Tree) -> Mapping[str, float]:
    """Every joint at zero, or at the limit nearest to it [rad or m]."""
    zero = {name: min(max(0.0, j.lower), j.upper) for name, j in tree.joints.items()}
    return tree.complete(zero)
