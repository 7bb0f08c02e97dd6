"""From a jump that is asked for to what the legs track, or why they cannot make it."""

from collections.abc import Mapping, Sequence

import numpy as np

from ocs_design.design import Device
from ocs_design.jumping.flight import FreeRobot, LegFlight, LegReturn
from ocs_design.jumping.floating_base import POSE, FloatingBase, Load
from ocs_design.jumping.jump import Jump, JumpPlan, JumpPlans, jump_of
from ocs_design.jumping.leg_trajectory import LegTrajectory
from ocs_design.jumping.legged_body import LeggedBody, obstacle_to_jumping
from ocs_design.jumping.push_off import PushOff, PushOffs
from ocs_design.requirement.maneuver import STANDARD_GRAVITY, Maneuver
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.selection.candidate import braked

_BRAKE = 0.15
_SWING = 1.5
"""Times in which the legs brake and go back, over sqrt(L / g) on Earth: the drives are the same
wherever they are."""

_LATEST = 0.7
"""Largest share of the flight that their swing back takes."""

_LEVEL = np.radians(0.5)
"""A trunk that comes down off level by less needs no correction [rad]."""

_SAMPLE = 1e-3
"""[s], between two samples of the references."""


def plan_jumps(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver]
) -> Mapping[str, JumpPlans]:
    """How the robot makes each maneuver from the ground, with its device and without, by its name.

    A drop has no push-off and is left out. Where the legs cannot make a jump with the device, the
    bare robot starts in flight as well, and the other way round: what is compared must be alike.
    """
    asked = {each.name: jump_of(each) for each in maneuvers}
    jumps = {name: jump for name, jump in asked.items() if jump is not None}
    if not jumps:
        return {}
    obstacle = obstacle_to_jumping(robot)
    if obstacle:
        return {name: _both(f"{_FALLBACK}: {obstacle}") for name in jumps}
    body = LeggedBody.of(robot)
    planner = JumpPlanner(body)
    flown = {each.name: device.as_flown(each) for each in maneuvers}
    return {
        name: _alike(
            planner.plan(jump, with_device(body.trunk, flown[name])), planner.plan(jump, body.trunk)
        )
        for name, jump in jumps.items()
    }


_FALLBACK = "starts at lift-off"


def _alike(carrying: JumpPlan, bare: JumpPlan) -> JumpPlans:
    if carrying.legs is not None and bare.legs is not None:
        return JumpPlans(carrying, bare)
    if carrying.legs is None:
        return _both(f"{_FALLBACK}, for the legs cannot make this jump: {carrying.note}")
    return _both(f"{_FALLBACK}, for the bare robot's legs cannot make this jump: {bare.note}")


def _both(note: str) -> JumpPlans:
    return JumpPlans(JumpPlan(None, note), JumpPlan(None, note))


def with_device(trunk: MassProperties, device: Device) -> MassProperties:
    """A trunk that carries a device whose wheels spin freely: nothing drives them until lift-off.

    The momentum of wheel and rotor about their axis does not turn with the trunk (docs/theory.md,
    The robot with its wheels: a gyrostat); the carrier's inertia has the rotor's in it.
    """
    wheel, motor = device.flywheel, device.motor
    free = Carrier(wheel.mass, -motor.rotor_inertia, wheel.transverse_inertia)
    centers = np.stack([module.position for module in device.modules])
    return braked(trunk, (free, device.carrier), centers, device.incidence)


class JumpPlanner:
    """Plans the jumps of one robot; what does not depend on the jump is made once."""

    def __init__(self, body: LeggedBody) -> None:
        self._body = body
        self._push_offs = PushOffs(body)
        self._free = FreeRobot(FloatingBase.of(body))
        self._known: dict[Jump, PushOff] = {}

    def plan(self, jump: Jump, trunk: MassProperties) -> JumpPlan:
        """A push-off from which the robot comes down level by itself.

        Args:
            jump: see `Jump`.
            trunk: of `LeggedBody`, with what it carries.
        """
        push_off = self._push_offs.find(jump, trunk, similar=self._known.get(jump))
        if push_off.forbidden:
            return JumpPlan(None, push_off.forbidden)
        flight = self._fly(push_off, jump, trunk)
        if np.abs(flight.tilt).max() > _LEVEL:
            # The legs turn the trunk as they go back: a spin at lift-off turns it as far again.
            inertia = self._free.inertia(push_off.y[-1], Load.values(jump.gravity, trunk))
            spin = -inertia @ flight.tilt / jump.flight_time
            push_off = self._push_offs.find(jump, trunk, spin=spin, similar=push_off)
            flight = self._fly(push_off, jump, trunk)
        if push_off.forbidden:
            return JumpPlan(None, push_off.forbidden)
        self._known[jump] = push_off
        return JumpPlan(_joined(self._body, push_off, flight), "")

    def _fly(self, push_off: PushOff, jump: Jump, trunk: MassProperties) -> LegFlight:
        body, y, v = self._body, push_off.y[-1], push_off.v[-1]
        time = np.sqrt(body.length / STANDARD_GRAVITY)
        duration = jump.flight_time
        swing = min(_SWING * float(time), _LATEST * duration)
        legs = LegReturn(y[POSE:], v[POSE:], body.posture, _BRAKE * float(time), swing)
        return self._free.fly(y, v, legs, Load.values(jump.gravity, trunk), duration)


def _joined(body: LeggedBody, push_off: PushOff, flight: LegFlight) -> LegTrajectory:
    """Push-off and flight one after the other."""
    lift_off = float(push_off.time[-1])
    pushing = np.arange(0.0, lift_off, _SAMPLE)
    position, velocity = push_off.joints_at(pushing)
    torque = [np.interp(pushing, push_off.time, column) for column in push_off.torque.T]
    return LegTrajectory(
        joints=tuple(joint.name for joint in body.joints),
        time=np.append(pushing, lift_off + flight.time),
        position=np.vstack([position, flight.position]),
        velocity=np.vstack([velocity, flight.velocity]),
        torque=np.vstack([np.column_stack(torque), flight.torque]),
        lift_off=lift_off,
    )
