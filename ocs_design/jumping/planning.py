"""Plans of jumps: references for the legs, or the reason why they cannot make a jump."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from os import cpu_count
from typing import NamedTuple

import numpy as np

from ocs_design.common.arrays import interpolated
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.device.device import Device
from ocs_design.jumping.flight import FreeRobot, LegReturn
from ocs_design.jumping.floating_base import POSE, FloatingBase, Load
from ocs_design.jumping.jump import Jump, JumpPlan, JumpPlans, LegTrajectory, jump_of
from ocs_design.jumping.legged_body import LeggedBody, obstacle_to_jumping
from ocs_design.jumping.push_off import PushOff, PushOffs
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot

_BRAKE = 0.15
_SWING = 1.5
"""Times in which the legs brake and swing back, over sqrt(L / g) with Earth's g: the drives are the
same under any gravity."""

_LATEST = 0.7
"""Largest share of the flight for the legs' swing back."""

_LEVEL = np.radians(0.5)
"""Tilt at touchdown below which no correction is needed [rad]."""

_SAMPLE = 1e-3
"""Time between two samples of the references [s]."""


_FALLBACK = "starts at lift-off"
"""Note on a run whose push-off cannot be planned."""

_BARE_LEGS = "bare robot's legs"


def plan_jumps(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver]
) -> Mapping[str, JumpPlans]:
    """Plans for each maneuver from the ground, with the device and without, by maneuver name.

    A drop has no push-off and is left out. If the legs cannot make a jump with the device, the bare
    robot starts in flight as well, and vice versa, so that the two can be compared.
    """
    planning = JumpPlanning(robot, maneuvers)
    planning.carry(device)
    return planning.plans()


class JumpPlanning:
    """Jumps planned in threads, in parallel with other work: IPOPT releases Python's lock.

    Planning for the bare robot begins immediately, and for the robot with its device as soon as the
    device is known. Then each search starts from the bare robot's push-off and takes a third of the
    time.
    """

    def __init__(self, robot: Robot, maneuvers: Sequence[Maneuver]) -> None:
        jumps = [(maneuver, jump_of(maneuver)) for maneuver in maneuvers]
        self._jumps = [(maneuver, jump) for maneuver, jump in jumps if jump is not None]
        self._obstacle = obstacle_to_jumping(robot) if self._jumps else ""
        self._bare: dict[Jump, Future[PlannedJump]] = {}
        self._carrying: dict[str, Future[PlannedJump]] = {}
        distinct = {jump for _, jump in self._jumps}
        self._threads = ThreadPoolExecutor(min(max(len(distinct), 1), cpu_count() or 1))
        if self._jumps and not self._obstacle:
            self._body = LeggedBody.of(robot)
            self._planner = self._threads.submit(JumpPlanner, self._body)
            for jump in dict.fromkeys(jump for _, jump in self._jumps):
                self._bare[jump] = self._threads.submit(self._plan, jump, self._body.trunk)

    def carry(self, device: Device) -> None:
        """Begin to plan for the robot that carries this device."""
        if self._bare:
            for maneuver, jump in self._jumps:
                # Nothing drives the wheels until lift-off.
                trunk = device.as_flown(maneuver).on(self._body.trunk, free=True)
                similar = self._bare[jump]
                self._carrying[maneuver.name] = self._threads.submit(
                    self._plan, jump, trunk, similar
                )

    def plans(self) -> Mapping[str, JumpPlans]:
        """All plans by maneuver name; waits until they are done."""
        by_name: dict[str, JumpPlans] = {}
        for maneuver, jump in self._jumps:
            if self._obstacle:
                by_name[maneuver.name] = _no_push_off(f"{_FALLBACK}: {self._obstacle}")
                continue
            carrying = self._carrying[maneuver.name].result().plan
            bare = self._bare[jump].result().plan
            if carrying.legs is not None and bare.legs is not None:
                by_name[maneuver.name] = JumpPlans(carrying, bare)
                continue
            legs_text, failed = ("legs", carrying) if carrying.legs is None else (_BARE_LEGS, bare)
            note = f"{_FALLBACK}, because the {legs_text} cannot make this jump: {failed.note}"
            by_name[maneuver.name] = _no_push_off(note)
        self._threads.shutdown()
        return by_name

    def cancel(self) -> None:
        """Start no further plans."""
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _plan(
        self, jump: Jump, trunk: MassProperties, similar: "Future[PlannedJump] | None" = None
    ) -> "PlannedJump":
        # Threads take their work in order, so the awaited plan has already begun.
        known = None if similar is None else similar.result().push_off
        return self._planner.result().plan(jump, trunk, similar=known)


def _no_push_off(note: str) -> JumpPlans:
    """Plans without a push-off, with and without the device, for the same reason."""
    return JumpPlans(JumpPlan(None, note), JumpPlan(None, note))


class PlannedJump(NamedTuple):
    """A jump's plan, and its push-off, from which to start the search for a similar one."""

    plan: JumpPlan
    push_off: PushOff


class JumpPlanner:
    """Plans the jumps of one robot; everything independent of the jump is built once."""

    def __init__(self, body: LeggedBody) -> None:
        base = FloatingBase.of(body)
        self._body = body
        self._push_offs = PushOffs(body, base)
        self._free = FreeRobot(base)

    def plan(
        self, jump: Jump, trunk: MassProperties, similar: PushOff | None = None
    ) -> PlannedJump:
        """Plan a jump from which the robot lands level without any help.

        Args:
            trunk: of `LeggedBody`, with its load.
            similar: a push-off of this jump with another trunk, from which the search starts.
        """
        load = Load.values(jump.gravity, trunk)
        time = float(np.sqrt(self._body.length / STANDARD_GRAVITY))
        swing, spin = min(_SWING * time, _LATEST * jump.flight_time), None
        for corrected in (False, True):
            push_off = self._push_offs.find(jump, trunk, spin=spin, similar=similar)
            if push_off.forbidden:
                return PlannedJump(JumpPlan(None, push_off.forbidden), push_off)
            y, v = push_off.y[-1], push_off.v[-1]
            legs = LegReturn(y[POSE:], v[POSE:], self._body.posture, _BRAKE * time, swing)
            flight = self._free.fly(y, v, legs, load, jump.flight_time)
            if corrected or np.abs(flight.tilt).max() <= _LEVEL:
                break
            # The legs turn the trunk as they swing back: a spin at lift-off turns it back as far.
            inertia = self._free.inertia(y, load)
            spin, similar = -inertia @ flight.tilt / jump.flight_time, push_off
        # Push-off, then flight.
        lift_off = float(push_off.time[-1])
        pushing = np.arange(0.0, lift_off, _SAMPLE)
        position, velocity = push_off.joints_at(pushing)
        torque = interpolated(pushing, push_off.time, push_off.torque)
        trajectory = LegTrajectory(
            joints=tuple(joint.name for joint in self._body.joints),
            time=np.append(pushing, lift_off + flight.time),
            position=np.vstack([position, flight.position]),
            velocity=np.vstack([velocity, flight.velocity]),
            torque=np.vstack([torque, flight.torque]),
            lift_off=lift_off,
        )
        return PlannedJump(JumpPlan(trajectory, ""), push_off)
