"""One simulated world: a model, its initial state, its wheel law and what acts on it.

Wheels and law refer to the trunk, which in some robots joints connect to the floating base (a
humanoid's chest to its pelvis). For most robots this chain is empty.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.jump import LegTrajectory
from ocs_design.requirement.boundary import Push
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Body, JointKind
from ocs_design.simulation.desaturation import Desaturation
from ocs_design.simulation.imperfections import Imperfections
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import Turn
from ocs_design.simulation.target import StoppedDrive
from ocs_design.simulation.wheel_law import WheelLaw
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Trajectory


@dataclass(frozen=True, eq=False)
class TrunkHinge:
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
    """Chain of bodies from the floating base to the trunk's frame B.

    Attributes:
        position, velocity: first index of the free joint in qpos and in qvel.
        links: from the base outwards; prismatic joints do not turn the trunk and are left out.
        end: frame B in the last body, quaternion (4,). origin: that of B there [m], shape (3,).
    """

    position: int
    velocity: int
    links: tuple[TrunkHinge, ...]
    end: FloatArray
    origin: FloatArray

    @classmethod
    def of(cls, robot: Robot, model: mujoco.MjModel) -> "TrunkChain":
        """The chain of `robot` with the coordinates of `model`."""
        # Bodies below the floating base on the way to the trunk.
        tree = robot.tree
        path: list[Body] = []
        last = tree.body_of_link[robot.trunk]
        while tree.bodies[last].joint is not None:
            path.insert(0, tree.bodies[last])
            last = tree.bodies[last].parent
        fixed, links = np.eye(3), []
        for body in path:
            fixed = fixed @ body.placement.rotation
            if body.joint is not None and body.joint.kind is JointKind.REVOLUTE:
                joint = model.joint(body.joint.name)
                position, velocity = int(joint.qposadr[0]), int(joint.dofadr[0])
                turn = quaternion(fixed)
                links.append(TrunkHinge(turn, body.joint.axis, position, velocity))
                fixed = np.eye(3)
        end = tree.bodies[tree.body_of_link[robot.trunk]].links[robot.trunk]
        free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
        return cls(
            int(model.jnt_qposadr[free]),
            int(model.jnt_dofadr[free]),
            tuple(links),
            quaternion(fixed @ end.rotation),
            end.position,
        )

    def attitude(self, qpos: FloatArray) -> FloatArray:
        """Frame B in the world, quaternions, from qpos (..., nq); shape (..., 4)."""
        attitude = qpos[..., self.position + 3 : self.position + 7]
        for link in self.links:
            hinge = quaternions.from_axis_angle(link.axis, qpos[..., link.position])
            attitude = quaternions.product(attitude, quaternions.product(link.fixed, hinge))
        return attitude if _is_identity(self.end) else quaternions.product(attitude, self.end)

    def rate(self, qpos: FloatArray, qvel: FloatArray) -> FloatArray:
        """Angular rate of the trunk in B [rad/s], shape (..., 3)."""
        carried: FloatArray = qvel[..., self.velocity + 3 : self.velocity + 6]
        for link in self.links:
            hinge = quaternions.from_axis_angle(link.axis, qpos[..., link.position])
            step = quaternions.matrix(quaternions.product(link.fixed, hinge))
            carried = np.einsum("...ji,...j->...i", step, carried)
            carried = carried + link.axis * qvel[..., link.velocity, None]
        if _is_identity(self.end):
            return carried
        rate: FloatArray = np.einsum("ji,...j->...i", quaternions.matrix(self.end), carried)
        return rate


def _is_identity(quaternion: FloatArray) -> bool:
    return bool(quaternion[0] == 1.0)


@dataclass(frozen=True)
class Addresses:
    """Addresses in the vectors of a model, equal for all worlds of a batch.

    Attributes:
        wheels: of the wheel joints in qvel. motors: of the wheel motors in ctrl.
        flywheels, trunk: indices of the wheels' bodies and of the trunk's.
        contact, com, momentum, height: in the sensor data.
    """

    wheels: tuple[int, ...]
    motors: tuple[int, ...]
    flywheels: tuple[int, ...]
    trunk: int
    contact: int
    com: int
    momentum: int
    height: int


@dataclass(frozen=True, eq=False)
class World:
    """Everything that a run needs; a batch takes any number of them with models of equal sizes.

    Attributes:
        model: compiled.
        qpos, qvel: at the start, shapes (nq,) and (nv,).
        ctrl: of the joint drives, which hold the nominal posture, shape (nu,).
        support: added to `ctrl` while the feet bear the weight, so that the legs do not sag under
            it, shape (nu,); zero if a trot has torques of its own.
        wheels: their names.
        body: the law's model of the robot, measured on the simulated model at the start.
        law: of the wheels. turn: of the trunk, to be followed. pushes: external ones.
        counted: axis about which whole turns count, in B, shape (3,).
        limits: of the motors; None: the wheels are not driven, or torque is not limited.
        trajectory: to be followed instead of the turn, with its feed-forward torque; None: none.
        legs: trajectory of their push-off or trot; None: they hold their posture.
        standing_height: of the trunk frame's origin when level with the feet on the ground [m].
        stands: how long it stands, or trots, before the maneuver [s]; None: it flies or jumps.
        takes_off: whether its legs send it up, in the run or right before it.
        flight_time: expected [s]. duration: of the run, push-off included [s].
        note: why it starts in flight although a jump was specified; how the turn was changed to
            suit the wheels, or a note on the trajectory; empty if nothing.
        settles: when a robot on a pivot is to be upright and at rest, which counts as its touchdown
            [s]; None: it is not on a pivot.
        imperfections: of sensors and drives; None: they are as the law assumes.
        desaturation: of the wheels in stance; None: they are left to the law.
        stopped: a drive that stops in flight; None: all run.
    """

    model: mujoco.MjModel
    qpos: FloatArray
    qvel: FloatArray
    ctrl: FloatArray
    support: FloatArray
    addresses: Addresses
    wheels: tuple[str, ...]
    chain: TrunkChain
    body: Gyrostat
    law: WheelLaw
    limits: MotorLimits | None
    turn: Turn
    counted: FloatArray
    trajectory: Trajectory | None
    legs: LegTrajectory | None
    pushes: tuple[Push, ...]
    standing_height: float
    stands: float | None
    takes_off: bool
    flight_time: float
    duration: float
    note: str
    settles: float | None = None
    imperfections: Imperfections | None = None
    desaturation: Desaturation | None = None
    stopped: StoppedDrive | None = None


def start_states(worlds: Sequence[World]) -> FloatArray:
    """Full physics states of all worlds at the start, shape (n, nstate)."""
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.empty((len(worlds), mujoco.mj_stateSize(worlds[0].model, kind)))
    data = mujoco.MjData(worlds[0].model)
    for state, world in zip(states, worlds, strict=True):
        data.qpos[:], data.qvel[:] = world.qpos, world.qvel
        mujoco.mj_getState(world.model, data, state, kind)
    return states


ANCHOR = "ocs_pivot"
"""Name of the body that holds a pivot in place (`scene`)."""


def total_mass_properties(model: mujoco.MjModel, data: mujoco.MjData) -> MassProperties:
    """Robot and device, posed as in `data`, as one rigid body in the world, without an anchor."""
    names = (model.body(index).name for index in range(model.nbody))
    mass = np.array(
        [0.0 if n == ANCHOR else m for n, m in zip(names, model.body_mass, strict=True)]
    )
    com = mass @ data.xipos / mass.sum()
    axes, offset = data.ximat.reshape(-1, 3, 3), data.xipos - com
    moments = np.where(mass[:, None] > 0.0, model.body_inertia, 0.0)
    rotated = np.einsum("bij,bj,bkj->ik", axes, moments, axes)
    squares = np.einsum("b,bi,bi->", mass, offset, offset)
    outer = np.einsum("b,bi,bj->ij", mass, offset, offset)
    return MassProperties(float(mass.sum()), com, rotated + squares * np.eye(3) - outer)
