"""One simulated world: a model, where it starts, what its wheels and its surroundings do."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Device
from ocs_design.jumping.jump import IN_FLIGHT, JumpPlan
from ocs_design.jumping.leg_trajectory import LegTrajectory
from ocs_design.requirement.froude import Scale
from ocs_design.requirement.maneuver import STANDARD_GRAVITY, Maneuver, Unforeseen
from ocs_design.robot.robot import Robot
from ocs_design.simulation.controller import Allocation, Gains, WheelLaw
from ocs_design.simulation.desaturation import Desaturation
from ocs_design.simulation.drives import DRIVE, leg_joints, set_gains
from ocs_design.simulation.imperfections import Imperfections
from ocs_design.simulation.launch import (
    Push,
    flight_time,
    launch,
    level_launch,
    on_the_ground,
)
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.placing import place, stand
from ocs_design.simulation.reference import FittedTurn, Profile, Quintic, Turn, fit_turn
from ocs_design.simulation.scene import (
    JUMP_STEP,
    WHEEL_JOINTS,
    Sensor,
    Wheels,
    compile_scene,
    locked_inertia,
    robot_scene,
)
from ocs_design.simulation.trotting import waiting
from ocs_design.simulation.trunk import TrunkChain
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.trajectory import Trajectory

PAPER_GAINS = Gains(stiffness=60.0, damping=12.0)
"""K_p and K_d of all robots where none are stated."""


STEADY_LEGS = 3
"""With so many a robot stands by itself."""


@dataclass(frozen=True)
class Addresses:
    """Where things are in the vectors of a model; equal for all worlds of a batch.

    Attributes:
        wheels: of the wheel joints in qvel. motors: of the wheel motors in ctrl.
        trunk: index of the trunk's body.
        contact, com, momentum, height: in the sensor data.
    """

    wheels: tuple[int, int]
    motors: tuple[int, int]
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
        addresses: see `Addresses`. chain: see `TrunkChain`.
        body: what the law believes in, measured on the model at the start.
        law: of the wheels. turn: what the trunk should do. push: what hits it.
        limits: of the motors; None where the wheels are not driven, or by no limited torque.
        trajectory: what it should do in place of the turn, with its feed-forward torque.
        legs: how they push the robot off the ground, or trot; None: they hold their posture.
        standing_height: of the trunk frame's origin when level with the feet on the ground [m].
        stands: or trots, for how long before the maneuver [s]; None: it flies or jumps.
        flight_time: expected [s]. duration: of the run, push-off included [s].
        note: why it starts in flight where a jump was asked for; how the turn was changed to suit
            the wheels, or what is to be said of the trajectory; empty if nothing.
        imperfections: of sensors and drives; None: they are as the law believes.
        desaturation: of the wheels in stance; None: they are left to the law.
    """

    model: mujoco.MjModel
    qpos: FloatArray
    qvel: FloatArray
    ctrl: FloatArray
    addresses: Addresses
    chain: TrunkChain
    body: Gyrostat
    law: WheelLaw
    limits: MotorLimits | None
    turn: Turn
    trajectory: Trajectory | None
    legs: LegTrajectory | None
    push: Push
    standing_height: float
    stands: float | None
    flight_time: float
    duration: float
    note: str
    imperfections: Imperfections | None = None
    desaturation: Desaturation | None = None


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
        self._limits = MotorLimits.of(device.motor)
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
        """The same flight, level and undisturbed with braked wheels: what the legs can bear."""
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
        model = compile_scene(self._scene, self._robot, device, wheels, maneuver.gravity)
        data = mujoco.MjData(model)
        standing = stand(self._robot, model, data)
        set_gains(model, data, self._robot)
        if legs is not None:
            # Only now: in every flight the drives are the same.
            model.opt.timestep = JUMP_STEP
        body = Gyrostat(
            locked_inertia(model, data, np.eye(3)),
            device.axes,
            device.flywheel.spin_inertia,
            device.motor.armature,
        )
        start = (
            level_launch(maneuver, standing)
            if level
            else launch(maneuver, standing, self._drop_profile)
        )
        flight = flight_time(start, standing, maneuver.gravity)
        settling = settling_time(self._robot, maneuver.gravity)
        weight = float(model.body_mass.sum()) * maneuver.gravity
        waits = waiting(maneuver, self._robot, weight, settling)
        fitted = self._fit(start.turn, body, wheels, trajectory)
        if legs is not None:
            start = on_the_ground(start, standing)
        place(self._robot, model, data, start, standing)
        return World(
            model=model,
            qpos=data.qpos.copy(),
            qvel=data.qvel.copy(),
            ctrl=_posture_control(self._robot, model),
            addresses=addresses(model),
            chain=TrunkChain.of(self._robot, model),
            body=body,
            law=self._law(body, wheels),
            limits=self._limits if wheels is Wheels.ACTIVE and self._limits.is_finite else None,
            turn=fitted.turn,
            trajectory=trajectory,
            legs=waits.legs or legs,
            push=start.push,
            standing_height=standing,
            stands=waits.duration,
            flight_time=flight,
            duration=(waits.duration or 0.0)
            + (0.0 if legs is None else legs.lift_off)
            + flight
            + settling,
            note="; ".join(filter(None, (jump.note, fitted.note))),
            desaturation=self._desaturation(body, wheels, standing, maneuver.gravity),
        )

    def _desaturation(
        self, body: Gyrostat, wheels: Wheels, standing: float, gravity: float
    ) -> Desaturation | None:
        if not self._desaturate or wheels is not Wheels.ACTIVE:
            return None
        return Desaturation.of(self._robot, standing, body.spin_inertia, gravity)

    def _fit(
        self, turn: Turn, body: Gyrostat, wheels: Wheels, trajectory: Trajectory | None
    ) -> FittedTurn:
        if trajectory is not None:
            return FittedTurn(turn, trajectory.note)
        if wheels is Wheels.ACTIVE:
            return fit_turn(turn, body, self._limits)
        return FittedTurn(turn, "")

    def _law(self, body: Gyrostat, wheels: Wheels) -> WheelLaw:
        if wheels is not Wheels.ACTIVE:
            return WheelLaw.off()
        # One leg or two on the ground hold no attitude.
        balances = 0 < len(self._robot.legs) < STEADY_LEGS
        return WheelLaw.of(body, self._gains, self._limits, self._allocation, balances=balances)


