"""Frames: rotation matrices from axes and angles, and placements in one another.

Rotations are those of robot files. SciPy's `Rotation` would do the same, but importing it
takes 0.3 s of processor time, and reading a robot in a known posture loads nothing else of SciPy.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.common.arrays import FloatArray, frozen


def cross(one: FloatArray, other: FloatArray) -> FloatArray:
    """Cross product of two vectors, shape (3,); on one pair `np.cross` takes ten times as long."""
    (a, b, c), (x, y, z) = one, other
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def rotation_about(axis: FloatArray, angle: float) -> FloatArray:
    """Rotation by `angle` [rad] about the unit vector `axis` (Rodrigues), shape (3, 3)."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: FloatArray = (
        np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * (across @ across)
    )
    return rotation


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> FloatArray:
    """Roll, pitch, yaw [rad] about the fixed axes x, y, z in turn, as in URDF, shape (3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rpy_from_rotation(rotation: FloatArray) -> FloatArray:
    """Roll, pitch and yaw [rad] about the fixed axes x, y, z in turn, shape (3,).

    If the pitch is a right angle, roll and yaw share an axis; the yaw is then zero.
    """
    cosine = np.hypot(rotation[0, 0], rotation[1, 0])
    pitch = np.arctan2(-rotation[2, 0], cosine)
    if cosine < 1e-7:
        return np.array([np.arctan2(-rotation[1, 2], rotation[1, 1]), pitch, 0.0])
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    return np.array([roll, pitch, np.arctan2(rotation[1, 0], rotation[0, 0])])


BACKWARDS = frozen([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Rotation of a frame whose z axis points backwards, y to the left and x up."""

FORWARDS = frozen([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Rotation of a frame whose z axis points forward, x to the left and y up."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Rotation and position of one frame in another.

    Attributes:
        rotation: maps coordinates of the frame to the other, shape (3, 3).
        position: of the frame's origin in the other [m], shape (3,).
    """

    rotation: FloatArray
    position: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "rotation", frozen(self.rotation))
        object.__setattr__(self, "position", frozen(self.position))

    @classmethod
    def identity(cls) -> "Placement":
        """The frame in itself."""
        return cls(np.eye(3), np.zeros(3))

    def __matmul__(self, inner: "Placement") -> "Placement":
        return Placement(self.rotation @ inner.rotation, self.point(inner.position))

    def point(self, inner: ArrayLike) -> FloatArray:
        """A point of the frame in coordinates of the other, shape (3,)."""
        return np.asarray(self.rotation @ np.asarray(inner, np.float64) + self.position)

    def inverse(self) -> "Placement":
        """The other frame in this one."""
        return Placement(self.rotation.T, -self.rotation.T @ self.position)
