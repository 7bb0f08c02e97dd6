"""Robots in Pinocchio, at postures by name."""

import numpy as np
import pinocchio as pin


def free_model(path):
    """A URDF file with a free base."""
    return pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())


def configuration(model, posture):
    """Pinocchio's q: all else is at 0, and a joint without limits is its cosine and sine."""
    q = pin.neutral(model)
    for name, value in posture.items():
        joint = model.joints[model.getJointId(name)]
        turn = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        q[joint.idx_q : joint.idx_q + joint.nq] = turn
    return q
