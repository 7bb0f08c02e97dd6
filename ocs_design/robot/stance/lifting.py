"""A foot straight up and down under a trunk that stays where it is."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.stance.chain import Chain

_SWEEPS = 10
"""Newton steps from one height to the next."""

_DAMPING = 1e-3
"""Over the leg's length: how near to a stretched leg the steps are shortened."""


def lifted(
    chain: Chain, foot: FloatArray, length: float, posture: FloatArray, heights: FloatArray
) -> FloatArray:
    """Joints that lift the foot to each height in turn, within their limits, shape (k, n).

    Damped Newton steps from each height to the next.

    Args:
        chain: of the leg. foot: in its last body's frame [m], shape (3,). length: of the leg [m].
        posture: of its driven joints at height zero [rad or m], shape (n,).
        heights: of the foot over where it is then, in B [m], shape (k,).
    """
    values = posture
    at_rest = chain.pose(posture).point(foot)
    damping = (_DAMPING * length) ** 2 * np.eye(3)
    found = []
    for height in heights:
        target = at_rest + np.array([0.0, 0.0, height])
        for _ in range(_SWEEPS):
            pose = chain.pose(values)
            miss = target - pose.point(foot)
            jacobian = chain.point_jacobian(pose, pose.point(foot))
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping, miss)
            values = np.clip(values + step, chain.lower, chain.upper)
        found.append(values)
    return np.array(found)
