"""Builds the worlds that fly a maneuver: start, law, legs and wheels of one robot."""

from dataclasses import dataclass, replace

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.device.bodies import flywheel_names, joint_names
from ocs_design.device.device import Device
from ocs_design.device.records.flights import ControlRecord
from ocs_design.export.physics import (
    STEADY_LEGS,
    STEP,
    leg_joints,
    set_gains,
    stand,
    standing_torques,
)
from ocs_design.jumping.jump import IN_FLIGHT, JumpPlan
from ocs_design.requirement.boundary import NO_PUSH, UPRIGHT, Y
from ocs_design.requirement.froude import FroudeScale, Gains, wheel_gains
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import HOLD_TIME_RATIO, Pivoted
from ocs_design.requirement.sections import ValidationSection
from ocs_design.requirement.vocabulary import CONTROL_PERIOD
from ocs_design.robot.robot import Robot
from ocs_design.simulation.desaturation import Desaturation
from ocs_design.simulation.engine import Engine
from ocs_design.simulation.launch import flight_time, place, start_height, turn_of
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.reference import NO_TURN, fit_turn
from ocs_design.simulation.scene import JUMP_STEP, Sensor, Wheels, compile_scene, robot_scene
from ocs_design.simulation.trotting import waiting
from ocs_design.simulation.wheel_law import Allocation, WheelLaw
from ocs_design.simulation.world import Addresses, TrunkChain, World, total_mass_properties
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Trajectory


@dataclass(frozen=True)
class Options:
    """Options of a simulation.

    Attributes:
        allocation: of the torque to the wheels.
        gains: of the wheel law; None: `wheel_gains` of the robot.
        drop_at_once: whether a dropped robot is commanded to level in one step, as in the paper.
        hold: steps of 1 ms per control step.
        desaturate: whether the wheels are braked while the robot stands.
        threads: of the physics; None: one per processor.
        pose_rate: of the recorded poses [1/s]; None: no poses.
        engine: of the physics; None: MuJoCo on the CPU.
    """

    allocation: Allocation = Allocation.PSEUDO_INVERSE
    gains: Gains | None = None
    drop_at_once: bool = False
    hold: int = 5
    desaturate: bool = False
    threads: int | None = None
    pose_rate: float | None = None
    engine: Engine | None = None

    @classmethod
    def of_record(cls, control: ControlRecord) -> "Options":
        """Options of flights under a recorded wheel law."""
        return cls(
            allocation=Allocation(control.projection),
            gains=Gains(control.kp, control.kd),
            hold=round(control.period / STEP),
            desaturate=control.desaturate,
        )


