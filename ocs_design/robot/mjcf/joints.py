"""Joints of a compiled MJCF model.

Several joints of one body act one after the other, each about its own anchor; see MuJoCo's
documentation, chapter Modeling, `body/joint`.
"""

from collections.abc import Iterator

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.files.links import Connection
from ocs_design.robot.mjcf.drives import effort_limit, leader_of
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.rotations import rotation_from_quaternion
from ocs_design.robot.tree import Joint, JointKind, Placement, joint_motion

_KINDS = {
    int(mujoco.mjtJoint.mjJNT_HINGE): JointKind.REVOLUTE,
    int(mujoco.mjtJoint.mjJNT_SLIDE): JointKind.PRISMATIC,
}


def connections_to(model: mujoco.MjModel, body: int, remarks: Remarks) -> Iterator[Connection]:
    """How a body hangs on its parent: one connection for each of its joints, or a rigid one."""
    name = model.body(body).name
    parent = model.body(int(model.body_parentid[body])).name
    place = Placement(rotation_from_quaternion(model.body_quat[body]), model.body_pos[body])
    joints = list(_scalar_joints(model, body, remarks))
    if not joints:
        yield Connection(name, parent, name, place)
    for index in joints:
        joint = _joint(model, index, remarks)
        anchor = _shift(model.jnt_pos[index])
        # MuJoCo's joint does not move its body at `ref`; a joint of the tree does not at zero.
        at_zero = joint_motion(joint, -float(model.qpos0[model.jnt_qposadr[index]]))
        is_last = index == joints[-1]
        child = name if is_last else f"{name}:{joint.name}"
        yield Connection(
            joint.name,
            parent,
            child,
            place @ anchor @ at_zero,
            joint,
            child_in_joint=anchor.inverse(),
        )
        parent, place = child, Placement.identity()


def _scalar_joints(model: mujoco.MjModel, body: int, remarks: Remarks) -> Iterator[int]:
    first = int(model.body_jntadr[body])
    for index in range(first, first + int(model.body_jntnum[body])):
        if int(model.jnt_type[index]) in _KINDS:
            yield index
        else:
            remarks.add("ball joints, held at their reference", model.joint(index).name)


def _joint(model: mujoco.MjModel, index: int, remarks: Remarks) -> Joint:
    degree = int(model.jnt_dofadr[index])
    lower, upper = model.jnt_range[index] if model.jnt_limited[index] else (-np.inf, np.inf)
    return Joint(
        model.joint(index).name,
        _KINDS[int(model.jnt_type[index])],
        np.array(model.jnt_axis[index]),
        float(lower),
        float(upper),
        effort=effort_limit(model, index),
        damping=float(np.ravel(model.dof_damping[degree])[0]),
        friction=float(model.dof_frictionloss[degree]),
        armature=float(model.dof_armature[degree]),
        mimic=leader_of(model, index, remarks),
    )


def _shift(position: FloatArray) -> Placement:
    return Placement(np.eye(3), position)
