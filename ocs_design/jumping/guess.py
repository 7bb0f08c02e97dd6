"""Where the search for a push-off begins: the trunk crouches and rises, level, over still feet."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.jumping.floating_base import POSE
from ocs_design.jumping.jump import Jump
from ocs_design.jumping.legged_body import JumpingLeg, LeggedBody
from ocs_design.jumping.mesh import NODES, SHARES, spline_slopes
from ocs_design.jumping.node import REACH, Layout
from ocs_design.robot.stance.lifting import lifted

_CROUCH = 0.25
"""Of the leg's length."""


@dataclass(frozen=True, eq=False)
class Crouch:
    """Down and up again.

    Attributes:
        depth, rise: of the trunk below and above its height in stance [m].
        down, up: how long each takes [s].
    """

    depth: float
    rise: float
    down: float
    up: float

    @classmethod
    def of(cls, body: LeggedBody, jump: Jump) -> "Crouch":
        """With a fall at 0.6 g, and a rise at constant acceleration to the speed at lift-off."""
        depth = _CROUCH * body.length
        stretched = max(REACH[1] * leg.length - _stance_length(leg, body) for leg in body.legs)
        rise = max(0.9 * stretched, 0.02 * body.length)
        return cls(
            depth,
            rise,
            2.0 * float(np.sqrt(2.0 * depth / (0.6 * jump.gravity))),
            2.0 * (depth + rise) / jump.upward,
        )

    @property
    def duration(self) -> float:
        """[s]."""
        return self.down + self.up

    def height(self, share: FloatArray) -> FloatArray:
        """Of the trunk against its stance [m], at shares of the duration: half a cosine each."""
        bottom = self.down / self.duration
        falling = share < bottom
        first = np.clip(share / bottom, 0.0, 1.0)
        second = np.clip((share - bottom) / (1.0 - bottom), 0.0, 1.0)
        down = -0.5 * self.depth * (1.0 - np.cos(np.pi * first))
        up = -self.depth + (self.depth + self.rise) * second**2
        return np.where(falling, down, up)


def guess(body: LeggedBody, jump: Jump) -> FloatArray:
    """Unknowns of all nodes, shape (size, nodes)."""
    layout, crouch = Layout(len(body.joints), len(body.legs)), Crouch.of(body, jump)
    found = np.zeros((layout.size, NODES))
    found[2] = body.height + crouch.height(SHARES)
    for leg, where in body.joint_slices:
        rows = slice(POSE + where.start, POSE + where.stop)
        lifts = body.height - found[2]
        found[rows] = lifted(leg.chain, leg.foot, leg.length, body.posture[where], lifts).T
    found[layout.v], found[layout.a] = spline_slopes(found[layout.y])
    rising = found[layout.a][2] / crouch.duration**2 / jump.gravity
    found[layout.f][2::3] = np.maximum(1.0 + rising, 0.2) / len(body.legs)
    found[layout.duration] = crouch.duration
    return found


def _stance_length(leg: JumpingLeg, body: LeggedBody) -> float:
    """From the hip's axis to the foot in stance [m]."""
    where = next(where for each, where in body.joint_slices if each is leg)
    pose = leg.chain.pose(body.posture[where])
    span = pose.point(leg.foot) - pose.origins[leg.hip]
    axis = pose.axes[leg.hip]
    return float(np.linalg.norm(span - axis * (axis @ span)))
