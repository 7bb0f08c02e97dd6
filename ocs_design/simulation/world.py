"""One simulated world: a model, where it starts, what its wheels and its surroundings do.

The wheels and the law live on the trunk, which in some robots hangs below the floating base by
joints (a humanoid's chest over its pelvis). For most robots the chain is empty.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.device.bodies import flywheel_names, joint_names
from ocs_design.device.device import Device
from ocs_design.export.physics import (
    STEADY_LEGS,
    leg_joints,
    set_gains,
    stand,
    standing_torques,
)
from ocs_design.jumping.jump import IN_FLIGHT, JumpPlan, LegTrajectory
from ocs_design.requirement.froude import Scale
from ocs_design.requirement.maneuver import Maneuver, Unforeseen
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Body, JointKind
from ocs_design.simulation import quaternions
from ocs_design.simulation.desaturation import Desaturation
from ocs_design.simulation.imperfections import Imperfections
from ocs_design.simulation.launch import (
    Push,
    flight_time,
    launch,
    level_launch,
    on_pivot,
    on_the_ground,
    place,
)
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import FittedTurn, Profile, Quintic, Turn, fit_turn
from ocs_design.simulation.scene import (
    JUMP_STEP,
    Sensor,
    Wheels,
    compile_scene,
    locked_inertia,
    robot_scene,
    whole_mass,
)
from ocs_design.simulation.target import StoppedDrive
from ocs_design.simulation.trotting import waiting
from ocs_design.simulation.wheel_law import Allocation, Gains, WheelLaw
from ocs_design.sizing.trajectory.boundary import HELD_ON
from ocs_design.sizing.trajectory.flight import Trajectory
from ocs_design.sizing.trajectory.gyrostat import Gyrostat


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
    """Chain of bodies from the floating base to the trunk's frame B.

    Attributes:
        position, velocity: where the free joint starts in qpos and in qvel.
        links: from the base outwards; slides do not turn the trunk and are left out.
        end: frame B in the last body, quaternion (4,). origin: that of B there [m], shape (3,).
    """

    position: int
    velocity: int
    links: tuple[Link, ...]
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
                links.append(Link(turn, body.joint.axis, position, velocity))
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


def _is_identity(quaternion: FloatArray) -> bool:
    return bool(quaternion[0] == 1.0)


PAPER_GAINS = Gains(stiffness=60.0, damping=12.0)
"""K_p and K_d of all robots where none are stated."""


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
    """Everything that a run needs; a batch takes any number with models of equal sizes.

    Attributes:
        model: compiled.
        qpos, qvel: at the start, shapes (nq,) and (nv,).
        ctrl: of the joint drives, which hold the nominal posture, shape (nu,).
        support: added to it while the feet bear the weight, so that the legs do not give way under
            it, shape (nu,); zero where a trot has torques of its own.
        addresses: see `Addresses`. wheels: their names. chain: see `TrunkChain`.
        body: what the law believes in, measured on the model at the start.
        law: of the wheels. turn: what the trunk should do. pushes: what hits it.
        limits: of the motors; None where the wheels are not driven, or by no limited torque.
        trajectory: what it should do in place of the turn, with its feed-forward torque.
        legs: how they push the robot off the ground, or trot; None: they hold their posture.
        standing_height: of the trunk frame's origin when level with the feet on the ground [m].
        stands: or trots, for how long before the maneuver [s]; None: it flies or jumps.
        takes_off: whether its legs send it up, in the run or right before it.
        flight_time: expected [s]. duration: of the run, push-off included [s].
        note: why it starts in flight where a jump was asked for; how the turn was changed to suit
            the wheels, or what is to be said of the trajectory; empty if nothing.
        settles: when a robot on a pivot is to be upright and at rest, what touchdown is to others
            [s]; None: it stands on none.
        imperfections: of sensors and drives; None: they are as the law believes.
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


