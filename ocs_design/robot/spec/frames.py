"""Rotations as MuJoCo writes them."""

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray


def quaternion(rotation: FloatArray) -> FloatArray:
    """The unit quaternion (w, x, y, z) of a rotation matrix (3, 3), shape (4,)."""
    found = np.empty(4)
    mujoco.mju_mat2Quat(found, np.ascontiguousarray(rotation, dtype=np.float64).ravel())
    return found
