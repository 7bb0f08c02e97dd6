"""How the trunk stands and turns, for a batch of generalised coordinates.

The wheels and the law live on the trunk, which in some robots hangs below the floating base by
joints (a humanoid's chest over its pelvis). For most robots the chain is empty.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.tree import Body, JointKind, Tree
from ocs_design.simulation import quaternions


@dataclass(frozen=True, eq=False)
class Link:
    """One hinge between the floating base and the trunk.

    Attributes:
        fixed: of the child's frame in its parent at zero, quaternion (4,).
        axis: in the child's frame, shape (3,).
        position, velocity: index of the joint in qpos and in qvel.
    """

    fixed: FloatArray
    axis: FloatArray
    position: int
    velocity: int


@dataclass(frozen=True, eq=False)
class TrunkChain:
    """From the floating base to the trunk's frame B.

    Attributes:
        position, velocity: where the free joint starts in qpos and in qvel.
        links: from the base outwards; slides do not turn the trunk and are left out.
        end: frame B in the last body, quaternion (4,).
    """

    position: int
    velocity: int
    links: tuple[Link, ...]
    end: FloatArray

    @classmethod
    def of(cls, robot: Robot, model: mujoco.MjModel) -> "TrunkChain":
        """The chain of `robot` with the coordinates of `model`."""
        fixed, links = np.eye(3), []
        for body in _path(robot.tree, robot.tree.body_of_link[robot.trunk]):
            fixed = fixed @ body.placement.rotation
            if body.joint is not None and body.joint.kind is JointKind.REVOLUTE:
                joint = model.joint(body.joint.name)
                position, velocity = int(joint.qposadr[0]), int(joint.dofadr[0])
                turn = quaternion(fixed)
                links.append(Link(turn, body.joint.axis, position, velocity))
                fixed = np.eye(3)
        end = robot.tree.bodies[robot.tree.body_of_link[robot.trunk]].links[robot.trunk].rotation
        free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
        return cls(
            int(model.jnt_qposadr[free]),
            int(model.jnt_dofadr[free]),
            tuple(links),
            quaternion(fixed @ end),
        )

    def attitude(self, qpos: FloatArray) -> FloatArray:
        """Frame B in the world, quaternions, from qpos (..., nq); shape (..., 4)."""
        found = qpos[..., self.position + 3 : self.position + 7]
        for link in self.links:
            hinge = quaternions.from_axis_angle(link.axis, qpos[..., link.position])
            found = quaternions.product(found, quaternions.product(link.fixed, hinge))
        return found if _is_identity(self.end) else quaternions.product(found, self.end)

    def rate(self, qpos: FloatArray, qvel: FloatArray) -> FloatArray:
        """Angular rate of the trunk in B [rad/s], shape (..., 3)."""
        found: FloatArray = qvel[..., self.velocity + 3 : self.velocity + 6]
        for link in self.links:
            hinge = quaternions.from_axis_angle(link.axis, qpos[..., link.position])
            step = quaternions.matrix(quaternions.product(link.fixed, hinge))
            found = np.einsum("...ji,...j->...i", step, found)
            found = found + link.axis * qvel[..., link.velocity, None]
        if _is_identity(self.end):
            return found
        rate: FloatArray = np.einsum("ji,...j->...i", quaternions.matrix(self.end), found)
        return rate


def _path(tree: Tree, last: int) -> list[Body]:
    """Bodies below the floating base on the way to the body `last`."""
    path: list[Body] = []
    while tree.bodies[last].joint is not None:
        path.insert(0, tree.bodies[last])
        last = tree.bodies[last].parent
    return path


def _is_identity(quaternion: FloatArray) -> bool:
    return bool(quaternion[0] == 1.0)