class WorldBuilder:
    """Builds the worlds of one robot; its scene is made once."""

    def __init__(
        self,
        robot: Robot,
        device: Device,
        *,
        allocation: Allocation = Allocation.PSEUDO_INVERSE,
        gains: Gains | None = None,
        drop_profile: Profile | None = None,
        desaturate: bool = False,
    ) -> None:
        self._robot = robot
        self._device = device
        self._allocation = allocation
        self._gains = wheel_gains(robot) if gains is None else gains
        self._drop_profile = Quintic() if drop_profile is None else drop_profile
        self._desaturate = desaturate
        self._limits = MotorLimits.of(device.motor, device.supply, len(device.modules))
        self._scene = robot_scene(robot)

    def flight(
        self,
        maneuver: Maneuver,
        wheels: Wheels,
        trajectory: Trajectory | None = None,
        jump: JumpPlan = IN_FLIGHT,
    ) -> World:
        """The maneuver with the wheels active, braked or absent.

        Args:
            maneuver: see `Maneuver`.
            wheels: see `Wheels`.
            trajectory: that active wheels track; None: a smooth turn that suits them. A disturbance
                is not known beforehand, and is met by feedback alone.
            jump: how the legs push the robot off the ground, if they do.
        """
        if wheels is not Wheels.ACTIVE or isinstance(maneuver, Unforeseen):
            trajectory = None
        return self._build(maneuver, wheels, trajectory, jump, level=False)

    def level_landing(self, maneuver: Maneuver, jump: JumpPlan = IN_FLIGHT) -> World:
        """World of the same flight, level, undisturbed, wheels braked: what the legs can bear."""
        return self._build(maneuver, Wheels.BRAKED, None, jump, level=True)

    def _build(
        self,
        maneuver: Maneuver,
        wheels: Wheels,
        trajectory: Trajectory | None,
        jump: JumpPlan,
        *,
        level: bool,
    ) -> World:
        device, legs = self._device.as_flown(maneuver), jump.legs
        pivoted = maneuver if isinstance(maneuver, Pivoted) else None
        model = compile_scene(
            self._scene, self._robot, device, wheels, maneuver.gravity, pivoted=pivoted
        )
        data = mujoco.MjData(model)
        standing = stand(self._robot, model, data)
        set_gains(model, data, self._robot)
        drives = [model.actuator(name).id for name in leg_joints(self._robot)]
        support = np.zeros(model.nu)
        support[drives] = (
            standing_torques(model, data, self._robot) / model.actuator_gainprm[drives, 0]
        )
        if legs is not None:
            # Only now: in every flight the drives are the same.
            model.opt.timestep = JUMP_STEP
        body = Gyrostat(
            locked_inertia(model, data, np.eye(3)),
            device.axes,
            device.flywheel.spin_inertia,
            device.motor.armature,
        )
        if pivoted is not None:
            pivoted = pivoted.on(whole_mass(model, data))
            body = replace(body, inertia=pivoted.inertia, pull=pivoted.pull, edge=pivoted.axis)
            start = on_pivot(pivoted, body)
            if trajectory is None:
                # No brake stops what cannot be spun up, or is not there.
                start = replace(start, rate=pivoted.struck)
        elif level:
            start = level_launch(maneuver, standing)
        else:
            start = launch(maneuver, standing, self._drop_profile)
        flight = flight_time(maneuver, start, standing)
        settling = settling_time(self._robot, maneuver.gravity or STANDARD_GRAVITY)
        weight = float(model.body_mass.sum()) * maneuver.gravity
        waits = waiting(maneuver, self._robot, weight, settling)

        duration = (waits.duration or 0.0) + (0.0 if legs is None else legs.lift_off)
        duration += flight + settling
        if pivoted is not None:
            standing, duration = -np.inf, (1.0 + HELD_ON) * pivoted.duration

        active = wheels is Wheels.ACTIVE
        fitted = FittedTurn(start.turn, "" if trajectory is None else trajectory.note)
        if active and trajectory is None:
            fitted = fit_turn(start.turn, body, self._limits)
        law, desaturation = WheelLaw.off(len(device.modules)), None
        if active:
            # One leg or two on the ground hold no attitude.
            balances = 0 < len(self._robot.legs) < STEADY_LEGS
            law = WheelLaw.of(body, self._gains, self._limits, self._allocation, balances=balances)
        if active and self._desaturate:
            desaturation = Desaturation.of(
                self._robot, standing, body.spin_inertia, maneuver.gravity
            )

        # Every leg drive at the nominal posture, the motors at zero.
        ctrl = np.zeros(model.nu)
        for name in leg_joints(self._robot):
            ctrl[model.actuator(name).id] = self._robot.posture[name]
        takes_off = bool(start.velocity.any())
        if legs is not None:
            start = on_the_ground(start, standing)
        place(self._robot, model, data, start, standing)
        where = addresses(model, device)
        if active:
            data.qvel[list(where.wheels)] = start.wheel_speed
        return World(
            model=model,
            qpos=data.qpos.copy(),
            qvel=data.qvel.copy(),
            ctrl=ctrl,
            support=support if waits.legs is None else np.zeros(model.nu),
            addresses=where,
            wheels=tuple(module.name for module in device.modules),
            chain=TrunkChain.of(self._robot, model),
            body=body,
            law=law,
            limits=self._limits if active and self._limits.is_finite else None,
            turn=fitted.turn,
            trajectory=trajectory,
            legs=waits.legs or legs,
            pushes=(start.push,),
            standing_height=standing,
            stands=waits.duration,
            takes_off=takes_off,
            flight_time=flight,
            duration=duration,
            settles=None if pivoted is None else pivoted.duration,
            note="; ".join(filter(None, (jump.note, fitted.note))),
            desaturation=desaturation,
        )


def wheel_gains(robot: Robot) -> Gains:
    """The gains of Solo12 with times scaled by the Froude number: `K_p ~ 1/T^2`, `K_d ~ 1/T`."""
    time = Scale.of(robot).time(STANDARD_GRAVITY)
    return Gains(PAPER_GAINS.stiffness / time**2, PAPER_GAINS.damping / time)


def settling_time(robot: Robot, gravity: float) -> float:
    """How long a robot is watched after touchdown [s]: one second for Solo12 on Earth."""
    return Scale.of(robot).time(gravity)


def addresses(model: mujoco.MjModel, device: Device) -> Addresses:
    """Addresses by the names that the device has in the model."""
    joints = joint_names(device)
    at = {sensor: int(model.sensor(sensor.value).adr[0]) for sensor in Sensor}
    return Addresses(
        wheels=tuple(int(model.joint(name).dofadr[0]) for name in joints),
        motors=tuple(model.actuator(name).id for name in joints),
        flywheels=tuple(model.body(name).id for name in flywheel_names(device)),
        trunk=int(model.sensor(Sensor.TRUNK.value).objid[0]),
        contact=at[Sensor.CONTACT],
        com=at[Sensor.COM],
        momentum=at[Sensor.MOMENTUM],
        height=at[Sensor.TRUNK] + 2,
    )


def start_states(worlds: Sequence[World]) -> FloatArray:
    """Full physics states of all worlds at the start, shape (n, nstate)."""
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.empty((len(worlds), mujoco.mj_stateSize(worlds[0].model, kind)))
    data = mujoco.MjData(worlds[0].model)
    for state, world in zip(states, worlds, strict=True):
        data.qpos[:], data.qvel[:] = world.qpos, world.qvel
        mujoco.mj_getState(world.model, data, state, kind)
    return states
