"""Robots in Pinocchio, with postures by joint name."""

import numpy as np
import pinocchio as pin


def free_model(path):
    """Pinocchio model of a URDF file, with a free base."""
    return pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())


def configuration(model, posture):
    """Pinocchio's q for a posture: other joints are at 0; unlimited joints have cosine and sine."""
    q = pin.neutral(model)
    for name, value in posture.items():
        joint = model.joints[model.getJointId(name)]
        coordinates = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        q[joint.idx_q : joint.idx_q + joint.nq] = coordinates
    return q
