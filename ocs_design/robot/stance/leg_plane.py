"""The plane in which a leg bends: hip and knee, and how long the leg is when stretched."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.stance.chain import Chain, ChainPose
from ocs_design.robot.stance.feet import ANKLED_JOINTS, is_wheel
from ocs_design.robot.tree import JointKind

_PARALLEL = 0.97
"""Joint axes whose unit vectors have at least this product count as parallel (14 degrees)."""


@dataclass(frozen=True, eq=False)
class LegPlane:
    """Geometry of a leg with all its joints at zero, in the chain's reference frame.

    Attributes:
        pitch: columns of the driven joints whose axes are parallel and bend the leg, hip first.
        axis: unit vector along them, shape (3,).
        hip: where the plane through the foot, across `axis`, meets the hip's axis [m], shape (3,).
        forward: unit vector in the plane, level, with its largest component positive, shape (3,).
        columns: columns of the driven joints that place the foot: all but a wheel's.
        flat: whether the leg has ankles that can keep its sole level.
        length: of the stretched leg within its limits, hip to foot [m]; 0 for slides alone.
    """

    pitch: tuple[int, ...]
    axis: FloatArray
    hip: FloatArray
    forward: FloatArray
    columns: tuple[int, ...]
    flat: bool
    length: float


def leg_plane(chain: Chain, foot: FloatArray, up: FloatArray) -> LegPlane:
    """The plane of a leg.

    The joints that bend a leg (hip pitch, knee and, in legs with ankles, ankle pitch) have parallel
    axes when all joints are at zero: the largest such set is taken, a wheel left out.

    Args:
        chain: the leg.
        foot: its foot in the last body's frame [m], shape (3,).
        up: unit vector against gravity in the chain's reference frame, shape (3,).
    """
    count = len(chain.driven)
    columns = tuple(range(count - 1 if is_wheel(chain.bodies[-1]) else count))
    zero = chain.pose(np.zeros(count))
    pitch = _pitch_joints(chain, zero, columns, up)
    flat = len(columns) >= ANKLED_JOINTS
    row = chain.driven[pitch[0]]
    axis, origin = zero.axes[row], zero.origins[row]
    hip = origin + axis * (axis @ (zero.point(foot) - origin))
    length = _stretched_length(chain, foot, hip, up, pitch[:2] if flat else pitch)
    return LegPlane(pitch, axis, hip, _forward(axis, up), columns, flat, length)


def _pitch_joints(
    chain: Chain, zero: ChainPose, columns: Sequence[int], up: FloatArray
) -> tuple[int, ...]:
    """Columns of the largest set of parallel hinges; of equal sets, the one spread widest."""
    sets = []
    for column in columns:
        axis = zero.axes[chain.driven[column]]
        alike = tuple(c for c in columns if _parallel(chain, zero, c, axis))
        if alike and abs(axis @ up) < _PARALLEL:
            spread = np.ptp([up @ zero.origins[chain.driven[c]] for c in alike])
            sets.append((len(alike), float(spread), alike))
    return max(sets)[2] if sets else (columns[0],)


def _parallel(chain: Chain, zero: ChainPose, column: int, axis: FloatArray) -> bool:
    row = chain.driven[column]
    hinge = chain.joints[row].kind is JointKind.REVOLUTE
    return hinge and bool(abs(zero.axes[row] @ axis) > _PARALLEL)


def _forward(axis: FloatArray, up: FloatArray) -> FloatArray:
    forward = np.cross(axis, up)
    length = float(np.linalg.norm(forward))
    if length < 1e-9:
        return np.zeros(3)
    leading = forward[np.argmax(np.abs(forward))]
    return np.asarray(np.sign(leading) * forward / length)


def _stretched_length(
    chain: Chain, foot: FloatArray, hip: FloatArray, up: FloatArray, pitch: Sequence[int]
) -> float:
    """How far below the hip the foot can be brought within the limits [m]; 0 if nothing bends."""
    if chain.joints[chain.driven[pitch[0]]].kind is JointKind.PRISMATIC:
        return 0.0
    stretched = chain.pose(chain.stretched(foot, -up, pitch))
    return float(up @ (hip - stretched.point(foot)))
