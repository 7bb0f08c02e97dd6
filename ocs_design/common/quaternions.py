"""Batches of unit quaternions (w, x, y, z), scalar first, as in MuJoCo.

Written out by component: the wheel law calls these a thousand times per simulated second, and a
call to a general rotation class would cost more than the physics.
"""

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.common.arrays import FloatArray


def from_axis_angle(axis: FloatArray, angle: FloatArray | float) -> FloatArray:
    """Rotation by `angle` [rad], shape (...), about the unit `axis` (..., 3); shape (..., 4)."""
    half = 0.5 * np.asarray(angle)
    return np.concatenate([np.cos(half)[..., None], np.sin(half)[..., None] * axis], axis=-1)


def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Hamilton product: first `right`, then `left`, shape (..., 4)."""
    a, b, c, d = (left[..., i] for i in range(4))
    w, x, y, z = (right[..., i] for i in range(4))
    return np.stack(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ],
        axis=-1,
    )


def conjugate(quaternion: FloatArray) -> FloatArray:
    """The inverse rotation, shape (..., 4)."""
    inverse: FloatArray = quaternion * np.array([1.0, -1.0, -1.0, -1.0])
    return inverse


def rotation_vector(quaternion: FloatArray) -> FloatArray:
    """Rotation vector, of at most half a turn [rad], shape (..., 3)."""
    shorter = np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
    sine = np.linalg.norm(shorter[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, shorter[..., :1])
    vector: FloatArray = shorter[..., 1:] * angle / (sine + 1e-30)
    return vector


def matrix(quaternion: FloatArray) -> FloatArray:
    """Rotation matrices, shape (..., 3, 3)."""
    w, x, y, z = (quaternion[..., i] for i in range(4))
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def rotation_from_quaternion(wxyz: ArrayLike) -> FloatArray:
    """Rotation matrix of a quaternion (w, x, y, z) of any nonzero length, shape (3, 3)."""
    quaternion = np.asarray(wxyz, dtype=np.float64)
    return matrix(quaternion / np.linalg.norm(quaternion))


def vertical(quaternion: FloatArray) -> FloatArray:
    """The world's upward direction in the rotated frame, unit vectors (..., 3)."""
    w, x, y, z = (quaternion[..., i] for i in range(4))
    upward = np.empty_like(quaternion[..., :3])
    upward[..., 0] = 2.0 * (x * z - w * y)
    upward[..., 1] = 2.0 * (y * z + w * x)
    upward[..., 2] = 1.0 - 2.0 * (x * x + y * y)
    return upward


def scaled_vertical(attitude: FloatArray) -> FloatArray:
    """The world's upward direction in B times the attitude's squared length, shape (..., 3)."""
    w, x, y, z = np.moveaxis(attitude, -1, 0)
    return np.stack(
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z], axis=-1
    )


def rotated_to_world(attitude: FloatArray, vectors: FloatArray) -> FloatArray:
    """Vectors of B in the world, shape (..., 3), for attitudes (..., 4)."""
    pure = np.concatenate([np.zeros_like(vectors[..., :1]), vectors], axis=-1)
    return product(product(attitude, pure), conjugate(attitude))[..., 1:]


def upright(direction: FloatArray) -> FloatArray:
    """Attitude in which a direction of B points up, the nearest to level, shape (4,)."""
    x, y, z = direction / np.linalg.norm(direction)
    half = np.array([1.0 + z, y, -x, 0.0])
    return np.asarray(half / np.linalg.norm(half))


def tilt(quaternion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Roll and pitch of the trunk from the vertical [rad], whatever its heading; shapes (...).

    Pitch is the angle of the vertical in the trunk's x-z plane, full circle, so that it can be
    unwrapped through a flip; roll is the elevation of the trunk's y axis. Near level both are the
    usual roll and pitch.
    """
    x, y, z = np.moveaxis(vertical(quaternion), -1, 0)
    return np.arcsin(np.clip(y, -1.0, 1.0)), np.arctan2(-x, z)


def heading(quaternion: FloatArray) -> FloatArray:
    """Rotation about the vertical by swing-twist decomposition [rad], shape (...)."""
    return 2.0 * np.arctan2(quaternion[..., 3], quaternion[..., 0])