def wheel_gains(robot: Robot) -> Gains:
    """The gains of Solo12 with times scaled by the Froude number: `K_p ~ 1/T^2`, `K_d ~ 1/T`."""
    time = Scale.of(robot).time(STANDARD_GRAVITY)
    return Gains(PAPER_GAINS.stiffness / time**2, PAPER_GAINS.damping / time)


def settling_time(robot: Robot, gravity: float) -> float:
    """How long a robot is watched after touchdown [s]: one second for Solo12 on Earth."""
    return Scale.of(robot).time(gravity)


def addresses(model: mujoco.MjModel) -> Addresses:
    """Looks everything up by name."""
    left, right = WHEEL_JOINTS
    at = {sensor: int(model.sensor(sensor.value).adr[0]) for sensor in Sensor}
    return Addresses(
        wheels=(int(model.joint(left).dofadr[0]), int(model.joint(right).dofadr[0])),
        motors=(model.actuator(left).id, model.actuator(right).id),
        trunk=int(model.sensor(Sensor.TRUNK.value).objid[0]),
        contact=at[Sensor.CONTACT],
        com=at[Sensor.COM],
        momentum=at[Sensor.MOMENTUM],
        height=at[Sensor.TRUNK] + 2,
    )


def _posture_control(robot: Robot, model: mujoco.MjModel) -> FloatArray:
    """Every leg drive at the nominal posture, the motors at zero, shape (nu,)."""
    ctrl = np.zeros(model.nu)
    for name in leg_joints(robot):
        ctrl[model.actuator(DRIVE + name).id] = robot.posture[name]
    return ctrl


def start_states(worlds: Sequence[World]) -> FloatArray:
    """Full physics states of all worlds at the start, shape (n, nstate)."""
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.empty((len(worlds), mujoco.mj_stateSize(worlds[0].model, kind)))
    data = mujoco.MjData(worlds[0].model)
    for state, world in zip(states, worlds, strict=True):
        data.qpos[:], data.qvel[:] = world.qpos, world.qvel
        mujoco.mj_getState(world.model, data, state, kind)
    return states