class WorldBuilder:
    """Builds the worlds of one robot; its scene is made once."""

    def __init__(self, robot: Robot, device: Device, options: Options | None = None) -> None:
        self._robot, self._device = robot, device
        self._options = options or Options()
        self._gains = self._options.gains or wheel_gains(robot)
        self._limits = MotorLimits.of(device.motor, device.supply, len(device.modules))
        self._scene = robot_scene(robot)

    def flight(
        self,
        maneuver: Maneuver,
        wheels: Wheels,
        trajectory: Trajectory | None = None,
        jump: JumpPlan = IN_FLIGHT,
        *,
        level: bool = False,
    ) -> World:
        """The maneuver with the wheels active, braked or absent.

        Args:
            trajectory: that active wheels track; None: a smooth turn that suits them. A disturbance
                is not known beforehand, and is met by feedback alone.
            jump: plan of the legs' push-off, if any.
            level: fly it level and undisturbed, to see whether the legs can bear the landing.
        """
        active = wheels is Wheels.ACTIVE
        if not active or maneuver.push is not None:
            trajectory = None
        device, legs = self._device.as_flown(maneuver), jump.legs
        pivoted = maneuver if isinstance(maneuver, Pivoted) else None
        model = compile_scene(
            self._scene, self._robot, device, wheels, maneuver.gravity, pivoted=pivoted
        )
        data = mujoco.MjData(model)
        standing = stand(self._robot, model, data)
        set_gains(model, data, self._robot)
        ctrl, support = self._leg_commands(model, data)
        if legs is not None:
            # Only now, since the drives must be the same in every flight.
            model.opt.timestep = JUMP_STEP
        total, wheel = total_mass_properties(model, data), device.flywheel
        body = Gyrostat(total.inertia, device.axes, wheel.spin_inertia, device.motor.armature)
        if pivoted is not None:
            maneuver = pivoted = pivoted.on(total)
            body = replace(
                body,
                inertia=pivoted.inertia,
                gravity_moment=pivoted.gravity_moment,
                edge=pivoted.axis,
            )
        maneuver = replace(maneuver, standing_height=standing)
        boundary = maneuver.boundary()
        turn = turn_of(maneuver, boundary, drop_at_once=self._options.drop_at_once)
        counted = boundary.axis if maneuver.counts_turns else Y
        if pivoted is not None and trajectory is None:
            # Without a plan, or without wheels, there is nothing to spin up and brake.
            boundary = replace(boundary, rate=pivoted.rate_after_disturbance)
        if level:
            boundary = replace(
                boundary, attitude=UPRIGHT, rate=np.zeros(3), wheel_speed=0.0, push=NO_PUSH
            )
            turn = NO_TURN
        flight = flight_time(maneuver, boundary)
        # Time simulated after touchdown: one second for Solo12 on Earth.
        settling = FroudeScale.of(self._robot).time(maneuver.gravity or STANDARD_GRAVITY)
        weight = float(model.body_mass.sum()) * maneuver.gravity
        stands, trot = waiting(maneuver, self._robot, weight, settling)
        lift_off = 0.0 if legs is None else legs.lift_off
        duration = (stands or 0.0) + lift_off + (flight + settling)
        if pivoted is not None:
            standing, duration = -np.inf, (1.0 + HOLD_TIME_RATIO) * pivoted.duration

        law, desaturation = WheelLaw.off(len(device.modules)), None
        if active:
            # The wheels also hold the attitude that one or two legs cannot.
            law = WheelLaw.of(
                body,
                self._gains,
                self._limits,
                self._options.allocation,
                balances=0 < len(self._robot.legs) < STEADY_LEGS,
            )
            turn = fit_turn(turn, body, self._limits) if trajectory is None else turn
            if self._options.desaturate:
                desaturation = Desaturation.of(
                    self._robot, max(standing, 0.0), body.spin_inertia, maneuver.gravity
                )
        turn_note = turn.note if trajectory is None else trajectory.note

        forward, up = maneuver.takeoff
        height, velocity = start_height(maneuver, boundary, standing), np.array([forward, 0.0, up])
        if legs is not None:
            # At rest on its feet: the legs produce the flight.
            height, velocity = standing, np.zeros(3)
        place(self._robot, model, data, replace(boundary, height=height), velocity)
        address = addresses(model, device)
        if active:
            data.qvel[list(address.wheels)] = boundary.wheel_speed
        return World(
            model=model,
            qpos=data.qpos.copy(),
            qvel=data.qvel.copy(),
            ctrl=ctrl,
            support=support if trot is None else np.zeros(model.nu),
            addresses=address,
            wheels=tuple(module.name for module in device.modules),
            chain=TrunkChain.of(self._robot, model),
            body=body,
            law=law,
            limits=self._limits if active and self._limits.is_finite else None,
            turn=turn,
            counted=counted,
            trajectory=trajectory,
            legs=trot or legs,
            pushes=(boundary.push,),
            standing_height=standing,
            stands=stands,
            takes_off=any(maneuver.takeoff),
            # A robot shoved on the ground does not fly: the whole simulated time counts.
            flight_time=flight or settling,
            duration=duration,
            settles=None if pivoted is None else pivoted.duration,
            note="; ".join(filter(None, (jump.note, turn_note))),
            desaturation=desaturation,
        )

    def _leg_commands(
        self, model: mujoco.MjModel, data: mujoco.MjData
    ) -> tuple[FloatArray, FloatArray]:
        """Commands that hold the nominal posture, and what is added to them to bear the weight.

        Of all actuators, shape (nu,) each; the motors of the wheels are at zero. In `data` the
        robot stands level.
        """
        joints = leg_joints(self._robot)
        drives = [model.actuator(name).id for name in joints]
        ctrl, support = np.zeros((2, model.nu))
        ctrl[drives] = [self._robot.posture[name] for name in joints]
        torques = standing_torques(model, data, self._robot)
        support[drives] = torques / model.actuator_gainprm[drives, 0]
        return ctrl, support


def addresses(model: mujoco.MjModel, device: Device) -> Addresses:
    """Addresses by the names that the device has in the model."""
    joints = joint_names(device)
    sensor_address = {sensor: int(model.sensor(sensor.value).adr[0]) for sensor in Sensor}
    return Addresses(
        wheels=tuple(int(model.joint(name).dofadr[0]) for name in joints),
        motors=tuple(model.actuator(name).id for name in joints),
        flywheels=tuple(model.body(name).id for name in flywheel_names(device)),
        trunk=int(model.site(Sensor.TRUNK.value).bodyid[0]),
        contact=sensor_address[Sensor.CONTACT],
        com=sensor_address[Sensor.COM],
        momentum=sensor_address[Sensor.MOMENTUM],
        height=sensor_address[Sensor.TRUNK] + 2,
    )


def control_of(specified: ValidationSection, robot: Robot) -> ControlRecord:
    """Wheel law as specified, with defaults for the rest."""
    gains = wheel_gains(robot)
    default = ControlRecord(
        projection=Allocation.PSEUDO_INVERSE,
        kp=gains.stiffness,
        kd=gains.damping,
        period=round(CONTROL_PERIOD / STEP) * STEP,
        ballistic=False,
    )
    return overridden(default, specified)


def overridden(control: ControlRecord, specified: ValidationSection) -> ControlRecord:
    """Wheel law as recorded, with the specified values replaced."""
    period = round((specified.control_period or control.period) / STEP) * STEP
    given = {
        name: getattr(specified, name) for name in vars(control).keys() & vars(specified).keys()
    }
    changes = {name: value for name, value in given.items() if value is not None}
    return replace(control, period=period, **changes)
